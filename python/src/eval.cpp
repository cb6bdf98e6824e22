// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include <burnish/factors/table_gradient.h>
#include <burnish/math/parallel.h>

#include "array_like.h"
#include "opened_brdf.h"
#include "rows.h"
#include "table_shape.h"

namespace burnish::python {

namespace {

// A task has so many directions that starting it costs hardly anything.
constexpr std::size_t kChunk = 32'768;

/// The arrays that one evaluation reads and writes.
template <class T>
struct Job {
  Rows<const T> wi, wo;
  Rows<T> f;
  std::size_t count, channels;
  bool transmits = false;  ///< wo lies below the surface, and is mirrored to above it before the evaluation
};

// Evaluates a part by a model. Arrays that are all in planes or all in rows are used in place; others go through
// buffers of rows.
void eval_model(const FactoredEvaluator& evaluator, const Job<float>& job, std::size_t begin,
                std::size_t end) {
  if (job.wi.planes() && job.wo.planes() && job.f.planes()) {
    const auto component = [&](const Rows<const float>& w, std::size_t k) {
      return std::span<const float>(w.at(begin, k), end - begin);
    };
    const auto plane = static_cast<std::size_t>(job.f.component);
    evaluator.eval({component(job.wi, 0), component(job.wi, 1), component(job.wi, 2), component(job.wo, 0),
                    component(job.wo, 1), component(job.wo, 2)},
                   {job.f.at(begin, 0), (job.channels - 1) * plane + (end - begin)}, plane);
    return;
  }
  const bool in_place = job.f.in_rows(job.channels);
  const std::size_t most = job.wi.in_rows(3) && job.wo.in_rows(3) && in_place ? end - begin : kBlock;
  std::vector<float> values(in_place ? 0 : job.channels * kBlock);
  float wi[3 * kBlock], wo[3 * kBlock];
  for (std::size_t i = begin; i < end; i += most) {
    const std::size_t count = std::min(most, end - i);
    float* const f = in_place ? job.f.at(i, 0) : values.data();
    evaluator.eval(DirectionRows{in_rows(job.wi, i, count, wi), in_rows(job.wo, i, count, wo)},
                   {f, job.channels * count});
    for (std::size_t k = 0; k < count && !in_place; ++k)
      for (std::size_t c = 0; c < job.channels; ++c) *job.f.at(i + k, c) = f[k * job.channels + c];
  }
}

// Evaluates one pair by the fast evaluator.
void eval_one(const FactoredEvaluator& evaluator, const Job<float>& job) {
  std::array<float, SymmetrizedBrdf::kMaxChannels> values;
  const auto f = std::span(values).first(job.channels);
  evaluator.eval(vector_at(job.wi, 0), vector_at(job.wo, 0), f);
  for (std::size_t c = 0; c < job.channels; ++c) *job.f.at(0, c) = f[c];
}

// Evaluates by the definition, in double precision.
template <class T>
void eval_source(BrdfRef brdf, const Job<T>& job, std::size_t begin, std::size_t end) {
  const std::size_t block = std::min(kBlock, end - begin);
  std::vector<DirectionPair> pairs(block);
  std::vector<double> values(block * job.channels);
  std::vector<std::uint8_t> known(block), valid(block);
  for (std::size_t i = begin; i < end; i += block) {
    const std::size_t count = std::min(block, end - i);
    for (std::size_t k = 0; k < count; ++k) {
      pairs[k] = {vector_at(job.wi, i + k), vector_at(job.wo, i + k)};
      valid[k] = is_direction(pairs[k].wi) && is_direction(pairs[k].wo);
      if (!valid[k]) pairs[k] = {{0, 0, 1}, {0, 0, 1}};
      if (job.transmits) pairs[k].wo.z = -pairs[k].wo.z;
    }
    brdf.eval(std::span(pairs).first(count), std::span(values).first(count * job.channels),
              std::span(known).first(count));
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t c = 0; c < job.channels; ++c)
        *job.f.at(i + k, c) = known[k] && valid[k] ? static_cast<T>(values[k * job.channels + c])
                                                   : std::numeric_limits<T>::quiet_NaN();
  }
}

template <class T>
nb::object eval(const OpenedBrdf& brdf, const Array<const T>& wi, const Array<const T>& wo,
                const nb::object& out) {
  Job<T> job{.wi = rows_of<T>(wi, "wi", 3),
             .wo = rows_of<T>(wo, "wo", 3),
             .f = {},
             .count = 0,
             .channels = brdf.ref().channels(),
             .transmits = brdf.source().findings.transmits()};
  const bool fast = brdf.model() && !job.transmits;
  const bool one = job.wi.one && job.wo.one;
  job.count = match(job.wi, job.wo, "wi and wo");
  const bool planes = job.wi.planes() && job.wo.planes() && job.count > 1;
  const Result<T> result = make_result<T>(out, job.count, job.channels, planes);
  job.f = result.rows;
  const FunctionWatch watch({&brdf});
  if (std::is_same_v<T, float> && job.count == 1 && fast) {
    if constexpr (std::is_same_v<T, float>) eval_one(brdf.evaluator(), job);
  } else if (job.count == 1) {
    eval_source(brdf.ref(), job, 0, 1);
    watch.rethrow();
  } else {
    without_gil(watch, [&] {
      for_each_chunk(job.count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
        if constexpr (std::is_same_v<T, float>)
          if (fast) return eval_model(brdf.evaluator(), job, begin, end);
        eval_source(brdf.ref(), job, begin, end);
      });
    });
  }
  return one && out.is_none() ? nb::object(result.array[0]) : result.array;
}

