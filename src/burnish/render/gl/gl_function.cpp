// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cassert>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <burnish/render/gl/gl_function.h>
#include <burnish/render/glsl_files.h>

namespace burnish {

namespace {

constexpr unsigned kGroup = 64;

std::string whole_program(const std::string& text, const std::string& name) {
  return fmt::format("{}\n#define burnish_called {}\n{}", text, name,
                     text_of(glsl_files(), "function.comp.glsl"));
}

}  // namespace

GlFunction::GlFunction(const std::string& text, const std::string& name)
    : program_(link_program(std::array{GlShaderSource{GL_COMPUTE_SHADER, whole_program(text, name)}})) {}

GlFunction::~GlFunction() {
  glDeleteBuffers(static_cast<GLsizei>(numbers_.size()), numbers_.data());
  glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  glDeleteProgram(program_);
}

void GlFunction::add_texture(const std::string& name, unsigned texture) {
  glProgramUniform1i(program_, glGetUniformLocation(program_, name.c_str()),
                     static_cast<GLint>(textures_.size()));
  textures_.push_back(texture);
}

void GlFunction::set_texture(const GlTexture& texture) {
  add_texture(texture.name, upload_texture(texture));
}

void GlFunction::set_texture(const MapTexture& texture, bool single) {
  add_texture(texture.name, upload_texture(texture, single));
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
