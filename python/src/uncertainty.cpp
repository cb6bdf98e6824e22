// SPDX-License-Identifier: Apache-2.0
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nanobind/stl/string.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/math/angles.h>
#include <burnish/math/parallel.h>
#include <burnish/math/written_degrees.h>
#include <burnish/reflectance/kriged_nodes.h>
#include <burnish/reflectance/next_measurements.h>
#include <burnish/reflectance/node_figures.h>
#include <burnish/reflectance/outliers.h>

#include "array_like.h"
#include "opened_brdf.h"
#include "progress.h"

namespace burnish::python {

namespace {

constexpr std::size_t kChunk = 4096;

template <class T>
nb::object relative_error(const OpenedBrdf& brdf, const Array<const T>& wi_array,
                          const Array<const T>& wo_array, const nb::object& out) {
  Rows<const T> wi = rows_of<T>(wi_array, "wi", 3), wo = rows_of<T>(wo_array, "wo", 3);
  const bool one = wi.one && wo.one;
  const std::size_t count = match(wi, wo, "wi and wo");
  const Result<T> result = make_result<T>(out, count, 0, false);
  {
    const nb::gil_scoped_release released;
    const KrigedNodes& function = brdf.uncertain();
    for_each_chunk(count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Vec3 to_light = vector_at(wi, i), to_viewer = vector_at(wo, i);
        *result.rows.at(i, 0) = is_direction(to_light) && is_direction(to_viewer)
                                    ? static_cast<T>(function.uncertainty(to_light, to_viewer).function)
                                    : std::numeric_limits<T>::quiet_NaN();
      }
    });
  }
  return one && out.is_none() ? nb::object(result.array[0]) : result.array;
}

nb::object relative_error_of_any(const OpenedBrdf& brdf, nb::handle wi, nb::handle wo,
                                 const nb::object& out) {
  return is_single({wi, wo}, out)
             ? relative_error<float>(brdf, array_of<float>(wi, "wi"), array_of<float>(wo, "wo"), out)
             : relative_error<double>(brdf, array_of<double>(wi, "wi"), array_of<double>(wo, "wo"), out);
}

nb::object next_to_measure(const OpenedBrdf& brdf, std::size_t count) {
  if (count < 1 || count > kMostNext)
    throw Error(fmt::format("count: expected 1 to {} directions, found {}", kMostNext, count));
  const Source& source = brdf.source();
  std::string text;
  {
    const nb::gil_scoped_release released;
    const MeasuredNodes all = measured_nodes(source), nodes = source.samples() ? without_outliers(all) : all;
    try {
      const LogCovariance covariance = choose_covariance(
          nodes, [told = progress_of(nb::none())](double fraction) { told("kriging", fraction); });
      nlohmann::ordered_json list = nlohmann::ordered_json::array();
      for (const auto& [pair, error] : next_measurements(nodes, covariance, count))
        list.push_back({{"theta_i_deg", written_degrees(theta_of(pair.wi))},
                        {"phi_i_deg", written_degrees(phi_of(pair.wi))},
                        {"theta_o_deg", written_degrees(theta_of(pair.wo))},
                        {"phi_o_deg", written_degrees(phi_of(pair.wo))},
                        {"error", error}});
      text = list.dump();
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", source.name, error.what()));
    }
  }
  return from_json(text);
}

constexpr const char* kErrorDoc =
    "Returns how far eval of a measurement may be off, as `burnish eval --error` writes it. The error\n"
    "is the standard deviation of ln(f + 0.001), which is about the relative error.\n"
    "\n"
    "wi, wo: as eval takes them. Returns (N,), or fills and returns `out`.\n"
    "The error is small where samples are dense and smooth, and larger where there are none. It is 0\n"
    "below the horizon, and nan where wi or wo is not a unit vector to 1 %. The first call makes the\n"
    "tables that it needs. Formulas and models are refused.";

}  // namespace

void bind_uncertainty(nb::module_& m) {
  nb::borrow<nb::class_<OpenedBrdf>>(m.attr("Source"))
      .def("relative_error", &relative_error_of_any, nb::arg("wi").none(), nb::arg("wo").none(),
           nb::arg("out") = nb::none(),
           nb::sig("def relative_error(self, wi: numpy.typing.ArrayLike, wo: numpy.typing.ArrayLike, "
                   "out: NDArray | None = None) -> NDArray"),
           kErrorDoc);
  m.def("next_measurements", &next_to_measure, nb::arg("source"), nb::arg("count") = 20,
        nb::sig("def next_measurements(source: Source, count: int = 20) -> list[dict[str, float]]"),
        "Returns directions to measure next, as `burnish measure --next` lists them. Each lowers the\n"
        "expected error of the measurement most, given the directions before it. All can be measured in one\n"
        "go.\n"
        "\n"
        "A pair of directions is a dictionary of theta_i_deg, phi_i_deg, theta_o_deg, phi_o_deg and error.\n"
        "The error is how far its value may be off once the pairs before it are measured.\n"
        "count: from 1 to 800. Formulas and models are refused.");
}

}  // namespace burnish::python
