// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nanobind/stl/function.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <burnish/error.h>
#include <burnish/factors/model_file.h>
#include <burnish/factors/model_spec.h>
#include <burnish/io/open_source.h>
#include <burnish/io/source_report.h>
#include <burnish/math/closest_name.h>

#include "opened_brdf.h"
#include "texts.h"

namespace burnish::python {

namespace {

// Returns the part of that name, or nothing for an empty name.
std::optional<BsdfPart> part_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (const auto part = find_bsdf_part(name)) return part;
  std::vector<std::string_view> names;
  for (const BsdfPart part : kBsdfParts) names.push_back(to_string(part));
  throw Error("part: " + expected_one_of(names, name));
}

OpenedBrdf* open(const std::string& spec, const OpenOptions& options) {
  Source source = open_source(spec, options);
  if (std::holds_alternative<FactoredBrdf>(source.brdf)) return new OpenedModel(std::move(source));
  return new OpenedBrdf(std::move(source));
}

// Returns (height, width, channels), and for a volume its depth before them.
std::vector<std::size_t> array_shape(const Table& table) {
  std::vector<std::size_t> shape;
  if (table.layout.shape == TableShape::volume) shape.push_back(static_cast<std::size_t>(table.layout.depth));
  for (const int side : {table.layout.height, table.layout.width})
    shape.push_back(static_cast<std::size_t>(side));
  shape.push_back(table.channels);
  return shape;
}

nb::object table_values(nb::handle self) {
  const auto& table = nb::cast<const Table&>(self);
  const std::vector<std::size_t> shape = array_shape(table);
  // The array makes no copy, and keeps the model alive.
  return nb::cast(nb::ndarray<nb::numpy, const float>(table.values.data(), shape.size(), shape.data(), self));
}

nb::object projection_terms(const Projection& p) {
  if (p.kind != Projection::Kind::affine) return nb::str(std::string(to_string(p.kind)).c_str());
  return nb::make_tuple(p.wi, p.wo, p.mirror, p.n);
}

nb::tuple warp_terms(const Warp& warp) {
  constexpr const char* kNames[] = {"identity", "power", "rational"};
  return nb::make_tuple(kNames[static_cast<std::size_t>(warp.kind)], warp.parameter);
}

OpenedModel* with_log_tables(const OpenedModel& self,
                             const std::vector<nb::ndarray<const double, nb::c_contig>>& logs,
                             const std::optional<std::string>& format) {
  const FactoredBrdf& brdf = self.brdf();
  std::vector<Table> tables(brdf.tables().begin(), brdf.tables().end());
  if (logs.size() != tables.size())
    throw Error("log_tables: expected " + std::to_string(tables.size()) + " arrays, found " +
                std::to_string(logs.size()));
  for (std::size_t t = 0; t < tables.size(); ++t) {
    Table& table = tables[t];
    const std::span<const std::int64_t> found(logs[t].shape_ptr(), logs[t].ndim());
    if (!std::ranges::equal(array_shape(table), found, std::cmp_equal<std::size_t, std::int64_t>))
      throw Error("log_tables: expected the shape of table '" + table.name + "'");
    std::copy(logs[t].data(), logs[t].data() + logs[t].size(), table.values.begin());
    if (format) table.format = parse_table_format(*format);
  }
  std::vector<Lobe> lobes(brdf.lobes().begin(), brdf.lobes().end());
  for (Lobe& lobe : lobes)
    for (double& s : lobe.scale) s = std::log(s);
  Model model = to_model(self);
  model.brdf = from_log_tables(brdf.channels(), std::move(tables), std::move(lobes));
  return new OpenedModel(self.source().name, std::move(model));
}

void bind_model_parts(nb::module_& m) {
  nb::class_<Table>(m, "Table", "One positive factor lambda: nodes over one to three angles or a hemisphere.")
      .def_ro("name", &Table::name)
      .def_ro("channels", &Table::channels, "1, shared by the BRDF's channels, or their number.")
      .def_prop_ro(
          "values", &table_values, nb::sig("def values(self) -> NDArray[numpy.float32]"),
          "float32 (height, width, channels), of a volume (depth, height, width, channels), read-only, no "
          "copy: lambda at the nodes, largest 1.")
      .def_prop_ro(
          "shape", [](const Table& t) { return std::string(to_string(t.layout.shape)); },
          "What the nodes are spread over: \"line\" (a polar angle), \"disk\" (a hemisphere), \"grid\" (two "
          "polar angles), \"volume\" (three).")
      .def_prop_ro("format", [](const Table& t) { return std::string(to_string(t.format)); })
      .def_prop_ro("byte_count", &Table::byte_count)
      .def_prop_ro(
          "warp", [](const Table& t) { return warp_terms(t.layout.warp); },
          nb::sig("def warp(self) -> tuple[str, float]"),
          "Spacing of the nodes: (\"identity\" | \"power\" | \"rational\", parameter).")
      .def_prop_ro(
          "warp_y", [](const Table& t) { return warp_terms(t.layout.warp_y); },
          nb::sig("def warp_y(self) -> tuple[str, float]"), "Of grids and volumes, along y.")
      .def_prop_ro(
          "warp_z", [](const Table& t) { return warp_terms(t.layout.warp_z); },
          nb::sig("def warp_z(self) -> tuple[str, float]"), "Of volumes, along z.")
      .def("__repr__", &text_of_table);
  nb::class_<FactorUse>(m, "FactorUse", "One use of a table in a product.")
      .def_ro("table", &FactorUse::table, "Index into Model.tables.")
      .def_prop_ro(
          "projection", [](const FactorUse& u) { return projection_terms(u.projection); },
          nb::sig("def projection(self) -> tuple[float, float, float, float] | str"),
          "(a, b, m, n) of normalize(a wi + b wo + m mirror(wi) + n normal), or the name of another kind, "
          "such "
          "as \"difference\".")
      .def_prop_ro(
          "projection_y", [](const FactorUse& u) { return projection_terms(u.projection_y); },
          nb::sig("def projection_y(self) -> tuple[float, float, float, float] | str"),
          "Of grids and volumes.")
      .def_prop_ro(
          "projection_z", [](const FactorUse& u) { return projection_terms(u.projection_z); },
          nb::sig("def projection_z(self) -> tuple[float, float, float, float] | str"), "Of volumes only.")
      .def("__repr__", &text_of_use);
  nb::class_<Lobe>(m, "Lobe", "One product of factors.")
      .def_ro("scale", &Lobe::scale, "One entry a channel.")
      .def_ro("factors", &Lobe::factors)
      .def("__repr__", &text_of_lobe);
}

void bind_opened_brdf(nb::module_& m) {
  nb::class_<OpenedBrdf>(
      m, "Source",
      "A BRDF: measured, analytic, a neural encoding or a model. Immutable; threads may share it.")
      .def_prop_ro("name", [](const OpenedBrdf& b) { return b.source().name; })
      .def_prop_ro(
          "channels", [](const OpenedBrdf& b) { return b.ref().channels(); },
          "1 (grey), 3 (linear Rec. 709) or the number of wavelengths.")
      .def_prop_ro("isotropic", [](const OpenedBrdf& b) { return b.ref().isotropic(); })
      .def_prop_ro(
          "lambda_nm", [](const OpenedBrdf& b) { return b.source().findings.lambda_nm; },
          "Wavelengths of the channels in nm; empty for grey and RGB.")
      .def_prop_ro(
          "bytes", [](const OpenedBrdf& b) { return b.source().bytes(); },
          "Size of a compressed BRDF; None for measurements and formulas.")
      .def(
          "info",
          [](const OpenedBrdf& b) {
            return from_json(
                without_gil(FunctionWatch({&b}), [&] { return to_json(report_on(b.source())); }));
          },
          nb::sig("def info(self) -> dict"),
          "What `burnish info --json` prints, but what a shader costs: see generate_shader.")
      .def("__repr__", &text_of_source);
}

void bind_model(nb::module_& m) {
  nb::class_<OpenedModel, OpenedBrdf>(m, "Model",
                                      "A factored BRDF: sum over lobes of scale * product of tables.")
      .def_prop_ro(
          "tables",
          [](nb::handle self) {
            nb::list list;
            for (const Table& table : nb::cast<const OpenedModel&>(self).brdf().tables())
              list.append(nb::cast(table, nb::rv_policy::reference_internal, self));
            return list;
          },
          nb::sig("def tables(self) -> list[Table]"))
      .def_prop_ro("lobes",
                   [](const OpenedModel& b) {
                     return std::vector<Lobe>(b.brdf().lobes().begin(), b.brdf().lobes().end());
                   })
      .def_prop_ro("reciprocal", [](const OpenedModel& b) { return b.brdf().reciprocal(); })
      .def_prop_ro("table_bytes", [](const OpenedModel& b) { return b.brdf().table_bytes(); })
      .def_prop_ro(
          "expression", [](const OpenedModel& b) { return model_expression(b.brdf()); },
          "Such as \"p(wo) q(h) p(wi)\".")
      .def_prop_ro(
          "notes", [](const OpenedModel& b) { return from_json(b.source().findings.notes); },
          nb::sig("def notes(self) -> dict"),
          "What the fit noted: source, options, errors. Of a measurement \"node_expected\" is the error "
          "\"relative\"\n"
          "that is expected over all directions, measured or not, and \"from_theta_i_deg\" in bands of 15 "
          "degrees.")
      .def("__repr__", &text_of_model)
      .def(
          "with_log_tables", &with_log_tables, nb::arg("log_tables"), nb::arg("format") = nb::none(),
          "The model with other tables, given by their natural logarithms.\n\n"
          "log_tables: one float64 array a table, of the shape of its values. Each is scaled to a largest "
          "value\n"
          "of 1, what is divided out moves into the lobes' scales, and rounded to its format or to `format`\n"
          "(\"half\", \"float\", \"rgb9e5\", \"unorm8\").");
}

void bind_baseline(nb::module_& m) {
  nb::class_<OpenedBaseline, OpenedBrdf>(m, "Baseline",
                                         "What `fit(..., method=)` makes: no positive factors.")
      .def_prop_ro(
          "kind", [](const OpenedBaseline& b) { return b.baseline().kind; },
          "\"svd\", \"nd\", \"nmf\", \"dgf\" or \"analytic\".")
      .def_prop_ro(
          "expression", [](const OpenedBaseline& b) { return baseline_expression(b.baseline().brdf); },
          "What it is made of, one line.")
      .def_prop_ro(
          "notes", [](const OpenedBaseline& b) { return from_json(b.baseline().notes); },
          nb::sig("def notes(self) -> dict"), "What the fit noted: source, options, errors.")
      .def("__repr__", &text_of_baseline);
}

}  // namespace

