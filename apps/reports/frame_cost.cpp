// Milliseconds a frame of what `burnish fit` gives and of what it is compared with.
#include <deque>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <burnish/factors/fetches.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/open_source.h>
#include <burnish/math/random.h>
#include <burnish/reflectance/half_diff_table.h>

#include "cost_sources.h"
#include "frames.h"
#include "peer_shaders.h"
#include "rates.h"
#include "report.h"

namespace burnish::reports {

namespace {

// A frame of nothing but its vertices, directions and cosines.
SurfaceShader matte() {
  return {.declarations = "", .view = "", .light = "", .value = "vec3(0.3183099)", .textures = {}};
}
struct Matte {
  static std::size_t channels() noexcept { return 1; }
  static bool isotropic() noexcept { return true; }
  static bool eval(Vec3 wi, Vec3 wo, std::span<double> f) noexcept {
    f[0] = wi.z > 0 && wo.z > 0 ? 0.3183099 : 0;
    return true;
  }
};

NeuralBrdf some_network() {
  Pcg32 random(5);
  std::vector<float> weights(NeuralBrdf::kWeights);
  for (float& w : weights) w = static_cast<float>(random.uniform() - 0.45) * 0.5f;
  return NeuralBrdf(weights);
}

// A fit by its command.
struct Fitted {
  std::string command;
  FactoredBrdf model;
};

Fitted fit_by_command(const Source& source, std::optional<std::uint64_t> bytes, std::optional<int> fetches,
                      std::optional<FitTarget> target = FitTarget::function) {
  std::string command = "fit";
  if (target) command += fmt::format(" --target {}", to_string(*target));
  FitOptions options{.target = target, .score = false};
  if (bytes) {
    command += fmt::format(" --budget {}", *bytes);
    if (fetches) command += fmt::format(" --fetches {}", *fetches);
    options.form = Budget{.bytes = bytes, .fetches = fetches};
  }
  tell(fmt::format("frame-cost: {}, {}", source.name, command));
  return {command, fit(source, options).model()};
}

constexpr const char* kAnisotropic = "ggx:alpha_x=0.1,alpha_y=0.3,f0=0.8,kd=0.3";

// What is compared.
struct Models {
  std::deque<Fitted> fits;
  Fitted anisotropic;
  Ggx ggx{{0.1, 0.3}, 0.8, 0.3};
  HalfDiffTable merl = tabulate_half_diff(Ggx{{0.3, 0.3}, 0.8, 0.3}, 90, 90, 180, false);
  NeuralBrdf network = some_network();
  BlinnPhong phong;
  Matte white;
};

Models models_of(const Source& source, bool quick) {
  struct Form {
    std::optional<std::uint64_t> bytes = {};
    std::optional<int> fetches = {};
  };
  const std::vector<Form> forms =
      quick ? std::vector<Form>{{}, {2700, 2}}
            : std::vector<Form>{{}, {2700, 2}, {65'536, 2}, {16'384, 4}, {16'384, 6}, {2700}, {65'536, 24}};
  std::deque<Fitted> fits{fit_by_command(source, {}, {}, std::nullopt)};
  for (const auto& [bytes, fetches] : forms) fits.push_back(fit_by_command(source, bytes, fetches));
  return {.fits = std::move(fits), .anisotropic = fit_by_command(open_source(kAnisotropic, {}), {}, {})};
}

// The first is what the others are related to.
std::vector<FrameMaterial> materials_of(const Models& models) {
  std::vector<FrameMaterial> materials;
  materials.push_back({"analytic GGX, anisotropic", shader_of(models.ggx), models.ggx});
  materials.push_back({"constant", matte(), models.white});
  const auto add = [&](const std::string& how, const FactoredBrdf& model, ShaderFilter filter,
                       TableFormat format) {
    materials.push_back({fmt::format("`{}`, {} bytes, {} fetches", how, model.bytes(), fetch_count(model)),
                         surface_shader(model, filter, format), model});
  };
  for (const auto& [command, model] : models.fits)
    add(command, model, ShaderFilter::hardware, TableFormat::rgb9e5);
  const auto& [command, model] = models.fits.front();
  const auto add_with = [&](const char* textures, ShaderFilter filter, TableFormat format) {
    materials.push_back(
        {fmt::format("`{}`, {}", command, textures), surface_shader(model, filter, format), model});
  };
  add_with("textures of half", ShaderFilter::hardware, TableFormat::half);
  add_with("textures of float, as `burnish render` has it", ShaderFilter::hardware, TableFormat::single);
  add_with("textures of half, exact filter", ShaderFilter::exact, TableFormat::half);
  add(models.anisotropic.command + " " + kAnisotropic, models.anisotropic.model, ShaderFilter::hardware,
      TableFormat::rgb9e5);
  materials.push_back({"Blinn-Phong, pow", shader_of(models.phong, false), models.phong});
  materials.push_back({"Blinn-Phong, w8", shader_of(models.phong, true), models.phong});
  materials.push_back({"MERL table, 3-D texture", shader_of(models.merl), models.merl});
  materials.push_back({"network of 675 weights", shader_of(models.network), models.network});
  return materials;
}

}  // namespace

void report_frame_cost(const ReportOptions& options) {
  const int repetitions = options.quick ? 1 : 11;
  const std::vector<int> lights = options.quick ? std::vector{1} : std::vector{1, 4, 16};
  const GlContext context(GlDevice::gpu_first);
  Page page(options, context.in_software() ? "frame-cost" : "frame-cost-gpu", "frame-cost");
  ReportOptions of_one = options;
  of_one.quick = true;
  const Source source = std::move(cost_sources(of_one).front());
  const Models models = models_of(source, options.quick);
  const std::vector<FrameMaterial> materials = materials_of(models);
  for (const FrameMaterial& material : materials) check_picture(material);
  page["source"] = source.name;
  page["vertices"] = std::to_string(kFrameVertices);
  page["size"] = std::to_string(kFrameSize);
  page["repetitions"] = std::to_string(repetitions);
  page["renderer"] = drawn_by(context);
  page["times"] = frame_times("frame-cost", "GGX", materials, lights, repetitions).markdown();
  tell("frame-cost: evaluations");
  page["rates"] = evaluation_rates("GGX", materials, repetitions).markdown();
  page.write();
}

}  // namespace burnish::reports
