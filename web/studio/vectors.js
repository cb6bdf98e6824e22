// Vectors of three numbers; angles are in radians.
export const add = (a, b, s = 1) => [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]];
export const scale = (a, s) => [s * a[0], s * a[1], s * a[2]];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const normalize = (a) => scale(a, 1 / Math.hypot(...a));
export const radians = (degrees) => (degrees * Math.PI) / 180;
export const degrees = (radians) => (radians * 180) / Math.PI;
export const clamp = (x, low, high) => Math.min(Math.max(x, low), high);
// Returns the unit vector at polar angle theta and azimuth phi.
export const direction = (theta, phi) => [Math.sin(theta) * Math.cos(phi), Math.sin(theta) * Math.sin(phi), Math.cos(theta)];

// Returns [wi, wo] of half/difference angles [Rusinkiewicz 1998]. They may lie below the horizon.
export function fromHalfDiff(thetaH, phiH, thetaD, phiD) {
  const h = direction(thetaH, phiH);
  const e1 = [Math.cos(thetaH) * Math.cos(phiH), Math.cos(thetaH) * Math.sin(phiH), -Math.sin(thetaH)];
  const e2 = [-Math.sin(phiH), Math.cos(phiH), 0];
  const side = add(scale(e1, Math.cos(phiD) * Math.sin(thetaD)), e2, Math.sin(phiD) * Math.sin(thetaD));
  const along = scale(h, Math.cos(thetaD));
  return [add(along, side), add(along, side, -1)];
}

// Returns values of n x channels as rgb triples. One channel becomes grey, many become their mean.
export function toRgb(values, channels) {
  if (channels === 3) return values;
  const count = values.length / channels, rgb = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    let sum = 0;
    for (let c = 0; c < channels; ++c) sum += values[i * channels + c];
    rgb.fill(sum / channels, 3 * i, 3 * i + 3);
  }
  return rgb;
}
