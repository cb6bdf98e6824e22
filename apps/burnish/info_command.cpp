// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/open_source.h>
#include <burnish/io/source_report.h>
#include <burnish/io/text_reader.h>
#include <burnish/io/window_xml.h>
#include <burnish/math/angles.h>
#include <burnish/shaders/cost_json.h>

#include "book_text.h"
#include "commands.h"
#include "info_json.h"
#include "json_output.h"
#include "nodes_info.h"
#include "notes_text.h"
#include "progress.h"
#include "source_arguments.h"
#include "surface_info.h"
#include "usage.h"

namespace burnish::cli {

namespace {

std::string to_string(const NodesKnown& nodes, const Source& source) {
  // Adaptive nodes of RGL that are no holes may lie at the horizon.
  const std::uint64_t whole = source.findings.sample_count - source.findings.hole_count;
  const bool some_below = std::holds_alternative<RglTable>(source.brdf) && whole > nodes.count;
  std::string text = fmt::format("{} measured{}", nodes.count, some_below ? " above the horizon" : "");
  if (nodes.incidences)
    text += fmt::format(" at {} incident angle{}", *nodes.incidences, *nodes.incidences == 1 ? "" : "s");
  if (some_below) text += fmt::format(", {} more at it or below", whole - nodes.count);
  if (nodes.predicted)
    text += fmt::format(", predicted from the others to relative {:.4f}, log_cos {:.4f}",
                        nodes.predicted->relative, nodes.predicted->log_cos);
  return text;
}

void print_line(std::string_view name, const std::string& text) {
  fmt::print("{:<13}{}\n", name, text);
}

void print_findings(const Source& source, const std::vector<std::string>& warnings,
                    const std::optional<NodesKnown>& nodes) {
  const Findings& findings = source.findings;
  print_line("name", source.name);
  print_line("format", findings.format);
  if (!findings.description.empty()) print_line("description", findings.description);
  print_line("channels",
             fmt::format("{}{}", source.ref().channels(),
                         findings.lambda_nm.empty() ? ""
                                                    : fmt::format(", {} to {} nm", findings.lambda_nm.front(),
                                                                  findings.lambda_nm.back())));
  print_line("material", source.ref().isotropic() ? "isotropic" : "anisotropic");
  for (const BsdfBlock& block : findings.blocks)
    print_line("part",
               fmt::format("{}: {}", to_string(block), block == findings.block ? "read" : "left out"));
  if (findings.blocks.empty() && findings.block) print_line("part", to_string(*findings.block));
  for (const std::string& convention : findings.conventions) print_line("convention", convention);
  for (const std::string& warning : warnings) print_line("warning", warning);
  if (!findings.left_out.empty())
    print_line("left out", fmt::format("{}", fmt::join(findings.left_out, ", ")));
  for (const std::string& comment : findings.comments) print_line("comment", std::string(trimmed(comment)));
  if (findings.sample_count > 0)
    print_line("samples", fmt::format("{}, {} of them holes", findings.sample_count, findings.hole_count));
  print_line("coverage", fmt::format("theta_i {:.1f} to {:.1f}, theta_o {:.1f} to {:.1f} degrees",
                                     degrees(findings.theta_i_min), degrees(findings.theta_i_max),
                                     degrees(findings.theta_o_min), degrees(findings.theta_o_max)));
  if (nodes) print_line("nodes", to_string(*nodes, source));
  if (findings.negative_count > 0)
    print_line("negatives", fmt::format("{} values below zero, down to {:.3g} 1/sr", findings.negative_count,
                                        findings.most_negative));
}

// Formats values with four digits after the point, or with two significant digits where a value is below 0.001.
std::vector<std::string> shown(const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (const double x : values)
    texts.push_back(x == 0 || std::abs(x) >= 1e-3 ? fmt::format("{:.4f}", x) : fmt::format("{:.1e}", x));
  return texts;
}

std::string added_light(const DirectionalAlbedo& albedo) {
  if (albedo.clamped == albedo.albedo) return "";
  std::vector<double> added;
  for (std::size_t c = 0; c < albedo.albedo.size(); ++c)
    added.push_back(albedo.clamped[c] - albedo.albedo[c]);
  return fmt::format(", {} more with values below zero cut", fmt::join(shown(added), " "));
}

/// Adds the totals of the parts that were not read. CIE-XYZ stands for bands that are listed themselves.
void add_other_totals(const SourceArguments& arguments, SourceReport& report) {
  constexpr std::size_t kMost = 16;
  for (const BsdfBlock& block : report.source.findings.blocks) {
    if (block == report.source.findings.block || block.band == kColourBand) continue;
    if (report.totals.size() == kMost) return;
    OpenOptions options = arguments.options;
    options.part = block.part;
    options.band = block.band;
    try {
      report.totals.push_back(totals_of(open_source(arguments.spec, options)));
    } catch (const Error&) {  // a part that cannot be read is named as left out, and has no totals
    }
  }
}

void print_factors(const FactoredBrdf& model) {
  if (const auto cost = shader_cost(model)) print_line("shader", to_string(*cost));
  for (const Lobe& lobe : model.lobes())
    print_line("lobe", fmt::format("scale {:.4g}", fmt::join(lobe.scale, " ")));
  for (const Table& table : model.tables())
    print_line("table", fmt::format("{}: {} x {}{}, {} channels, warp {}, {}, {} bytes", table.name,
                                    table.layout.width, table.layout.height,
                                    table.layout.depth > 1 ? fmt::format(" x {}", table.layout.depth) : "",
                                    table.channels, to_string(table.layout.warp), to_string(table.format),
                                    table.byte_count()));
}

void print_text(const SourceReport& report, const std::optional<NodesKnown>& nodes) {
  const auto& [source, albedos, reciprocity, model, mirror_asymmetry, totals, warnings] = report;
  print_findings(source, warnings, nodes);
  for (const auto& [theta_i, phi_i, albedo] : albedos)
    print_line(
        source.findings.transmits() ? "transmitted" : "albedo",
        fmt::format("{} at theta_i = {:.0f}{} degrees{}{}",
                    albedo.unknown_fraction < 1 ? fmt::format("{}", fmt::join(shown(albedo.albedo), " "))
                                                : std::string("unknown"),
                    degrees(theta_i), phi_i > 0 ? fmt::format(", phi_i = {:.0f}", degrees(phi_i)) : "",
                    albedo.unknown_fraction > 0 && albedo.unknown_fraction < 1
                        ? fmt::format(", {:.1f} % of the hemisphere unknown", 100 * albedo.unknown_fraction)
                        : "",
                    added_light(albedo)));
  for (const auto& [block, at] : totals)
    for (const TotalAt& total : at)
      print_line("total",
                 fmt::format("{} at {:.0f} degrees: direct {:.1f} %, scattered {:.1f} %", to_string(block),
                             degrees(total.theta_i), 100 * total.direct, 100 * total.scattered));
  print_line(
      "reciprocity",
      fmt::format("mean relative asymmetry {:.4g} over {} pairs{}", reciprocity.mean, reciprocity.pairs,
                  source.findings.transmits()     ? ": exchanged, the light comes from the other side"
                  : model && !model->reciprocal() ? ": the model tells the directions apart"
                                                  : ""));
  if (mirror_asymmetry)
    print_line("mirror", fmt::format("{:.2f} % from its mirror image in the plane of incidence, on average",
                                     100 * std::expm1(*mirror_asymmetry)));
  if (const auto bytes = source.bytes()) {
    std::error_code none;
    const std::uintmax_t file = std::filesystem::file_size(source.name, none);
    print_line("bytes", fmt::format("{}{}", *bytes, none ? "" : fmt::format(", its file {}", file)));
  }
  if (model) print_factors(*model);
  if (!source.findings.notes.empty())
    for (const auto& [word, says] : notes_lines(source.findings.notes)) print_line(word, says);
}

// Returns the book that a file holds, or nothing where it is no book.
std::optional<MaterialBook> book_of(const std::string& spec) {
  std::ifstream file(spec, std::ios::binary);
  std::array<char, 32> head{};
  file.read(head.data(), head.size());
  if (!looks_like_book(std::as_bytes(std::span(head)))) return std::nullopt;
  return parse_book(read_file(spec));
}

}  // namespace

void add_info_command(CLI::App& app) {
  CLI::App* verb = app.add_subcommand(
      "info", "Say what a BRDF is: kind, conventions, coverage, holes, albedo, reciprocity");
  verb->footer("Example: burnish info --json paint.bsdf");
  auto arguments = std::make_shared<SourceArguments>();
  auto as_json = std::make_shared<bool>(false);
  auto target = std::make_shared<std::string>("function");
  add_source_arguments(*verb, *arguments);
  verb->add_option("--target", *target,
                   "Describes the function that interpolates the measured nodes, or the nodes themselves.")
      ->check(one_of({"function", "nodes"}))
      ->capture_default_str();
  verb->add_flag("--json", *as_json, "Prints the same as JSON.");
  verb->callback([=] {
    const auto refuse_nodes = [&](const char* kind) {
      if (*target == "nodes")
        throw Error(
            fmt::format("{}: expected a measurement for --target nodes, found {}", arguments->spec, kind));
    };
    if (const auto book = book_of(arguments->spec)) {
      refuse_nodes("a book");
      if (*as_json)
        print_as_json(book_json(*book));
      else
        print_book(arguments->spec, *book);
      return;
    }
    if (std::error_code none; std::filesystem::is_regular_file(arguments->spec, none)) {
      const FileBytes file = read_file(arguments->spec);
      if (looks_like_surface(file.bytes)) {
        refuse_nodes("a surface");
        const SurfaceModel surface = parse_surface(file);
        if (*as_json)
          fmt::print("{}\n", surface_info_json(surface, arguments->spec));
        else
          fmt::print("{}", surface_info(surface, arguments->spec));
        return;
      }
    }
    const Source source = [&] {
      const Progress progress("reading " + arguments->spec);
      return open_source(arguments->spec, arguments->options);  // warnings are part of the report
    }();
    if (*target == "nodes") {
      const NodesInfo nodes = nodes_info(source);
      fmt::print("{}", *as_json ? nodes_json(nodes) + "\n" : nodes_text(nodes));
      return;
    }
    std::optional<Progress> progress(std::in_place, "describing");
    SourceReport report = report_on(source);
    add_other_totals(*arguments, report);
    const auto nodes = nodes_of(source);
    progress.reset();
    if (*as_json)
      fmt::print("{}\n", info_json(report, nodes));
    else
      print_text(report, nodes);
  });
}

}  // namespace burnish::cli
