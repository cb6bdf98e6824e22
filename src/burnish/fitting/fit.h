// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <burnish/baselines/baseline_file.h>
#include <burnish/book/material_book.h>
#include <burnish/factors/factored_brdf.h>
#include <burnish/factors/table_format.h>
#include <burnish/fitting/fit_report.h>
#include <burnish/reflectance/measured_nodes.h>
#include <burnish/source.h>

namespace burnish {

/// Options of the log-linear fit of one lobe: see HomomorphicOptions.
struct LogLinear {
  bool cross_validate = false;           ///< choose the smoothness; of scattered samples always
  std::optional<int> reweightings = {};  ///< none: 4 for scattered samples, else 0
  double floor = 3e-5;                   ///< 1/sr, added to every value before its logarithm is taken
};

/// One lobe: a product of tables.
struct OneLobe {
  std::string model = "pqp";             ///< see parse_model_spec
  std::vector<std::string> tables = {};  ///< the same
  LogLinear how = {};
};

/// The most bytes that a model may be asked to take.
inline constexpr std::uint64_t kMaxBudget = std::uint64_t{64} << 20;

/// The best model within a number of bytes, which FactoredBrdf::bytes counts. Without a number of fetches it may have
/// several lobes of lines and grids. With one it may have any form that is within both limits.
struct Budget {
  /// At most this many bytes, from 1 to kMaxBudget. None: the library tries more and more bytes, until more would store
  /// noise or hardly help, see BudgetChoice. Each trial then takes the fetches of DefaultBudget, unless fetches, lobes
  /// or a search are given.
  std::optional<std::uint64_t> bytes = 2700;
  /// At most this many filtered reads of tables in one evaluation, at least 1, see fetch_count. None: the library tries
  /// several numbers on part of the pairs. It takes the fewest whose error is within two percent of the least.
  /// The one lobe of scattered samples keeps to a given number too. Excludes lobes and search.
  std::optional<int> fetches = {};
  /// This many lobes of lines or hemispheres, at least 1. None: the library chooses.
  std::optional<int> lobes = {};
  bool search = false;  ///< search factors, projections, warps and sizes first, see search_plan
  FitLoss loss = FitLoss::image;
  LogLinear scattered = {};  ///< of the one lobe that scattered samples get as a function
};

/// The bytes of DefaultBudget.
inline constexpr std::uint64_t kDefaultBudget = 16 << 10;

/// The budget that serves most uses: 16 KB, and two fetches for an isotropic source, six for another. Nodes of an
/// isotropic source get one fetch more if the model's error at the nodes is larger than their cross-validation error.
/// The one lobe of scattered samples has as many fetches as predict best.
struct DefaultBudget {
  FitLoss loss = FitLoss::image;
  LogLinear scattered = {};  ///< as Budget has it
};

/// Lobes as given, refined together.
struct GivenLobes {
  std::string model;                     ///< see parse_model_spec
  std::vector<std::string> tables = {};  ///< the same
  FitLoss loss = FitLoss::image;
};

/// A method of others in place of positive factors.
struct BaselineMethod {
  std::string method;  ///< one of baseline_methods()
  /// At most this many bytes, at least 1. None: the default of BaselineOptions.
  std::optional<std::uint64_t> bytes = {};
};

/// A line and a volume, completed by what the materials of a book have in common: see complete (fitting/book/complete.h).
/// Scattered samples are what is known; of any other source it is as many pairs as FitOptions::samples says. The
/// model is reciprocal whatever FitOptions::symmetrize says.
struct FromBook {
  std::shared_ptr<const MaterialBook> book;  ///< not null
};

/// The form of the model that a fit makes.
using FitForm = std::variant<OneLobe, Budget, DefaultBudget, GivenLobes, BaselineMethod, FromBook>;

/// The form for a model as parse_model_spec reads it: OneLobe or, where it has several, GivenLobes. Without a
/// model DefaultBudget, or where there are tables OneLobe's model. Throws Error as parse_model_spec does.
FitForm form_of(const std::string& model, const std::vector<std::string>& tables, bool isotropic,
                const LogLinear& of_one_lobe, FitLoss of_several);

/// The data of a fit: the function that the owner of a measurement makes of it, or the measured nodes themselves.
/// Between the nodes of an isotropic source, a KrigedNodes interpolates under the covariance that predicts left-out
/// nodes best. Nodes of an anisotropic source are fitted as they are.
enum class FitTarget { function, nodes };

/// "function" or "nodes". Throws Error on anything else.
FitTarget parse_fit_target(std::string_view text);
/// Returns the name that parse_fit_target reads.
std::string_view to_string(FitTarget target) noexcept;

struct FitOptions;

/// Returns the target where the options name none.
/// - nodes: scattered samples, unless they crowd about wi = wo or are fewer than 1,000 of an anisotropic source; and
///   isotropic RGL files. Their owners multiply the interpolation between nodes by a distribution of normals, speckle
///   included (docs/results/measured.md). Nodes also wherever some are held out.
/// - function: any other source, and every source without symmetrize, for one lobe, for baselines and books, and where
///   a budget's smoothness is cross-validated.
/// Scattered samples with lobes as given are fitted as they are.
FitTarget default_target(const Source& source, const FitOptions& options);

struct FitOptions {
  std::optional<FitForm> form = {};      ///< none: DefaultBudget
  std::optional<FitTarget> target = {};  ///< none: default_target
  std::optional<NodePart> hold_out =
      {};  ///< nodes that are not fitted and choose nothing; with FitTarget::nodes

