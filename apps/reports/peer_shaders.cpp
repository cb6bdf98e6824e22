// SPDX-License-Identifier: Apache-2.0
#include "peer_shaders.h"

#include <cmath>

#include <fmt/format.h>

#include <burnish/math/angles.h>
#include <burnish/power/code.h>
#include <burnish/reflectance/analytic/diffuse.h>

namespace burnish::reports {

namespace {

std::string number(double x) {
  const std::string digits = fmt::format("{}", static_cast<float>(x));
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}
std::string color(Rgb c) {
  return fmt::format("vec3({}, {}, {})", number(c.r), number(c.g), number(c.b));
}

// Layers of the network [Sztrajman 2021], four units a vec4. The weights hold the kernel's rows, then the bias.
class Layers {
 public:
  explicit Layers(std::span<const float> weights) : weights_(weights) {}

  // Returns the layer's statements. Its outputs are the components of NAME0, NAME1, ...
  std::string layer(const std::vector<std::string>& inputs, std::size_t outputs, const std::string& name,
                    bool cut_off) {
    const auto weight = [&](std::size_t i, std::size_t o) {
      return o < outputs ? number(weights_[at_ + i * outputs + o]) : std::string("0.0");
    };
    std::string text;
    for (std::size_t first = 0; first < outputs; first += 4) {
      const auto row = [&](std::size_t i) {
        return fmt::format("vec4({}, {}, {}, {})", weight(i, first), weight(i, first + 1),
                           weight(i, first + 2), weight(i, first + 3));
      };
      std::string sum = row(inputs.size());
      for (std::size_t i = 0; i < inputs.size(); ++i)
        if (!inputs[i].empty()) sum += fmt::format(" + {} * {}", inputs[i], row(i));
      text +=
          fmt::format(fmt::runtime(cut_off ? "  vec4 {}{} = max({}, vec4(0.0));\n" : "  vec4 {}{} = {};\n"),
                      name, first / 4, sum);
    }
    at_ += (inputs.size() + 1) * outputs;
    return text;
  }

 private:
  std::span<const float> weights_;
  std::size_t at_ = 0;
};

std::vector<std::string> components(const std::string& name, std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < count; ++i) names.push_back(fmt::format("{}{}.{}", name, i / 4, "xyzw"[i % 4]));
  return names;
}

// This code computes wi in the frame that turns the half vector onto the normal [Rusinkiewicz 1998].
constexpr const char* kDifference =
    "  vec3 h = normalize(wi + wo);\n"
    "  float sine = sqrt(max(h.x * h.x + h.y * h.y, 1e-20));\n"
    "  vec2 turn = h.xy / sine;\n"
    "  float ahead = dot(turn, wi.xy);\n"
    "  vec3 d = vec3(h.z * ahead - sine * wi.z, turn.x * wi.y - turn.y * wi.x, dot(wi, h));\n";

}  // namespace

SurfaceShader shader_of(const Ggx& ggx) {
  const double x = ggx.distribution.alpha_x, y = ggx.distribution.alpha_y;
  const std::string area = fmt::format(
      "0.5 * ({{0}}.z + sqrt({} * {{0}}.x * {{0}}.x + {} * {{0}}.y * {{0}}.y + {{0}}.z * {{0}}.z))",
      number(x * x), number(y * y));
  SurfaceShader shader;
  shader.view = "  float area_o = " + fmt::format(fmt::runtime(area), "wo") + ";\n";
  shader.light = fmt::format(
      "  vec3 h = normalize(wi + wo);\n"
      "  float q = {} * h.x * h.x + {} * h.y * h.y + h.z * h.z;\n"
      "  float area_i = {};\n"
      "  float visible = area_i * wo.z + area_o * wi.z - wi.z * wo.z;\n"
      "  float m = 1.0 - dot(wi, h);\n"
      "  float m2 = m * m;\n",
      number(1 / (x * x)), number(1 / (y * y)), fmt::format(fmt::runtime(area), "wi"));
  shader.value =
      fmt::format("{} + {} / (q * q * visible) * ({} + m2 * m2 * m * {})", color(Rgb(1 / kPi) * ggx.kd),
                  number(1 / (4 * kPi * x * y)), color(ggx.f0), color(1 + -1.0 * ggx.f0));
  return shader;
}

SurfaceShader shader_of(const BlinnPhong& phong, bool by_w8) {
  SurfaceShader shader;
  if (by_w8)
    shader.declarations = power_code(PowerMethod::w8, {.language = "glsl", .exponent = phong.exponent});
  shader.light = "  float c = normalize(wi + wo).z;\n";
  const double scale = phong.normalized ? blinn_phong_normalization(phong.exponent) : 1;
  shader.value = fmt::format("{} + {} * {}", color(Rgb(1 / kPi) * phong.kd),
                             by_w8 ? "power_w8(c)" : fmt::format("pow(c, {})", number(phong.exponent)),
                             color(Rgb(scale) * phong.ks));
  return shader;
}

SurfaceShader shader_of(const HalfDiffTable& table) {
  SurfaceShader shader;
  shader.declarations = "uniform sampler3D table;\n";
  shader.light = fmt::format(
      "{}  float theta_h = atan(sine, h.z), theta_d = acos(min(d.z, 1.0)), phi_d = atan(d.y, d.x);\n"
      "  vec3 at = vec3(fract(phi_d * {}), theta_d * {}, sqrt(theta_h * {}));\n",
      kDifference, number(1 / (table.full_circle ? kTwoPi : kPi)), number(1 / kHalfPi), number(1 / kHalfPi));
  shader.value = "textureLod(table, at, 0.0).rgb";
  GlTexture texture{.name = "table",
                    .width = table.phi_d_count,
                    .height = table.theta_d_count,
                    .depth = table.theta_h_count,
                    .channels = 3,
                    .precision = TableFormat::half,
                    .filtered = true,
                    .values = table.values};
  for (float& value : texture.values) value = std::isnan(value) ? 0 : value;
  shader.textures.push_back(std::move(texture));
  return shader;
}

SurfaceShader shader_of(const NeuralBrdf& network) {
  constexpr std::size_t kHidden = NeuralBrdf::kHidden;
  Layers layers(network.weights());
  SurfaceShader shader;
  shader.light = kDifference;
  shader.light += layers.layer({"sine", "", "h.z", "d.x", "d.y", "d.z"}, kHidden, "first", true);
  shader.light += layers.layer(components("first", kHidden), kHidden, "second", true);
  shader.light += layers.layer(components("second", kHidden), NeuralBrdf::kOutputs, "out_", false);
  shader.value = "max(exp(out_0.xyz) - 1.0, vec3(0.0))";
  return shader;
}

}  // namespace burnish::reports
