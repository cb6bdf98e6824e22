// SPDX-License-Identifier: Apache-2.0
#include <vector>

#include <burnish/math/parallel.h>

#include "array_like.h"
#include "opened_brdf.h"
#include "rows.h"

namespace burnish::python {

namespace {

constexpr std::size_t kChunk = 16'384;

template <class T>
nb::object pdf(const OpenedBrdf& brdf, const Array<const T>& wi_array, const Array<const T>& wo_array,
               const nb::object& out) {
  Rows<const T> wi = rows_of<T>(wi_array, "wi", 3), wo = rows_of<T>(wo_array, "wo", 3);
  const bool one = wi.one && wo.one;
  const std::size_t n = match(wi, wo, "wi and wo");
  const Result<T> result = make_result<T>(out, n, 0, false);
  without_gil(FunctionWatch({&brdf}), [&] {
    const TabulatedSampler& sampler = brdf.sampler();
    for_each_chunk(n, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      alignas(64) Buffer buffers[6], values;
      for (std::size_t i = begin; i < end; i += kBlock) {
        const std::size_t count = std::min(kBlock, end - i);
        if constexpr (std::is_same_v<T, float>) {
          const auto v = components<3>(wi, i, count, buffers), w = components<3>(wo, i, count, buffers + 3);
          sampler.pdf({v[0], v[1], v[2], w[0], w[1], w[2]}, {values, count});
          for (std::size_t k = 0; k < count; ++k) *result.rows.at(i + k, 0) = values[k];
        } else {
          for (std::size_t k = i; k < i + count; ++k)
            *result.rows.at(k, 0) = sampler.pdf({*wi.at(k, 0), *wi.at(k, 1), *wi.at(k, 2)},
                                                {*wo.at(k, 0), *wo.at(k, 1), *wo.at(k, 2)});
        }
      }
    });
  });
  return one && out.is_none() ? nb::object(result.array[0]) : result.array;
}

template <class T>
nb::tuple sample_wi(const OpenedBrdf& brdf, const Array<const T>& wo_array, const Array<const T>& u_array) {
  Rows<const T> wo = rows_of<T>(wo_array, "wo", 3), u = rows_of<T>(u_array, "u", 2);
  const bool one = wo.one && u.one;
  const std::size_t n = match(wo, u, "wo and u");
  const Result<T> wi = make_result<T>(nb::none(), n, 3, wo.planes() && n > 1),
                  pdf = make_result<T>(nb::none(), n, 0, false);
  without_gil(FunctionWatch({&brdf}), [&] {
    const TabulatedSampler& sampler = brdf.sampler();
    for_each_chunk(n, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      alignas(64) Buffer buffers[5], drawn[4];
      for (std::size_t i = begin; i < end; i += kBlock) {
        const std::size_t count = std::min(kBlock, end - i);
        if constexpr (std::is_same_v<T, float>) {
          const auto w = components<3>(wo, i, count, buffers);
          const auto v = components<2>(u, i, count, buffers + 3);
          sampler.sample_wi({w[0], w[1], w[2], v[0], v[1]},
                            {{drawn[0], count}, {drawn[1], count}, {drawn[2], count}, {drawn[3], count}});
        }
        for (std::size_t k = 0; k < count; ++k) {
          T w[3], density;
          if constexpr (std::is_same_v<T, float>) {
            for (std::size_t c = 0; c < 3; ++c) w[c] = drawn[c][k];
            density = drawn[3][k];
          } else {
            const DrawnDirection d = sampler.sample_wi({*wo.at(i + k, 0), *wo.at(i + k, 1), *wo.at(i + k, 2)},
                                                       {*u.at(i + k, 0), *u.at(i + k, 1)});
            w[0] = d.wi.x;
            w[1] = d.wi.y;
            w[2] = d.wi.z;
            density = d.pdf;
          }
          // No direction is drawn for a viewer below the horizon.
          const bool above = *wo.at(i + k, 2) > 0;
          for (std::size_t c = 0; c < 3; ++c) *wi.rows.at(i + k, c) = above ? w[c] : T(c == 2);
          *pdf.rows.at(i + k, 0) = above ? density : T(0);
        }
      }
    });
  });
  if (one) return nb::make_tuple(wi.array[0], pdf.array[0]);
  return nb::make_tuple(wi.array, pdf.array);
}

