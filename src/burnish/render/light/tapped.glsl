
// The environment seen through what directions share of a lobe: a sum over taps, each with its solid angle and its
// level of blur. Normal n, tangent t, and s at right angles to both.
const vec4 @LOBE_taps[@COUNT] = vec4[](@TAPS);
const float @LOBE_levels[@COUNT] = float[](@LEVELS);
vec3 @LOBE_gathered(vec3 wo, vec3 n, vec3 t, vec3 s) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < @COUNT; ++i) {
    vec3 tap = @LOBE_taps[i].xyz;
    float area = @LOBE_taps[i].w, level = @LOBE_levels[i];
@DIRECTION    if (wi.z <= 0.0) continue;
@LIGHT    sum += @VALUE;
  }
  return sum;
}
