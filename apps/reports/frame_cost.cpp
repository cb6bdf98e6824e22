// Milliseconds a frame of factored BRDFs and of what they are compared with.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
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
#include "report.h"

namespace burnish::reports {

namespace {

constexpr int kSize = 1024, kVertices = 10000;
constexpr double kMinPsnr = 40;

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
  if (!(found >= kMinPsnr))
    throw Error(
        fmt::format("{}: expected a picture of at least {} dB, found {:.1f}", peer.name, kMinPsnr, found));
}

struct Times {
  double least = 0, median = 0;
};

// Repetitions of all peers in turn, so that a busy moment meets all.
std::vector<Times> time_frames(std::span<const Peer> peers, int lights, int repetitions) {
  const Scene scene = knot(lights);
  std::vector<std::unique_ptr<GlRenderer>> renderers;
  for (const Peer& peer : peers) {
    renderers.push_back(std::make_unique<GlRenderer>(scene, std::span(&peer.shader, 1), kSize, kSize));
    renderers.back()->draw();  // compiles
  }
  std::vector<std::vector<double>> ms(peers.size());
  for (int repetition = 0; repetition < repetitions; ++repetition)
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

// What is compared.
struct Models {
  FactoredBrdf lines = smooth_model({"", "pqp", {"p=32", "q=64,rational:0.2"}, 3});
  FactoredBrdf disks = smooth_model({"", "pqp", {"p=64x64", "q=64x64,rational:0.2"}, 3});
  FactoredBrdf two = smooth_model(
      {"", "p(wo) q(h) r(theta_d) p(wi) + s(wo) t(h) s(wi)", {"p=24", "q=64", "r=16", "s=16", "t=32"}, 3});
  FactoredBrdf volume = smooth_model(
      {"", "z(theta_h) g(theta_h,theta_d,phi_d)", {"z=200,power:0.5", "g=48x12x6,power:0.5"}, 3});
  Ggx ggx{{0.1, 0.3}, 0.8, 0.3};
  HalfDiffTable merl = tabulate_half_diff(Ggx{{0.3, 0.3}, 0.8, 0.3}, 90, 90, 180, false);
  NeuralBrdf network = some_network();
  BlinnPhong phong;
  Matte white;
};

// The first is what the others are related to.
std::vector<Peer> peers_of(const Models& models) {
  std::vector<Peer> peers;
  peers.push_back({"analytic GGX, anisotropic", shader_of(models.ggx), models.ggx});
  peers.push_back({"constant", matte(), models.white});
  const auto add = [&](ShaderFilter filter, TableFormat format, const char* how) {
    const auto shader = [&](const FactoredBrdf& brdf) { return surface_shader(brdf, filter, format); };
    peers.push_back({fmt::format("factored `pqp`, lines, {}", how), shader(models.lines), models.lines});
    peers.push_back({fmt::format("factored `pqp`, disks, {}", how), shader(models.disks), models.disks});
    peers.push_back({fmt::format("factored, 2 lobes of lines, {}", how), shader(models.two), models.two});
    peers.push_back({fmt::format("line times volume, {}", how), shader(models.volume), models.volume});
  };
  add(ShaderFilter::hardware, TableFormat::rgb9e5, "rgb9e5");
  add(ShaderFilter::hardware, TableFormat::half, "half");
  add(ShaderFilter::exact, TableFormat::half, "half, exact filter");
  peers.push_back({"Blinn-Phong, pow", shader_of(models.phong, false), models.phong});
  peers.push_back({"Blinn-Phong, w8", shader_of(models.phong, true), models.phong});
  peers.push_back({"MERL table, 3-D texture", shader_of(models.merl), models.merl});
  peers.push_back({"network of 675 weights", shader_of(models.network), models.network});
  return peers;
}

Table times_table(std::span<const Peer> peers, std::span<const int> lights, int repetitions) {
  std::vector<std::string> head{"material"};
  std::vector<std::vector<std::string>> rows;
  for (const Peer& peer : peers) rows.push_back({peer.name});
  for (const int count : lights) {
    head.push_back(fmt::format("{} light{}", count, count == 1 ? "" : "s"));
    head.emplace_back("of GGX");
    tell(fmt::format("frame-cost: lights: {}", count));
    const std::vector<Times> times = time_frames(peers, count, repetitions);
    for (std::size_t i = 0; i < peers.size(); ++i) {
      rows[i].push_back(fmt::format("{:.1f} ({:.1f})", times[i].least, times[i].median));
      rows[i].push_back(fmt::format("{:.2f}", times[i].least / times[0].least));
    }
  }
  Table table(head);
  for (const auto& row : rows) table.add(row);
  return table;
}

}  // namespace

void report_frame_cost(const ReportOptions& options) {
  const int repetitions = options.quick ? 1 : 11;
  const std::vector<int> lights = options.quick ? std::vector{1} : std::vector{1, 4, 16};
  Page page(options, "frame-cost");
  const GlContext context;
  const Models models{};
  const std::vector<Peer> peers = peers_of(models);
  for (const Peer& peer : peers) check_answer(peer);
  page["vertices"] = std::to_string(kVertices);
  page["size"] = std::to_string(kSize);
  page["repetitions"] = std::to_string(repetitions);
  page["renderer"] = context.renderer();
  page["times"] = times_table(peers, lights, repetitions).markdown();
  page.write();
}

}  // namespace burnish::reports
