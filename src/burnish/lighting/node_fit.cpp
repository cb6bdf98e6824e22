// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <burnish/lighting/node_fit.h>
#include <burnish/math/angles.h>
#include <burnish/reflectance/half_vector_quadrature.h>

namespace burnish {

namespace {

constexpr std::array<std::size_t, 5> kMirroredEntries{0, 2, 4, 6, 8};
constexpr std::array<std::size_t, 9> kAllEntries{0, 1, 2, 3, 4, 5, 6, 7, 8};
constexpr int kAzimuths = 96, kRadii = 192;
// Solid angle of the white lamps in a picture in which 3 % of a sphere's pixels are white.
constexpr double kWhiteAngle = 0.35;

// The order of a node's parameters: for every lobe its free entries and then its heights, and last the cosine's
// heights.
struct Layout {
  std::span<const std::size_t> entries;
  std::size_t channels, lobes;
  bool with_cosine;

  std::size_t lobe_size() const { return entries.size() + channels; }
  std::size_t shape(std::size_t j) const { return j * lobe_size(); }
  std::size_t height(std::size_t j) const { return j * lobe_size() + entries.size(); }
  std::size_t cosine() const { return lobes * lobe_size(); }
  std::size_t size() const { return cosine() + (with_cosine ? channels : 0); }
};

Eigen::VectorXd parameters_of(const NodeLobes& node, const Layout& layout) {
  Eigen::VectorXd p(layout.size());
  for (std::size_t j = 0; j < layout.lobes; ++j) {
    for (std::size_t k = 0; k < layout.entries.size(); ++k)
      p[static_cast<Eigen::Index>(layout.shape(j) + k)] = node.lobes[j].inverse[layout.entries[k]];
    for (std::size_t c = 0; c < layout.channels; ++c)
      p[static_cast<Eigen::Index>(layout.height(j) + c)] = node.lobes[j].amplitude[c];
  }
  if (layout.with_cosine)
    for (std::size_t c = 0; c < layout.channels; ++c)
      p[static_cast<Eigen::Index>(layout.cosine() + c)] = node.cosine[c];
  return p;
}

NodeLobes lobes_of(const Eigen::VectorXd& p, const Layout& layout, const NodeLobes& like) {
  NodeLobes node = like;
  for (std::size_t j = 0; j < layout.lobes; ++j) {
    for (std::size_t k = 0; k < layout.entries.size(); ++k)
      node.lobes[j].inverse[layout.entries[k]] = p[static_cast<Eigen::Index>(layout.shape(j) + k)];
    for (std::size_t c = 0; c < layout.channels; ++c)
      node.lobes[j].amplitude[c] = p[static_cast<Eigen::Index>(layout.height(j) + c)];
  }
  if (layout.with_cosine)
    for (std::size_t c = 0; c < layout.channels; ++c)
      node.cosine[c] = p[static_cast<Eigen::Index>(layout.cosine() + c)];
  return node;
}

// Keeps heights positive, and the cosine's row at unit length: a matrix's size has no effect.
void settle(NodeLobes& node, const NodeTarget& target) {
  for (NodeLobes::Lobe& lobe : node.lobes) {
    const double size = std::hypot(lobe.inverse[6], lobe.inverse[7], lobe.inverse[8]);
    if (size > 0)
      for (double& b : lobe.inverse) b /= size;
    for (std::size_t c = 0; c < target.channels; ++c)
      lobe.amplitude[c] = std::max(lobe.amplitude[c], 1e-5 * target.albedo[c]);
  }
  for (std::size_t c = 0; c < target.channels; ++c) node.cosine[c] = std::max(node.cosine[c], 0.0);
}

double share_of(const TrialLamp& lamp, const std::array<double, 9>& inverse) {
  const TransformedCosine lobe{inverse};
  std::array<Vec3, 5> seen;
  for (std::size_t i = 0; i < lamp.count; ++i) seen[i] = lobe.to_cosine(lamp.corners[i]);
  return cosine_share(std::span(seen).first(lamp.count));
}

// Steps of finite differences for a matrix's entries, in proportion to its rows.
std::vector<double> steps_of(const std::array<double, 9>& b, std::span<const std::size_t> entries) {
  std::vector<double> steps;
  for (const std::size_t k : entries) {
    const std::size_t row = k / 3;
    steps.push_back(1e-5 * std::hypot(b[3 * row], b[3 * row + 1], b[3 * row + 2]));
  }
  return steps;
}

class Model {
 public:
  Model(const NodeTarget& target, const Layout& layout, const std::array<Vec3, 3>& up)
      : target_(target), layout_(layout), up_(up) {}