  std::optional<double> smooth = {};  ///< >= 0; none: the solver's own, or chosen where LogLinear says so
  /// The format of tables without one of their own. None: half; with a budget or several lobes and three channels
  /// rgb9e5; with a budget and scattered samples of three channels the one of both that predicts better.
  std::optional<TableFormat> format = {};
  /// Pairs drawn from a source that is a function, at least 1: for one lobe, a baseline or a book. None: 200,000, for
  /// one lobe of an anisotropic source 500,000, for a book 1,000.
  std::optional<std::size_t> samples = {};
  std::uint64_t seed = 1;        ///< of the drawn pairs
  bool symmetrize = true;        ///< fit the reciprocal part, see SymmetrizedBrdf; of no transmission
  bool conserve_energy = false;  ///< see burnish::conserve_energy
  bool score = true;             ///< measure what is stored on pairs that were not fitted
  /// Called from the calling thread with what is done ("kriging the nodes", "sampling", "choosing lobes",
  /// "searching", "fitting", "matching albedos", a baseline's method) and a rising share of it. An exception that it
  /// throws ends the fit and reaches the caller.
  std::function<void(std::string_view stage, double fraction)> progress = {};
};

/// The result of a fit. Its file is written by format_fit (fit_file.h).
struct Fit {
  std::variant<FactoredBrdf, BaselineBrdf> brdf;  ///< the second where the form was a BaselineMethod
  std::vector<double> lambda_nm;                  ///< wavelengths of the channels; empty for grey and RGB
  FitReport report;

  /// The factored BRDF. Throws Error where a baseline was fitted.
  const FactoredBrdf& model() const&;
  FactoredBrdf model() &&;
  /// Refers to this object, which must outlive it and stay where it is.
  BrdfRef ref() const noexcept;
  /// Size as its type counts it.
  std::size_t bytes() const noexcept;
};

/// Fits a source the way `burnish fit` does: one lobe log-linearly (fit_homomorphic), to scattered samples
/// and to tables of half and difference angles as they are, to pairs drawn from any other source; several
/// lobes as fit_plan or fit_lobes do; baselines as fit_baseline does. The same bits for the same options,
/// whatever the number of threads. Throws Error for options that the form or the source does not take (a
/// model, table or format that does not fit; a baseline with a format, a smoothness or conserve_energy; a book with
/// nodes as the target or a smoothness), and what the solvers throw.
Fit fit(const Source& source, const FitOptions& options);

}  // namespace burnish
