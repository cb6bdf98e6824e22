#include <algorithm>
#include <memory>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/csv.h>
#include <burnish/math/parallel.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/node_figures.h>

#include "commands.h"
#include "json_output.h"
#include "source_arguments.h"

namespace burnish::cli {

namespace {

std::string header(std::size_t channels, const std::vector<double>& lambda_nm) {
  if (!lambda_nm.empty()) {
    std::vector<std::string> names;
    for (const double l : lambda_nm) names.push_back(fmt::format("value_{}", l));
    return fmt::format("{}", fmt::join(names, ","));
  }
  return channels == 1 ? "value" : "r,g,b";
}

/// What knows how far a measurement's values may be off: the function of scattered samples, or one made for this.
struct Uncertain {
  const KrigedNodes* function = nullptr;
  std::unique_ptr<const KrigedNodes> own;

  explicit operator bool() const noexcept { return function != nullptr; }
};

Uncertain uncertain_of(const Source& source) {
  const auto* scattered = std::get_if<ScatteredBrdf>(&source.brdf);
  if (const KrigedNodes* function = scattered ? scattered->kriged() : nullptr) return {function, nullptr};
  const MeasuredNodes nodes = measured_nodes(source);
  try {
    auto own = std::make_unique<const KrigedNodes>(nodes, choose_covariance(nodes));
    return {own.get(), std::move(own)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", source.name, error.what()));
  }
}

}  // namespace

void add_eval_command(CLI::App& app) {
  struct Arguments {
    SourceArguments source;
    std::string directions, out;
    bool json = false, error = false;
  };
  CLI::App* verb =
      app.add_subcommand("eval", "Evaluate a BRDF at direction pairs: f_r in 1/sr, without the cosine");
  verb->footer(
      "Example: burnish eval paint.exr directions.csv -o values.csv\n"
      "directions.csv has the header wi_x,wi_y,wi_z,wo_x,wo_y,wo_z; a measured source is evaluated as "
      "measured, and nan stands where it knows nothing. --error says of measurements how far the value may "
      "be off: the "
      "standard deviation of ln(f + 0.001), which is about the relative error");
  auto arguments = std::make_shared<Arguments>();
  add_source_arguments(*verb, arguments->source);
  verb->add_option("DIRECTIONS", arguments->directions, "CSV file of direction pairs")->required();
  verb->add_option("-o,--output,--out", arguments->out, "CSV file to write")->required();
  verb->add_flag("--error", arguments->error,
                 "a column more: how far the value may be off, where the source is a measurement");
  verb->add_flag("--json", arguments->json, "print how many values were written and known as JSON");
  verb->callback([arguments] {
    check_writable(arguments->out);
    const Source source = arguments->source.open();
    const std::vector<DirectionPair> pairs = parse_directions(read_file(arguments->directions));
    const Uncertain uncertain = arguments->error ? uncertain_of(source) : Uncertain{};
    const BrdfRef brdf = source.ref();
    const auto channels = brdf.channels();
    std::vector<double> values(pairs.size() * channels);
    std::vector<std::uint8_t> known(pairs.size());
    for_each_chunk(pairs.size(), 4096, [&](std::size_t, std::size_t begin, std::size_t end) {
      brdf.eval(std::span(pairs).subspan(begin, end - begin),
                std::span(values).subspan(begin * channels, (end - begin) * channels),
                std::span(known).subspan(begin, end - begin));
    });
    std::string text = header(brdf.channels(), source.findings.lambda_nm) + (uncertain ? ",error\n" : "\n");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      for (std::size_t c = 0; c < channels; ++c)
        if (known[i])
          text += fmt::format("{}{}", c ? "," : "", values[i * channels + c]);
        else
          text += fmt::format("{}nan", c ? "," : "");
      if (uncertain)
        text += fmt::format(",{:.4g}", uncertain.function->uncertainty(pairs[i].wi, pairs[i].wo).function);
      text += '\n';
    }
    write_then_rename(arguments->out, text);
    if (arguments->json)
      print_as_json({{"output", arguments->out},
                     {"pairs", pairs.size()},
                     {"known", std::count(known.begin(), known.end(), 1)},
                     {"channels", channels}});
  });
}

}  // namespace burnish::cli
