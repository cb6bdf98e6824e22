#include "fit_arguments.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/book/book_file.h>
#include <burnish/file.h>
#include <burnish/fitting/baselines/baselines.h>

#include "usage.h"

namespace burnish::cli {

namespace {

constexpr std::string_view kAuto = "auto";

std::string no_budget(const std::string& text) {
  return fmt::format("expected auto or a number of bytes above 0, as 2700, 16K or 1M, found '{}'", text);
}

// A number as AsSizeValue leaves it; nothing for auto or where nothing is given.
std::optional<std::uint64_t> parse_bytes(const std::string& text) {
  std::uint64_t bytes = 0;
  if (text.empty() || text == kAuto) return {};
  if (!CLI::detail::lexical_cast(text, bytes) || bytes == 0)
    throw CLI::ValidationError("--budget", no_budget(text));
  return bytes;
}

// Reads "16K" as 16384 and leaves auto.
CLI::Validator bytes_or_auto() {
  const CLI::AsSizeValue size(false);
  const auto read = [size](std::string& text) {
    if (text == kAuto) return std::string();
    const std::string given = text;
    try {
      if (!text.starts_with('-') && size(text).empty()) return std::string();
    } catch (const CLI::ValidationError&) {  // of an unknown unit, naming all that there are
    }
    return no_budget(given);
  };
  return {read, "SIZE [b, kb(=1024b), ...] or auto", "bytes_or_auto"};
}

double parse_smooth(const std::string& text) {
  double smooth = -1;
  if (!CLI::detail::lexical_cast(text, smooth) || !(smooth >= 0))
    throw CLI::ValidationError(fmt::format("--smooth: expected auto or a number >= 0, found '{}'", text));
  return smooth;
}

FitForm fit_form(const FitArguments& arguments, bool isotropic) {
  if (arguments.book) return FromBook{arguments.book};
  const std::optional<std::uint64_t> bytes = parse_bytes(arguments.bytes);
  if (!arguments.method.empty()) {
    if (arguments.bytes == kAuto)
      throw CLI::ValidationError("--budget: expected a number of bytes with --method, found 'auto'");
    return BaselineMethod{.method = arguments.method, .bytes = bytes.value_or(0)};
  }
  LogLinear how = arguments.one_lobe.how;
  how.cross_validate = arguments.smooth == "auto";
  const FitLoss loss = parse_fit_loss(arguments.loss);
  if (!arguments.bytes.empty()) {
    Budget budget = arguments.budget;
    budget.bytes = bytes;
    budget.loss = loss;
    budget.scattered = how;
    return budget;
  }
  return usage(
      [&] { return form_of(arguments.one_lobe.model, arguments.one_lobe.tables, isotropic, how, loss); });
}

void add_lobes_arguments(CLI::App& verb, FitArguments& arguments) {
  Budget& budget = arguments.budget;
  verb.add_option(
          "--budget", arguments.bytes,
          "bytes: fits the best model that this many hold; K and M count as 1024s; auto: until more would "
          "store the measurement's noise or hardly help")
      ->transform(bytes_or_auto());
  verb.add_option("--fetches", budget.fetches,
                  "of --budget: at most this many filtered reads of tables an evaluation (default: the "
                  "fewest of those "
                  "tried within two percent of the least error; with auto 2, of some nodes 3, of anisotropic "
                  "sources 6)")
      ->check(in_range(1, 256))
      ->needs("--budget")
      ->excludes("--method");
  verb.add_option("--lobes", budget.lobes, "of --budget: lobes of lines or hemispheres, this many")
      ->check(in_range(1, 64))
      ->needs("--budget")
      ->excludes("--fetches");
  verb.add_option(
          "--loss", arguments.loss,
          "what several lobes are refined for: pictures at every exposure beside both means, or one mean")
      ->check(one_of({"image", "relative", "log_cos"}))
      ->capture_default_str();
  verb.add_flag("--search", budget.search,
                "of --budget: search factors, projections, warps and sizes first (up to a minute)")
      ->needs("--budget")
      ->excludes("--fetches");
}

}  // namespace

FitOptions fit_options(const FitArguments& arguments, bool isotropic) {
  FitOptions options = arguments.options;
  options.form = fit_form(arguments, isotropic);
  options.symmetrize = !arguments.no_symmetrize;
  if (!arguments.target.empty()) options.target = parse_fit_target(arguments.target);
  if (!arguments.hold_out.empty())
    options.hold_out = usage([&] { return parse_node_part(arguments.hold_out); });
  if (!arguments.format.empty()) options.format = parse_table_format(arguments.format);
  if (arguments.smooth != "auto" && arguments.smooth != "default")
    options.smooth = parse_smooth(arguments.smooth);
  return options;
}

void add_fit_arguments(CLI::App& verb, FitArguments& arguments) {
  FitOptions& options = arguments.options;
  OneLobe& one_lobe = arguments.one_lobe;
  verb.add_option("--method", arguments.method,
                  fmt::format("fit what others would instead of positive factors, at --budget bytes (default "
                              "{}): {}",
                              BaselineOptions{}.budget, fmt::join(baseline_methods(), ", ")));
  add_lobes_arguments(verb, arguments);
  verb.add_option("--model", one_lobe.model,
                  "product of tables over projections: pqp (the paper's), pqpr, or such as "
                  "\"p(wo) q(h) s(wi+wo+0.5n) p(wi)\" (default: --budget 16K --fetches 2, of some nodes 3, "
                  "of anisotropic sources 6)")
      ->excludes("--budget");
  verb.add_option("--table", one_lobe.tables,
                  "size and spacing of a table: NAME=SIZE[,warp...][,shared][,format], SIZE N (1-D), NxN "
                  "(hemisphere), NxM or NxMxK; warp identity, power:P or rational:K; format as --format")
      ->allow_extra_args(false)
      ->excludes("--budget");
  verb.add_option(
      "--smooth", arguments.smooth,
      "smoothness of the tables: a number >= 0, or auto (cross-validation: the default for scattered "
      "samples; of volumes what predicts measured nodes best, which takes noise away)");
  verb.add_option(
          "--target", arguments.target,
          "fit the function that the source's owner makes of it, rings of its interpolation and all, or "
          "nodes: what was measured (default: of isotropic RGL files nodes, unless one lobe, "
          "--smooth auto, --no-symmetrize, --method or --book is asked for, else function)")
      ->check(one_of({"function", "nodes"}));
  verb.add_option("--hold-out", arguments.hold_out,
                  "fit nodes and leave these out: half=0, half=1 (of a checkerboard) or theta_i=K, "
                  "counted from 0");
  verb.add_option("--floor", one_lobe.how.floor,
                  "added to every value before its logarithm is taken, 1/sr, at most 1")
      ->check(above_zero())
      ->capture_default_str();
  verb.add_option("--reweightings", one_lobe.how.reweightings,
                  "passes towards the mean absolute error (default: 4 for scattered samples, else 0)")
      ->check(in_range(0, 100));
  verb.add_option("--count,--samples", options.samples, "pairs drawn from a source that is a function")
      ->check(in_range(std::size_t{1}, std::size_t{100'000'000}));
  verb.add_option("--seed", options.seed, "of the drawn pairs")
      ->check(at_least_zero())
      ->capture_default_str();
  verb.add_option(
          "--format", arguments.format,
          "of the stored tables (default: half; with --budget and three channels rgb9e5, which leaves shared "
          "tables half)")
      ->check(one_of({"half", "float", "rgb9e5", "unorm8"}));
  verb.add_flag(
      "--no-symmetrize", arguments.no_symmetrize,
      "fit f(wi, wo) as it is, not its reciprocal part; with --budget an isotropic model gets tables\n"
      "that wi alone looks up where the source is not reciprocal");
  CLI::Option* book = verb.add_option_function<std::string>(
      "--book",
      [&arguments](const std::string& file) {
        arguments.book = std::make_shared<const MaterialBook>(parse_book(read_file(file)));
      },
      "complete a few measured pairs by what the materials of this book have in common (see `burnish book`)");
  for (const char* other : {"--budget", "--method", "--model", "--table", "--smooth", "--target",
                            "--hold-out", "--floor", "--reweightings", "--no-symmetrize"})
    book->excludes(other);
  verb.add_flag("--conserve-energy", options.conserve_energy,
                "damp the model where it reflects more than it receives, and say what that cost");
}

}  // namespace burnish::cli
