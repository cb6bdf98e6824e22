#include <algorithm>
#include <cmath>

#include <burnish/error.h>
#include <burnish/fitting/cholesky.h>
#include <burnish/fitting/refine.h>
#include <burnish/fitting/refine_system.h>

namespace burnish {

namespace {

constexpr std::size_t kMostDirectUnknowns = 2000;

// Levenberg-Marquardt: the damping's start, what a success and a failure make of it, and its smallest.
constexpr double kFirstDamping = 1e-2, kEase = 0.3, kHarden = 4, kLeastDamping = 1e-6;
constexpr int kMostTrials = 6, kMostSlowSteps = 3;
// Pins what neither data nor smoothness determine, as shares of the mean diagonal.
constexpr double kRidge = 1e-7, kDampedRidge = 1e-3;
constexpr double kLongestStep = 2;  // change of a logarithm

// A truncated solution is good enough for a step that is tried and judged.
constexpr int kMostCgIterations = 40;
constexpr double kCgTolerance = 1e-2;

/// One channel's, or coupled channels', damped linear systems.
class StepSolver {
 public:
  StepSolver(const RefineSystem& system, double smooth) : system_(system), smooth_(smooth) {
    if (!direct()) roughness_diagonal_ = 2 * smooth * system.roughness_diagonal();
  }

  void linearize(const Eigen::VectorXd& x, const ErrorTerms& means) {
    if (direct()) {
      system_.find_normal(x, means, partial_);
      system_.add_roughness_matrix(2 * smooth_, partial_.front().matrix);
    } else {
      rows_ = system_.rows(x, means);
    }
    gradient() += 2 * smooth_ * system_.roughness_matrix_times(x);
  }

  Eigen::VectorXd step(double damping) {
    const Eigen::VectorXd diagonal = direct() ? Eigen::VectorXd(partial_.front().matrix.diagonal())
                                              : Eigen::VectorXd(rows_.diagonal + roughness_diagonal_);
    const Eigen::VectorXd extra =
        damping * diagonal.array() + (kRidge + damping * kDampedRidge) * diagonal.mean();
    Eigen::VectorXd dx;
    if (direct()) {
      factorized_ = partial_.front().matrix;
      factorized_.diagonal() += extra;
      dx = -partial_.front().gradient;
      solve_in_place(factorized_, dx);
    } else {
      dx = conjugate_gradients(extra, diagonal + extra);
    }
    return dx.cwiseMax(-kLongestStep).cwiseMin(kLongestStep);
  }

 private:
  bool direct() const { return system_.size() <= kMostDirectUnknowns; }
  Eigen::VectorXd& gradient() { return direct() ? partial_.front().gradient : rows_.gradient; }

  Eigen::VectorXd conjugate_gradients(const Eigen::VectorXd& extra, const Eigen::VectorXd& diagonal) const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(extra.size()), r = -rows_.gradient;
    Eigen::VectorXd z = r.cwiseQuotient(diagonal), p = z;
    double rz = r.dot(z);
    const double enough = kCgTolerance * kCgTolerance * rz;
    for (int k = 0; k < kMostCgIterations && rz > enough; ++k) {
      const Eigen::VectorXd ap =
          system_.apply(rows_, p) + 2 * smooth_ * system_.roughness_matrix_times(p) + extra.cwiseProduct(p);
      const double alpha = rz / p.dot(ap);
      x += alpha * p;
      r -= alpha * ap;
      z = r.cwiseQuotient(diagonal);
      const double next = r.dot(z);
      p = z + next / rz * p;
      rz = next;
    }
    return x;
  }

  const RefineSystem& system_;
  double smooth_;
  Eigen::VectorXd roughness_diagonal_;
  std::vector<RefineSystem::Normal> partial_;
  Eigen::MatrixXd factorized_;
  RefineSystem::Rows rows_;
};

}  // namespace

RefineSummary refine(LogModel& model, const TrainingSet& set, const RefineOptions& options) {
  if (!(options.smooth >= 0) || !std::isfinite(options.smooth) || !(options.max_iterations >= 0))
    throw Error("fit: expected smooth >= 0 and a number of iterations >= 0");
  if (model.channels != set.channels)
    throw Error("fit: expected as many channels in the model as in the data");
  const Lookups lookups = find_lookups(model.spec, set);
  const PictureLoss loss{.shares = options.shares, .exposure = set.exposure};
  const auto channels = static_cast<std::size_t>(model.channels);
  const std::size_t together = model.any_shared() ? channels : 1, systems = channels / together;
  RefineSummary summary{.stop_reason = "no more progress"};

  for (std::size_t s = 0; s < systems; ++s) {
    const RefineSystem system(model, set, lookups, loss, options.format, s * together, (s + 1) * together);
    StepSolver solver(system, options.smooth);
    Eigen::VectorXd x = system.read(model);
    system.clamp(x);
    ErrorTerms means = system.errors(x);
    double best = loss.objective(means) + options.smooth * system.roughness(x);
    summary.objective_before += best / static_cast<double>(systems);
    double damping = kFirstDamping;
    int slow = 0, iteration = 0;
    for (; iteration < options.max_iterations && slow < kMostSlowSteps; ++iteration) {
      if (options.progress)
        options.progress((static_cast<double>(s) + static_cast<double>(iteration) / options.max_iterations) /
                         static_cast<double>(systems));
      solver.linearize(x, means);
      bool accepted = false;
      for (int trial = 0; trial < kMostTrials && !accepted; ++trial) {
        Eigen::VectorXd next = x + solver.step(damping);
        system.clamp(next);
        const ErrorTerms next_means = system.errors(next);
        const double value = loss.objective(next_means) + options.smooth * system.roughness(next);
        accepted = value < best;
        if (accepted) {
          slow = best - value < options.least_progress ? slow + 1 : 0;
          best = value;
          x = std::move(next);
          means = next_means;
          if (trial == 0) damping = std::max(kLeastDamping, kEase * damping);
        } else {
          damping *= kHarden;
        }
      }
      if (!accepted) break;
    }
    if (iteration == options.max_iterations) summary.stop_reason = "iteration limit";
    summary.iterations += iteration;
    summary.objective_after += best / static_cast<double>(systems);
    system.write(x, model);
  }
  if (options.progress) options.progress(1);
  return summary;
}

double objective(const LogModel& model, const TrainingSet& set, const ErrorTerms& shares) {
  const Lookups lookups = find_lookups(model.spec, set);
  const PictureLoss loss{.shares = shares, .exposure = set.exposure};
  const auto channels = static_cast<std::size_t>(model.channels);
  double sum = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const RefineSystem system(model, set, lookups, loss, TableFormat::single, c, c + 1);
    sum += loss.objective(system.errors(system.read(model)));
  }
  return sum / static_cast<double>(channels);
}

}  // namespace burnish
