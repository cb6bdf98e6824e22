#include <algorithm>
#include <atomic>
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

// Levenberg-Marquardt: the damping's start, its smallest, and what successes and failures make of it.
// It changes where the objective falls by more or less than these shares of what was predicted, as a third of
// the damping that serves best makes a step that leads up.
constexpr double kFirstDamping = 1e-2, kFirstIterativeDamping = 0.1, kMinDamping = 1e-6;
constexpr double kEase = 0.3, kHarden = 4, kGoodGain = 0.75, kPoorGain = 0.25;
constexpr int kMaxTrials = 6, kMaxSlowSteps = 3;
/// Levenberg-Marquardt steps of one channel, or of coupled channels.
class Descent {
 public:
  Descent(const LogModel& model, const TrainingSet& set, const Lookups& lookups, const PictureLoss& loss,
          const RefineOptions& options, std::size_t first_channel, std::size_t last_channel)
      : options_(options),
        loss_(loss),
        system_(model, set, lookups, loss, options.format, first_channel, last_channel),
        x_(system_.read(model)) {}

  template <class BeforeStep>
  void run(BeforeStep before_step) {
    StepSolver solver(system_, options_.smooth);
    system_.clamp(x_);
    // Large tables stay in a box: if their floor rose with their largest node, no step might lead down.
    const bool boxed = system_.has_volume();
    const RefineSystem::Box box = boxed ? system_.box(x_) : RefineSystem::Box{};
    ErrorTerms means = system_.errors(x_);
    before_ = after_ = objective(means, x_);
    double damping = solver.is_direct() ? kFirstDamping : kFirstIterativeDamping;
    for (int slow = 0; iterations_ < options_.max_iterations && slow < kMaxSlowSteps; ++iterations_) {
      before_step();
      solver.linearize(x_, means);
      if (boxed) solver.stay_within(box, x_);
      // harder and harder damped, until a step leads down
      bool accepted = false;
      for (int trial = 0; trial < kMaxTrials && !accepted; ++trial) {
        Eigen::VectorXd next = x_ + solver.step(damping);
        if (boxed)
          next = next.cwiseMax(box.least).cwiseMin(box.most);
        else
          system_.clamp(next);
        const ErrorTerms next_means = system_.errors(next);
        const double value = objective(next_means, next);
        accepted = value < after_;
        if (accepted) {
          const double gain = (value - after_) / solver.predicted_change(next - x_);
          slow = after_ - value < options_.least_progress ? slow + 1 : 0;
          after_ = value;
          x_ = std::move(next);
          means = next_means;
          if (gain > kGoodGain && trial == 0) damping = std::max(kMinDamping, kEase * damping);
          if (gain < kPoorGain) damping *= kHarden / 2;
        } else {
          damping *= kHarden;
        }
      }
      if (!accepted) break;
    }
  }

  /// Puts the tables into the model and adds to the summary.
  void finish(LogModel& model, FitSummary& summary) const {
    system_.write(x_, model);
    if (iterations_ == options_.max_iterations) summary.stop_reason = StopReason::iteration_limit;
    summary.iterations += iterations_;
    summary.error_before += before_;
    summary.error_after += after_;
  }

 private:
  double objective(const ErrorTerms& means, const Eigen::VectorXd& x) const {
    return loss_.objective(means) + options_.smooth * system_.roughness(x);
  }

  const RefineOptions& options_;
  const PictureLoss& loss_;
  RefineSystem system_;
  Eigen::VectorXd x_;
  double before_ = 0, after_ = 0;
  int iterations_ = 0;
};

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
  if (!(options.smooth >= 0) || !std::isfinite(options.smooth) || !(options.max_iterations >= 0))
    throw Error("fit: expected smooth >= 0 and a number of iterations >= 0");
  if (model.channels != set.channels)
    throw Error("fit: expected as many channels in the model as in the data");
  const PictureLoss loss{.shares = options.shares, .exposure = set.exposure};
  const auto channels = model.channels;
  const std::size_t together = model.any_shared() ? channels : 1;
  std::vector<Descent> descents;
  for (std::size_t c = 0; c < channels; c += together)
    if (together > 1 || options.channel.value_or(c) == c)
      descents.emplace_back(model, set, lookups, loss, options, c, c + together);

  // Side by side, as much of a step is too small to share out.
  std::atomic<int> steps = 0;
  const std::thread::id caller = std::this_thread::get_id();
  const double all_steps = static_cast<double>(descents.size()) * std::max(options.max_iterations, 1);
  for_each_chunk(descents.size(), 1, [&](std::size_t s, std::size_t, std::size_t) {
    descents[s].run([&] {
      const int done = steps++;
      if (options.progress && std::this_thread::get_id() == caller) options.progress(done / all_steps);
    });
  });

  FitSummary summary{.stop_reason = StopReason::no_more_progress};
  for (const Descent& descent : descents) descent.finish(model, summary);
  summary.error_before /= static_cast<double>(descents.size());
  summary.error_after /= static_cast<double>(descents.size());
  if (options.progress) options.progress(1);
  return summary;
}

double objective(const LogModel& model, const TrainingSet& set, const ErrorTerms& shares) {
  return objective(model, set, lookups_of(model.spec, set), shares);
}

double objective(const LogModel& model, const TrainingSet& set, const Lookups& lookups,
                 const ErrorTerms& shares) {
  const PictureLoss loss{.shares = shares, .exposure = set.exposure};
  const auto channels = model.channels;
  double sum = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const RefineSystem system(model, set, lookups, loss, TableFormat::single, c, c + 1);
    sum += loss.objective(system.errors(system.read(model)));
  }
  return sum / static_cast<double>(channels);
}

}  // namespace burnish
