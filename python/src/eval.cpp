#include <chrono>
#include <cmath>
#include <limits>
#include <vector>

#include <burnish/math/parallel.h>

#include "opened_brdf.h"
#include "rows.h"

namespace burnish::python {

namespace {

// Directions a task: enough that starting one costs nothing.
constexpr std::size_t kChunk = 32'768;

/// What one evaluation reads and writes.
template <class T>
struct Job {
  Rows<const T> wi, wo;
  Rows<T> f;
  std::size_t count, channels;
};

// A part of a model's evaluation, through buffers where arrays are not in planes.
void eval_model(const FactoredEvaluator& evaluator, const Job<float>& job, std::size_t begin,
                std::size_t end) {
  alignas(64) Buffer buffers[6];
  const auto directions = [&](std::size_t first, std::size_t count) {
    const auto i = components<3>(job.wi, first, count, buffers);
    const auto o = components<3>(job.wo, first, count, buffers + 3);
    return DirectionSpans{i[0], i[1], i[2], o[0], o[1], o[2]};
  };
  if (job.wi.planes() && job.wo.planes() && job.f.planes()) {
    // as it lies: nothing is copied
    const auto plane = static_cast<std::size_t>(job.f.component);
    evaluator.eval(directions(begin, end - begin),
                   {job.f.at(begin, 0), (job.channels - 1) * plane + (end - begin)}, plane);
    return;
  }
  std::vector<float> values(job.channels * kBlock);
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    evaluator.eval(directions(i, count), std::span(values).first(job.channels * count));
    if (job.channels == 3 && job.f.row == 3 && job.f.component == 1)
      to_rows(values.data(), values.data() + count, values.data() + 2 * count, count, job.f.at(i, 0));
    else
      for (std::size_t c = 0; c < job.channels; ++c)
        for (std::size_t k = 0; k < count; ++k) *job.f.at(i + k, c) = values[c * count + k];
  }
}

template <class T>
Vec3 vector_at(const Rows<const T>& rows, std::size_t i) noexcept {
  return {static_cast<double>(*rows.at(i, 0)), static_cast<double>(*rows.at(i, 1)),
          static_cast<double>(*rows.at(i, 2))};
}

// To 1 %, as readers of directions ask for; false for what is no number.
bool is_direction(Vec3 w) noexcept {
  return std::abs(dot(w, w) - 1) < 0.02;
}

// The definition, in double precision.
template <class T>
void eval_source(BrdfRef brdf, const Job<T>& job, std::size_t begin, std::size_t end) {
  std::vector<DirectionPair> pairs(kBlock);
  std::vector<double> values(kBlock * job.channels);
  std::vector<std::uint8_t> known(kBlock), valid(kBlock);
  for (std::size_t i = begin; i < end; i += kBlock) {
    const std::size_t count = std::min(kBlock, end - i);
    for (std::size_t k = 0; k < count; ++k) {
      pairs[k] = {vector_at(job.wi, i + k), vector_at(job.wo, i + k)};
      valid[k] = is_direction(pairs[k].wi) && is_direction(pairs[k].wo);
      if (!valid[k]) pairs[k] = {{0, 0, 1}, {0, 0, 1}};
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
  Job<T> job{rows_of<T>(wi, "wi", 3),
             rows_of<T>(wo, "wo", 3),
             {},
             0,
             static_cast<std::size_t>(brdf.ref().channels())};
  const bool one = job.wi.one && job.wo.one;
  job.count = match(job.wi, job.wo, "wi and wo");
  const bool planes = job.wi.planes() && job.wo.planes() && job.count > 1;
  const Result<T> result = make_result<T>(out, job.count, job.channels, planes);
  job.f = result.rows;
  {
    const nb::gil_scoped_release released;
    for_each_chunk(job.count, kChunk, [&](std::size_t, std::size_t begin, std::size_t end) {
      if constexpr (std::is_same_v<T, float>)
        if (brdf.model()) return eval_model(brdf.evaluator(), job, begin, end);
      eval_source(brdf.ref(), job, begin, end);
    });
  }
  return one && out.is_none() ? nb::object(result.array[0]) : result.array;
}

// Seconds of FactoredEvaluator::eval on planes in one call and thread, the best of `repeats`: what Python's
// eval is measured against.
double time_eval(const OpenedModel& model, const Array<const float>& wi, const Array<const float>& wo,
                 int repeats) {
  Rows<const float> rows_i = rows_of<float>(wi, "wi", 3), rows_o = rows_of<float>(wo, "wo", 3);
  const std::size_t count = match(rows_i, rows_o, "wi and wo");
  const nb::gil_scoped_release released;
  std::vector<float> planes(6 * count), f(static_cast<std::size_t>(model.brdf().channels()) * count);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < count; ++i) {
      planes[k * count + i] = *rows_i.at(i, k);
      planes[(k + 3) * count + i] = *rows_o.at(i, k);
    }
  const auto plane = [&](std::size_t k) { return std::span<const float>(planes).subspan(k * count, count); };
  const DirectionSpans directions{plane(0), plane(1), plane(2), plane(3), plane(4), plane(5)};
  double best = std::numeric_limits<double>::infinity();
  for (int r = 0; r < repeats; ++r) {
    const auto start = std::chrono::steady_clock::now();
    model.evaluator().eval(directions, f);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

constexpr const char* kEvalDoc =
    "f_r in 1/sr, without the cosine, zero below the horizon.\n\n"
    "wi, wo: unit vectors to the light and the viewer, (N, 3) or (3,), both float32 or both float64, any\n"
    "strides, read where they lie; normal (0, 0, 1). Returns (N, channels) of the same type, or fills and\n"
    "returns `out`. float64 is the definition; float32 of a model is the fast evaluator. nan stands where a\n"
    "measurement knows nothing, and, but for float32 of models, where wi or wo is no unit vector to 1 %.\n"
    "Arrays whose components lie in planes (order='F') are fastest, and the result is laid out like them.\n"
    "Uses all threads; other Python threads go on meanwhile.";

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
                   "out: NDArray[numpy.float64] | None = None) -> NDArray[numpy.float64]"));
  m.def("_time_eval", &time_eval, nb::arg("model"), nb::arg("wi").noconvert(), nb::arg("wo").noconvert(),
        nb::arg("repeats"));
}

}  // namespace burnish::python
