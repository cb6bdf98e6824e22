// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>

#include <burnish/error.h>
#include <burnish/formula/writer.h>
#include <burnish/shaders/frame_function.h>
#include <burnish/shaders/shader_formula.h>
#include <burnish/shaders/spatial_shader.h>
#include <burnish/shaders/texture_declaration.h>

namespace burnish {

namespace {

std::string local_of(std::size_t texture) {
  return fmt::format("m{}", texture);
}
Expr read_expression(const MapComponent& place) {
  return Expr::input(fmt::format("{}.{}", local_of(place.texture), "xyzw"[place.component]));
}

/// The members of a place, by the components that are read: names and values.
struct PlaceMember {
  std::string name;
  Expr value;
};

// Computes as frame_about does: normal and tangent of the surface's plane, the tangent made orthogonal.
std::vector<PlaceMember> frame_members(const PackedMaps& maps) {
  Expr nx = 0.0, ny = 0.0, nz = 1.0, tx = 1.0, ty = 0.0;
  if (maps.normals) {
    const Expr x = read_expression((*maps.normals)[0]), y = read_expression((*maps.normals)[1]);
    // halves may be longer than 1 by their rounding
    const Expr square = named("square", x * x + y * y);
    const Expr shrink = named("shrink", Expr(1.0) / sqrt(max(square, 1.0)));
    nx = named("nx", shrink * x);
    ny = named("ny", shrink * y);
    nz = named("nz", shrink * sqrt(max(Expr(1.0) - square, 0.0)));
  }
  if (maps.tangents) {
    tx = read_expression((*maps.tangents)[0]);
    ty = read_expression((*maps.tangents)[1]);
  }
  const Expr along = named("along", tx * nx + ty * ny);
  const Expr x = named("x", tx - along * nx), y = named("y", ty - along * ny),
             z = maps.normals ? named("z", -(along * nz)) : Expr(0.0);
  const Expr unit = named("unit", Expr(1.0) / sqrt(x * x + y * y + z * z));
  const Expr px = named("px", unit * x), py = named("py", unit * y), pz = named("pz", unit * z);
  const auto vector = [](const Expr& a, const Expr& b, const Expr& c) { return Expr(Op::vector, {a, b, c}); };
  return {{"t", vector(px, py, pz)},
          {"b", vector(ny * pz - nz * py, nz * px - nx * pz, nx * py - ny * px)},
          {"n", vector(nx, ny, nz)}};
}

std::vector<PlaceMember> place_members(const SpatialBrdf& surface, const PackedMaps& maps) {
  std::vector<PlaceMember> members;
  for (std::size_t j = 0; j < maps.weights.size(); ++j) {
    const SurfaceMap& map = surface.maps().weights[j];
    std::vector<Expr> weight;
    for (std::size_t c = 0; c < map.channels(); ++c)
      weight.push_back(static_cast<double>(map.scale()) * read_expression(maps.weights[j][c]));
    members.push_back({fmt::format("w{}", j), weight.size() == 1 ? weight[0] : Expr(Op::vector, weight)});
  }
  if (!maps.normals && !maps.tangents) return members;
  for (PlaceMember& member : frame_members(maps)) members.push_back(std::move(member));
  return members;
}

/// The struct, and the functions that make one.
struct PlaceText {
  std::string text;
  ShaderCost cost;
};

PlaceText place_text(const Language& l, const ShaderOptions& options, const SpatialBrdf& surface,
                     const PackedMaps& maps, std::size_t first_number) {
  const std::string& name = options.name;
  const std::string structure = fmt::format("burnish_{}_place", name),
                    gathered = fmt::format("burnish_{}_maps", name);
  // textures
  std::string declarations;
  for (std::size_t i = 0; i < maps.textures.size() && !l.filtered_texture.empty(); ++i)
    declarations += declared_texture(l, l.filtered_texture, maps.textures[i].name, first_number + i, options);
  PlaceText place;
  place.text = l.texture_struct.empty() ? declarations
                                        : fmt::format(fmt::runtime(l.texture_struct), gathered, declarations);

  // the struct
  const std::vector<PlaceMember> members = place_members(surface, maps);
  std::string listed;
  for (const PlaceMember& member : members)
    listed += fmt::format(fmt::runtime(l.member), l.type_name(member.value.type()), member.name);
  place.text += fmt::format(fmt::runtime(l.structure), structure, listed);

  // the function that reads
  Graph graph;
  std::vector<std::size_t> roots;
  for (const PlaceMember& member : members) roots.push_back(graph.add(member.value));
  const Writer writer(l, graph, roots);
  std::string body, values;
  if (!l.texture_struct.empty())
    body += "  constexpr sampler map_sampler(filter::linear, mip_filter::linear, address::repeat);\n";
  for (std::size_t i = 0; i < maps.textures.size(); ++i)
    body += fmt::format(fmt::runtime(l.map_read), local_of(i), maps.textures[i].name, i);
  for (const std::size_t root : roots) values += (values.empty() ? "" : ", ") + writer.text(root);
  body += writer.text() + fmt::format(fmt::runtime(l.made), structure, values);
  std::string parameters = fmt::format(fmt::runtime(l.map_parameter), gathered);
  for (const char* const p : {"u", "v", "lod"})
    parameters += (parameters.empty() ? "" : ", ") +
                  fmt::format(fmt::runtime(l.parameter), l.type_name(ValueType::real), p);
  place.text += l.map_template;
  place.text += fmt::format(fmt::runtime(l.definition), structure, fmt::format("burnish_{}_at", name),
                            parameters, body);

  const OperationCount count = graph.count();
  const auto textures = static_cast<int>(maps.textures.size());
  place.cost = {.fetches = textures,
                .textures = textures,
                .operations = count.multiplies + count.adds + count.compares,
                .divisions = count.divisions,
                .roots = count.roots};
  return place;
}

// log2 of the larger step of a pixel, in texels.
std::string lod_function(const Language& l, const std::string& name, const SpatialBrdf& surface) {
  constexpr std::array<std::string_view, 4> kSteps{"ux", "vx", "uy", "vy"};
  const Expr width(surface.width()), height(surface.height());
  const auto square = [&](const char* u, const char* v) {
    const Expr x = width * Expr::input(u), y = height * Expr::input(v);
    return x * x + y * y;
  };
  Graph graph;
  const Expr largest = max(max(square("ux", "vx"), square("uy", "vy")), 1.0);
  const std::size_t root = graph.add(0.5 * Expr(Op::log2, {largest}));
  const Writer writer(l, graph, {root});
  return l.function(ValueType::real, fmt::format("burnish_{}_lod", name), kSteps, "",
                    writer.text() + fmt::format(fmt::runtime(l.result), writer.text(root)));
}

// The lobes times the place's weights.
ShaderFormula spatial_formula(const SpatialBrdf& surface, const ShaderOptions& options) {
  if (options.textures_are_arguments)
    throw Error("shader: expected textures that are uniforms of a surface, found arguments");
  if (options.half_products)
    throw Error("shader: expected single products of a surface, whose weights are single, found half");
  ShaderFormula formula = shader_formula(surface.lobes(), options);
  formula.value = Expr();
  for (std::size_t j = 0; j < formula.lobes.size(); ++j) {
    const bool coloured = surface.maps().weights[j].channels() > 1;
    const Expr weight =
        Expr::input(fmt::format("place.w{}", j), coloured ? ValueType::vector : ValueType::real);
    formula.value = formula.value + weight * formula.lobes[j];
  }
  return formula;
}

// `burnish_NAME(wi, wo, place)` by `burnish_NAME_lobes`, in the place's frame.
std::string turned_function(const Language& l, const std::string& name, const MoreParameters& more) {
  const auto local = [&](const char* w) {
    return fmt::format("{0}(dot(place.t, {1}), dot(place.b, {1}), dot(place.n, {1}))", l.vector, w);
  };
  return l.function(ValueType::vector, "burnish_" + name, kTwoDirections, more.declarations,
                    fmt::format(fmt::runtime(l.result), fmt::format("burnish_{}_lobes({}, {}, {})", name,
                                                                    local("wi"), local("wo"), more.names)));
}

MoreParameters with_place(const Language& l, MoreParameters more, const std::string& name) {
  const std::string comma = more.names.empty() ? "" : ", ";
  more.declarations +=
      comma + fmt::format(fmt::runtime(l.parameter), fmt::format("burnish_{}_place", name), "place");
  more.names += comma + "place";
  return more;
}

std::string map_name(const ShaderOptions& options) {
  return fmt::format("burnish_{}_map", options.name);
}

}  // namespace

SpatialShader generate_shader(const SpatialBrdf& surface, const ShaderOptions& options) {
  const Language& l = language(to_string(options.language));
  ShaderFormula formula = spatial_formula(surface, options);
  SpatialShader shader{.text = {},
                       .textures = std::move(formula.textures),
                       .maps = pack_maps(surface, map_name(options), options.maps_in_blocks),
                       .place_cost = {},
                       .light_cost = {}};
  const FormulaSurroundings around = formula_surroundings(options, shader.textures);
  const PlaceText place = place_text(l, options, surface, shader.maps, shader.textures.size());
  const bool framed = shader.maps.normals || shader.maps.tangents;
  const MoreParameters more = with_place(l, around.more, options.name);
  const FormulaFunction lobes = formula_function(
      formula.value, options, fmt::format("burnish_{}{}", options.name, framed ? "_lobes" : ""), more,
      shader.textures.size());
  shader.place_cost = place.cost;
  shader.light_cost = lobes.cost;
  const bool cpp = options.language == ShaderLanguage::cpp;
  shader.text = fmt::format(
      "// Generated by burnish from a surface of {0} x {1} texels: change the surface, not this file.\n"
      "// burnish_{2}_at(u, v, lod): weights and frame of a place, once a pixel: {3}.\n"
      "// burnish_{2}(wi, wo, place): f_r in 1/sr, without the cosine; unit vectors of the surface's frame,\n"
      "// +z the normal, +x along u, +y against v. {4}.\n{5}",
      surface.width(), surface.height(), options.name, to_string(place.cost), to_string(lobes.cost),
      cpp ? language(to_string(options.language)).header : "");
  shader.text += cpp ? "namespace burnish_shader {\n" + around.declarations.substr(l.header.size())
                     : around.declarations;
  shader.text += place.text + lod_function(l, options.name, surface) + lobes.text;
  if (framed) shader.text += turned_function(l, options.name, more);
  shader.text += world_function(l, options.name, more);
  if (cpp) shader.text += "}  // namespace burnish_shader\n";
  return shader;
}

SplitSpatialShader split_shader(const SpatialBrdf& surface, const ShaderOptions& options) {
  const Language& l = language(to_string(options.language));
  SplitSpatialShader split{.declarations = {},
                           .place = {},
                           .framed = false,
                           .lobes = split_formula(spatial_formula(surface, options), options),
                           .maps = pack_maps(surface, map_name(options), options.maps_in_blocks)};
  split.framed = split.maps.normals || split.maps.tangents;
  split.declarations = split.lobes.declarations +
                       place_text(l, options, surface, split.maps, split.lobes.textures.size()).text +
                       lod_function(l, options.name, surface);
  split.place = fmt::format("  burnish_{0}_place place = burnish_{0}_at(u, v, lod);\n", options.name);
  return split;
}

}  // namespace burnish
