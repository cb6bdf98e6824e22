// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <burnish/reflectance/brdf.h>

namespace burnish {

/// Positions of samples along one angle.
struct AngleAxis {
  std::vector<double> nodes;  ///< increasing, radians, at least one
  double period = 0;          ///< 2 pi for an azimuth, 0 for an angle that does not wrap
  bool closed = false;        ///< the step from the last node around to the first is one to interpolate over
  double reach = 0;           ///< how far beyond the last node its value holds; 0: half the last step
};

/// The two nodes next to an angle and the weight of the second. Not `inside` farther from the first or last
/// node than half its step (the last: than the axis's reach): nothing is known there. A single node stands for
/// every angle.
struct AxisNeighbours {
  std::array<std::size_t, 2> index{};
  double fraction = 0;
  bool inside = true;
};

/// An azimuth's axis is closed where the step around is at most 1.5 times the widest other step.
AngleAxis make_axis(std::vector<double> nodes, double period = 0);

AxisNeighbours neighbours(const AngleAxis& axis, double angle) noexcept;

/// Angles of cell centres, (i + 1/2) / count times the extent.
std::vector<double> cell_centres(std::size_t count, double extent);

/// A dense table over four angles, the first two of which are phi_i and theta_i. The last two depend on the
/// frame:
/// - normal: theta_o and the azimuth phi_o - phi_i;
/// - specular: the azimuth around and the angle from the mirror direction of wi; azimuth 0 points to the
///   normal and grows counter-clockwise as seen against the mirror direction. Refracted light has another direction
///   in the place of the mirror direction (centre_theta).
/// A single node of phi_i makes it isotropic.
struct AngleTable {
  enum class Frame { normal, specular };

  Frame frame = Frame::normal;
  bool folded = false;  ///< azimuths a and -a have one value; the axis covers [0, pi]
  std::array<AngleAxis, 4> axes;
  std::size_t channel_count = 1;
  /// [axis 0][axis 1][axis 2][axis 3][channel], 1/sr; NaN in all channels is a hole
  std::vector<float> values;
  /// Frame::specular: for each node of theta_i the polar angle of the direction that the last two angles count from,
  /// radians. Empty if it is theta_i.
  std::vector<double> centre_theta = {};

  std::size_t channels() const noexcept { return channel_count; }
  bool isotropic() const noexcept { return axes[0].nodes.size() == 1; }
  /// Linear along each angle. Holes have no weight, the others' weights are scaled to sum to 1; unknown where those that
  /// are no holes have less than 1e-9 of it and outside an axis (see AxisNeighbours).
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
  bool eval_raw(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;
};

static_assert(HasRawValues<AngleTable>);

/// Directions of the entry at a node of each axis; either may lie below the horizon. Precondition: indices
/// below the axes' sizes.
DirectionPair node_directions(const AngleTable& table, const std::array<std::size_t, 4>& node) noexcept;

/// The nodes of an entry, counted as `values` does. Precondition: entry < entry_count(table).
std::array<std::size_t, 4> node_of_entry(const AngleTable& table, std::size_t entry) noexcept;

std::size_t entry_count(const AngleTable& table) noexcept;

/// Fills a table that has frame, folding and axes with a source's channels and values at its nodes, on all
/// threads. A folded table takes the mean of both sides of the plane of incidence, or the one that is known.
/// Entries with a direction below the horizon and unknown ones become holes.
AngleTable tabulate_angles(BrdfRef source, AngleTable layout);

/// The direction wo at `azimuth` around and `radial` from the mirror direction of the light at (theta_i,
/// phi_i); see AngleTable::Frame::specular.
Vec3 around_specular(double theta_i, double phi_i, double azimuth, double radial) noexcept;

}  // namespace burnish
