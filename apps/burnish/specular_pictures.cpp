// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/image/png.h>
#include <burnish/library/folder_file.h>
#include <burnish/power/bounds.h>
#include <burnish/report/specular_figures.h>

#include "json_output.h"
#include "specular_command.h"
#include "usage.h"

namespace burnish::cli {
namespace {

namespace fs = std::filesystem;

void write_plot(const fs::path& path, const Plot& plot) {
  if (path.extension() == ".svg")
    write_then_rename(path, to_svg(plot));
  else if (path.extension() == ".png")
    write_png(path, to_image(plot));
  else
    throw CLI::ValidationError(path.string(), "expected a name that ends in .svg or .png");
}

Plot figure(const std::string& name, const std::vector<PowerMethod>& methods,
            const std::vector<double>& exponents) {
  if (name == "2a") return lobe_figure(methods, exponents);
  if (name == "2b") return relative_error_figure(methods, exponents);
  if (name == "3") return max_relative_error_figure(methods);
  if (name == "coefficient") return coefficient_figure();
  return front_figure(exponents.front());
}

struct Row {
  std::string what;
  double found;
  std::string stated;
};

// Measures the values that the paper and its checks state.
std::vector<Row> facts() {
  std::vector<Row> rows;
  const auto add = [&](std::string what, double found, std::string stated) {
    rows.push_back({std::move(what), found, std::move(stated)});
  };
  const std::pair<double, const char*> coefficients[] = {
      {10, "7.357622"}, {100, "78.192739"}, {512, "402.412385"}, {1000, "786.438568"}};
  for (const auto& [e, stated] : coefficients)
    add(fmt::format("a({:g})", e), quadratic_coefficient(e), stated);
  const std::pair<double, const char*> errors[] = {{3, "1.0"}, {10, "2.5"}, {100, "3.1"}, {1000, "3.157"}};
  for (const auto& [e, stated] : errors)
    add(fmt::format("largest relative error above 0.56 at e = {:g}, %", e),
        100 * max_relative_error(PowerMethod::quadratic_raw, e, 0.56), stated);
  for (const auto& [e, stated] : {std::pair{10.0, "0.232"}, std::pair{1000.0, "0.28"}})
    add(fmt::format("clamped, largest absolute error at e = {:g}", e),
        max_absolute_error(PowerMethod::quadratic, e), stated);
  for (const auto& [e, stated] : {std::pair{10.0, "71"}, std::pair{1000.0, "64"}})
    add(fmt::format("clamped, energy kept at e = {:g}, %", e),
        100 / power_normalization(PowerMethod::quadratic, e), stated);
  double worst = 0;
  for (double e = 2; e <= 1000; e *= 1.001)
    worst = std::max(worst, e * std::abs(quadratic_coefficient(e) - quadratic_coefficient_affine(e)));
  add("largest e |a(e) - (0.7869387 e - 1/2)| from e = 2", worst, "0.15");
  return rows;
}

void print_report(double exponent, bool json) {
  nlohmann::json report = {{"facts", nlohmann::json::array()}, {"members", nlohmann::json::array()}};
  if (!json) fmt::print("{:<52} {:>12} {:>12}\n", "the paper's quadratic", "found", "stated");
  for (const Row& row : facts()) {
    report["facts"].push_back({{"what", row.what}, {"found", row.found}, {"stated", row.stated}});
    if (!json) fmt::print("{:<52} {:>12.6f} {:>12}\n", row.what, row.found, row.stated);
  }
  if (!json)
    fmt::print("\n{:<16} {:>6} {:>10} {:>7} {:>9} {:>8} {:>11} {:>9}\n", "member", "cost", "bound", "from e",
               "proof", "boxes", "error", "energy");
  for (const PowerInfo& info : power_methods()) {
    if (info.method == PowerMethod::exact) continue;
    for (const PowerBound& bound : info.bounds) {
      const BoundProof proof = prove_power_bound(info.method, bound);
      nlohmann::json row = {{"name", info.name},      {"weight", info.cost.weight()},
                            {"bound", bound.bound},   {"min_exponent", bound.min_exponent},
                            {"proved", proof.proved}, {"boxes", proof.boxes}};
      std::string figures;
      if (exponent >= bound.min_exponent) {
        const double error = max_absolute_error(info.method, exponent);
        const double energy = 1 / power_normalization(info.method, exponent);
        row.update({{"error", error}, {"energy", energy}});
        figures = fmt::format("{:>11.4g} {:>9.4f}", error, energy);
      }
      report["members"].push_back(row);
      if (!json)
        fmt::print("{:<16} {:>6} {:>10.3g} {:>7g} {:>9} {:>8} {}\n", info.name, info.cost.weight(),
                   bound.bound, bound.min_exponent, proof.proved ? "proved" : "NOT", proof.boxes, figures);
    }
  }
  if (json)
    fmt::print("{}\n", report.dump(2));
  else
    fmt::print("error and energy (of the power's) at exponent {:g}\n", exponent);
}

}  // namespace

void add_specular_plot(CLI::App& verb) {
  struct Arguments {
    std::string figure = "2a", out;
    std::vector<std::string> methods{"quadratic"};
    std::vector<double> exponents{10};
    bool json = false;
  };
  CLI::App* sub = verb.add_subcommand("plot", "Draw one figure, SVG or PNG by the ending of the file's name");
  sub->footer(
      "2a: lobes; 2b: relative errors; 3: largest relative error above 0.56; coefficient: a(e) against a "
      "line;\n"
      "front: error over cost; sphere (PNG): lit sphere, highlight magnified, difference; one column a "
      "method.\n"
      "Example: burnish specular plot --figure 2a --method quadratic --method cubic2 --exponent 10 -o "
      "lobe.svg");
  auto arguments = std::make_shared<Arguments>();
  sub->add_option("--figure", arguments->figure, "Draws this figure.")
      ->check(one_of({"2a", "2b", "3", "coefficient", "front", "sphere"}))
      ->capture_default_str();
  sub->add_option("--method", arguments->methods, "Draws these methods of `specular list`.")
      ->capture_default_str();
  sub->add_option("--exponent", arguments->exponents, "Draws these exponents.")->capture_default_str();
  sub->add_option("-o,--output,--out", arguments->out, "Names the file to write.")->required();
  sub->add_flag("--json", arguments->json, "Prints what was drawn as JSON.");
  sub->callback([arguments] {
    nlohmann::ordered_json about{{"output", arguments->out}, {"figure", arguments->figure}};
    const std::vector<PowerMethod> methods = parse_methods(arguments->methods);
    if (arguments->figure != "sphere") {
      write_plot(arguments->out,
                 usage([&] { return figure(arguments->figure, methods, arguments->exponents); }));
      if (arguments->json) print_as_json(about);
      return;
    }
    if (fs::path(arguments->out).extension() != ".png")
      throw CLI::ValidationError(arguments->out, "expected a name that ends in .png");
    const SphereFigure sphere = usage([&] { return sphere_figure(methods, arguments->exponents.front()); });
    write_png(arguments->out, sphere.image);
    about["white_in_last_row"] = sphere.max_difference;
    if (arguments->json)
      print_as_json(about);
    else
      fmt::print("white in the last row: +{:.4g}\n", sphere.max_difference);
  });
}

void add_specular_report(CLI::App& verb) {
  struct Arguments {
    std::string out;
    double exponent = 50;
    bool json = false;
  };
  CLI::App* sub =
      verb.add_subcommand("report", "Measure the paper's figures, prove every bound, draw all pictures");
  sub->footer("Example: burnish specular report --exponent 20 -o out/specular");
  auto arguments = std::make_shared<Arguments>();
  sub->add_option("--exponent", arguments->exponent, "Reports errors, energies and spheres of this exponent.")
      ->check(in_range(4.0, kMaxExponent))
      ->capture_default_str();
  sub->add_flag("--json", arguments->json, "Prints the same as JSON.");
  sub->add_option("-o,--output,--out", arguments->out, "Writes figures as SVG and PNG into this folder.");
  sub->callback([arguments] {
    if (!arguments->out.empty()) make_folder(arguments->out);
    print_report(arguments->exponent, arguments->json);
    if (arguments->out.empty()) return;
    const fs::path folder = arguments->out;
    using M = PowerMethod;
    const std::vector<M> paper{M::quadratic}, good{M::quadratic, M::two_piece, M::w8, M::cubic2};
    const std::vector<double> ten{10}, asked{arguments->exponent};
    const std::pair<const char*, Plot> plots[] = {
        {"figure_2a", lobe_figure({{M::quadratic_raw}}, ten)},
        {"figure_2b", relative_error_figure({{M::quadratic_raw}}, ten)},
        {"figure_3", max_relative_error_figure(paper)},
        {"lobes", lobe_figure(good, asked)},
        {"coefficient", coefficient_figure()},
        {"front", front_figure(arguments->exponent)},
    };
    for (const auto& [name, plot] : plots)
      for (const char* extension : {".svg", ".png"})
        write_plot(folder / (std::string(name) + extension), plot);
    for (const PowerInfo& info : power_methods()) {
      const SphereFigure sphere = sphere_figure({{M::exact, info.method}}, arguments->exponent);
      write_png(folder / fmt::format("sphere_{}.png", info.name), sphere.image);
    }
  });
}

}  // namespace burnish::cli
