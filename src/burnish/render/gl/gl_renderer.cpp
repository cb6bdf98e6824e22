// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/render/gl/gl_renderer.h>

namespace burnish {

namespace {

// Column after column; near and far planes around the scene.
std::array<float, 16> projection_of(const Scene& scene, int width, int height) {
  const Camera& camera = scene.camera;
  const CameraFrame f = frame_of(camera);

  // the scene's distances along the view; a depth of floats stays fine where low is not tiny beside high
  double low = 1e-30, high = 1;
  if (!scene.parts.empty()) {
    const Bounds bounds = bounds_of(scene.parts);
    const double distance = dot(camera.eye - bounds.middle(), f.back),
                 radius = std::max(bounds.radius(), 1e-12);
    low = std::max(distance - 1.01 * radius, 1e-3 * radius);
    high = std::max(distance + 1.01 * radius, 2 * low);
  }

  // rows of the matrix: the frame's axes from the eye, then OpenGL's perspective
  const double y = 1 / std::tan(0.5 * camera.field_of_view), x = y * height / width;
  const double a = (high + low) / (low - high), b = 2 * high * low / (low - high);
  const auto row = [&](double s, Vec3 axis) {
    return std::array{s * axis.x, s * axis.y, s * axis.z, -s * dot(axis, camera.eye)};
  };
  const auto rx = row(x, f.right), ry = row(y, f.up), back = row(1, f.back);
  std::array<float, 16> m{};
  for (std::size_t j = 0; j < 4; ++j) {
    m[4 * j] = static_cast<float>(rx[j]);
    m[4 * j + 1] = static_cast<float>(ry[j]);
    m[4 * j + 2] = static_cast<float>(a * back[j] + (j == 3 ? b : 0));
    m[4 * j + 3] = static_cast<float>(-back[j]);
  }
  return m;
}

}  // namespace

struct GlRenderer::State {
  // The layout of the shader's uniform block.
  struct LightEntry {
    float place[4], intensity[4];
  };
  struct Material {
    GLuint program = 0;
    std::vector<GLuint> textures;
  };
  struct Part {
    GLuint array = 0;
    GLuint buffers[3] = {};  // vertices, corners, values
    GLsizei corners = 0;
    std::size_t material = 0;
  };
  std::vector<Material> materials;
  std::vector<Part> parts;
  std::vector<LightEntry> lights;
  GLuint frame = 0, targets[2] = {}, light_buffer = 0, depth_program = 0;
  std::array<float, 4> background{};
  int width = 0, height = 0;

  ~State() {
    for (const Material& m : materials) {
      glDeleteProgram(m.program);
      glDeleteTextures(static_cast<GLsizei>(m.textures.size()), m.textures.data());
    }
    for (const Part& p : parts) {
      glDeleteVertexArrays(1, &p.array);
      glDeleteBuffers(3, p.buffers);
    }
    glDeleteProgram(depth_program);
    glDeleteBuffers(1, &light_buffer);
    glDeleteFramebuffers(1, &frame);
    glDeleteRenderbuffers(2, targets);
  }

