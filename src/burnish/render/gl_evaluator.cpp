#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl_evaluator.h>
#include <burnish/render/gl_objects.h>

namespace burnish {

namespace {

constexpr unsigned kGroup = 64;

constexpr const char* kMain = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Pairs { float pairs[]; };
layout(std430, binding = 1) writeonly buffer Values { float values[]; };
uniform uint count;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 wi = vec3(pairs[6u * i], pairs[6u * i + 1u], pairs[6u * i + 2u]);
  vec3 wo = vec3(pairs[6u * i + 3u], pairs[6u * i + 4u], pairs[6u * i + 5u]);
  vec3 f = burnish_model(wi, wo);
  values[3u * i] = f.x;
  values[3u * i + 1u] = f.y;
  values[3u * i + 2u] = f.z;
}
)";

}  // namespace

GlEvaluator::GlEvaluator(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision) {
  if (precision != TableFormat::half && precision != TableFormat::single)
    throw Error(fmt::format("OpenGL: expected textures of half or float, found {}", to_string(precision)));
  const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"});
  const GlShaderSource source{GL_COMPUTE_SHADER, shader.text + kMain};
  program_ = link_program({&source, 1});
  for (std::size_t i = 0; i < brdf.tables().size(); ++i) {
    const Table& table = brdf.tables()[i];
    textures_.push_back(upload_texture({.name = shader.textures[i],
                                        .width = table.layout.width,
                                        .height = table.layout.height,
                                        .channels = table.channels,
                                        .precision = precision,
                                        .filtered = filter == ShaderFilter::hardware,
                                        .values = table.values}));
    glProgramUniform1i(program_, glGetUniformLocation(program_, shader.textures[i].c_str()),
                       static_cast<GLint>(i));
  }
}

GlEvaluator::~GlEvaluator() {
  glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  glDeleteProgram(program_);
}

std::vector<float> GlEvaluator::eval(std::span<const GlDirections> pairs) const {
  assert(pairs.size() <= kMostPairs);
  std::vector<float> values(3 * pairs.size());
  if (pairs.empty()) return values;
  GLuint buffers[2];
  glCreateBuffers(2, buffers);
  glNamedBufferStorage(buffers[0], static_cast<GLsizeiptr>(pairs.size_bytes()), pairs.data(), 0);
  const auto size = static_cast<GLsizeiptr>(values.size() * sizeof(float));
  glNamedBufferStorage(buffers[1], size, nullptr, 0);
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, 2, buffers);
  glBindTextures(0, static_cast<GLsizei>(textures_.size()), textures_.data());
  glUseProgram(program_);
  const auto count = static_cast<GLuint>(pairs.size());
  glProgramUniform1ui(program_, glGetUniformLocation(program_, "count"), count);
  glDispatchCompute((count + kGroup - 1) / kGroup, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(buffers[1], 0, size, values.data());
  glDeleteBuffers(2, buffers);
  return values;
}

}  // namespace burnish
