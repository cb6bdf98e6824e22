// SPDX-License-Identifier: Apache-2.0
#include "module.h"

#include <memory>

#include <nanobind/stl/optional.h>

#include <burnish/error.h>
#include <burnish/math/parallel.h>

#include "mistakes.h"

namespace burnish::python {

namespace {

/// ThreadLimit as a context manager.
class ThreadLimitContext {
 public:
  explicit ThreadLimitContext(int threads) : threads_(threads) {}
  void enter() { limit_ = std::make_unique<ThreadLimit>(threads_); }
  void leave() { limit_.reset(); }

 private:
  int threads_;
  std::unique_ptr<ThreadLimit> limit_;
};

void bind_threads(nb::module_& m) {
  nb::class_<ThreadLimitContext>(
      m, "ThreadLimit",
      "A context manager: in `with ThreadLimit(n):` the library uses at most n threads; 0 means all.")
      .def(nb::init<int>(), nb::arg("threads"))
      .def("__enter__",
           [](nb::object self) {
             nb::cast<ThreadLimitContext&>(self).enter();
             return self;
           })
      .def("__exit__", [](ThreadLimitContext& self, const nb::args&) { self.leave(); });
}

}  // namespace

NB_MODULE(_burnish, m) {
  m.doc() = "Compressed, sampled and measured BRDFs: the C++ library's functions on NumPy arrays.";
  nb::exception<Error>(m, "Error", PyExc_ValueError).attr("__doc__") =
      "Bad input: a file that is not what it claims to be, or a parameter outside its domain. The message\n"
      "is one line: \"file: offset N: expected E, found F\".";
  bind_threads(m);
  bind_source(m);
  bind_eval(m);
  bind_sampling(m);
  bind_graphs(m);
  bind_fitting(m);
  bind_batch(m);
  bind_book(m);
  bind_metrics(m);
  bind_shaders(m);
  bind_exports(m);
  bind_writers(m);
  bind_surfaces(m);
  bind_own_sources(m);
  bind_uncertainty(m);
  explain_mistakes(m);
}

}  // namespace burnish::python
