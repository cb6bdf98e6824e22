// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <thread>
#include <utility>

#include <burnish/error.h>
#include <burnish/fitting/refinement/refine.h>
#include <burnish/fitting/refinement/refine_system.h>
#include <burnish/fitting/refinement/step_solver.h>
#include <burnish/math/parallel.h>

namespace burnish {

namespace {

// Constants of Levenberg-Marquardt [Marquardt1963]: the damping's start, its least value, and its factors
// after good and bad steps.
// The damping changes where the actual fall of the objective is above or below these shares of the predicted
// fall. A third of the damping that serves best makes a step that raises the objective.
constexpr double kFirstDamping = 1e-2, kFirstIterativeDamping = 0.1, kMinDamping = 1e-6;
constexpr double kEase = 0.3, kHarden = 4, kGoodGain = 0.75, kPoorGain = 0.25;
constexpr int kMaxTrials = 6, kMaxSlowSteps = 3;

}  // namespace

/// Levenberg-Marquardt steps of one channel, or of coupled channels.
class Descent {
 public:
  Descent(const LogModel& model, const TrainingSet& set, const Lookups& lookups, const PictureLoss& loss,
          const RefineOptions& options, std::size_t first_channel, std::size_t last_channel)
      : options_(options),
        loss_(loss),
        system_(model, set, lookups, loss, options.format, first_channel, last_channel),
        x_(system_.read(model)) {}

  /// Takes at most `most` further steps.
  template <class BeforeStep>
  void run(int most, BeforeStep before_step) {
    if (!solver_) {
      prepare();
      means_ = system_.errors(x_);
      before_ = after_ = objective(means_, x_);
      damping_ = solver_->is_direct() ? kFirstDamping : kFirstIterativeDamping;
    }
    for (int n = 0; n < most && goes_on(); ++n) {
      before_step();
      step();
    }
  }

  /// Returns all that decides the further steps as numbers, x last.
  std::vector<double> state() const {
    std::vector<double> numbers{static_cast<double>(iterations_),
                                static_cast<double>(slow_),
                                stuck_ ? 1.0 : 0.0,
                                damping_,
                                before_,
                                after_,
                                solver_->last_share()};
    for (const double ErrorTerms::*const term : kTerms) numbers.push_back(means_.*term);
    numbers.insert(numbers.end(), x_.begin(), x_.end());
    return numbers;
  }
  /// Restores a state in place of the first run.
  void go_on_from(std::span<const double> state) {
    prepare();
    iterations_ = static_cast<int>(state[0]);
    slow_ = static_cast<int>(state[1]);
    stuck_ = state[2] != 0;
    damping_ = state[3];
    before_ = state[4];
    after_ = state[5];
    solver_->set_last_share(state[6]);
    state = state.subspan(7);
    for (double ErrorTerms::*const term : kTerms) {
      means_.*term = state.front();
      state = state.subspan(1);
    }
    std::ranges::copy(state, x_.begin());
  }

  /// Writes the tables into the model.
  void write(LogModel& model) const { system_.write(x_, model); }
  void add_to(FitSummary& summary) const {
    if (iterations_ == options_.max_iterations) summary.stop_reason = StopReason::iteration_limit;
    summary.iterations += iterations_;
    summary.error_before += before_;
    summary.error_after += after_;
  }

 private:
  static constexpr std::array kTerms{&ErrorTerms::pictures, &ErrorTerms::dimmed,   &ErrorTerms::relative,
                                     &ErrorTerms::log_cos,  &ErrorTerms::absolute, &ErrorTerms::albedo};
  static_assert(sizeof(ErrorTerms) == kTerms.size() * sizeof(double));

  void prepare() {
    solver_.emplace(system_, options_.smooth);
    system_.clamp(x_);
    // Large tables stay in a box: if their floor rose with their largest node, no step might lead down.
    if (system_.has_volume()) box_ = system_.box(x_);
  }

  bool goes_on() const noexcept {
    return iterations_ < options_.max_iterations && slow_ < kMaxSlowSteps && !stuck_;
  }

