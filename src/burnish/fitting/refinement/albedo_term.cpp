// SPDX-License-Identifier: Apache-2.0
#include <array>

#include <burnish/fitting/refinement/albedo_term.h>
#include <burnish/math/parallel.h>

namespace burnish {

AlbedoTerm::AlbedoTerm(const ModelSpec& spec, std::span<const LobeLanes::NumberedTable> tables,
                       const AlbedoSet& set, std::size_t all_channels, std::size_t first_channel,
                       std::size_t channels)
    : set_(set), all_channels_(all_channels), first_channel_(first_channel), channels_(channels) {
  if (set.empty()) return;
  lookups_ = std::make_unique<Lookups>(lookups_of(spec, TrainingSet{.pairs = set.pairs}));
  lanes_ = std::make_unique<LobeLanes>(tables, *lookups_, channels);
}

template <class Visit>
void AlbedoTerm::for_each_block(std::size_t direction, Visit visit) const {
  constexpr std::size_t kBlock = LobeLanes::kBlock;
  const std::size_t blocks = set_.points() / kBlock;
  for (std::size_t b = direction * blocks; b < (direction + 1) * blocks; ++b)
    for (std::size_t c = 0; c < channels_; ++c) {
      // Errors are relative: weights cos(theta_o) times solid angle are divided by the scale of the target.
      const float scale = set_.scales[direction * all_channels_ + first_channel_ + c];
      std::array<float, kBlock> weights;
      for (std::size_t i = 0; i < kBlock; ++i) weights[i] = set_.weights[b * kBlock + i] / scale;
      visit(c, b, weights);
    }
}

double AlbedoTerm::target(std::size_t direction, std::size_t channel) const noexcept {
  const std::size_t at = direction * all_channels_ + first_channel_ + channel;
  return static_cast<double>(set_.targets[at] / set_.scales[at]);
}

Eigen::VectorXd AlbedoTerm::residuals(const Eigen::VectorXd& x) const {
  Eigen::VectorXd result = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(size()));
  if (set_.empty()) return result;
  // residual = (sum over points of weight f^ - target) / scale, for each direction and channel.
  const LobeLanes::Values values = lanes_->values(x);
  for_each_chunk(set_.directions, 1, [&](std::size_t k, std::size_t, std::size_t) {
    LobeLanes::Block at = lanes_->block();
    const auto residual = [&](std::size_t c) -> double& {
      return result[static_cast<Eigen::Index>(k * channels_ + c)];
    };
    for_each_block(k, [&](std::size_t c, std::size_t b, const auto& weights) {
      lanes_->evaluate(values, b, c, at);
      for (std::size_t i = 0; i < weights.size(); ++i)
        residual(c) += static_cast<double>(weights[i]) * static_cast<double>(at.total[i]);
    });
    for (std::size_t c = 0; c < channels_; ++c) residual(c) -= target(k, c);
  });
  return result;
}

AlbedoTerm::Rows AlbedoTerm::rows(const Eigen::VectorXd& x) const {
  Rows result{residuals(x), Eigen::MatrixXd::Zero(x.size(), static_cast<Eigen::Index>(size()))};
  if (set_.empty()) return result;
  const LobeLanes::Values values = lanes_->values(x);
  for_each_chunk(set_.directions, 1, [&](std::size_t k, std::size_t, std::size_t) {
    LobeLanes::Block at = lanes_->block();
    std::vector<AlignedVector<float>> sums(channels_);
    for (auto& sum : sums) sum.resize(values.lambdas.size());
    for_each_block(k, [&](std::size_t c, std::size_t b, const auto& weights) {
      // The residual is linear in f^, and d f^ = f^ d ln f^, so each point's row is scaled by weight times f^.
      lanes_->evaluate(values, b, c, at);
      std::array<float, LobeLanes::kBlock> amounts;
      for (std::size_t i = 0; i < amounts.size(); ++i) amounts[i] = weights[i] * at.total[i];
      lanes_->differentiate(at);
      lanes_->add_transposed(at, amounts.data(), b, c, sums[c]);
    });
    for (std::size_t c = 0; c < channels_; ++c) {
      Eigen::VectorXd slope = Eigen::VectorXd::Zero(x.size());
      lanes_->gather(sums[c], slope);
      // The unknowns are x = ln lambda, so the derivative by lambda is multiplied by lambda.
      result.slopes.col(static_cast<Eigen::Index>(k * channels_ + c)) = slope.cwiseProduct(values.lambda);
    }
  });
  return result;
}

}  // namespace burnish
