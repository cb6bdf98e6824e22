// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_objects.h>

namespace burnish {

namespace {

// The storage of texels, and the format of the input.
struct TexelFormat {
  GLenum stored, layout, type;
};

TexelFormat format_of(const GlTexture& texture) {
  const bool grey = texture.channels == 1;
  switch (texture.precision) {
    case TableFormat::single:
      return {grey ? GLenum{GL_R32F} : GLenum{GL_RGBA32F}, grey ? GLenum{GL_RED} : GLenum{GL_RGB}, GL_FLOAT};
    case TableFormat::half:
      return {grey ? GLenum{GL_R16F} : GLenum{GL_RGB16F}, grey ? GLenum{GL_RED} : GLenum{GL_RGB}, GL_FLOAT};
    case TableFormat::rgb9e5:
      if (!grey) return {GL_RGB9_E5, GL_RGB, GL_FLOAT};
      break;
    default:
      break;
  }
  throw Error(fmt::format("OpenGL: expected textures of half, float or rgb9e5, found {} of {} channels",
                          to_string(texture.precision), texture.channels));
}

std::string log_of(GLuint object, bool program) {
  std::string log(4096, '\0');
  GLsizei size = 0;
  (program ? glGetProgramInfoLog : glGetShaderInfoLog)(object, static_cast<GLsizei>(log.size()), &size,
                                                       log.data());
  return log.substr(0, static_cast<std::size_t>(size));
}

}  // namespace

unsigned upload_texture(const GlTexture& texture) {
  const TexelFormat format = format_of(texture);

  // as many dimensions as there are sides
  GLuint name = 0;
  glCreateTextures(texture.depth ? GL_TEXTURE_3D : texture.height ? GL_TEXTURE_2D : GL_TEXTURE_1D, 1, &name);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  if (texture.depth) {
    glTextureStorage3D(name, 1, format.stored, texture.width, texture.height, texture.depth);
    glTextureSubImage3D(name, 0, 0, 0, 0, texture.width, texture.height, texture.depth, format.layout,
                        format.type, texture.values.data());
  } else if (!texture.height) {
    glTextureStorage1D(name, 1, format.stored, texture.width);
    glTextureSubImage1D(name, 0, 0, texture.width, format.layout, format.type, texture.values.data());
  } else {
    glTextureStorage2D(name, 1, format.stored, texture.width, texture.height);
    glTextureSubImage2D(name, 0, 0, 0, texture.width, texture.height, format.layout, format.type,
                        texture.values.data());
  }

  for (const GLenum filters : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(name, filters, texture.filtered ? GL_LINEAR : GL_NEAREST);
  for (const GLenum edges : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(name, edges, GL_CLAMP_TO_EDGE);
  return name;
}

unsigned upload_texture(const MapTexture& texture, bool single) {
  const bool half = texture.format == TableFormat::half, in_blocks = texture.blocks != TexelBlocks::none;
  const GLenum blocks = texture.blocks == TexelBlocks::bc5_snorm ? GL_COMPRESSED_SIGNED_RG_RGTC2
                                                                 : GL_COMPRESSED_RG_RGTC2,
               stored = in_blocks ? blocks
                        : single  ? GL_RGBA32F
                        : half    ? GL_RGBA16F
                                  : GL_RGBA8;
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureStorage2D(name, static_cast<GLsizei>(texture.levels.size()), stored, texture.width,
                     texture.height);
  for (std::size_t l = 0; l < texture.levels.size(); ++l) {
    const auto level = static_cast<GLint>(l);
    const GLsizei width = std::max(texture.width >> l, 1), height = std::max(texture.height >> l, 1);
    const std::vector<std::byte>& bytes = texture.levels[l];
    if (in_blocks)
      glCompressedTextureSubImage2D(name, level, 0, 0, width, height, blocks,
                                    static_cast<GLsizei>(bytes.size()), bytes.data());
    else
      glTextureSubImage2D(name, level, 0, 0, width, height, GL_RGBA, half ? GL_HALF_FLOAT : GL_UNSIGNED_BYTE,
                          bytes.data());
  }
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum edges : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTextureParameteri(name, edges, GL_REPEAT);
  return name;
}

unsigned link_program(std::span<const GlShaderSource> shaders) {
  // every shader compiled, so that all of them can complain
  const GLuint program = glCreateProgram();
  std::string failure;
  for (const auto& [type, text] : shaders) {
    const std::string whole = "#version 450\n" + text;
    const char* source = whole.c_str();
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (!compiled) failure += log_of(shader, false);
    glAttachShader(program, shader);
    glDeleteShader(shader);  // once the program goes
  }

  GLint linked = 0;
  if (failure.empty()) {
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) failure = log_of(program, true);
  }
  if (linked) return program;
  glDeleteProgram(program);
  throw Error("OpenGL: expected a shader that links, found: " + failure);
}

}  // namespace burnish
