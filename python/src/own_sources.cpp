// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/io/sample_checks.h>
#include <burnish/io/sample_file.h>
#include <burnish/reflectance/function_brdf.h>
#include <burnish/reflectance/goniometer.h>

#include "array_like.h"
#include "opened_brdf.h"

namespace burnish::python {

namespace {

constexpr std::size_t kTriedPairs = 200;
constexpr std::array kTriedTurns{0.7, 2.2, 4.1};  // radians
constexpr double kSameTurned = 1e-3;              // relative: the difference of functions in floats

std::string shape_text(const Array<const double>& array) {
  return array.ndim() == 1 ? fmt::format("({},)", array.shape(0))
                           : fmt::format("({})", fmt::join(std::span(array.shape_ptr(), array.ndim()), ", "));
}

std::string vector_text(Vec3 w) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", w.x, w.y, w.z);
}

// Returns a direction above the horizon. Its length must be 1 to 1 %, as in readers of files, and is scaled to 1.
Vec3 measured_direction(const Rows<const double>& rows, std::size_t i, const char* name) {
  const Vec3 w = vector_at(rows, i);
  const double l = length(w);
  if (!(std::abs(l - 1) <= 0.01))
    throw Error(fmt::format("{}[{}]: expected a unit vector, found {}", name, i, vector_text(w)));
  if (!(w.z > 0))
    throw Error(
        fmt::format("{}[{}]: expected a direction above the horizon, found {}", name, i, vector_text(w)));
  return std::abs(l - 1) < 1e-12 ? w : (1 / l) * w;
}

// Returns values of shape (N,) or (N, channels). One pair, given as two vectors, has values of shape () or (channels,).
Rows<const double> value_rows(const Array<const double>& values, std::size_t count, bool one) {
  const std::size_t n = values.ndim();
  if (one && n == 0) return {values.data(), 0, 1, 1, true};
  if (one && n == 1 && values.shape(0) > 0) return {values.data(), 0, values.stride(0), 1, true};
  if (n == 1 && values.shape(0) == count) return {values.data(), values.stride(0), 0, count, false};
  if (n == 2 && values.shape(0) == count && values.shape(1) > 0)
    return {values.data(), values.stride(0), values.stride(1), count, false};
  throw Error(
      fmt::format("values: expected shape ({0},) or ({0}, channels) for {0} pairs of directions, found {1}",
                  count, shape_text(values)));
}

std::size_t channels_of(const Array<const double>& values, bool one) {
  if (values.ndim() == 2) return values.shape(1);
  return one && values.ndim() == 1 ? values.shape(0) : 1;
}

Samples samples_of(const Array<const double>& wi_array, const Array<const double>& wo_array,
                   const Array<const double>& values) {
  Rows<const double> wi = rows_of<double>(wi_array, "wi", 3), wo = rows_of<double>(wo_array, "wo", 3);
  const bool one = wi.one && wo.one;
  const std::size_t count = match(wi, wo, "wi and wo");
  const Rows<const double> rows = value_rows(values, count, one);
  Samples samples;
  samples.channels = channels_of(values, one);
  if (samples.channels > kMaxFileChannels)
    throw Error(
        fmt::format("values: expected at most {} channels, found {}", kMaxFileChannels, samples.channels));
  for (std::size_t i = 0; i < count; ++i) {
    samples.pairs.push_back({measured_direction(wi, i, "wi"), measured_direction(wo, i, "wo")});
    for (std::size_t c = 0; c < samples.channels; ++c) {
      const double value = *rows.at(i, c);
      if (!std::isfinite(value))
        throw Error(fmt::format("values[{}]: expected finite values, found {}", i, value));
      samples.values.push_back(value);
    }
  }
  return samples;
}

void check_wavelengths(std::size_t channels, const std::vector<double>& lambda_nm) {
  if (lambda_nm.empty() && channels != 1 && channels != 3)
    throw Error(fmt::format("lambda_nm: expected {0} wavelengths for {0} channels, found none", channels));
  if (!lambda_nm.empty() && lambda_nm.size() != channels)
    throw Error(fmt::format("lambda_nm: expected {0} wavelengths for {0} channels, found {1}", channels,
                            lambda_nm.size()));
}

OpenedBrdf* from_samples(nb::handle wi, nb::handle wo, nb::handle values, std::optional<bool> isotropic,
                         const std::string& name, const std::vector<double>& lambda_nm, bool keep_spectral,
                         const std::string& illuminant, bool clamp_negatives) {
  SampleFile file;
  file.samples =
      samples_of(array_of<double>(wi, "wi"), array_of<double>(wo, "wo"), array_of<double>(values, "values"));
  check_wavelengths(file.samples.channels, lambda_nm);
  const nb::gil_scoped_release released;
  file.samples.isotropic = isotropic ? *isotropic : same_incident_azimuth(file.samples);
  file.findings.format = "scattered samples";
  file.findings.lambda_nm = lambda_nm;
  file.findings.conventions = {isotropic ? (*isotropic ? "Isotropic, as asked." : "Anisotropic, as asked.")
                               : file.samples.isotropic
                                   ? "Taken as isotropic: every sample has the same phi_i."
                                   : settle_isotropy(file.samples)};
  OpenOptions options;
  options.keep_spectral = keep_spectral;
  options.illuminant = illuminant;
  finish_samples(name, options, file);
  check_azimuths(file.samples, file.findings);
  return new OpenedBrdf(
      {name, ScatteredBrdf(std::move(file.samples)), std::move(file.findings), clamp_negatives});
}

// A Python function. Any thread may destroy it.
class Callable {
 public:
  explicit Callable(nb::handle function)
      : function_(nb::borrow(function).release().ptr(), [](PyObject* object) {
          if (!Py_IsInitialized()) return;
          const nb::gil_scoped_acquire acquired;
          Py_DECREF(object);
        }) {}

