// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <burnish/fitting/numerics/smoothness.h>
#include <burnish/fitting/refinement/albedo_term.h>
#include <burnish/fitting/refinement/lane_gram.h>
#include <burnish/fitting/refinement/lobe_lanes.h>
#include <burnish/fitting/refinement/log_model.h>
#include <burnish/fitting/refinement/lookups.h>
#include <burnish/fitting/refinement/node_band.h>
#include <burnish/fitting/refinement/picture_loss_lanes.h>
#include <burnish/fitting/refinement/sparse_gram.h>
#include <burnish/fitting/refinement/training_set.h>

namespace burnish {

struct LogRange {
  double least, most;
};

/// The unknowns of some channels of a model, those of one channel or, where a table is shared, of all, and
/// the sums over the training set that a Gauss-Newton step needs.
class RefineSystem {
 public:
  RefineSystem(const LogModel& model, const TrainingSet& set, const Lookups& lookups, const PictureLoss& loss,
               TableFormat format, std::size_t first_channel, std::size_t last_channel);

  std::size_t size() const noexcept { return size_; }
  Eigen::VectorXd read(const LogModel& model) const;
  void write(const Eigen::VectorXd& x, LogModel& model) const;
  /// Moves unknowns to where their table's format can hold them. No value is smaller than a share of the
  /// table's largest. Values of rgb9e5 tables stay within a range about the texel's channels in the model
  /// given to the constructor.
  void clamp(Eigen::VectorXd& x) const;

  /// Bounds for each unknown: where clamp would keep it if the others stayed at x, and a table's largest
  /// value rose by no more than kHeadroom (ln 2).
  struct Box {
    Eigen::VectorXd least, most;
  };
  Box box(const Eigen::VectorXd& x) const;

  /// Means of the errors at x.
  ErrorTerms errors(const Eigen::VectorXd& x) const;

  /// Slope of the objective at x, whose errors are `means`, and the lower triangle of its Gauss-Newton
  /// matrix.
  /// With many pairs per unknown, the matrix uses an evenly spaced subset of them.
  struct GaussNewton {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd matrix;
    LaneRows factor;  ///< room that is kept from step to step
  };
  void gauss_newton_matrix(const Eigen::VectorXd& x, const ErrorTerms& means, GaussNewton& result) const {
    gauss_newton_matrix(x, means, 0, size_, result);
  }
  /// Computes the same for the unknowns [first, last) of whole tables, with all others fixed.
  void gauss_newton_matrix(const Eigen::VectorXd& x, const ErrorTerms& means, std::size_t first,
                           std::size_t last, GaussNewton& result) const;

  /// Slope and diagonal without the matrix. Its factor J has the rows curvature^(1/2) d ln f^ / dx.
  struct GaussNewtonFactor {
    Eigen::VectorXd gradient;
    /// Diagonal of the matrix, without the cross terms of one row's lookups that share an unknown.
    Eigen::VectorXd diagonal;
    LobeLanes::Values values;
    /// curvature^(1/2) times the lobes' shares of f^, as LobeLanes::times takes them.
    AlignedVector<float> shares;
    /// Columns whose squares albedos add to the matrix.
    Eigen::MatrixXd albedo_roots;
  };
  GaussNewtonFactor gauss_newton_factor(const Eigen::VectorXd& x, const ErrorTerms& means) const;
  /// Returns the Gauss-Newton matrix times v. As d lambda / dx = lambda, rows are multiplied by the values.
  Eigen::VectorXd gauss_newton_times(const GaussNewtonFactor& factor, const Eigen::VectorXd& v) const {
    const Eigen::VectorXd& lambda = factor.values.lambda;
    return lambda.cwiseProduct(lanes_.times(factor.values, factor.shares, lambda.cwiseProduct(v))) +
           factor.albedo_roots * (factor.albedo_roots.transpose() * v);
  }

  /// Returns true if a table has three axes.
  bool has_volume() const noexcept;
  NodeBand node_band() const { return NodeBand(lanes_.tables(), lookups_, channels()); }
  /// Puts the Gauss-Newton matrix at x and `smooth` times that of the roughness into a band like node_band().
  void fill(const Eigen::VectorXd& x, const ErrorTerms& means, double smooth, NodeBand& band) const;

  /// Returns the sparse matrix of the system, with `smooth` times the roughness as its constant part.
  /// Returns nothing if the model has no volumes or too many nodes meet (SparseGram::of).
  std::optional<SparseGram> sparse_gram(double smooth) const;
  struct SparseGaussNewton {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd albedo_roots;  ///< as in GaussNewtonFactor
  };
  /// Returns the slope at x and puts the matrix at x into `gram`.
  SparseGaussNewton linearize(const Eigen::VectorXd& x, const ErrorTerms& means, SparseGram& gram) const;

  /// Roughness of all tables, its gradient, its matrix times v and its diagonal.
  double roughness(const Eigen::VectorXd& x) const;
  Eigen::VectorXd roughness_matrix_times(const Eigen::VectorXd& v) const;
  Eigen::VectorXd roughness_diagonal() const;
  void add_roughness_matrix(double scale, Eigen::MatrixXd& matrix) const {
    add_roughness_matrix(scale, 0, matrix);
  }
  /// Adds to the matrix of the unknowns from `first` on.
  void add_roughness_matrix(double scale, std::size_t first, Eigen::MatrixXd& matrix) const;

 private:
  std::size_t channels() const noexcept { return last_channel_ - first_channel_; }
  struct SystemTable {
    NodeNumbers number;
    std::size_t nodes, step;  ///< of the model's log_values
    double share, log_range;
    SmoothnessRows smoothness;
  };
  // The inputs of PictureLoss for all pairs, in whole blocks. The last block is filled up with pairs of
  // weight 0.
  struct Losses {
    AlignedVector<float> targets;  // [block][channel of the system][first, second][pair]
    AlignedVector<float> cos_theta_i, picture_weight, pair_weight;  // [pair]
  };
  void add_tables(const LogModel& model, TableFormat format);
  void fill_losses();
  // The albedos' part of the slope, and roots R of their part R R^T of the matrix.
  struct AlbedoPart {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd roots;
  };
  AlbedoPart albedo_part(const Eigen::VectorXd& x, const ErrorTerms& derivatives) const;
  LossInputs loss_inputs(std::size_t block, std::size_t channel, const float* model) const noexcept;
  // Calls visit(block, channel, lanes as differentiate leaves them, gradients, curvatures) for the blocks
  // from `begin` to `end`.
  template <class Visit>
  void for_each_slope(const LobeLanes::Values& values, const ErrorTerms& derivatives, std::size_t begin,
                      std::size_t end, Visit visit) const;
  template <class Visit>
  void for_each_unknown(Visit visit) const;
  template <class Visit>
  void for_each_limit(const Eigen::VectorXd& x, Visit visit) const;
  template <class Visit>
  void for_each_roughness_row(Visit visit) const;

  const TrainingSet& set_;
  const Lookups& lookups_;
  PictureLoss loss_;
  Losses losses_;
  std::size_t first_channel_, last_channel_, size_ = 0;
  std::vector<SystemTable> tables_;
  std::vector<LogRange> ranges_;  // of the unknowns, over their channel's mean in the table
  double picture_weight_ = 0, pair_weight_ = 0;
  LobeLanes lanes_;
  AlbedoTerm albedo_;
};

}  // namespace burnish