  // A picture of floats and its depth.
  void make_target() {
    glCreateFramebuffers(1, &frame);
    glCreateRenderbuffers(2, targets);
    glNamedRenderbufferStorage(targets[0], GL_RGBA32F, width, height);
    glNamedRenderbufferStorage(targets[1], GL_DEPTH_COMPONENT32F, width, height);
    glNamedFramebufferRenderbuffer(frame, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, targets[0]);
    glNamedFramebufferRenderbuffer(frame, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, targets[1]);
    if (glCheckNamedFramebufferStatus(frame, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Error(fmt::format("OpenGL: expected room for a picture of floats, found none for {} x {}", width,
                              height));
  }

  // A program for the scene's camera.
  GLuint linked(const std::string& fragment, const Scene& scene) const {
    const GlShaderSource sources[] = {{GL_VERTEX_SHADER, scene_vertex_shader()},
                                      {GL_FRAGMENT_SHADER, fragment}};
    const GLuint program = link_program(sources);
    glProgramUniformMatrix4fv(program, glGetUniformLocation(program, "burnish_projection"), 1, GL_FALSE,
                              projection_of(scene, width, height).data());
    return program;
  }

  // A surface's program and its textures, bound to units 0, 1, ... in their order.
  void add_material(const std::string& fragment, std::span<const GlTexture> textures,
                    std::span<const MapTexture> maps, const Scene& scene) {
    Material& m = materials.emplace_back();
    m.program = linked(fragment, scene);
    const auto at = [&](const std::string& name) { return glGetUniformLocation(m.program, name.c_str()); };
    glProgramUniform3fv(m.program, at("burnish_eye"), 1, to_floats(scene.camera.eye).data());
    const auto add = [&](const auto& texture) {
      glProgramUniform1i(m.program, at(texture.name), static_cast<GLint>(m.textures.size()));
      m.textures.push_back(upload_texture(texture));
    };
    for (const GlTexture& texture : textures) add(texture);
    for (const MapTexture& texture : maps) add(texture);
  }

  void draw_part(const Part& part, GLuint program) const {
    glUseProgram(program);
    glBindVertexArray(part.array);
    glDrawElements(GL_TRIANGLES, part.corners, GL_UNSIGNED_INT, nullptr);
  }

  // A part's vertices and corners; with `values`, one a vertex, they are all that is shown.
  void add_part(const MeshPart& part, const std::vector<Rgb>* values) {
    Part& p = parts.emplace_back();
    p.corners = static_cast<GLsizei>(3 * part.mesh.triangles.size());
    p.material = values ? 0 : static_cast<std::size_t>(part.material);
    glCreateVertexArrays(1, &p.array);
    glCreateBuffers(3, p.buffers);
    const auto fill = [](GLuint buffer, const auto& list) {
      glNamedBufferData(buffer, static_cast<GLsizeiptr>(list.size() * sizeof(list[0])), list.data(),
                        GL_STATIC_DRAW);
    };
    fill(p.buffers[0], part.mesh.vertices);
    fill(p.buffers[1], part.mesh.triangles);
    glVertexArrayVertexBuffer(p.array, 0, p.buffers[0], 0, sizeof(Vertex));
    glVertexArrayElementBuffer(p.array, p.buffers[1]);

    // attributes as the vertex shader numbers them: position, normal, tangent, side, value, uv
    const auto attribute = [&](GLuint index, GLuint binding, GLint count, std::size_t offset) {
      glEnableVertexArrayAttrib(p.array, index);
      glVertexArrayAttribFormat(p.array, index, count, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
      glVertexArrayAttribBinding(p.array, index, binding);
    };
    attribute(0, 0, 3, offsetof(Vertex, position));
    if (values) {
      std::vector<std::array<float, 3>> floats;
      for (const Rgb v : *values) floats.push_back(to_floats({v.r, v.g, v.b}));
      fill(p.buffers[2], floats);
      glVertexArrayVertexBuffer(p.array, 1, p.buffers[2], 0, sizeof(floats[0]));
      attribute(4, 1, 3, 0);
    } else {
      attribute(1, 0, 3, offsetof(Vertex, normal));
      attribute(2, 0, 3, offsetof(Vertex, tangent));
      attribute(3, 0, 1, offsetof(Vertex, side));
      attribute(5, 0, 2, offsetof(Vertex, uv));
    }
  }
};

GlRenderer::GlRenderer(const Scene& scene, std::span<const SurfaceShader> materials,
                       std::span<const std::vector<Rgb>> vertex_values, int width, int height)
    : state_(std::make_unique<State>()) {
  const bool interpolated = !vertex_values.empty();
  check_scene(scene, width, height, interpolated ? SIZE_MAX : materials.size());
  State& s = *state_;
  s.width = width;
  s.height = height;
  s.background = {static_cast<float>(scene.background.r), static_cast<float>(scene.background.g),
                  static_cast<float>(scene.background.b), 1};

  // programs: one that only finds depths, then one a material
  s.make_target();
  s.depth_program = s.linked("void main() {}\n", scene);
  if (interpolated) s.add_material(interpolated_fragment_shader(), {}, {}, scene);
  for (const SurfaceShader& surface : materials)
    s.add_material(scene_fragment_shader(surface), surface.textures, surface.maps, scene);

  // meshes and lights
  for (std::size_t i = 0; i < scene.parts.size(); ++i)
    s.add_part(scene.parts[i], interpolated ? &vertex_values[i] : nullptr);
  for (const PointLight& light : scene.lights) {
    const auto place = to_floats(light.position);
    const Rgb c = light.intensity;
    const auto intensity = to_floats({c.r, c.g, c.b});
    s.lights.push_back({{place[0], place[1], place[2], 1}, {intensity[0], intensity[1], intensity[2], 1}});
  }
  if (interpolated) s.lights.clear();  // they shine already
  glCreateBuffers(1, &s.light_buffer);
  glNamedBufferStorage(s.light_buffer, kLightsAPass * sizeof(State::LightEntry), nullptr,
                       GL_DYNAMIC_STORAGE_BIT);
}

GlRenderer::GlRenderer(const Scene& scene, std::span<const SurfaceShader> materials, int width, int height)
    : GlRenderer(scene, materials, {}, width, height) {}

GlRenderer::GlRenderer(const Scene& scene, std::span<const std::vector<Rgb>> vertex_values, int width,
                       int height)
    : GlRenderer(scene, {}, vertex_values, width, height) {}

GlRenderer::~GlRenderer() = default;

void GlRenderer::draw(int frames) const {
  for (int i = 0; i < frames; ++i) draw_frame();
  glFinish();
}

void GlRenderer::draw_frame() const {
  const State& s = *state_;
  glBindFramebuffer(GL_FRAMEBUFFER, s.frame);
  glViewport(0, 0, s.width, s.height);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  const float far = 1;
  glClearNamedFramebufferfv(s.frame, GL_COLOR, 0, s.background.data());
  glClearNamedFramebufferfv(s.frame, GL_DEPTH, 0, &far);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, s.light_buffer);

  // depth first, so that only what is seen is shaded
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  for (const State::Part& part : s.parts) s.draw_part(part, s.depth_program);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);

  // then passes of as many lights as the block holds; without lights one, for what shines itself
  glDepthFunc(GL_EQUAL);
  std::size_t first = 0;
  do {
    const std::size_t count = std::min(s.lights.size() - first, std::size_t{kLightsAPass});
    if (count > 0)
      glNamedBufferSubData(s.light_buffer, 0, static_cast<GLsizeiptr>(count * sizeof(State::LightEntry)),
                           &s.lights[first]);
    if (first > 0) glEnable(GL_BLEND);  // more lights: added to what is there
    for (const State::Part& part : s.parts) {
      const State::Material& m = s.materials[part.material];
      glProgramUniform1i(m.program, glGetUniformLocation(m.program, "burnish_light_count"),
                         static_cast<GLint>(count));
      glProgramUniform1i(m.program, glGetUniformLocation(m.program, "burnish_first"), first == 0);
      glBindTextures(0, static_cast<GLsizei>(m.textures.size()), m.textures.data());
      s.draw_part(part, m.program);
    }
    first += count;
  } while (first < s.lights.size());
}

Image GlRenderer::read() const {
  // OpenGL's first row is the lowest
  const State& s = *state_;
  Image upside_down(s.width, s.height, 3), image(s.width, s.height, 3);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, s.frame);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glReadPixels(0, 0, s.width, s.height, GL_RGB, GL_FLOAT, upside_down.pixels.data());
  const auto row = static_cast<std::ptrdiff_t>(3 * s.width);
  for (int y = 0; y < s.height; ++y)
    std::copy_n(upside_down.pixels.begin() + row * (s.height - 1 - y), row, image.pixels.begin() + row * y);
  return image;
}

}  // namespace burnish
