// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <burnish/factors/table.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// One product of factors; scale has one entry a channel.
struct Lobe {
  std::vector<double> scale;
  std::vector<FactorUse> factors;

  friend bool operator==(const Lobe&, const Lobe&) = default;
};

/// A factored BRDF: f(wi, wo) = sum over lobes of scale * product of table lookups, all positive
/// [HomomorphicBrdf, eq. 4; several lobes go beyond the paper]. A table used for both directions is stored
/// once, and the two lookups are multiplied with each other first, so a reciprocal model is reciprocal to the
/// last bit. Satisfies Brdf: eval takes directions above the horizon, f has channels() entries, 1/sr.
class FactoredBrdf {
 public:
  FactoredBrdf() = default;
  /// Throws Error if a table's size, name, channels or values (finite, > 0, held by its format to the last
  /// bit), a lobe's scale (finite, >= 0) or a factor's table index does not fit.
  FactoredBrdf(std::size_t channels, std::vector<Table> tables, std::vector<Lobe> lobes);
  /// The same with every table in `format`.
  FactoredBrdf(std::size_t channels, std::vector<Table> tables, std::vector<Lobe> lobes, TableFormat format);

  std::size_t channels() const noexcept { return channels_; }
  bool isotropic() const noexcept { return isotropic_; }
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  std::span<const Table> tables() const noexcept { return tables_; }
  std::span<const Lobe> lobes() const noexcept { return lobes_; }
  /// The table that a factor looks up. Precondition: use.table is below tables().size().
  const Table& table_of(const FactorUse& use) const noexcept { return tables_[use.table]; }
  /// Factors of lobe j in evaluation order: first 2 * pair_count(j) in pairs that swapping wi and wo
  /// exchanges, each pair multiplied with itself before anything else, then the rest.
  std::span<const FactorUse> ordered_factors(std::size_t j) const noexcept { return ordered_[j]; }
  std::size_t pair_count(std::size_t j) const noexcept { return pair_counts_[j]; }

  /// True if swapping wi and wo leaves every lobe's factors the same.
  bool reciprocal() const noexcept { return reciprocal_; }
  /// Smallest stored table value; the largest is 1.
  double smallest_factor() const noexcept;
  /// Bytes of the tables as stored, each in its format.
  std::size_t table_bytes() const noexcept;
  /// table_bytes() plus 4 bytes for every scale, warp parameter and projection coefficient that the
  /// projection's name does not imply.
  std::size_t bytes() const noexcept;

  friend bool operator==(const FactoredBrdf&, const FactoredBrdf&) = default;

 private:
  const TableLayout& layout_of(const FactorUse& use) const noexcept { return table_of(use).layout; }

  std::size_t channels_ = 0;
  bool isotropic_ = true, reciprocal_ = true;
  std::vector<Table> tables_;
  std::vector<Lobe> lobes_;
  // lobes_[i].factors in evaluation order: the first 2 * pair_counts_[i] are pairs that swapping exchanges
  std::vector<std::vector<FactorUse>> ordered_;
  std::vector<std::size_t> pair_counts_;
  // distinct places of lookups, and those of ordered_
  std::vector<FactorUse> places_;
  std::vector<std::vector<std::size_t>> place_of_;
};

static_assert(Brdf<FactoredBrdf>);

/// The coefficients of a projection that are not 0 and that its name does not imply.
std::size_t coefficient_count(const Projection& projection) noexcept;

/// Entries of half and single tables are kept at or above this share of the largest: half floats stay
/// positive there, as subnormal numbers with an error of at most 1/32. 2^-14, the smallest normal half, would
/// cut the tails of shiny materials (docs/notes/factorization.md).
inline constexpr double kTableFloor = 0x1p-20;

/// Turns a table of logarithms of lambda into one as it is stored: makes the largest value of every channel 1
/// (rgb9e5: see Table), raises entries to kTableFloor (rgb9e5 and unorm8: to the smallest value their texel
/// can have) and rounds them to the table's format. Returns, for each of its channels, the logarithm of what
/// was divided out. Throws Error if the format does not hold the channels or a logarithm is not finite.
std::vector<double> store_log_table(Table& log_table);

/// Tables as they are stored, each with what its channels were divided by, logarithms, as store_log_table
/// returns them: what they were divided by goes into the lobes' scales, which hold logarithms, one entry a
/// channel. Throws as the constructor does.
FactoredBrdf from_stored_tables(std::size_t channels, std::vector<Table> tables,
                                std::span<const std::vector<double>> divided,
                                std::vector<Lobe> log_scaled_lobes);

/// Stores the tables by store_log_table, what they are divided by moved into the lobes' scales. The tables
/// hold logarithms of lambda, channels as in Table; the lobes' scales logarithms, one entry a channel. Throws
/// as the constructor does.
FactoredBrdf from_log_tables(std::size_t channels, std::vector<Table> log_tables,
                             std::vector<Lobe> log_scaled_lobes);
/// The same with every table in `format`.
FactoredBrdf from_log_tables(std::size_t channels, std::vector<Table> log_tables,
                             std::vector<Lobe> log_scaled_lobes, TableFormat format);

/// "p(wo) q(h) p(wi) + ..." with the tables' names.
std::string model_expression(const FactoredBrdf& brdf);

}  // namespace burnish