  /// Takes one step: damps it more and more until the objective falls.
  void step() {
    // The quadratic model about x gives the step. Unknowns at a side of the box that descent pushes outwards are
    // held.
    solver_->linearize(x_, means_);
    if (box_) solver_->stay_within(*box_, x_);
    bool accepted = false;
    for (int trial = 0; trial < kMaxTrials && !accepted; ++trial) {
      // The damped step is moved back into the box, or to what the tables' formats hold.
      Eigen::VectorXd next = x_ + solver_->step(damping_);
      if (box_)
        next = next.cwiseMax(box_->least).cwiseMin(box_->most);
      else
        system_.clamp(next);
      const ErrorTerms next_means = system_.errors(next);
      const double value = objective(next_means, next);
      accepted = value < after_;
      if (accepted) {
        // The gain is the actual change over the predicted one. It tells how far the quadratic model can be
        // trusted.
        const double gain = (value - after_) / solver_->predicted_change(next - x_);
        slow_ = after_ - value < options_.least_progress ? slow_ + 1 : 0;
        after_ = value;
        x_ = std::move(next);
        means_ = next_means;
        // A good first step eases the damping; a poor one hardens it by half of what a failure does.
        if (gain > kGoodGain && trial == 0) damping_ = std::max(kMinDamping, kEase * damping_);
        if (gain < kPoorGain) damping_ *= kHarden / 2;
      } else {
        damping_ *= kHarden;
      }
    }
    if (accepted)
      ++iterations_;
    else
      stuck_ = true;
  }

  double objective(const ErrorTerms& means, const Eigen::VectorXd& x) const {
    return loss_.objective(means) + options_.smooth * system_.roughness(x);
  }

  RefineOptions options_;
  PictureLoss loss_;
  RefineSystem system_;
  Eigen::VectorXd x_;
  std::optional<StepSolver>
      solver_;  ///< refers to system_: from the first run on this object stays where it is
  std::optional<RefineSystem::Box> box_;
  ErrorTerms means_;
  double before_ = 0, after_ = 0, damping_ = 0;
  int iterations_ = 0, slow_ = 0;
  bool stuck_ = false;  ///< no step led down
};

namespace {

void check(const LogModel& model, const TrainingSet& set, const RefineOptions& options) {
  if (!(options.smooth >= 0) || !std::isfinite(options.smooth) || !(options.max_iterations >= 0))
    throw Error("fit: expected smooth >= 0 and a number of iterations >= 0");
  if (model.channels != set.channels)
    throw Error("fit: expected as many channels in the model as in the data");
}

PictureLoss loss_of(const TrainingSet& set, const ErrorTerms& shares) {
  return {.shares = shares, .exposure = set.exposure};
}

/// Returns true if two channels of interleaved values are equal.
template <class T>
bool are_equal(const std::vector<T>& values, std::size_t channels, std::size_t a, std::size_t b) {
  for (std::size_t i = 0; i < values.size(); i += channels)
    if (values[i + a] != values[i + b]) return false;
  return true;
}

/// Returns the first channel with the same data and the same start. Grey materials are refined once for all
/// channels.
std::size_t first_like(std::size_t channel, const LogModel& model, const TrainingSet& set) {
  const std::size_t channels = set.channels;
  for (std::size_t c = 0; c < channel; ++c)
    if (are_equal(set.values, channels, c, channel) && are_equal(set.albedo.targets, channels, c, channel) &&
        are_equal(set.albedo.scales, channels, c, channel) &&
        std::ranges::all_of(model.log_values,
                            [&](const auto& logs) { return are_equal(logs, channels, c, channel); }))
      return c;
  return channel;
}

void copy_channel(std::size_t from, std::size_t to, LogModel& model) {
  for (std::vector<double>& logs : model.log_values)
    for (std::size_t i = 0; i < logs.size(); i += model.channels) logs[i + to] = logs[i + from];
}

}  // namespace

std::function<void(double)> part_of_progress(std::function<void(double)> whole, double from, double to) {
  if (!whole) return nullptr;
  return [whole = std::move(whole), from, to](double f) { whole(from + f * (to - from)); };
}

FitSummary refine(LogModel& model, const TrainingSet& set, const RefineOptions& options) {
  return refine(model, set, lookups_of(model.spec, set), options);
}

FitSummary refine(LogModel& model, const TrainingSet& set, const Lookups& lookups,
                  const RefineOptions& options) {
  check(model, set, options);
  const PictureLoss loss = loss_of(set, options.shares);
  const auto channels = model.channels;
  const std::size_t together = model.any_shared() ? channels : 1;
  // Channels coupled by a shared table are one descent. Otherwise each channel is one, unless an earlier one
  // is equal.
  std::vector<Descent> descents;
  struct Part {
    std::size_t channel, like, descent;  ///< `like` is refined in place of `channel`
  };
  std::vector<Part> parts;
  for (std::size_t c = 0; c < channels; c += together) {
    if (together == 1 && options.channel.value_or(c) != c) continue;
    const std::size_t like = together > 1 || options.channel ? c : first_like(c, model, set);
    const auto known = std::ranges::find(parts, like, &Part::channel);
    if (known != parts.end()) {
      parts.push_back({c, like, known->descent});
      continue;
    }
    parts.push_back({c, c, descents.size()});
    descents.emplace_back(model, set, lookups, loss, options, c, c + together);
  }

  // Descents run side by side: many parts of one step are too small to share between threads.
  std::atomic<int> steps = 0;
  const std::thread::id caller = std::this_thread::get_id();
  const double all_steps = static_cast<double>(descents.size()) * std::max(options.max_iterations, 1);
  for_each_chunk(descents.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    descents[s].run(options.max_iterations, [&] {
      const int done = steps++;
      if (options.progress && std::this_thread::get_id() == caller) options.progress(done / all_steps);
    });
  });

