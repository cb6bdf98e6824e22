#include <cassert>

#include <epoxy/gl.h>

#include <burnish/error.h>
#include <burnish/render/gl_function.h>

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

GlFunction::GlFunction(const std::string& text, const std::string& name) {
  const std::string whole = "#version 450\n" + text + "\n#define burnish_called " + name + kMain;
  const char* source = whole.c_str();
  program_ = glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &source);
  GLint linked = 0;
  glGetProgramiv(program_, GL_LINK_STATUS, &linked);
  if (linked) return;
  std::string log(4096, '\0');
  GLsizei size = 0;
  glGetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), &size, log.data());
  glDeleteProgram(program_);
  throw Error("OpenGL: expected a shader that links, found: " +
              log.substr(0, static_cast<std::size_t>(size)));
}

GlFunction::~GlFunction() {
  glDeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
  glDeleteProgram(program_);
}

void GlFunction::set_texture(const std::string& sampler, const Texels& texels) {
  const GLenum stored =
      texels.channels == 1 ? (texels.half ? GL_R16F : GL_R32F) : (texels.half ? GL_RGB16F : GL_RGB32F);
  const GLenum given = texels.channels == 1 ? GL_RED : GL_RGB;
  GLuint texture = 0;
  glCreateTextures(texels.depth ? GL_TEXTURE_3D : GL_TEXTURE_2D, 1, &texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (texels.depth) {
    glTextureStorage3D(texture, 1, stored, texels.width, texels.height, texels.depth);
    glTextureSubImage3D(texture, 0, 0, 0, 0, texels.width, texels.height, texels.depth, given, GL_FLOAT,
                        texels.values.data());
  } else {
    glTextureStorage2D(texture, 1, stored, texels.width, texels.height);
    glTextureSubImage2D(texture, 0, 0, 0, texels.width, texels.height, given, GL_FLOAT, texels.values.data());
  }
  for (const GLenum filters : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(texture, filters, texels.linear ? GL_LINEAR : GL_NEAREST);
  for (const GLenum edges : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(texture, edges, GL_CLAMP_TO_EDGE);
  glProgramUniform1i(program_, glGetUniformLocation(program_, sampler.c_str()),
                     static_cast<GLint>(textures_.size()));
  textures_.push_back(texture);
}

std::vector<float> GlFunction::call(std::span<const GlVectors> arguments) const {
  assert(arguments.size() <= kMostCalls);
  std::vector<float> values(3 * arguments.size());
  if (arguments.empty()) return values;
  GLuint buffers[2];
  glCreateBuffers(2, buffers);
  glNamedBufferStorage(buffers[0], static_cast<GLsizeiptr>(arguments.size_bytes()), arguments.data(), 0);
  const auto size = static_cast<GLsizeiptr>(values.size() * sizeof(float));
  glNamedBufferStorage(buffers[1], size, nullptr, 0);
  glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, 2, buffers);
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
