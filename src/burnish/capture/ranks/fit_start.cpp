// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include <fmt/format.h>

#include <burnish/capture/ranks/fit_start.h>
#include <burnish/error.h>

namespace burnish {

namespace {

constexpr std::string_view kWeights = "weights", kLobes = "lobes";

}  // namespace

std::string format_start(const FitStart& start) {
  if (start.step == FitStep::weights) return std::string(kWeights);
  return std::string(kLobes) + (start.begun ? format_checkpoint(*start.begun) : "");
}

FitStart parse_start(const FileBytes& message) {
  const std::string_view text = message.text();
  if (text == kWeights) return {.step = FitStep::weights};
  if (!text.starts_with(kLobes))
    throw Error::in_file(message.name, fmt::format("{} or {}", kWeights, kLobes), "another message");
  FitStart start{.step = FitStep::lobes};
  if (text.size() == kLobes.size()) return start;
  const auto first = message.bytes.begin() + static_cast<std::ptrdiff_t>(kLobes.size());
  start.begun = parse_lobes_checkpoint({message.name, {first, message.bytes.end()}});
  if (!start.begun) throw Error::in_file(message.name, "a checkpoint of a surface's lobes", "another");
  return start;
}

}  // namespace burnish
