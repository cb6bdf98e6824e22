// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/book/book_file.h>
#include <burnish/capture/surface_baselines.h>
#include <burnish/capture/surface_fit.h>
#include <burnish/capture/surface_picture.h>
#include <burnish/capture/surface_report_json.h>
#include <burnish/factors/model_file.h>
#include <burnish/file.h>
#include <burnish/image/png.h>
#include <burnish/math/parallel.h>

#include "commands.h"
#include "counted.h"
#include "json_output.h"
#include "progress.h"
#include "usage.h"

namespace burnish::cli {

namespace {

namespace fs = std::filesystem;

struct FitSurfaceArguments {
  std::string capture, out, book, picture, normals = "auto";
  SurfaceFitOptions options;
  std::size_t pictures = Capture::kBtfPictures;
  int threads = 0;
  bool resume = false, compare = false, json = false;
};

std::string checkpoint_of(const FitSurfaceArguments& arguments) {
  return arguments.out + ".part";
}

std::string decibels(double psnr) {
  return std::isinf(psnr) ? "exact" : fmt::format("{:.2f} dB", psnr);
}
std::string psnr_text(double psnr) {
  return (std::isinf(psnr) ? "" : "psnr ") + decibels(psnr);
}

std::string text_of(const PictureScore& score, const SurfaceReport& report) {
  const std::string of =
      report.of_samples ? counted(score.pictures, "sample") + " a texel" : counted(score.pictures, "picture");
  if (!score.psnr) return of;
  return fmt::format("{} of {}{}", psnr_text(*score.psnr), of,
                     score.psnr_of_all && *score.psnr_of_all != *score.psnr
                         ? fmt::format(", {} with what masks leave out", decibels(*score.psnr_of_all))
                         : "");
}

// Writes the comparison of the first picture that was held out, or of the first picture where none was.
void write_comparison(const FitSurfaceArguments& arguments, const SurfaceFit& fit) {
  Capture capture(arguments.capture, arguments.pictures);
  const auto& pictures = capture.form().pictures;
  const auto held_out = std::ranges::find(pictures, true, &CapturePicture::held_out);
  const auto number = held_out == pictures.end() ? 0 : static_cast<std::size_t>(held_out - pictures.begin());
  write_png(arguments.picture, surface_picture(capture, fit.surface.brdf, number, fit.report.exposure));
}

// Returns the scores of the baselines if they are asked for.
std::vector<BaselineScore> scores_of_others(const FitSurfaceArguments& arguments, const SurfaceFit& fit,
                                            const SurfaceFitOptions& options) {
  if (!arguments.compare) return {};
  return score_surface_baselines(Capture(arguments.capture, arguments.pictures), fit, options);
}

void print_surface_json(const FitSurfaceArguments& arguments, const SurfaceReport& report,
                        std::span<const BaselineScore> others) {
  nlohmann::ordered_json json = json_of(report);
  json["output"] = arguments.out;
  json["seconds"] = report.seconds;
  json["weight_seconds"] = report.weight_seconds;
  json["resumed_rows"] = report.resumed_rows;
  for (const BaselineScore& other : others)
    json["methods"].push_back(
        {{"method", other.method},
         {"bytes_a_texel", other.bytes_a_texel},
         {"held_out_psnr", other.held_out ? nlohmann::ordered_json(*other.held_out) : nullptr}});
  print_as_json(json);
}

void print_surface_report(const FitSurfaceArguments& arguments, const SurfaceReport& report,
                          std::span<const BaselineScore> others) {
  for (const auto& [file, why] : report.left_out) fmt::print("left out   {}: {}\n", file, why);
  const std::string without_data =
      report.texels_without_data == 0
          ? ""
          : fmt::format("; {} without data", counted(report.texels_without_data, "texel"));
  if (report.of_samples)
    fmt::print("capture    {} x {} texels of at most {}{}\n", report.width, report.height,
               counted(report.pictures, "sample"), without_data);
  else
    fmt::print("capture    {} x {} texels, {} ({} of light and view fitted); {} clipped, {} missing{}\n",
               report.width, report.height, counted(report.pictures, "picture"),
               counted(report.lights_and_views, "pair"), counted(report.clipped_pixels, "pixel"),
               report.missing_pixels, without_data);
  fmt::print("surface    {} of {} bytes together, {} + {} bytes a texel (weights, normals)\n",
             counted(report.lobes, "lobe"), report.lobe_bytes, report.weight_bytes, report.frame_bytes);
  fmt::print("fitted     {}\n", text_of(report.fitted, report));
  if (report.held_out.pictures > 0) fmt::print("held out   {}\n", text_of(report.held_out, report));
  for (const BaselineScore& other : others)
    fmt::print(
        "{:<10} {}, {:.3g} bytes a texel\n", other.method,
        other.held_out ? psnr_text(*other.held_out) + " of held-out pictures" : "no picture was held out",
        other.bytes_a_texel);
  fmt::print("written    {} in {:.2f} s, {:.2f} s of them for the weights of all texels\n", arguments.out,
             report.seconds, report.weight_seconds);
}

SurfaceFitOptions surface_options(const FitSurfaceArguments& arguments) {
  SurfaceFitOptions options = arguments.options;
  if (!arguments.book.empty()) {
    const FileBytes book = read_file(arguments.book);
    if (looks_like_book(book.bytes))
      throw Error::in_file(arguments.book, "a model or a surface for --book", "a book of materials");
    options.book =
        looks_like_surface(book.bytes) ? parse_surface(book).brdf.own_model() : parse_model(book).brdf;
  }
  if (arguments.normals == "flat") options.normals = NormalsFrom::flat;
  if (arguments.normals == "capture") options.normals = NormalsFrom::capture;
  if (arguments.normals == "estimate") options.normals = NormalsFrom::estimate;
  return options;
}

// Refuses output names that end as files of another format do, or that are equal.
void check_names(const FitSurfaceArguments& arguments) {
  const auto check = [](const char* option, const fs::path& path, std::initializer_list<const char*> endings,
                        const char* such) {
    const fs::path found = path.extension();
    if (!found.empty() && std::ranges::find(endings, found) == endings.end())
      throw CLI::ValidationError(
          fmt::format("{}: expected a name such as {}, found '{}'", option, such, path.string()));
  };
  check("--output", arguments.out, {".burnish", ".exr"}, "wall.burnish");
  check("--picture", arguments.picture, {".png"}, "wall.png");
  const auto whole = [](const std::string& path) {
    std::error_code none;
    return fs::weakly_canonical(fs::absolute(path, none), none);
  };
  if (!arguments.picture.empty() && whole(arguments.picture) == whole(arguments.out))
    throw CLI::ValidationError(
        fmt::format("--picture: expected another file than --output, found '{}'", arguments.picture));
}

// Throws Error where an output would overwrite an input.
void check_inputs_stay(const FitSurfaceArguments& arguments, const Capture& capture) {
  std::vector<fs::path> read{capture.form_file()};
  if (fs::is_directory(arguments.capture)) {
    const CaptureForm& form = capture.form();
    read.push_back(capture.file(form.normals));
    for (const CapturePicture& picture : form.pictures)
      for (const std::string& name : {picture.file, picture.mask}) read.push_back(capture.file(name));
    for (const Capture::LeftOut& picture : capture.left_out()) read.push_back(capture.file(picture.file));
  }
  for (const std::string& out : {arguments.out, checkpoint_of(arguments), arguments.picture}) {
    std::error_code none;
    const auto is_out = [&](const fs::path& path) { return fs::equivalent(path, out, none); };
    if (!fs::is_regular_file(out, none)) continue;
    if (std::ranges::any_of(read, is_out))
      throw Error::in_file(out, "an output that is not also an input", "a file of the capture");
    if (is_out(arguments.book)) throw Error::in_file(out, "an output that is not also an input", "the book");
  }
}

void fit_surface(const FitSurfaceArguments& arguments, FitCrew* crew) {
  check_names(arguments);
  const ThreadLimit limit(arguments.threads);
  SurfaceFitOptions options = surface_options(arguments);
  options.crew = crew;
  if (crew && crew->rank() != 0) {
    help_fit_surface(Capture(arguments.capture, arguments.pictures), options);
    return;
  }
  check_writable(arguments.out);
  if (!arguments.picture.empty()) check_writable(arguments.picture);
  options.checkpoint = checkpoint_of(arguments);
  Capture capture(arguments.capture, arguments.pictures);
  check_inputs_stay(arguments, capture);
  if (!capture.disagreement().empty())
    fmt::print(stderr, "burnish: {}: {}\n", arguments.capture, capture.disagreement());
  if (!arguments.resume) fs::remove(options.checkpoint);
  if (!arguments.picture.empty() && capture.form().own_directions)
    throw Error::in_file(arguments.capture, "pictures, for --picture", "samples of texels");
  const SurfaceFit fit = [&] {
    Progress progress("fitting");
    options.progress = progress.stages();
    return burnish::fit_surface(std::move(capture), options);
  }();
  options.progress = nullptr;
  write_then_rename(arguments.out, format_surface_as(arguments.out, fit.surface));
  fs::remove(options.checkpoint);

  if (!arguments.picture.empty()) write_comparison(arguments, fit);
  const std::vector<BaselineScore> others = scores_of_others(arguments, fit, options);
  if (arguments.json)
    print_surface_json(arguments, fit.report, others);
  else
    print_surface_report(arguments, fit.report, others);
}

}  // namespace

void add_fit_surface_command(CLI::App& app, FitCrew* crew) {
  CLI::App* verb =
      app.add_subcommand("fit-surface", "Fit a surface to registered pictures: lobes whose scales are maps");
  verb->footer(
      "Examples: burnish fit-surface capture/ -o wall.burnish\n"
      "          burnish fit-surface capture/ -o wall.burnish --lobes 4 --normals estimate\n"
      "          burnish fit-surface fabric01.btf -o fabric.burnish --normals flat\n"
      "          burnish fit-surface samples.csv -o spots.burnish --lobes 3\n"
      "          burnish fit-surface capture/ -o wall.burnish --lobes 4 --compare\n"
      "          burnish fit-surface capture/ -o wall.burnish --book lobes.burnish");
  auto arguments = std::make_shared<FitSurfaceArguments>();
  SurfaceFitOptions& options = arguments->options;
  verb->add_option("CAPTURE", arguments->capture,
                   "Names a folder with capture.json and its pictures, a BTF of UBO2014, or a CSV of samples "
                   "of texels.")
      ->required();
  verb->add_option("-o,--output,--out", arguments->out, "Names the surface's file, .burnish or .exr.")
      ->required();
  verb->add_option("--lobes", options.lobes, "Fits this many lobes.")
      ->check(in_range(std::size_t{1}, kMaxSurfaceLobes))
      ->capture_default_str();
  verb->add_option("--lobe-bytes", options.lobe_bytes,
                   "Spends this many bytes on each lobe's tables; K counts as 1024.")
      ->transform(CLI::AsSizeValue(false))
      ->capture_default_str();
  verb->add_option("--book", arguments->book,
                   "Takes the lobes of this model as they are, and fits weights alone.")
      ->excludes("--lobes")
      ->excludes("--lobe-bytes");
  verb->add_option("--normals", arguments->normals,
                   "Takes normals of the capture, none (flat) or estimated ones; auto estimates them where "
                   "the capture has none.")
      ->check(one_of({"auto", "capture", "flat", "estimate"}))
      ->capture_default_str();
  verb->add_option("--pictures", arguments->pictures,
                   "Takes this many of a BTF's pictures, spread evenly; 0 takes all.")
      ->capture_default_str();
  verb->add_option(
          "--rounds", options.rounds,
          "Fits lobes and weights in turn for this many rounds (default: 9, where normals are estimated 24).")
      ->check(in_range(1, kMaxSurfaceRounds));
  verb->add_option("--memory", options.tile_bytes,
                   "Holds at most this many bytes of pictures in memory; M counts as 1024^2.")
      ->transform(CLI::AsSizeValue(false));
  verb->add_option("--seed", options.seed, "Chooses the texels and pixels that lobes are fitted to.")
      ->check(at_least_zero())
      ->capture_default_str();
  verb->add_flag("--widen", options.widened,
                 "Adds copies of the lobes for bumps that mip levels lose, each for one fetch more a light.");
  verb->add_option("--threads", arguments->threads, "Uses at most this many threads; 0 uses all.")
      ->check(in_range(0, 1024));
  verb->add_option("--picture", arguments->picture,
                   "Writes a PNG with a held-out picture, the surface in its place, and the lobes' weights.");
  verb->add_flag(
      "--compare", arguments->compare,
      "Also scores other methods: GGX in each texel, the nearest lobe alone, and principal components.");
  verb->add_flag("--resume", arguments->resume,
                 "Goes on from OUTPUT.part, which a stopped fit of the same capture and options left.");
  verb->add_flag("--json", arguments->json, "Prints the report as JSON.");
  verb->callback([arguments, crew] { fit_surface(*arguments, crew); });
}

}  // namespace burnish::cli