  // Returns values for every lamp and channel, and last the albedo of every channel.
  Eigen::VectorXd values(const NodeLobes& node, Eigen::MatrixXd* jacobian) const {
    const std::size_t channels = target_.channels, lamps = target_.lamps.size();
    Eigen::VectorXd values(static_cast<Eigen::Index>((lamps + 1) * channels));
    std::vector<std::vector<double>> steps;
    for (const NodeLobes::Lobe& lobe : node.lobes) steps.push_back(steps_of(lobe.inverse, layout_.entries));
    if (jacobian) jacobian->setZero();
    for (std::size_t i = 0; i <= lamps; ++i) {
      const auto share = [&](const std::array<double, 9>& b) {
        return i < lamps ? share_of(target_.lamps[i], b) : above(b);
      };
      const double cosine = i < lamps ? target_.lamps[i].cosine : 1;
      for (std::size_t c = 0; c < channels; ++c) {
        const auto row = static_cast<Eigen::Index>(i * channels + c);
        values[row] = cosine * node.cosine[c];
        if (jacobian && layout_.with_cosine)
          (*jacobian)(row, static_cast<Eigen::Index>(layout_.cosine() + c)) = cosine;
      }
      for (std::size_t j = 0; j < layout_.lobes; ++j) {
        const NodeLobes::Lobe& lobe = node.lobes[j];
        const double s = share(lobe.inverse);
        for (std::size_t c = 0; c < channels; ++c) {
          const auto row = static_cast<Eigen::Index>(i * channels + c);
          values[row] += s * lobe.amplitude[c];
          if (jacobian) (*jacobian)(row, static_cast<Eigen::Index>(layout_.height(j) + c)) = s;
        }
        if (!jacobian) continue;
        for (std::size_t k = 0; k < layout_.entries.size(); ++k) {
          std::array<double, 9> b = lobe.inverse;
          b[layout_.entries[k]] += steps[j][k];
          const double slope = (share(b) - s) / steps[j][k];
          for (std::size_t c = 0; c < channels; ++c)
            (*jacobian)(static_cast<Eigen::Index>(i * channels + c),
                        static_cast<Eigen::Index>(layout_.shape(j) + k)) = slope * lobe.amplitude[c];
        }
      }
    }
    return values;
  }

 private:
  double above(const std::array<double, 9>& b) const {
    TransformedCosine local;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& v = up_[k];
        local.inverse[3 * i + k] = b[3 * i] * v.x + b[3 * i + 1] * v.y + b[3 * i + 2] * v.z;
      }
    return local.share_above();
  }

