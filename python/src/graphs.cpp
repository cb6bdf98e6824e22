// SPDX-License-Identifier: Apache-2.0
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/eval/sampler_expression.h>
#include <burnish/formula/graph.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/analytic/openpbr_expression.h>
#include <burnish/shaders/shader_formula.h>

#include "opened_brdf.h"

namespace burnish::python {

namespace {

constexpr const char* type_name(ValueType type) noexcept {
  return type == ValueType::vector ? "vector" : type == ValueType::integer ? "integer" : "real";
}

// Returns (operation, type, constant, name, numbers of the arguments' nodes) for every node, and the outputs' nodes.
nb::tuple graph_of(const std::vector<Expr>& outputs) {
  Graph graph;
  std::vector<std::size_t> places;
  for (const Expr& output : outputs) places.push_back(graph.add(output));
  nb::list nodes;
  for (const Graph::Node& node : graph.nodes())
    nodes.append(nb::make_tuple(std::string(to_string(node.op)), type_name(node.type), node.constant,
                                node.name, node.arguments));
  return nb::make_tuple(nodes, places);
}

// Returns the graph with the tables that its texels are read from, by their names in the graph.
nb::tuple eval_graph(const OpenedModel& model) {
  const ShaderFormula formula = shader_formula(model.brdf(), {.language = ShaderLanguage::cpp});
  nb::dict tables;
  for (const ShaderTexture& texture : formula.textures)
    tables[texture.name.c_str()] = texture.tables[0].table;
  return nb::make_tuple(graph_of({formula.value}), tables);
}

// Returns the graph of OpenPBR, which has no tables.
nb::tuple formula_graph(const OpenedBrdf& opened) {
  const auto* const analytic = std::get_if<AnalyticBrdf>(&opened.source().brdf);
  const auto* const material = analytic ? std::get_if<OpenPbr>(&analytic->variant()) : nullptr;
  if (!material)
    throw Error(opened.source().name + ": expected a burnish model or OpenPBR, found another BRDF");
  return nb::make_tuple(graph_of({openpbr_expression(*material)}), nb::dict());
}

// Returns the graph with each lobe as an output.
nb::tuple lobe_graph(const OpenedModel& model) {
  return nb::make_tuple(graph_of(shader_formula(model.brdf(), {.language = ShaderLanguage::cpp}).lobes),
                        eval_graph(model)[1]);
}

SamplerTables tables_of(const OpenedBrdf& brdf) {
  return without_gil(FunctionWatch({&brdf}), [&] { return brdf.sampler().tables(); });
}

nb::dict sampler_graphs(const OpenedBrdf& brdf) {
  const SamplerTables t = tables_of(brdf);
  const DrawnExpr drawn = sample_expression(t);
  nb::dict graphs;
  graphs["sample_wi"] = graph_of({drawn.x, drawn.y, drawn.z, drawn.pdf});
  graphs["pdf"] = graph_of({pdf_expression(t)});
  for (const auto& [name, edges] : {std::pair{"row_edges", t.row_edges}, {"cell_edges", t.cell_edges}})
    graphs[name] = to_numpy(std::vector(edges.begin(), edges.end()), {edges.size()});
  return graphs;
}

}  // namespace

void bind_graphs(nb::module_& m) {
  nb::borrow<nb::class_<OpenedModel>>(m.attr("Model"))
      .def(
          "_eval_graph", &eval_graph,
          "Returns f_r as a graph over the vectors wi and wo, for programs that compile their own code. The\n"
          "graph is (nodes, numbers of the outputs' nodes). A node is (operation, type, constant, name,\n"
          "arguments). The second result has the tables of the texels, by name.")
      .def("_lobe_graph", &lobe_graph, "Returns the same graph with one output for each lobe.");
  nb::borrow<nb::class_<OpenedBrdf>>(m.attr("Source"))
      .def("_eval_graph", &formula_graph,
           "Returns the graph of OpenPBR, as Model._eval_graph does, without tables. Raises Error for "
           "another\n"
           "BRDF.")
      .def("_sampler_graphs", &sampler_graphs,
           "Returns sample_wi and pdf as such graphs, and the arrays of integers that they read.");
}

}  // namespace burnish::python