  // Returns its values for the pairs, checked to be real numbers. Needs the GIL.
  Array<const double> operator()(std::span<const DirectionPair> pairs) const {
    std::vector<double> wi, wo;
    for (const auto& [i, o] : pairs) {
      wi.insert(wi.end(), {i.x, i.y, i.z});
      wo.insert(wo.end(), {o.x, o.y, o.z});
    }
    const std::size_t n = pairs.size();
    const nb::object result =
        nb::handle(function_.get())(to_numpy(std::move(wi), {n, 3}), to_numpy(std::move(wo), {n, 3}));
    return array_of<double>(result, "function");
  }

 private:
  std::shared_ptr<PyObject> function_;
};

[[noreturn]] void refuse_shape(std::size_t pairs, std::size_t channels, const Array<const double>& found) {
  throw Error(channels == 1
                  ? fmt::format("function: expected shape ({0},) or ({0}, 1) for {0} pairs, found {1}", pairs,
                                shape_text(found))
                  : fmt::format("function: expected shape ({0}, {2}) for {0} pairs, found {1}", pairs,
                                shape_text(found), channels));
}

void copy_values(const Array<const double>& found, std::span<const DirectionPair> pairs, std::size_t channels,
                 std::span<double> values) {
  const std::size_t n = found.ndim();
  if ((n != 1 && n != 2) || found.shape(0) != pairs.size() ||
      (n == 2 ? found.shape(1) != channels : channels != 1))
    refuse_shape(pairs.size(), channels, found);
  const Rows<const double> rows{found.data(), found.stride(0), n == 2 ? found.stride(1) : 0, pairs.size(),
                                false};
  for (std::size_t i = 0; i < pairs.size(); ++i)
    for (std::size_t c = 0; c < channels; ++c) {
      const double value = *rows.at(i, c);
      if (!(value >= 0 && std::isfinite(value)))
        throw Error(
            fmt::format("function: expected finite values of at least 0, found {:.4g} at wi = {}, wo = {}",
                        value, vector_text(pairs[i].wi), vector_text(pairs[i].wo)));
      values[i * channels + c] = value;
    }
}

// Returns a function's number of channels, from its answer to several pairs.
std::size_t channels_of_answer(const Array<const double>& found, std::size_t pairs) {
  const std::size_t n = found.ndim();
  if (n == 1 && found.shape(0) == pairs) return 1;
  if (n == 2 && found.shape(0) == pairs && found.shape(1) >= 1) return found.shape(1);
  throw Error(fmt::format("function: expected shape ({0},) or ({0}, channels) for {0} pairs, found {1}",
                          pairs, shape_text(found)));
}

Vec3 turned(Vec3 w, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * w.x - s * w.y, s * w.x + c * w.y, w.z};
}

// Returns true if turning both directions about the normal changes nothing, at the turns that are tried.
bool turns(const Callable& function, std::span<const DirectionPair> pairs, std::span<const double> expected,
           std::size_t channels) {
  std::vector<double> values(expected.size());
  for (const double angle : kTriedTurns) {
    std::vector<DirectionPair> tried;
    for (const auto& [wi, wo] : pairs) tried.push_back({turned(wi, angle), turned(wo, angle)});
    copy_values(function(tried), tried, channels, values);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::abs(values[i] - expected[i]) > kSameTurned * std::max(values[i], expected[i])) return false;
  }
  return true;
}

std::string name_of_function(nb::handle function) {
  if (!nb::hasattr(function, "__name__")) return "function";
  const std::string name = nb::str(nb::handle(function.attr("__name__"))).c_str();
  return name == "<lambda>" ? "function" : name;
}