  const NodeTarget& target_;
  const Layout& layout_;
  std::array<Vec3, 3> up_;  // axes of the local frame in that of the mirrored view
};

// A value as it is shown. 1 is white; brighter values still count a little.
struct Shown {
  double value, slope;
};
Shown shown(double x) {
  constexpr double kGamma = 1 / 2.2, kFloor = 1e-3, kBeyond = 0.1;
  if (x > 1) return {std::pow(1 + kFloor, kGamma) + kBeyond * std::log(x), kBeyond / x};
  const double power = std::pow(std::max(x, 0.0) + kFloor, kGamma);
  return {power, kGamma * power / (std::max(x, 0.0) + kFloor)};
}

constexpr double kAlbedoWeight = 2;

// Returns the residuals of values. Scales the rows of `jacobian`, if it is not null, by their slopes.
Eigen::VectorXd residuals(const NodeTarget& target, const Eigen::VectorXd& values,
                          Eigen::MatrixXd* jacobian) {
  Eigen::VectorXd r(values.size());
  const std::size_t channels = target.channels, lamps = target.lamps.size();
  for (std::size_t i = 0; i <= lamps; ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      const auto row = static_cast<Eigen::Index>(i * channels + c);
      double slope = 0;
      if (i < lamps) {
        const TrialLamp& lamp = target.lamps[i];
        const double root = std::sqrt(lamp.weight), white = target.white[lamp.size];
        const Shown model = shown(values[row] / white), truth = shown(lamp.value[c] / white);
        r[row] = root * (model.value - truth.value);
        slope = root * model.slope / white;
      } else {
        const double scale = kAlbedoWeight / std::max(target.albedo[c], 1e-12);
        r[row] = scale * (values[row] - target.albedo[c]);
        slope = scale;
      }
      if (jacobian) jacobian->row(row) *= slope;
    }
  return r;
}

// Returns the weight that holds each parameter near the neighbour's, relative to the options' weight.
Eigen::VectorXd stiffness(const NodeLobes& near, const NodeTarget& target, const Layout& layout) {
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(layout.size()));
  double albedo = 0;
  for (std::size_t c = 0; c < target.channels; ++c) albedo += target.albedo[c];
  for (std::size_t j = 0; j < layout.lobes; ++j) {
    for (std::size_t k = 0; k < layout.entries.size(); ++k) {
      const std::size_t row = layout.entries[k] / 3;
      const auto& b = near.lobes[j].inverse;
      const double size = std::hypot(b[3 * row], b[3 * row + 1], b[3 * row + 2]);
      weight[static_cast<Eigen::Index>(layout.shape(j) + k)] = albedo / (size * size + 1e-12);
    }
    for (std::size_t c = 0; c < target.channels; ++c)
      weight[static_cast<Eigen::Index>(layout.height(j) + c)] = 1 / (target.albedo[c] + 1e-12);
  }
  if (layout.with_cosine)
    for (std::size_t c = 0; c < target.channels; ++c)
      weight[static_cast<Eigen::Index>(layout.cosine() + c)] = 1 / (target.albedo[c] + 1e-12);
  return weight;
}

// f_r cos(theta_i) towards one view, at any direction. Wide lamps use fixed directions, which are dense where half
// vectors lie near the normal.
class Reflected {
 public:
  Reflected(BrdfRef brdf, Vec3 wo, const MirroredView& frame, bool halved)
      : brdf_(brdf), wo_(wo), frame_(frame) {
    for (const auto& [wi, weight] : half_vector_quadrature(wo, kAzimuths, kRadii)) {
      const double side = dot(frame.y, wi);
      if (halved && side < 0) continue;
      const std::array<double, 3> f = at(wi);
      Point point{{dot(frame.x, wi), side, dot(frame.z, wi)}, {}};
      for (std::size_t c = 0; c < 3; ++c) point.value[c] = f[c] * weight;
      points_.push_back(point);
      if (!halved) continue;
      point.w.y = -side;
      points_.push_back(point);
    }
  }