nb::object pdf_of_any(const OpenedBrdf& brdf, nb::handle wi, nb::handle wo, const nb::object& out) {
  return is_single({wi, wo}, out)
             ? pdf<float>(brdf, array_of<float>(wi, "wi"), array_of<float>(wo, "wo"), out)
             : pdf<double>(brdf, array_of<double>(wi, "wi"), array_of<double>(wo, "wo"), out);
}

nb::tuple sample_any(const OpenedBrdf& brdf, nb::handle wo, nb::handle u) {
  return is_single({wo, u}) ? sample_wi<float>(brdf, array_of<float>(wo, "wo"), array_of<float>(u, "u"))
                            : sample_wi<double>(brdf, array_of<double>(wo, "wo"), array_of<double>(u, "u"));
}

constexpr const char* kSampleDoc =
    "Draws directions to the light, nearly in proportion to f_r cos(theta_i).\n"
    "\n"
    "wo: unit vectors to the viewer, (N, 3) or (3,).\n"
    "u: uniform numbers in [0, 1), (N, 2) or (2,), of the same type as wo, float32 or float64. Lists\n"
    "are taken as eval takes them.\n"
    "Returns wi (N, 3) and their densities (N,) per solid angle, 1/sr. A density of 0 means that\n"
    "rounding put wi onto the horizon, and that the draw carries no light. The first call makes the\n"
    "sampler's tables.";
constexpr const char* kPdfDoc =
    "Returns the density with which sample_wi draws wi for wo, per solid angle, 1/sr; zero below the\n"
    "horizon.\n"
    "\n"
    "wi, wo: unit vectors, (N, 3) or (3,), both float32 or both float64. Lists are taken as eval takes\n"
    "them.\n"
    "Returns (N,), or fills and returns `out`.";

}  // namespace

void bind_sampling(nb::module_& m) {
  auto source = nb::borrow<nb::class_<OpenedBrdf>>(m.attr("Source"));
  source
      .def("sample_wi", &sample_wi<float>, nb::arg("wo").noconvert(), nb::arg("u").noconvert(),
           nb::sig("def sample_wi(self, wo: NDArray[numpy.float32], u: NDArray[numpy.float32]) -> "
                   "tuple[NDArray[numpy.float32], NDArray[numpy.float32]]"),
           kSampleDoc)
      .def("sample_wi", &sample_wi<double>, nb::arg("wo").noconvert(), nb::arg("u").noconvert(),
           nb::sig("def sample_wi(self, wo: NDArray[numpy.float64], u: NDArray[numpy.float64]) -> "
                   "tuple[NDArray[numpy.float64], NDArray[numpy.float64]]"))
      .def("sample_wi", &sample_any, nb::arg("wo"), nb::arg("u"),
           nb::sig("def sample_wi(self, wo: numpy.typing.ArrayLike, u: numpy.typing.ArrayLike) -> "
                   "tuple[NDArray, NDArray]"))
      .def("pdf", &pdf<float>, nb::arg("wi").noconvert(), nb::arg("wo").noconvert(),
           nb::arg("out") = nb::none(),
           nb::sig("def pdf(self, wi: NDArray[numpy.float32], wo: NDArray[numpy.float32], "
                   "out: NDArray[numpy.float32] | None = None) -> NDArray[numpy.float32]"),
           kPdfDoc)
      .def("pdf", &pdf<double>, nb::arg("wi").noconvert(), nb::arg("wo").noconvert(),
           nb::arg("out") = nb::none(),
           nb::sig("def pdf(self, wi: NDArray[numpy.float64], wo: NDArray[numpy.float64], "
                   "out: NDArray[numpy.float64] | None = None) -> NDArray[numpy.float64]"))
      .def("pdf", &pdf_of_any, nb::arg("wi").none(), nb::arg("wo").none(), nb::arg("out") = nb::none(),
           nb::sig("def pdf(self, wi: numpy.typing.ArrayLike, wo: numpy.typing.ArrayLike, "
                   "out: NDArray | None = None) -> NDArray"));
}

}  // namespace burnish::python