nb::object eval_any(const OpenedBrdf& brdf, nb::handle wi, nb::handle wo, const nb::object& out) {
  return is_single({wi, wo}, out)
             ? eval<float>(brdf, array_of<float>(wi, "wi"), array_of<float>(wo, "wo"), out)
             : eval<double>(brdf, array_of<double>(wi, "wi"), array_of<double>(wo, "wo"), out);
}

// Sums the gradients of all pairs by each value of each table, one array a table. The sum has one order, and so the
// same bits each time.
nb::list table_gradient(const OpenedModel& model, nb::handle wi_given, nb::handle wo_given,
                        nb::handle weights_given) {
  const FactoredBrdf& brdf = model.brdf();
  const auto wi_array = array_of<double>(wi_given, "wi"), wo_array = array_of<double>(wo_given, "wo"),
             weights_array = array_of<double>(weights_given, "weights");
  auto wi = rows_of<double>(wi_array, "wi", 3), wo = rows_of<double>(wo_array, "wo", 3);
  auto weights = rows_of<double>(weights_array, "weights", brdf.channels());
  const std::size_t count = match(wi, wo, weights, "wi, wo and weights");
  const bool transmits = model.source().findings.transmits();
  std::vector<std::vector<double>> sum = zero_table_gradient(brdf);
  {
    const nb::gil_scoped_release released;
    std::vector<double> weight(brdf.channels());
    for (std::size_t i = 0; i < count; ++i) {
      Vec3 to_viewer = vector_at(wo, i);
      if (transmits) to_viewer.z = -to_viewer.z;
      if (!is_direction(vector_at(wi, i)) || !is_direction(to_viewer)) continue;
      for (std::size_t c = 0; c < weight.size(); ++c) weight[c] = *weights.at(i, c);
      add_table_gradient(brdf, vector_at(wi, i), to_viewer, weight, sum);
    }
  }
  nb::list arrays;
  for (std::size_t t = 0; t < sum.size(); ++t)
    arrays.append(to_numpy(std::move(sum[t]), array_shape(brdf.tables()[t])));
  return arrays;
}