  std::array<double, 3> at(Vec3 wi) const {
    std::array<double, 3> f{};
    if (wi.z <= 0) return f;
    brdf_.eval(wi, wo_, std::span(f).first(brdf_.channels()));
    for (double& value : f) value *= wi.z;
    return f;
  }
  std::array<double, 3> albedo() const {
    std::array<double, 3> sum{};
    for (const Point& point : points_)
      for (std::size_t c = 0; c < 3; ++c) sum[c] += point.value[c];
    return sum;
  }
  // Returns the reflection of a square lamp. Its centre is the unit vector `to` of the mirrored view's frame; u and v
  // are half its sides at distance 1.
  std::array<double, 3> of_lamp(Vec3 to, Vec3 u, Vec3 v) const {
    std::array<double, 3> sum{};
    const double half = length(u);
    if (to.z < std::cos(std::min(3.5 * half, kPi)) && half < 0.2) {  // the BRDF is smooth there
      constexpr int kSide = 6;
      for (int i = 0; i < kSide; ++i)
        for (int k = 0; k < kSide; ++k) {
          const Vec3 w = to + ((2 * i + 1.0) / kSide - 1) * u + ((2 * k + 1.0) / kSide - 1) * v;
          const double square = dot(w, w);
          const std::array<double, 3> f =
              at((1 / std::sqrt(square)) * (w.x * frame_.x + w.y * frame_.y + w.z * frame_.z));
          const double angle = 4 * half * half / (kSide * kSide * square * std::sqrt(square));
          for (std::size_t c = 0; c < 3; ++c) sum[c] += angle * f[c];
        }
      return sum;
    }
    const double reach = half * half;
    for (const Point& point : points_) {
      const double along = dot(point.w, to);
      if (along <= 0 || std::abs(dot(point.w, u)) > reach * along ||
          std::abs(dot(point.w, v)) > reach * along)
        continue;
      for (std::size_t c = 0; c < 3; ++c) sum[c] += point.value[c];
    }
    return sum;
  }

 private:
  struct Point {
    Vec3 w;
    std::array<double, 3> value;
  };
  BrdfRef brdf_;
  Vec3 wo_;
  MirroredView frame_;
  std::vector<Point> points_;
};

// Adds lamps of one size on rings about the mirrored view.
void add_lamps(NodeTarget& target, std::size_t size, const MirroredView& frame, const Reflected& reflected,
               bool halved) {
  constexpr int kRings = 18, kAround = 5;
  const double half = std::tan(0.5 * kTrialSizes[size]), first = 0.25 * kTrialSizes[size], last = 0.8 * kPi;
  const auto edge = [&](int ring) {
    return ring == 0 ? 0 : first * std::pow(last / first, (ring - 1.0) / (kRings - 1));
  };
  const Vec3 up{frame.x.z, frame.y.z, frame.z.z};  // the normal
  const int around = halved ? kAround : 2 * kAround;
  for (int ring = 0; ring < kRings; ++ring) {
    const double low = edge(ring), high = edge(ring + 1),
                 polar = ring == 0 ? 0.6 * high : std::sqrt(low * high);
    for (int k = 0; k < around; ++k) {
      const double phi = (halved ? kPi : kTwoPi) * (k + 0.5) / around;
      const Vec3 to = spherical_direction(polar, phi);
      const Vec3 u = half * spherical_direction(polar + kHalfPi, phi),
                 v = half * Vec3{-std::sin(phi), std::cos(phi), 0};
      TrialLamp lamp;
      lamp.size = size;
      lamp.weight = kTwoPi * (std::cos(low) - std::cos(high)) / around;
      // The lamp is clipped in the local frame.
      std::array<Vec3, 4> local;
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 w = to + (i == 1 || i == 2 ? 1.0 : -1.0) * u + (i >= 2 ? 1.0 : -1.0) * v;
        local[i] = {w.x * frame.x.x + w.y * frame.y.x + w.z * frame.z.x,
                    w.x * frame.x.y + w.y * frame.y.y + w.z * frame.z.y, dot(w, up)};
      }
      const std::vector<Vec3> seen = clipped_above(local);
      if (seen.size() < 3) continue;
      lamp.count = seen.size();
      for (std::size_t i = 0; i < seen.size(); ++i)
        lamp.corners[i] = {dot(frame.x, seen[i]), dot(frame.y, seen[i]), dot(frame.z, seen[i])};
      lamp.cosine = cosine_share(seen);
      lamp.value = reflected.of_lamp(to, u, v);
      target.lamps.push_back(lamp);
    }
  }
}

// Returns the value that lamps and channels of kWhiteAngle sr exceed.
double white_of(std::span<const TrialLamp> lamps, std::size_t channels) {
  std::vector<std::pair<double, double>> values;
  for (const TrialLamp& lamp : lamps)
    for (std::size_t c = 0; c < channels; ++c)
      values.emplace_back(lamp.value[c], lamp.weight / static_cast<double>(channels));
  std::ranges::sort(values, std::greater<>());
  double sum = 0;
  for (const auto& [value, weight] : values) {
    sum += weight;
    if (sum >= kWhiteAngle) return std::max(value, 1e-12);
  }
  return 1e-12;
}

}  // namespace

