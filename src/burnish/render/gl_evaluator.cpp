#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl_evaluator.h>

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

GLuint upload(const Table& table, ShaderFilter filter, TableFormat precision) {
  const bool half = precision == TableFormat::half;
  const GLenum stored = table.channels == 1 ? (half ? GL_R16F : GL_R32F) : (half ? GL_RGB16F : GL_RGB32F);
  const GLint interpolation = filter == ShaderFilter::exact ? GL_NEAREST : GL_LINEAR;
  GLuint texture = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &texture);
  glTextureStorage2D(texture, 1, stored, table.layout.width, table.layout.height);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTextureSubImage2D(texture, 0, 0, 0, table.layout.width, table.layout.height,
                      table.channels == 1 ? GL_RED : GL_RGB, GL_FLOAT, table.values.data());
  for (const GLenum filters : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(texture, filters, interpolation);
  for (const GLenum edges : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTextureParameteri(texture, edges, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

GlEvaluator::GlEvaluator(const FactoredBrdf& brdf, ShaderFilter filter, TableFormat precision) {
  if (precision != TableFormat::half && precision != TableFormat::single)
    throw Error(fmt::format("OpenGL: expected textures of half or float, found {}", to_string(precision)));
  const Shader shader = generate_shader(brdf, {ShaderLanguage::glsl, filter, "model"});
  const std::string text = "#version 450\n" + shader.text + kMain;
  const char* source = text.c_str();
  program_ = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source);
  GLint linked = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &linked);
  if (!linked) {
    std::string log(4096, '\0');
    GLsizei size = 0;
    glGetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), &size, log.data());
    glDeleteProgram(program_);
    throw Error("OpenGL: expected a shader that links, found: " +
                log.substr(0, static_cast<std::size_t>(size)));
  }
  for (std::size_t i = 0; i < brdf.tables().size(); ++i) {
    textures_.push_back(upload(brdf.tables()[i], filter, precision));
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
