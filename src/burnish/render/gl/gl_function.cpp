#include <array>
#include <cassert>

#include <epoxy/gl.h>

#include <burnish/render/gl/gl_function.h>

namespace burnish {

namespace {

constexpr unsigned kGroup = 64;

constexpr const char* kMain = R"(
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Arguments { float arguments[]; };
layout(std430, binding = 1) writeonly buffer Values { float values[]; };
uniform uint count;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 a = vec3(arguments[6u * i], arguments[6u * i + 1u], arguments[6u * i + 2u]);
  vec3 b = vec3(arguments[6u * i + 3u], arguments[6u * i + 4u], arguments[6u * i + 5u]);
  vec3 f = burnish_called(a, b);
  values[3u * i] = f.x;
  values[3u * i + 1u] = f.y;
  values[3u * i + 2u] = f.z;
}
)";

}  // namespace

GlFunction::GlFunction(const std::string& text, const std::string& name)
    : program_(link_program(
          std::array{GlShaderSource{GL_COMPUTE_SHADER, text + "\n#define burnish_called " + name + kMain}})) {
}

GlFunction::~GlFunction() {
  glDeleteBuffers(static_cast<GLsizei>(numbers_.size()), numbers_.data());
  glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  glDeleteProgram(program_);
}

void GlFunction::set_texture(const GlTexture& texture) {
  glProgramUniform1i(program_, glGetUniformLocation(program_, texture.name.c_str()),
                     static_cast<GLint>(textures_.size()));
  textures_.push_back(upload_texture(texture));
}

void GlFunction::set_numbers(std::span<const float> numbers) {
  glDeleteBuffers(static_cast<GLsizei>(numbers_.size()), numbers_.data());
  numbers_.resize(1);
  glCreateBuffers(1, numbers_.data());
  glNamedBufferStorage(numbers_[0], static_cast<GLsizeiptr>(numbers.size_bytes()), numbers.data(), 0);
}

std::vector<float> GlFunction::call(std::span<const GlVectors> arguments) const {
  assert(arguments.size() <= kMaxCalls);
  std::vector<float> values(3 * arguments.size());
  if (arguments.empty()) return values;
  GLuint buffers[2];
  glCreateBuffers(2, buffers);
  glNamedBufferStorage(buffers[0], static_cast<GLsizeiptr>(arguments.size_bytes()), arguments.data(), 0);
  const auto size = static_cast<GLsizeiptr>(values.size() * sizeof(float));
  glNamedBufferStorage(buffers[1], size, nullptr, 0);
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, 2, buffers);
  if (!numbers_.empty()) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, numbers_[0]);
  glBindTextures(0, static_cast<GLsizei>(textures_.size()), textures_.data());
  glUseProgram(program_);
  const auto count = static_cast<GLuint>(arguments.size());
  glProgramUniform1ui(program_, glGetUniformLocation(program_, "count"), count);
  glDispatchCompute((count + kGroup - 1) / kGroup, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(buffers[1], 0, size, values.data());
  glDeleteBuffers(2, buffers);
  return values;
}

}  // namespace burnish
