// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/factors/factored_brdf.h>

namespace burnish {

/// A factored BRDF without its numbers: which tables there are and how the lobes use them.
struct ModelSpec {
  struct TableSpec {
    std::string name;
    TableLayout layout;
    bool shared = false;                ///< one channel for all
    double smooth_share = 1;            ///< multiplies the fit's smoothness for this table
    std::optional<TableFormat> format;  ///< none: what the fit's options say
    /// For grids. even_y: y is an angle about whose zero f is even, so that f is level there where no sample tells.
    /// pole_x: x is an angle too and y the azimuth about it, so that at x = 0 all y are one direction.
    bool even_y = false, pole_x = false;
    bool circle_z = false;  ///< of volumes: the first layer and the last are one place
  };
  std::vector<TableSpec> tables;
  std::vector<std::vector<FactorUse>> lobes;
};

/// Reads a model such as "p(wo) q(h) p(wi)" or "p(wo) q(h) r(theta_d) p(wi) + s(wi+wo+0.3n)": lobes joined by
/// '+', a lobe a product of tables, each with one projection (see parse_projection), or with two or three polar
/// angles as in "g(theta_h,theta_d,phi_d)". "pqp" and "pqpr" stand for the first and the first lobe of the second.
///
/// `table_options` set tables, one text each: "NAME=SIZE[,warp...][,shared][,format]". SIZE is N (a line over
/// the polar angle), NxN (a disk), NxM (a grid, where two projections are given) or NxMxK (a volume, of
/// three); warps as parse_warp reads them, one an axis in turn, the format as parse_table_format does. Where
/// there is none, the table is a line of 32 nodes (64 and a rational warp for the half vector) if the source
/// is `isotropic` or the projection has a theta name, and otherwise a disk of 64 x 64; a grid has 32 x 32, a
/// volume 24 nodes along theta_h, with a root warp, 12 along theta_d and 8 along another. Throws Error on
/// anything else, and on options for a table that the model does not have.
ModelSpec parse_model_spec(std::string_view expression, std::span<const std::string> table_options,
                           bool isotropic);

/// The format that a table of the spec is stored in: its own; else `general`, but half where that is rgb9e5
/// and the table shared.
TableFormat format_of(const ModelSpec::TableSpec& table, TableFormat general) noexcept;

}  // namespace burnish
