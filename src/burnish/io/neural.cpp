#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <burnish/error.h>
#include <burnish/io/neural.h>
#include <burnish/io/text_reader.h>
#include <burnish/math/angles.h>

namespace burnish {

namespace {

constexpr std::size_t kNamesShown = 5;

std::string_view row_name(std::string_view line) noexcept {
  return trimmed(line.substr(0, line.find(',')));
}

std::vector<float> read_weights(TextReader& reader) {
  reader.word();  // the name
  std::vector<float> weights(NeuralBrdf::kWeights);
  for (std::size_t i = 0; i < weights.size(); ++i)
    weights[i] = static_cast<float>(reader.number(fmt::format("weight {}", i + 1)));
  reader.end_of_line();
  return weights;
}

std::string some_names(const std::vector<std::string>& names) {
  const auto shown = static_cast<std::ptrdiff_t>(std::min(names.size(), kNamesShown));
  return fmt::format(
      "{}{}", fmt::join(names.begin(), names.begin() + shown, ", "),
      names.size() > kNamesShown ? fmt::format(" and {} more", names.size() - kNamesShown) : "");
}

}  // namespace

bool looks_like_neural(std::string_view text) noexcept {
  const std::string_view line = first_content_line(text);
  return std::count(line.begin(), line.end(), ',') == static_cast<std::ptrdiff_t>(NeuralBrdf::kWeights);
}

NeuralFile parse_neural(const FileBytes& file, std::string_view name) {
  // the row of that name, or the only one
  TextReader reader(file);
  std::vector<std::string> names;
  std::vector<float> weights;
  while (weights.empty() && reader.next_content_line()) {
    const std::string_view found = row_name(reader.line());
    names.push_back(printable(found, 80));
    if (found.empty() || found.find_first_of(" \t") != std::string_view::npos)
      reader.fail("a name without blanks", in_quotes(found));
    if (name.empty() ? names.size() == 1 : found == name) weights = read_weights(reader);
  }
  if (name.empty() && reader.next_content_line()) {
    do names.push_back(printable(row_name(reader.line()), 80));
    while (reader.next_content_line());
    throw Error::in_file(file.name, "one encoding, or a name: nbrdf:FILE#NAME", some_names(names));
  }
  if (weights.empty())
    throw Error::in_file(file.name, fmt::format("an encoding named {}", in_quotes(name)),
                         names.empty() ? "no row" : some_names(names));

  Findings findings;
  findings.format = "neural encoding";
  findings.description = names.back();
  findings.conventions = {"675 weights, 1,350 bytes as half floats"};
  findings.theta_i_max = findings.theta_o_max = kHalfPi;
  try {
    return {names.back(), NeuralBrdf(weights), std::move(findings)};
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  }
}

}  // namespace burnish