OpenedBrdf* from_function(nb::handle function, std::optional<bool> isotropic,
                          const std::optional<std::string>& name, std::vector<double> lambda_nm) {
  if (!PyCallable_Check(function.ptr()))
    throw nb::type_error(
        fmt::format("function: expected a function of wi and wo, found {}", nb::repr(function).c_str())
            .c_str());
  const Callable called(function);
  const std::vector<DirectionPair> pairs = draw_pairs(kTriedPairs, 1, false);
  const Array<const double> found = called(pairs);
  const std::size_t channels = channels_of_answer(found, pairs.size());
  check_wavelengths(channels, lambda_nm);
  std::vector<double> values(pairs.size() * channels), one(channels);
  copy_values(found, pairs, channels, values);
  copy_values(called(std::span(pairs).first(1)), std::span(pairs).first(1), channels, one);
  const bool same = isotropic ? *isotropic : turns(called, pairs, values, channels);
  const std::string called_as = name ? *name : name_of_function(function);
  Source source =
      to_source(called_as,
                FunctionBrdf(channels, same,
                             [called, channels](std::span<const DirectionPair> asked, std::span<double> f) {
                               const nb::gil_scoped_acquire acquired;
                               copy_values(called(asked), asked, channels, f);
                             }),
                std::move(lambda_nm));
  source.findings.conventions = {isotropic ? (same ? "Isotropic, as asked." : "Anisotropic, as asked.")
                                 : same    ? "Taken as isotropic: turned directions gave the same values."
                                           : "Taken as anisotropic: turned directions gave other values."};
  return new OpenedBrdf(std::move(source));
}

constexpr const char* kSamplesDoc =
    "Makes a source from scattered samples, as open_source does from a file of them.\n"
    "\n"
    "wi, wo: unit vectors to the light and to the viewer, (N, 3), above the horizon. One vector (3,)\n"
    "stands for every row of the other argument.\n"
    "values: f_r in 1/sr, without the cosine, (N,) or (N, channels). The channels are 1, 3 (linear Rec.\n"
    "709) or one for each wavelength. Values below zero are kept, as noise about small values. Values\n"
    "that are not finite are refused.\n"
    "Arrays of any real type and strides, and lists, are copied.\n"
    "isotropic: None decides as for files: isotropic where all wi have one azimuth, otherwise whichever\n"
    "predicts the samples better.\n"
    "name: the name of the source, after which exports are named.\n"
    "lambda_nm: increasing wavelengths of the channels in nm. The spectra become linear Rec. 709 under\n"
    "the illuminant, unless keep_spectral is set.\n"
    "illuminant: \"E\", \"D50\", \"D65\", \"A\" or a file.\n"
    "clamp_negatives: sets interpolated values below zero to zero.";
constexpr const char* kFunctionDoc =
    "Makes a source from a Python function. The function itself is evaluated; no table stands in\n"
    "between.\n"
    "\n"
    "function(wi, wo): takes float64 arrays (N, 3) of unit vectors above the horizon, N from one to\n"
    "thousands. Returns f_r in 1/sr, without the cosine, (N,) or (N, channels), finite and at least 0.\n"
    "The channels are 1, 3 (linear Rec. 709), or one for each wavelength in lambda_nm. Row i may depend\n"
    "on row i of wi and wo alone.\n"
    "isotropic: True if turning both directions about the normal changes nothing. None: this is tried\n"
    "at 200 pairs.\n"
    "name: the name of the source, by default that of the function.\n"
    "\n"
    "The library calls the function from its own threads, one call at a time, with many pairs at once\n"
    "where it can. Each call takes the GIL. Callers of the library have released the GIL, so no call\n"
    "can deadlock, even if the function evaluates other sources.\n"
    "The function should give the same values for the same directions, and change nothing. A fit asks\n"
    "for a million pairs or so. The function never gets directions below the horizon.\n"
    "An exception that the function raises ends the call that needed it, and is raised there. Wrong\n"
    "shapes, nan, infinite values and values below zero raise an Error there.";

}  // namespace

void bind_own_sources(nb::module_& m) {
  nb::borrow<nb::class_<OpenedBrdf>>(m.attr("Source"))
      .def_static(
          "from_samples", &from_samples, nb::arg("wi"), nb::arg("wo"), nb::arg("values"), nb::kw_only(),
          nb::arg("isotropic") = nb::none(), nb::arg("name") = "samples",
          nb::arg("lambda_nm") = std::vector<double>(), nb::arg("keep_spectral") = false,
          nb::arg("illuminant") = "E", nb::arg("clamp_negatives") = true, nb::rv_policy::take_ownership,
          nb::sig("def from_samples(wi: numpy.typing.ArrayLike, wo: numpy.typing.ArrayLike, "
                  "values: numpy.typing.ArrayLike, *, isotropic: bool | None = None, name: str = 'samples', "
                  "lambda_nm: Sequence[float] = [], keep_spectral: bool = False, illuminant: str = 'E', "
                  "clamp_negatives: bool = True) -> Source"),
          kSamplesDoc)
      .def_static(
          "from_function", &from_function, nb::arg("function"), nb::kw_only(),
          nb::arg("isotropic") = nb::none(), nb::arg("name") = nb::none(),
          nb::arg("lambda_nm") = std::vector<double>(), nb::rv_policy::take_ownership,
          nb::sig("def from_function(function: Callable[[NDArray[numpy.float64], NDArray[numpy.float64]], "
                  "numpy.typing.ArrayLike], *, isotropic: bool | None = None, name: str | None = None, "
                  "lambda_nm: Sequence[float] = []) -> Source"),
          kFunctionDoc);
}

}  // namespace burnish::python