void bind_source(nb::module_& m) {
  bind_model_parts(m);
  bind_opened_brdf(m);
  bind_model(m);
  bind_baseline(m);
  m.def(
      "open_source",
      [](const nb::object& spec, bool keep_spectral, const std::string& illuminant, bool has_cosine,
         bool clamp_negatives, bool back_side, bool has_cosine_o, bool brf, const std::string& part,
         const std::string& band, bool scale_to_tis) {
        if (!nb::isinstance<nb::str>(spec) && !nb::hasattr(spec, "__fspath__"))
          throw nb::type_error(
              fmt::format("spec: expected a path or a spec, found {}", nb::repr(spec).c_str()).c_str());
        const auto path = nb::cast<std::string>(nb::module_::import_("os").attr("fspath")(spec));
        const nb::gil_scoped_release released;
        return open(path, {keep_spectral, illuminant, has_cosine, clamp_negatives, back_side, has_cosine_o,
                           brf, part_of(part), band, scale_to_tis});
      },
      nb::arg("spec"), nb::kw_only(), nb::arg("keep_spectral") = false, nb::arg("illuminant") = "E",
      nb::arg("has_cosine") = false, nb::arg("clamp_negatives") = true, nb::arg("back_side") = false,
      nb::arg("has_cosine_o") = false, nb::arg("brf") = false, nb::arg("part") = "", nb::arg("band") = "",
      nb::arg("scale_to_tis") = false, nb::rv_policy::take_ownership,
      nb::sig(
          "def open_source(spec: str | os.PathLike, *, keep_spectral: bool = False, illuminant: str = 'E', "
          "has_cosine: bool = False, clamp_negatives: bool = True, back_side: bool = False, "
          "has_cosine_o: bool = False, brf: bool = False, part: str = '', band: str = '', "
          "scale_to_tis: bool = False) -> Source"),
      "Opens a file of any known format (found by content), a neural encoding \"nbrdf:FILE#NAME\" or\n"
      "\"np:FOLDER#NAME\", or an analytic BRDF such as \"ggx:alpha_x=0.1,alpha_y=0.3\".\n\n"
      "keep_spectral: one channel a wavelength instead of linear Rec. 709; illuminant: \"E\", \"D50\", "
      "\"D65\", \"A\" or a file, "
      "the\n"
      "light under which spectra become RGB; has_cosine: CSV values are f_r cos(theta_i), has_cosine_o: f_r\n"
      "cos(theta_o), brf: pi f_r; clamp_negatives: "
      "set\n"
      "interpolated values below zero to zero; back_side: Klems, the back's reflection. part:\n"
      "\"reflection-front\", \"reflection-back\", \"transmission-front\" or \"transmission-back\" of a file "
      "with\n"
      "several, band: \"Visible\", \"Solar\", \"NIR\", \"CIE-XYZ\", ...; info() names those there are.\n"
      "scale_to_tis: Zemax, scale each incidence to its TIS. A burnish model is returned as a Model.");
}

}  // namespace burnish::python
