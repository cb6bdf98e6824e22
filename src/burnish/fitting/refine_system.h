#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <burnish/fitting/log_model.h>
#include <burnish/fitting/picture_loss.h>
#include <burnish/fitting/smoothness.h>
#include <burnish/fitting/training_set.h>

namespace burnish {

/// Where a model's lookups fall, the same for every channel: [pair][use], uses of all lobes in order.
struct Lookups {
  std::size_t uses = 0;
  std::vector<std::uint32_t> node;
  std::vector<float> fx, fy;
};

Lookups find_lookups(const ModelSpec& spec, const TrainingSet& set);

/// The unknowns of some channels of a model, those of one channel or, where a table is shared, of all, and
/// the sums over the training set that a Gauss-Newton step needs.
class RefineSystem {
 public:
  RefineSystem(const LogModel& model, const TrainingSet& set, const Lookups& lookups, const PictureLoss& loss,
               TableFormat format, std::size_t first_channel, std::size_t last_channel);

  std::size_t size() const noexcept { return size_; }
  Eigen::VectorXd read(const LogModel& model) const;
  void write(const Eigen::VectorXd& x, LogModel& model) const;
  /// Raises unknowns to what their table's format can hold: a share of the table's largest, and of rgb9e5
  /// tables a share of the texel's largest channel, as the other channels stand in the model given.
  void clamp(Eigen::VectorXd& x) const;

  /// Means of the errors at x.
  ErrorTerms errors(const Eigen::VectorXd& x) const;

  /// Slope and Gauss-Newton matrix of the objective at x whose errors are `means`. Where there are over 80
  /// pairs an unknown, the matrix is that of an even part of them.
  struct Normal {
    Eigen::VectorXd gradient;
    Eigen::MatrixXd matrix;
  };
  /// `partial` is room for the sums of groups of pairs, kept from step to step; the first is the result.
  void find_normal(const Eigen::VectorXd& x, const ErrorTerms& means, std::vector<Normal>& partial) const {
    find_normal(x, means, 0, size_, partial);
  }
  /// The same of the unknowns [first, last), the others being fixed.
  void find_normal(const Eigen::VectorXd& x, const ErrorTerms& means, std::size_t first, std::size_t last,
                   std::vector<Normal>& partial) const;

  /// The same without the matrix: the rows of its factor, curvature^(1/2) d ln f^ / dx.
  struct Rows {
    Eigen::VectorXd gradient;
    Eigen::VectorXd diagonal;  ///< of the matrix, less what terms of one row that share an unknown add
    std::size_t width = 0;     ///< terms a row; the row of pair i and channel c is number i * channels + c
    std::vector<std::uint32_t> unknown;
    std::vector<float> value;
  };
  Rows rows(const Eigen::VectorXd& x, const ErrorTerms& means) const;
  /// The normal matrix times v.
  Eigen::VectorXd apply(const Rows& rows, const Eigen::VectorXd& v) const;

  /// Roughness of all tables, its gradient, its matrix times v and its diagonal.
  double roughness(const Eigen::VectorXd& x) const;
  Eigen::VectorXd roughness_matrix_times(const Eigen::VectorXd& v) const;
  Eigen::VectorXd roughness_diagonal() const;
  void add_roughness_matrix(double scale, Eigen::MatrixXd& matrix) const {
    add_roughness_matrix(scale, 0, matrix);
  }
  /// The same to the matrix of the unknowns from `first` on.
  void add_roughness_matrix(double scale, std::size_t first, Eigen::MatrixXd& matrix) const;

 private:
  struct Use {
    std::size_t base, stride,
        channel_stride;    // unknown of node n, channel c: base + n stride + c channel_stride
    std::size_t next_row;  // 0: a line
    std::size_t lobe;
  };
  struct TableUnknowns {
    std::size_t base, stride, copies, nodes, step;
    double share, log_range;
    SmoothnessRows rows;
  };
  struct Term {
    std::uint32_t unknown;
    float value;
  };

  // The model's value at pair i, and the terms of d ln f^ / dx.
  double evaluate(const double* lambda, std::size_t pair, std::size_t channel, std::span<double> factor,
                  std::span<double> product) const noexcept;
  std::size_t differentiate(const double* lambda, std::size_t pair, std::size_t channel, double total,
                            std::span<const double> factor, std::span<const double> product,
                            std::span<Term> terms) const noexcept;
  template <class Visit>
  void for_each_roughness_row(Visit visit) const;

  const TrainingSet& set_;
  const Lookups& lookups_;
  PictureLoss loss_;
  std::vector<PictureLoss::Target> targets_;  // [pair][channel of the system]
  std::size_t first_channel_, last_channel_, size_ = 0, lobes_ = 0;
  std::vector<Use> uses_;
  std::vector<TableUnknowns> tables_;
  std::vector<double> floors_;  // of the unknowns, -infinity where the other channels ask for none
  double picture_weight_ = 0, pair_weight_ = 0;
};

}  // namespace burnish