  // Each descent writes its channels, equal channels are copied, and the summary's errors are means over the
  // channels.
  FitSummary summary{.stop_reason = StopReason::no_more_progress};
  for (const Descent& descent : descents) descent.write(model);
  for (const Part& part : parts) {
    if (part.like != part.channel) copy_channel(part.like, part.channel, model);
    descents[part.descent].add_to(summary);
  }
  summary.error_before /= static_cast<double>(parts.size());
  summary.error_after /= static_cast<double>(parts.size());
  if (options.progress) options.progress(1);
  return summary;
}

ChannelRefinement::ChannelRefinement(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                                     const RefineOptions& options) {
  check(model, set, options);
  assert(options.channel && !model.any_shared());
  descent_ = std::make_unique<Descent>(model, set, lookups, loss_of(set, options.shares), options,
                                       *options.channel, *options.channel + 1);
}
ChannelRefinement::ChannelRefinement(ChannelRefinement&&) noexcept = default;
ChannelRefinement& ChannelRefinement::operator=(ChannelRefinement&&) noexcept = default;
ChannelRefinement::~ChannelRefinement() = default;

void ChannelRefinement::run(int steps) {
  descent_->run(steps, [] {});
}
std::vector<double> ChannelRefinement::state() const {
  return descent_->state();
}
void ChannelRefinement::go_on_from(std::span<const double> state) {
  descent_->go_on_from(state);
}
void ChannelRefinement::finish(LogModel& model) const {
  descent_->write(model);
}

double objective(const LogModel& model, const TrainingSet& set, const ErrorTerms& shares) {
  return objective(model, set, lookups_of(model.spec, set), shares);
}

double objective(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                 const ErrorTerms& shares) {
  const PictureLoss loss = loss_of(set, shares);
  const auto channels = model.channels;
  // The objective is the mean over the channels of the loss of their errors.
  double sum = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const RefineSystem system(model, set, lookups, loss, TableFormat::single, c, c + 1);
    sum += loss.objective(system.errors(system.read(model)));
  }
  return sum / static_cast<double>(channels);
}

}  // namespace burnish