// Returns the seconds of one call of FactoredEvaluator::eval in one thread, the best of `repeats`. All arrays are in
// planes, or all in rows. Python's eval is compared with it.
double time_eval(const OpenedModel& model, const Array<const float>& wi, const Array<const float>& wo,
                 const nb::object& out, int repeats) {
  Job<float> job{.wi = rows_of<float>(wi, "wi", 3),
                 .wo = rows_of<float>(wo, "wo", 3),
                 .f = {},
                 .count = 0,
                 .channels = model.brdf().channels()};
  job.count = match(job.wi, job.wo, "wi and wo");
  job.f = make_result<float>(out, job.count, job.channels, false).rows;
  const nb::gil_scoped_release released;
  double best = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    const auto start = std::chrono::steady_clock::now();
    eval_model(model.evaluator(), job, 0, job.count);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

constexpr const char* kEvalDoc =
    "Returns f_r in 1/sr, without the cosine; zero below the horizon. A transmission gives f_t, and its\n"
    "wo lies below the surface: z < 0.\n"
    "\n"
    "wi, wo: unit vectors to the light and to the viewer; the normal is (0, 0, 1). Both have shape (N,\n"
    "3) or (3,), both are float32 or both float64. Any strides are read in place. Lists and integers\n"
    "are converted to the type of the other argument, or to float64. Arrays of other packages (DLPack,\n"
    "__array__) are taken like NumPy's.\n"
    "Returns (N, channels) of the same type, or fills and returns `out`. float64 is evaluated by the\n"
    "definition, float32 of a model by the fast evaluator. The value is nan where a measurement has\n"
    "none, and where wi or wo is not a unit vector to 1 %.\n"
    "Rows (order='C') and planes of components (order='F') are equally fast. Planes give planes.\n"
    "The call uses all threads. Other Python threads run meanwhile.";

}  // namespace

void bind_eval(nb::module_& m) {
  auto source = nb::borrow<nb::class_<OpenedBrdf>>(m.attr("Source"));
  source
      .def("eval", &eval<float>, nb::arg("wi").noconvert(), nb::arg("wo").noconvert(),
           nb::arg("out") = nb::none(),
           nb::sig("def eval(self, wi: NDArray[numpy.float32], wo: NDArray[numpy.float32], "
                   "out: NDArray[numpy.float32] | None = None) -> NDArray[numpy.float32]"),
           kEvalDoc)
      .def("eval", &eval<double>, nb::arg("wi").noconvert(), nb::arg("wo").noconvert(),
           nb::arg("out") = nb::none(),
           nb::sig("def eval(self, wi: NDArray[numpy.float64], wo: NDArray[numpy.float64], "
                   "out: NDArray[numpy.float64] | None = None) -> NDArray[numpy.float64]"))
      .def("eval", &eval_any, nb::arg("wi").none(), nb::arg("wo").none(), nb::arg("out") = nb::none(),
           nb::sig("def eval(self, wi: numpy.typing.ArrayLike, wo: numpy.typing.ArrayLike, "
                   "out: NDArray | None = None) -> NDArray"));
  nb::borrow<nb::class_<OpenedModel>>(m.attr("Model"))
      .def(
          "table_gradient", &table_gradient, nb::arg("wi"), nb::arg("wo"), nb::arg("weights"),
          nb::sig("def table_gradient(self, wi: numpy.typing.ArrayLike, wo: numpy.typing.ArrayLike, "
                  "weights: numpy.typing.ArrayLike) -> list[NDArray[numpy.float64]]"),
          "Returns the derivatives of sum(weights * eval(wi, wo)) by each value of each table. There is one\n"
          "float64 array for each table, in the shape of its values.\n"
          "\n"
          "weights: (N, channels) or (channels,).\n"
          "Multiplied by Table.values, the derivatives are those by the natural logarithms that\n"
          "with_log_tables takes. Pairs whose wi or wo is no unit vector to 1 % add nothing.\n"
          "The call uses one thread. Other Python threads run meanwhile.");
  m.def("_time_eval", &time_eval, nb::arg("model"), nb::arg("wi").noconvert(), nb::arg("wo").noconvert(),
        nb::arg("out"), nb::arg("repeats"));
}

}  // namespace burnish::python
