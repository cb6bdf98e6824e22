// What docs/frame-cost.md shows: milliseconds a frame of factored BRDFs and of what they are compared with.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/metrics/sphere_images.h>
#include <burnish/reflectance/half_diff_table.h>
#include <burnish/render/cpu_renderer.h>
#include <burnish/render/gl/gl_context.h>
#include <burnish/render/mesh/shapes.h>
#include <burnish/render/picture.h>
#include <burnish/testing/models.h>

#include "peer_shaders.h"

namespace burnish {
namespace {

constexpr int kSize = 1024, kVertices = 10000, kRepetitions = 11;
constexpr std::array kLights{1, 4, 16};
constexpr double kLeastPsnr = 40;

struct Peer {
  std::string name;
  SurfaceShader shader;
  BrdfRef truth;
};

Scene knot(int lights) {
  Scene scene;
  scene.parts = {{make_shape(Shape::torus_knot, kVertices), 0}};
  fit_to_unit_sphere(scene.parts);
  for (int i = 0; i < lights; ++i) {
    const double turn = kTwoPi * i / lights;
    scene.lights.push_back({{3 * std::cos(turn), 3 * std::sin(turn), 3}, 20.0 / lights});
  }
  scene.camera = camera_for_unit_sphere(radians(20), radians(20));
  return scene;
}

// A frame of nothing but its vertices, directions and cosines.
SurfaceShader matte() {
  return {.declarations = "", .view = "", .light = "", .value = "vec3(0.3183099)", .textures = {}};
}
struct Matte {
  static int channels() noexcept { return 1; }
  static bool isotropic() noexcept { return true; }
  static bool eval(Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
    f[0] = wi.z > 0 && wo.z > 0 ? 0.3183099 : 0;
    return true;
  }
};

// What is timed must draw the right picture.
void check_answer(const Peer& peer) {
  const Scene scene = knot(4);
  constexpr int kSmall = 192;
  const GlRenderer renderer(scene, {&peer.shader, 1}, kSmall, kSmall);
  renderer.draw();
  const Image truth = render_cpu(scene, {&peer.truth, 1}, {.width = kSmall, .height = kSmall});
  const double exposure = automatic_exposure(truth, scene.background);
  const double found =
      psnr(mean_squared_error(tone_map(renderer.read(), exposure), tone_map(truth, exposure)));
  if (!(found >= kLeastPsnr))
    throw Error(
        fmt::format("{}: expected a picture of at least {} dB, found {:.1f}", peer.name, kLeastPsnr, found));
}

struct Times {
  double least = 0, median = 0;
};

// Repetitions of all peers in turn, so that a busy moment meets all.
std::vector<Times> time_frames(std::span<const Peer> peers, int lights) {
  const Scene scene = knot(lights);
  std::vector<std::unique_ptr<GlRenderer>> renderers;
  for (const Peer& peer : peers) {
    renderers.push_back(std::make_unique<GlRenderer>(scene, std::span(&peer.shader, 1), kSize, kSize));
    renderers.back()->draw();  // compiles
  }
  std::vector<std::vector<double>> ms(peers.size());
  for (int repetition = 0; repetition < kRepetitions; ++repetition)
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      renderers[i]->draw();
      ms[i].push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
  std::vector<Times> times;
  for (auto& list : ms) {
    std::ranges::sort(list);
    times.push_back({list.front(), list[list.size() / 2]});
  }
  return times;
}

NeuralBrdf some_network() {
  Pcg32 random(5);
  std::vector<float> weights(NeuralBrdf::kWeights);
  for (float& w : weights) w = static_cast<float>(random.uniform() - 0.45) * 0.5f;
  return NeuralBrdf(weights);
}

void report() {
  const GlContext context;
  const ModelCase pqp_lines{"", "pqp", {"p=32", "q=64,rational:0.2"}, 3};
  const ModelCase pqp_disks{"", "pqp", {"p=64x64", "q=64x64,rational:0.2"}, 3};
  const ModelCase two_lobes{
      "", "p(wo) q(h) r(theta_d) p(wi) + s(wo) t(h) s(wi)", {"p=24", "q=64", "r=16", "s=16", "t=32"}, 3};
  const FactoredBrdf lines = smooth_model(pqp_lines), disks = smooth_model(pqp_disks),
                     two = smooth_model(two_lobes);
  const Ggx ggx{{0.1, 0.3}, 0.8, 0.3};
  const Ggx round{{0.3, 0.3}, 0.8, 0.3};
  const HalfDiffTable merl = tabulate_half_diff(round, 90, 90, 180, false);
  const NeuralBrdf network = some_network();
  const BlinnPhong phong;
  const Matte white;
  std::vector<Peer> peers;
  peers.push_back({"analytic GGX, anisotropic", shader_of(ggx), ggx});
  peers.push_back({"constant", matte(), white});
  const auto add = [&](ShaderFilter filter, TableFormat format, const char* how) {
    const auto shader = [&](const FactoredBrdf& brdf) { return surface_shader(brdf, filter, format); };
    peers.push_back({fmt::format("factored `pqp`, lines, {}", how), shader(lines), lines});
    peers.push_back({fmt::format("factored `pqp`, disks, {}", how), shader(disks), disks});
    peers.push_back({fmt::format("factored, 2 lobes of lines, {}", how), shader(two), two});
  };
  add(ShaderFilter::hardware, TableFormat::rgb9e5, "rgb9e5");
  add(ShaderFilter::hardware, TableFormat::half, "half");
  add(ShaderFilter::exact, TableFormat::half, "half, exact filter");
  peers.push_back({"Blinn-Phong, pow", shader_of(phong, false), phong});
  peers.push_back({"Blinn-Phong, w8", shader_of(phong, true), phong});
  peers.push_back({"MERL table, 3-D texture", shader_of(merl), merl});
  peers.push_back({"network of 675 weights", shader_of(network), network});
  for (const Peer& peer : peers) check_answer(peer);

  fmt::print(
      "## Milliseconds a frame\n\nTorus knot of {} vertices, {} x {} pixels, {} frames of each in turn: "
      "least (median), "
      "then the least over that of analytic GGX. Renderer: {}.\n\n| material |",
      kVertices, kSize, kSize, kRepetitions, context.renderer());
  std::vector<std::vector<Times>> columns;
  for (const int lights : kLights) {
    fmt::print(" {} light{} | of GGX |", lights, lights == 1 ? "" : "s");
    columns.push_back(time_frames(peers, lights));
  }
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < kLights.size(); ++i) fmt::print("---|---|");
  for (std::size_t i = 0; i < peers.size(); ++i) {
    fmt::print("\n| {} |", peers[i].name);
    for (const auto& times : columns)
      fmt::print(" {:.1f} ({:.1f}) | {:.2f} |", times[i].least, times[i].median,
                 times[i].least / times[0].least);
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace burnish

int main() {
  try {
    fmt::print(
        "<!-- Written by `make frame-cost`; edit apps/frame_cost instead. -->\n"
        "# What a frame costs\n\n");
    burnish::report();
  } catch (const std::exception& error) {
    fmt::print(stderr, "burnish_frame_cost: {}\n", error.what());
    return 1;
  }
}
