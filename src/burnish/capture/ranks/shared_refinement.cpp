// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/capture/ranks/shared_refinement.h>
#include <burnish/capture/ranks/shared_work.h>
#include <burnish/fitting/refinement/lookups.h>

namespace burnish {

namespace {

/// The refinements of the channels that this rank works on. Each begins at its first use.
class ChannelRefinements {
 public:
  ChannelRefinements(const LogModel& model, const TrainingSet& set, const RefineOptions& options)
      : model_(model), set_(set), options_(options), lookups_(lookups_of(model.spec, set)) {}

  ChannelRefinement& of(std::size_t channel) {
    std::optional<ChannelRefinement>& begun = begun_[channel];
    if (begun) return *begun;
    RefineOptions own = options_;
    own.channel = channel;
    return begun.emplace(model_, set_, lookups_, own);
  }

 private:
  const LogModel& model_;
  const TrainingSet& set_;
  const RefineOptions& options_;
  Lookups lookups_;
  std::array<std::optional<ChannelRefinement>, kCaptureChannels> begun_;
};

/// Shares the third channel between two ranks: rank 0 begins it, while rank 1 works on its own channel. Then rank 1
/// takes over.
void halve_third_channel(FitCrew& crew, ChannelRefinements& refinements, int steps) {
  const auto halfway = made_together(&crew, 2, [&](std::size_t rank) {
    ChannelRefinement& channel = refinements.of(2 - rank);
    channel.run(steps);
    std::string bytes;
    append_values<double>(bytes, channel.state());
    return bytes;
  });
  if (crew.rank() != 1) return;
  std::vector<double> state(halfway[0].size() / sizeof(double));
  std::string_view bytes = halfway[0];
  take_values<double>(bytes, state);
  refinements.of(2).go_on_from(state);
}

}  // namespace

void refine_together(FitCrew* crew, LogModel& model, const TrainingSet& set, const RefineOptions& options) {
  if (!crew || crew->ranks() == 1) {
    refine(model, set, options);
    return;
  }
  ChannelRefinements refinements(model, set, options);
  // Channels are independent: each rank has one. With two ranks, each has one channel and half the steps of the
  // third.
  std::vector<std::vector<std::size_t>> channels{{0}, {1}, {2}};  // one list a part
  if (crew->ranks() == 2) {
    halve_third_channel(*crew, refinements, options.max_iterations / 2);
    channels = {{0}, {2, 1}};
  }
  const auto refined = made_together(crew, channels.size(), [&](std::size_t part) {
    std::string bytes;
    for (const std::size_t c : channels[part]) {
      refinements.of(c).run(options.max_iterations);
      LogModel own = model;
      refinements.of(c).finish(own);
      for (const std::vector<double>& table : own.log_values) append_values<double>(bytes, table);
    }
    return bytes;
  });
  // Every part holds whole tables; only its own channels are copied.
  for (std::size_t part = 0; part < channels.size(); ++part) {
    std::string_view rest = refined[part];
    for (const std::size_t c : channels[part])
      for (std::vector<double>& table : model.log_values) {
        std::vector<double> all(table.size());
        take_values<double>(rest, all);
        for (std::size_t i = c; i < table.size(); i += kCaptureChannels) table[i] = all[i];
      }
  }
}

}  // namespace burnish
