// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
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
#include "table_shape.h"
#include "texts.h"

namespace burnish::python {

std::optional<BsdfPart> part_of(const std::string& name) {
  if (name.empty()) return std::nullopt;
  if (const auto part = find_bsdf_part(name)) return part;
  std::vector<std::string_view> names;
  for (const BsdfPart part : kBsdfParts) names.push_back(to_string(part));
  throw Error("part: " + expected_one_of(names, name));
}

namespace {

OpenedBrdf* open(const std::string& spec, const OpenOptions& options) {
  Source source = open_source(spec, options);
  if (std::holds_alternative<FactoredBrdf>(source.brdf)) return new OpenedModel(std::move(source));
  return new OpenedBrdf(std::move(source));
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
      throw Error(fmt::format("log_tables: expected shape ({}) of table '{}', found ({})",
                              fmt::join(array_shape(table), ", "), table.name, fmt::join(found, ", ")));
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
      .def_ro("channels", &Table::channels,
              "The table's channels: as many as the BRDF has, or 1 that they share.")
      .def_prop_ro(
          "values", &table_values, nb::sig("def values(self) -> NDArray[numpy.float32]"),
          "lambda at the nodes, the largest 1: float32 (height, width, channels), or for a volume (depth,\n"
          "height, width, channels). The array is read-only and no copy.")
      .def_prop_ro(
          "shape", [](const Table& t) { return std::string(to_string(t.layout.shape)); },
          "The domain of the nodes: \"line\" (a polar angle), \"disk\" (a hemisphere), \"grid\" (two polar "
          "angles),\n"
          "\"volume\" (three).")
      .def_prop_ro("format", [](const Table& t) { return std::string(to_string(t.format)); })
      .def_prop_ro("byte_count", &Table::byte_count)
      .def_prop_ro(
          "warp", [](const Table& t) { return warp_terms(t.layout.warp); },
          nb::sig("def warp(self) -> tuple[str, float]"),
          "Spacing of the nodes: (\"identity\" | \"power\" | \"rational\", parameter).")
      .def_prop_ro(
          "warp_y", [](const Table& t) { return warp_terms(t.layout.warp_y); },
          nb::sig("def warp_y(self) -> tuple[str, float]"),
          "Spacing of the nodes along y, for grids and volumes.")
      .def_prop_ro(
          "warp_z", [](const Table& t) { return warp_terms(t.layout.warp_z); },
          nb::sig("def warp_z(self) -> tuple[str, float]"), "Spacing of the nodes along z, for volumes.")
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
          "The projection along y, for grids and volumes.")
      .def_prop_ro(
          "projection_z", [](const FactorUse& u) { return projection_terms(u.projection_z); },
          nb::sig("def projection_z(self) -> tuple[float, float, float, float] | str"),
          "The projection along z, for volumes.")
      .def("__repr__", &text_of_use);
  nb::class_<Lobe>(m, "Lobe", "One product of factors.")
      .def_ro("scale", &Lobe::scale, "The scale in 1/sr, one entry for each channel.")
      .def_ro("factors", &Lobe::factors)
      .def("__repr__", &text_of_lobe);
}

void bind_opened_brdf(nb::module_& m) {
  nb::class_<OpenedBrdf>(
      m, "Source",
      "A BRDF: measured, analytic, a neural encoding or a model. It never changes; threads may share it.")
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
          "Bytes of a compressed BRDF; None for measurements and formulas.")
      .def(
          "info",
          [](const OpenedBrdf& b) {
            return from_json(
                without_gil(FunctionWatch({&b}), [&] { return to_json(report_on(b.source())); }));
          },
          nb::sig("def info(self) -> dict"),
          "Returns what `burnish info --json` prints, except the cost of a shader: see generate_shader.")
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
          "The product of tables, such as \"p(wo) q(h) p(wi)\".")
      .def_prop_ro(
          "notes", [](const OpenedModel& b) { return from_json(b.source().findings.notes); },
          nb::sig("def notes(self) -> dict"),
          "Notes of the fit: source, options, errors. For a measurement, \"node_expected\" holds expected\n"
          "errors: \"relative\" over all directions, measured or not, and \"from_theta_i_deg\" in bands of "
          "15\n"
          "degrees.")
      .def("__repr__", &text_of_model)
      .def("with_log_tables", &with_log_tables, nb::arg("log_tables"), nb::arg("format") = nb::none(),
           "Returns the model with other tables, given by their natural logarithms.\n"
           "\n"
           "log_tables: one float64 array for each table, in the shape of its values. Each table is scaled "
           "to\n"
           "a largest value of 1, and the lobes' scales take the factor. Values are then rounded to the\n"
           "table's format, or to `format` (\"half\", \"float\", \"rgb9e5\", \"unorm8\").");
}

void bind_baseline(nb::module_& m) {
  nb::class_<OpenedBaseline, OpenedBrdf>(
      m, "Baseline", "A model that `fit(..., method=)` makes. It has no positive factors.")
      .def_prop_ro(
          "kind", [](const OpenedBaseline& b) { return b.baseline().kind; },
          "\"svd\", \"nd\", \"nmf\", \"dgf\" or \"analytic\".")
      .def_prop_ro(
          "expression", [](const OpenedBaseline& b) { return baseline_expression(b.baseline().brdf); },
          "The parts of the model, in one line.")
      .def_prop_ro(
          "notes", [](const OpenedBaseline& b) { return from_json(b.baseline().notes); },
          nb::sig("def notes(self) -> dict"), "Notes of the fit: source, options, errors.")
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
      "Opens a file of any known format, which is recognized by its content. Also opens a neural encoding\n"
      "\"nbrdf:FILE#NAME\" or \"np:FOLDER#NAME\", or an analytic BRDF such as "
      "\"ggx:alpha_x=0.1,alpha_y=0.3\".\n"
      "A burnish model is returned as a Model.\n"
      "\n"
      "keep_spectral: keeps one channel for each wavelength, instead of linear Rec. 709.\n"
      "illuminant: the light under which spectra become RGB: \"E\", \"D50\", \"D65\", \"A\" or a file.\n"
      "has_cosine: CSV and ASTM values are f_r cos(theta_i).\n"
      "has_cosine_o: CSV and ASTM values are f_r cos(theta_o).\n"
      "brf: CSV and ASTM values are pi f_r.\n"
      "clamp_negatives: sets interpolated values below zero to zero.\n"
      "back_side: takes the back's reflection from a file with several parts.\n"
      "part: \"reflection-front\", \"reflection-back\", \"transmission-front\" or \"transmission-back\" of a "
      "file\n"
      "with several parts.\n"
      "band: \"Visible\", \"Solar\", \"NIR\", \"CIE-XYZ\", ... of a file with several bands. info() lists "
      "parts\n"
      "and bands.\n"
      "scale_to_tis: scales each incidence of Zemax and LightTools files to its TIS.");
}

}  // namespace burnish::python
