// SPDX-License-Identifier: Apache-2.0
// Measures the milliseconds a frame of models by `burnish fit` and of models that they are compared with.
#include <algorithm>
#include <deque>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/factors/fetches.h>
#include <burnish/file.h>
#include <burnish/fitting/fit.h>
#include <burnish/io/csv_columns.h>
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

// Draws a constant, so a frame costs only its vertices, directions and cosines.
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

// A fit and the command that made it.
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

constexpr int kLights[] = {1, 4, 16}, kRepetitions = 11;

// Returns the first source of the report of costs.
Source source_of(ReportOptions options) {
  options.quick = true;
  return std::move(cost_sources(options).front());
}

// The compared models.
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

// Returns the materials; times are given relative to the first one's.
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

// The page has a column for each kind of device, and one run measures one of them. A run therefore writes its rows to
// frame-cost-DEVICE-KIND.csv. The page joins the rows of all devices that were measured.
struct Device {
  const char* name;   // in names of files
  const char* title;  // above its columns
};
constexpr Device kGpu{"gpu", "GPU"}, kProcessor{"processor", "processor"};

// Returns the rows of a device's file below its head, or none where the device was not measured.
std::vector<std::vector<std::string>> rows_of(const fs::path& folder, const Device& device,
                                              const char* kind) {
  const fs::path file = folder / fmt::format("frame-cost-{}-{}.csv", device.name, kind);
  std::vector<std::vector<std::string>> rows;
  if (!fs::exists(file)) return rows;
  const FileBytes bytes = read_file(file);
  std::string_view text = bytes.text();
  std::vector<std::string_view> cells;
  for (bool head = true; !text.empty(); head = false) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (head) continue;
    split_cells(line, ',', cells);
    rows.emplace_back(cells.begin(), cells.end());
  }
  return rows;
}

// Puts both devices' rows side by side, matched by the first cell. A pair of cells holds "least (median)" and the ratio
// to GGX. The page shows "least (ratio)"; the medians stay in the files.
Table beside_each_other(const fs::path& folder, const char* kind, const std::vector<std::string>& columns) {
  std::vector<std::string> names, head{"material"};
  std::map<std::string, std::vector<std::string>> cells;
  for (const Device& device : {kGpu, kProcessor}) {
    const auto rows = rows_of(folder, device, kind);
    if (rows.empty()) continue;
    for (const std::string& column : columns) head.push_back(fmt::format("{}, {}", device.title, column));
    for (const auto& row : rows) {
      if (!cells.contains(row.front())) names.push_back(row.front());
      std::vector<std::string>& line = cells[row.front()];
      line.resize(head.size() - columns.size() - 1, "");  // empty cells for an earlier device
      for (std::size_t i = 1; i + 1 < row.size(); i += 2)
        line.push_back(fmt::format("{} ({})", row[i].substr(0, row[i].find(' ')), row[i + 1]));
    }
  }
  Table table(head);
  for (const std::string& name : names) {
    cells[name].resize(head.size() - 1, "");
    table.add(joined({name}, cells[name]));
  }
  return table;
}

// Returns a row for each device that drew, and sets the source of the fits. Throws Error where nothing was measured.
Table drawers(const fs::path& folder, std::string& source) {
  Table table({"drawn by", "seconds to measure", "on", "at commit"});
  for (const Device& device : {kGpu, kProcessor})
    for (const auto& row : rows_of(folder, device, "run")) {
      source = row.at(4);
      table.add({row.begin(), row.begin() + 4});
    }
  if (table.empty())
    throw Error::in_file(folder.string(), "frame-cost-gpu-run.csv or frame-cost-processor-run.csv", "none");
  return table;
}

// Measures on the device that draws here, and writes its rows.
void measure_frames(const ReportOptions& options, const Page& page) {
  const int repetitions = options.quick ? 1 : kRepetitions;
  const std::vector<int> lights =
      options.quick ? std::vector{1} : std::vector<int>(std::begin(kLights), std::end(kLights));
  const Stopwatch watch;
  const GlContext context(GlDevice::gpu_first);
  const Device& device = context.in_software() ? kProcessor : kGpu;
  const Source source = source_of(options);
  const Models models = models_of(source, options.quick);
  const std::vector<FrameMaterial> materials = materials_of(models);
  for (const FrameMaterial& material : materials) check_picture(material);
  const auto write = [&](const char* kind, const Table& rows) {
    page.write_rows(fmt::format("{}-{}", device.name, kind), rows);
  };
  write("times", frame_times("frame-cost", "GGX", materials, lights, repetitions));
  tell("frame-cost: evaluations");
  write("rates", evaluation_rates("GGX", materials, repetitions));
  Table run({"drawn by", "seconds", "machine", "commit", "source"});
  run.add(
      {drawn_by(context), fmt::format("{:.0f}", watch.seconds()), processor(), options.commit, source.name});
  write("run", run);
}

}  // namespace

void report_frame_cost(const ReportOptions& options) {
  Page page(options, "frame-cost");
  if (options.section != "page") measure_frames(options, page);
  std::vector<std::string> columns;
  for (const int count : kLights) {
    if (options.quick && count > 1) continue;
    columns.push_back(fmt::format("{} light{}", count, count == 1 ? "" : "s"));
  }
  page["vertices"] = std::to_string(kFrameVertices);
  page["size"] = std::to_string(kFrameSize);
  page["repetitions"] = std::to_string(options.quick ? 1 : kRepetitions);
  page["drawers"] = drawers(options.folder, page["source"]).markdown();
  page["times"] = beside_each_other(options.folder, "times", columns).markdown();
  page["rates"] = beside_each_other(options.folder, "rates", {"billions a second"}).markdown();
  page.write();
}

}  // namespace burnish::reports
