// SPDX-License-Identifier: Apache-2.0
#include "rates.h"

#include <array>
#include <memory>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

namespace burnish::reports {

namespace {

constexpr unsigned kGroup = 64, kGroups = 1 << 13;

// Evaluates at points of an additive sequence, in a square within the disk of a unit vector's x and y. The sums are
// written, so the driver cannot leave evaluations out.
constexpr const char* kProgram = R"(layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer burnish_Sums {{ float burnish_sums[]; }};
uniform int burnish_rounds;
{declarations}
void main() {{
  vec4 burnish_at = fract(float(gl_GlobalInvocationID.x) * vec4(0.6180340, 0.4142136, 0.7320508, 0.2360680));
  vec3 burnish_sum = vec3(0.0);
  for (int burnish_i = 0; burnish_i < burnish_rounds; ++burnish_i) {{
    burnish_at = fract(burnish_at + vec4(0.8566749, 0.7338919, 0.6287067, 0.5385972));
    vec2 burnish_o = 1.4 * burnish_at.xy - 0.7, burnish_a = 1.4 * burnish_at.zw - 0.7;
    vec3 wo = vec3(burnish_o, sqrt(1.0 - dot(burnish_o, burnish_o))), wi = vec3(burnish_a, sqrt(1.0 - dot(burnish_a, burnish_a)));
{view}{light}    burnish_sum += wi.z * ({value});
  }}
  burnish_sums[gl_GlobalInvocationID.x] = burnish_sum.x + burnish_sum.y + burnish_sum.z;
}}
)";

class Evaluations {
 public:
  explicit Evaluations(const SurfaceShader& shader)
      : program_(link_program(std::array{
            GlShaderSource{GL_COMPUTE_SHADER,
                           fmt::format(fmt::runtime(kProgram), fmt::arg("declarations", shader.declarations),
                                       fmt::arg("view", shader.view), fmt::arg("light", shader.light),
                                       fmt::arg("value", shader.value))}})) {
    for (const GlTexture& texture : shader.textures) {
      glProgramUniform1i(program_, glGetUniformLocation(program_, texture.name.c_str()),
                         static_cast<GLint>(textures_.size()));
      textures_.push_back(upload_texture(texture));
    }
    glCreateBuffers(1, &sums_);
    glNamedBufferStorage(sums_, GLsizeiptr{kGroup} * kGroups * GLsizeiptr{sizeof(float)}, nullptr, 0);
  }
  ~Evaluations() {
    glDeleteBuffers(1, &sums_);
    glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    glDeleteProgram(program_);
  }
  Evaluations(const Evaluations&) = delete;
  Evaluations& operator=(const Evaluations&) = delete;

  // Runs kGroup * kGroups evaluations a round.
  void run(int rounds) const {
    glUseProgram(program_);
    glProgramUniform1i(program_, glGetUniformLocation(program_, "burnish_rounds"), rounds);
    glBindTextures(0, static_cast<GLsizei>(textures_.size()), textures_.data());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, sums_);
    glDispatchCompute(kGroups, 1, 1);
    glFinish();
  }

 private:
  GLuint program_, sums_ = 0;
  std::vector<GLuint> textures_;
};

}  // namespace

Table evaluation_rates(const std::string& first, const std::vector<FrameMaterial>& materials,
                       int repetitions) {
  std::vector<std::unique_ptr<Evaluations>> all;
  std::vector<std::function<void(int)>> tasks;
  for (const FrameMaterial& material : materials) {
    all.push_back(std::make_unique<Evaluations>(material.shader));
    all.back()->run(1);  // compiles the shader
    tasks.emplace_back([evaluations = all.back().get()](int rounds) { evaluations->run(rounds); });
  }
  const std::vector<Times> times = time_rounds(tasks, repetitions);
  Table table({"material", "billions a second", "of " + first});
  const auto rate = [](double seconds) { return 1e-9 * kGroup * kGroups / seconds; };
  for (std::size_t i = 0; i < materials.size(); ++i)
    table.add({materials[i].name, fmt::format("{:.3g} ({:.3g})", rate(times[i].least), rate(times[i].median)),
               fmt::format("{:.2f}", times[i].least / times[0].least)});
  return table;
}

}  // namespace burnish::reports
