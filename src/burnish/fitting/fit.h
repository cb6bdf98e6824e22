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

/// How one lobe is fitted, log-linearly: see HomomorphicOptions.
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

/// The model that serves a number of bytes best, at most so many as FactoredBrdf::bytes counts them, of several
/// lobes of lines and grids, or within a number of fetches of whatever serves best within both.
struct Budget {
  /// None: the least of some numbers of bytes beyond which more would store noise or hardly help, see
  /// BudgetChoice; within the fetches of default_budget unless they, lobes or a search are asked for. At most
  /// kMaxBudget.
  std::optional<std::uint64_t> bytes = 2700;
  /// Filtered reads of one evaluation, see fetch_count; 0: the fewest of those tried whose error is within two percent
  /// of the least. The one lobe of scattered samples has at most so many, where somebody chose them.
  int fetches = 0;
  /// Nobody did: whatever `fetches` says, they are default_budget's. Nodes of an isotropic source get one more where
  /// those leave a model farther from them than nodes that are left out are from what the others foretell.
  bool default_fetches = false;
  int lobes = 0;        ///< lobes of lines or hemispheres, without fetches; 0: a choice
  bool search = false;  ///< search_plan first; without fetches
  FitLoss loss = FitLoss::image;
  LogLinear scattered = {};  ///< scattered samples are too few for several lobes: they get one
};

/// Lobes as given, refined together.
struct GivenLobes {
  std::string model;                     ///< see parse_model_spec
  std::vector<std::string> tables = {};  ///< the same
  FitLoss loss = FitLoss::image;
};

/// What others would do instead of positive factors.
struct BaselineMethod {
  std::string method;       ///< one of baseline_methods()
  std::uint64_t bytes = 0;  ///< at most so many; 0: the default of BaselineOptions
};

/// A line and a volume, completed by what the materials of a book have in common: see complete (fitting/book/complete.h).
/// Scattered samples are what is known; of any other source it is as many pairs as FitOptions::samples says, by default
/// 1,000. The model is reciprocal whatever FitOptions::symmetrize says.
struct FromBook {
  std::shared_ptr<const MaterialBook> book;  ///< not null
};

/// What a fit makes.
using FitForm = std::variant<OneLobe, Budget, GivenLobes, BaselineMethod, FromBook>;

/// Bytes and fetches that serve most uses: 16 KB, and two fetches for an isotropic source, six for another.
Budget default_budget(bool isotropic);

/// The form for a model as parse_model_spec reads it: OneLobe or, where it has several, GivenLobes. Without a
/// model default_budget, or where there are tables OneLobe's model. Throws Error as parse_model_spec does.
FitForm form_of(const std::string& model, const std::vector<std::string>& tables, bool isotropic,
                const LogLinear& of_one_lobe, FitLoss of_several);

/// What is fitted: the function that the owner of a measurement makes of it, or what was measured itself. Between
/// nodes of an isotropic source a SmoothedNodes stands, as smooth as predicts nodes best that it has not seen; nodes of
/// an anisotropic one are fitted as they are.
enum class FitTarget { function, nodes };

/// "function" or "nodes". Throws Error on anything else.
FitTarget parse_fit_target(std::string_view text);
/// What parse_fit_target reads.
std::string_view to_string(FitTarget target) noexcept;

struct FitOptions;

/// What is fitted where nobody says. The nodes of isotropic RGL files, whose owners multiply what stands between nodes by
/// a distribution of normals, speckle and all: nodes that were left out are foretold better by the others than by that
/// function, which knows them (docs/results/measured.md). The function of any other source, whose owner interpolates what
/// was measured; of every source without symmetrize, for one lobe, baselines and books, and where a budget's smoothness
/// is cross-validated. Nodes wherever some are held out.
FitTarget default_target(const Source& source, const FitOptions& options);

struct FitOptions {
  std::optional<FitForm> form = {};      ///< none: default_budget
  std::optional<FitTarget> target = {};  ///< none: default_target
  std::optional<NodePart> hold_out =
      {};  ///< nodes that are not fitted and choose nothing; with FitTarget::nodes

  std::optional<double> smooth = {};  ///< >= 0; none: the solver's own, or chosen where LogLinear says so
  /// Of tables without one of their own. None: half; with a budget or several lobes and three channels
  /// rgb9e5; with a budget and scattered samples of three channels the one of both that predicts better.
  std::optional<TableFormat> format = {};
  /// Pairs drawn for one lobe or a baseline from a source that is a function; 0: 200,000, or 500,000 for one
  /// lobe of an anisotropic source.
  std::size_t samples = 0;
  std::uint64_t seed = 1;        ///< of the drawn pairs
  bool symmetrize = true;        ///< fit the reciprocal part, see SymmetrizedBrdf
  bool conserve_energy = false;  ///< see burnish::conserve_energy
  bool score = true;             ///< measure what is stored on pairs that were not fitted
  /// Called from the calling thread with what is done ("smoothing the nodes", "sampling", "choosing lobes", "searching",
  /// "fitting", "matching albedos", a baseline's method) and a rising share of it. What it throws ends the fit and reaches the caller.
  std::function<void(std::string_view stage, double fraction)> progress = {};
};

/// What came of a fit. Its file is written by format_fit (fit_file.h).
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