std::span<const std::size_t> free_entries(bool mirrored) noexcept {
  if (mirrored) return kMirroredEntries;
  return kAllEntries;
}

NodeTarget node_target(BrdfRef brdf, Vec3 wo, AreaLightViews views, bool halved) {
  NodeTarget target;
  target.channels = brdf.channels();
  const MirroredView frame = mirrored_view(wo, views);
  const Reflected reflected(brdf, wo, frame, halved);
  target.albedo = reflected.albedo();
  for (std::size_t size = 0; size < kTrialSizes.size(); ++size) {
    const std::size_t first = target.lamps.size();
    add_lamps(target, size, frame, reflected, halved);
    target.white[size] = white_of(std::span(target.lamps).subspan(first), target.channels);
  }
  return target;
}

double fit_node(const NodeTarget& target, const std::array<Vec3, 3>& up, NodeLobes& start,
                const NodeLobes* near, const NodeFitOptions& options) {
  const Layout layout{free_entries(options.mirrored), target.channels, start.lobes.size(),
                      options.with_cosine};
  settle(start, target);
  const Model model(target, layout, up);
  const auto columns = static_cast<Eigen::Index>(layout.size());
  Eigen::MatrixXd jacobian(static_cast<Eigen::Index>((target.lamps.size() + 1) * target.channels), columns);
  Eigen::VectorXd hold = Eigen::VectorXd::Zero(columns), at = hold;
  if (near) {
    hold = options.pull * stiffness(*near, target, layout);
    at = parameters_of(*near, layout);
  }
  const auto pulled = [&](const Eigen::VectorXd& q) { return hold.dot((q - at).cwiseAbs2()); };

  Eigen::VectorXd p = parameters_of(start, layout);
  double loss = residuals(target, model.values(start, nullptr), nullptr).squaredNorm(),
         total = loss + pulled(p);
  double damping = 1e-2;
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const Eigen::VectorXd values = model.values(start, &jacobian);
    const Eigen::VectorXd residual = residuals(target, values, &jacobian);
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    normal.diagonal() += hold;
    const Eigen::VectorXd gradient = jacobian.transpose() * residual + hold.cwiseProduct(p - at);
    const double before = total;
    bool better = false;
    for (int attempt = 0; attempt < 8 && !better; ++attempt) {
      Eigen::MatrixXd damped = normal;
      damped.diagonal() +=
          damping * normal.diagonal() + Eigen::VectorXd::Constant(columns, 1e-12 * normal.trace());
      NodeLobes next = lobes_of(p - damped.ldlt().solve(gradient), layout, start);
      settle(next, target);
      const double next_loss = residuals(target, model.values(next, nullptr), nullptr).squaredNorm();
      const Eigen::VectorXd q = parameters_of(next, layout);
      const double next_total = next_loss + pulled(q);
      better = std::isfinite(next_total) && next_total < total;
      damping = std::clamp(better ? 0.3 * damping : 4 * damping, 1e-9, 1e9);
      if (!better) continue;
      start = std::move(next);
      p = q;
      loss = next_loss;
      total = next_total;
    }
    if (!better || before - total < 1e-5 * before) break;
  }
  return loss;
}

void conserve_albedo(const NodeTarget& target, NodeLobes& node, Vec3 wo, AreaLightViews views) {
  const MirroredView frame = mirrored_view(wo, views);
  for (std::size_t c = 0; c < target.channels; ++c) {
    double sum = node.cosine[c];
    for (const NodeLobes::Lobe& lobe : node.lobes)
      sum += lobe.amplitude[c] * frame.of_local(lobe.inverse).share_above();
    const double scale = sum > 0 ? target.albedo[c] / sum : 0;
    node.cosine[c] *= scale;
    for (NodeLobes::Lobe& lobe : node.lobes) lobe.amplitude[c] *= scale;
  }
}

}  // namespace burnish
