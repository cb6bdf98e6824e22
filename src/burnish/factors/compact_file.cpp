// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/cbor.h>
#include <burnish/factors/compact_extension.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/shallow_json.h>

namespace burnish {

namespace {

using Json = nlohmann::json;

constexpr int kCompactVersion = 1;
constexpr std::uint64_t kSelfDescribed = 55799;  // [RFC8949, 3.4.6]
constexpr std::string_view kName = "burnish";
// A file lists name, version, channels, lambda_nm, kinds, tables, products and lobes. The notes may follow, and
// then the surface that the model is a part of.
constexpr std::size_t kParts = 8, kExtendedParts = kParts + 2;
constexpr std::size_t kMaxChannels = SymmetrizedBrdf::kMaxChannels;
constexpr std::size_t kTableItems = 3;  // name, kind, texels
constexpr std::size_t kLongestName = 255, kLongestNotes = 1 << 20;
constexpr int kMaxNotesDepth = 32;

// Files hold numbers for these values: their places in the lists.
constexpr std::array kShapes{TableShape::line, TableShape::disk, TableShape::grid, TableShape::volume};
constexpr std::array kFormats{TableFormat::half, TableFormat::single, TableFormat::rgb9e5,
                              TableFormat::unorm8};
constexpr std::array kWarps{WarpKind::identity, WarpKind::power, WarpKind::rational};

template <class List, class T>
std::int64_t place_in(const List& list, const T& value) {
  return std::ranges::find(list, value) - std::begin(list);
}

/// Nodes along one axis of a table, and their spacing.
struct Axis {
  int nodes = 0;
  Warp warp;
};

/// Returns the number of a shape's axes in a file. The two sides of a disk are one axis.
std::size_t axes_in_file(TableShape shape) {
  return static_cast<std::size_t>(projection_count(shape));
}

std::vector<Axis> axes_of(const TableLayout& layout) {
  std::vector<Axis> axes{{layout.width, layout.warp}};
  if (axes_in_file(layout.shape) > 1) axes.push_back({layout.height, layout.warp_y});
  if (axes_in_file(layout.shape) > 2) axes.push_back({layout.depth, layout.warp_z});
  return axes;
}

TableLayout layout_of(TableShape shape, std::span<const Axis> axes) {
  TableLayout layout{
      .shape = shape, .width = axes[0].nodes, .warp = axes[0].warp, .warp_y = {}, .warp_z = {}};
  if (shape == TableShape::disk) layout.height = layout.width;
  if (axes.size() > 1) {
    layout.height = axes[1].nodes;
    layout.warp_y = axes[1].warp;
  }
  if (axes.size() > 2) {
    layout.depth = axes[2].nodes;
    layout.warp_z = axes[2].warp;
  }
  return layout;
}

std::vector<Projection> projections_of(const FactorUse& use, TableShape shape) {
  std::vector<Projection> projections{use.projection};
  if (axes_in_file(shape) > 1) projections.push_back(use.projection_y);
  if (axes_in_file(shape) > 2) projections.push_back(use.projection_z);
  return projections;
}

FactorUse use_of(std::size_t table, std::span<const Projection> projections) {
  FactorUse use{.table = table, .projection = projections[0], .projection_y = {}, .projection_z = {}};
  if (projections.size() > 1) use.projection_y = projections[1];
  if (projections.size() > 2) use.projection_z = projections[2];
  return use;
}

bool is_name(const std::string& text) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  return text.size() <= kLongestName && is_utf8(text) && std::ranges::none_of(text, control);
}

// Returns the text as a JSON object of bounded depth; nothing for anything else.
std::optional<Json> parse_notes(const std::string& text) {
  try {
    Json json = parse_shallow(text, kMaxNotesDepth);
    if (json.is_object()) return json;
  } catch (const Error&) {
  } catch (const Json::exception&) {
  }
  return std::nullopt;
}

/// The properties that tables of one kind share. Tables of several lobes are often of one kind.
struct TableKind {
  TableLayout layout;
  TableFormat format = TableFormat::single;
  std::size_t channels = 1;

  friend bool operator==(const TableKind&, const TableKind&) = default;
};

TableKind kind_of(const Table& table) {
  return {table.layout, table.format, table.channels};
}

std::vector<TableKind> kinds_of(std::span<const Table> tables) {
  std::vector<TableKind> kinds;
  for (const Table& table : tables)
    if (std::ranges::find(kinds, kind_of(table)) == kinds.end()) kinds.push_back(kind_of(table));
  return kinds;
}

/// The projections that the factors of a lobe are looked up by, one for each axis. Lobes often differ in their
/// tables alone.
using Product = std::vector<std::vector<Projection>>;

Product product_of(const FactoredBrdf& brdf, const Lobe& lobe) {
  Product product;
  for (const FactorUse& use : lobe.factors)
    product.push_back(projections_of(use, brdf.table_of(use).layout.shape));
  return product;
}

std::vector<Product> products_of(const FactoredBrdf& brdf) {
  std::vector<Product> products;
  for (const Lobe& lobe : brdf.lobes())
    if (Product product = product_of(brdf, lobe); std::ranges::find(products, product) == products.end())
      products.push_back(std::move(product));
  return products;
}

/// Returns the notes that a file keeps even without all notes. They state the part of a surface's BSDF that the model
/// is of; without it, its directions would be read wrong. Returns nothing for notes without a part.
std::optional<std::string> kept_notes(const std::string& text) {
  const std::optional<Json> json = parse_notes(text);
  if (!json || !json->contains("part")) return std::nullopt;
  Json kept = Json::object();
  for (const char* key : {"part", "band"})
    if (const auto found = json->find(key); found != json->end() && found->is_string() &&
                                            found->get_ref<const std::string&>().size() <= kLongestName)
      kept[key] = *found;
  return kept.dump();
}

/// Writes one file.
class CompactWriter {
 public:
  using Append = std::function<void(CborWriter&)>;

  std::string run(const Model& model, CompactContent content, const Append& append = nullptr) {
    const FactoredBrdf& brdf = model.brdf;
    const std::optional<std::string> notes =
        content == CompactContent::model_and_notes ? model.notes : kept_notes(model.notes);
    cbor_.tag(kSelfDescribed);
    cbor_.list(append ? kExtendedParts : notes ? kParts + 1 : kParts);
    cbor_.text(kName);
    cbor_.integer(kCompactVersion);
    cbor_.integer(brdf.channels());
    numbers(model.lambda_nm);

    // A table names its kind by the place in this list.
    const std::vector<TableKind> kinds = kinds_of(brdf.tables());
    cbor_.list(kinds.size());
    for (const TableKind& k : kinds) kind(k);
    cbor_.list(kTableItems * brdf.tables().size());
    for (const Table& table : brdf.tables()) {
      cbor_.text(table.name);
      cbor_.integer(place_in(kinds, kind_of(table)));
      cbor_.bytes(pack(table.format, table.channels, table.values));
    }

    // A lobe names its product by the place in this list.
    const std::vector<Product> products = products_of(brdf);
    cbor_.list(products.size());
    for (const Product& p : products) product(p);
    cbor_.list(brdf.lobes().size());
    for (const Lobe& lobe : brdf.lobes()) {
      cbor_.list(2 + lobe.factors.size());
      numbers(lobe.scale);
      cbor_.integer(place_in(products, product_of(brdf, lobe)));
      for (const FactorUse& use : lobe.factors) cbor_.integer(use.table);
    }
    if (notes) cbor_.text(*notes);
    if (append) append(cbor_);
    return cbor_.written();
  }

 private:
  void numbers(std::span<const double> values) {
    cbor_.list(values.size());
    for (const double value : values) cbor_.number(value);
  }

  void kind(const TableKind& kind) {
    const std::vector<Axis> axes = axes_of(kind.layout);
    cbor_.list(3 + axes.size());
    cbor_.integer(place_in(kShapes, kind.layout.shape));
    cbor_.integer(place_in(kFormats, kind.format));
    cbor_.integer(kind.channels);
    for (const auto& [nodes, warp] : axes) {
      if (warp.kind == WarpKind::identity) {
        cbor_.integer(nodes);
        continue;
      }
      cbor_.list(3);
      cbor_.integer(nodes);
      cbor_.integer(place_in(kWarps, warp.kind));
      cbor_.number(warp.parameter);
    }
  }

  void product(const Product& product) {
    cbor_.list(product.size());
    for (const std::vector<Projection>& projections : product) {
      cbor_.list(projections.size());
      for (const Projection& p : projections) projection(p);
    }
  }

  // Writes a projection's number, or the coefficients of wi, wo, mirror and n up to the last that is not 0.
  void projection(const Projection& p) {
    if (const auto known = std::ranges::find(kNumberedProjections, p); known != kNumberedProjections.end())
      return cbor_.integer(known - kNumberedProjections.begin());
    if (p.kind != Projection::Kind::affine)
      throw Error("compact file: a projection that has no number in it");
    std::vector<double> terms{p.wi, p.wo, p.mirror, p.n};
    while (!terms.empty() && terms.back() == 0) terms.pop_back();
    numbers(terms);
  }

  CborWriter cbor_;
};

/// Reads one file.
class CompactReader {
 public:
  explicit CompactReader(const FileBytes& file) : cbor_(file), name_(file.name) {}

  using Read = std::function<void(CborReader&, const Model&)>;

  Model run(const Read& read = nullptr) {
    cbor_.tag("a compact file", kSelfDescribed);
    const auto parts_at = cbor_.offset();
    const std::size_t parts = cbor_.list("a model", kParts, kExtendedParts);
    if (parts == kExtendedParts && !read)
      cbor_.fail(parts_at, "a model that is the same everywhere",
                 "a surface, whose lobes have maps of weights");
    if (parts != kExtendedParts && read)
      cbor_.fail(parts_at, "a surface, whose lobes have maps of weights",
                 "a model that is the same everywhere");
    if (const auto at = cbor_.offset(); cbor_.text("the name of the format", kName.size()) != kName)
      cbor_.fail(at, "'burnish'", "another name");
    cbor_.integer("version", kCompactVersion, kCompactVersion);
    channels_ = static_cast<std::size_t>(cbor_.integer("channels", 1, kMaxChannels));
    Model model;
    const auto lambda_at = cbor_.offset();
    model.lambda_nm = numbers("lambda_nm", 0, channels_);
    if (!model.lambda_nm.empty() && model.lambda_nm.size() != channels_)
      cbor_.fail(lambda_at, fmt::format("lambda_nm, none or {} wavelengths", channels_),
                 fmt::format("{}", model.lambda_nm.size()));

    // Kinds of tables come first, then the tables, then the products and lobes that use them.
    read_list("kinds of tables", 0, kMaxCompactItems, [&] { kinds_.push_back(kind()); });
    tables();
    read_list("products", 0, kMaxCompactItems, [&] { products_.push_back(product()); });
    std::vector<Lobe> lobes;
    read_list("lobes", 0, kMaxCompactItems, [&] { lobes.push_back(lobe()); });
    if (parts > kParts) model.notes = notes();
    if (!read) cbor_.end();

    // The constructor checks that all parts fit together.
    try {
      model.brdf = FactoredBrdf(channels_, std::move(tables_), std::move(lobes));
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", name_, error.what()));
    }
    if (read) {
      read(cbor_, model);
      cbor_.end();
    }
    return model;
  }

 private:
  template <class Read>
  void read_list(std::string_view what, std::size_t least, std::size_t most, const Read& read) {
    for (std::size_t count = cbor_.list(what, least, most); count > 0; --count) read();
  }

  std::vector<double> numbers(std::string_view what, std::size_t least, std::size_t most) {
    std::vector<double> values(cbor_.list(what, least, most));
    for (double& value : values) value = cbor_.number(what);
    return values;
  }

  template <class List>
  const auto& one_of(const List& list, std::string_view what) {
    const auto last = static_cast<std::int64_t>(std::size(list)) - 1;
    return list[static_cast<std::size_t>(cbor_.integer(what, 0, last))];
  }

  /// Runs a check whose errors have no place, and adds the file and the offset to them.
  template <class Check>
  auto checked(std::uint64_t offset, const Check& check) {
    try {
      return check();
    } catch (const Error& error) {
      throw Error(fmt::format("{}: offset {}: {}", name_, offset, error.what()));
    }
  }

  TableKind kind() {
    const auto at = cbor_.offset();
    const std::size_t items = cbor_.list("a kind of tables", 4, 3 + kMaxAxes);
    const TableShape shape = one_of(kShapes, "a shape");
    if (items != 3 + axes_in_file(shape))
      cbor_.fail(at, fmt::format("a kind of tables with {} axes", axes_in_file(shape)),
                 fmt::format("{}", items - 3));
    TableKind kind{.layout = {}, .format = one_of(kFormats, "a table format")};
    kind.channels = static_cast<std::size_t>(
        cbor_.integer("a table's channels", 1, static_cast<std::int64_t>(channels_)));
    if (kind.channels != 1 && kind.channels != channels_)
      cbor_.fail(at, fmt::format("a kind of tables of 1 or {} channels", channels_),
                 fmt::format("{}", kind.channels));
    std::vector<Axis> axes;
    while (axes.size() < axes_in_file(shape)) axes.push_back(axis());
    kind.layout = layout_of(shape, axes);
    if (!holds_channels(kind.format, kind.channels))
      cbor_.fail(at, fmt::format("3 channels for {}", to_string(kind.format)),
                 fmt::format("{}", kind.channels));
    return kind;
  }

  Axis axis() {
    const auto nodes = [&] { return static_cast<int>(cbor_.integer("nodes of an axis", 2, kMaxSide)); };
    if (!cbor_.list_is_next()) return {nodes(), {}};
    cbor_.list("nodes, spacing and its parameter", 3, 3);
    Axis axis{nodes(), {}};
    const auto at = cbor_.offset();
    axis.warp.kind = one_of(kWarps, "a spacing");
    axis.warp.parameter = cbor_.number("the parameter of a spacing");
    if (axis.warp.kind == WarpKind::identity) cbor_.fail(at, "a spacing with a parameter", "even spacing");
    checked(at, [&] { return parse_warp(to_string(axis.warp)); });
    return axis;
  }

  void tables() {
    const auto at = cbor_.offset();
    const std::size_t items = cbor_.list("tables", 0, kTableItems * kMaxCompactItems);
    if (items % kTableItems != 0) cbor_.fail(at, "three items a table", fmt::format("{} items", items));
    while (tables_.size() < items / kTableItems) tables_.push_back(table());
  }

  Table table() {
    const auto at = cbor_.offset();
    std::string name = cbor_.text("a table's name", kLongestName);
    if (!is_name(name)) cbor_.fail(at, "a table's name in UTF-8 without control characters", "another");
    const TableKind& kind = one_of(kinds_, "a table's kind");
    const std::uint64_t size =
        kind.layout.node_count() * std::uint64_t{texel_bytes(kind.format, kind.channels)};
    const auto texels = cbor_.bytes(fmt::format("the texels of table '{}'", name), size);
    return {.name = std::move(name),
            .layout = kind.layout,
            .channels = kind.channels,
            .values = unpack(kind.format, kind.channels, texels),
            .format = kind.format};
  }

  Product product() {
    Product product(cbor_.list("a product", 0, kMaxCompactItems - use_count_));
    use_count_ += product.size();
    for (std::vector<Projection>& projections : product)
      read_list("the projections of a factor", 1, kMaxAxes, [&] { projections.push_back(projection()); });
    return product;
  }

  Lobe lobe() {
    const auto at = cbor_.offset();
    const std::size_t items = cbor_.list("a lobe", 2, 2 + kMaxCompactItems - factor_count_);
    factor_count_ += items - 2;
    const auto channels = channels_;
    Lobe lobe{.scale = numbers("a lobe's scales", channels, channels), .factors = {}};
    const Product& product = one_of(products_, "a lobe's product");
    if (items != 2 + product.size())
      cbor_.fail(at, fmt::format("a lobe of {} factors", product.size()), fmt::format("{}", items - 2));
    for (const std::vector<Projection>& projections : product) lobe.factors.push_back(factor(projections));
    return lobe;
  }

  FactorUse factor(std::span<const Projection> projections) {
    const auto at = cbor_.offset();
    const auto table = static_cast<std::size_t>(
        cbor_.integer("a factor's table", 0, static_cast<std::int64_t>(tables_.size()) - 1));
    const std::size_t axes = axes_in_file(tables_[table].layout.shape);
    if (projections.size() != axes)
      cbor_.fail(at, fmt::format("a table of {} axes", projections.size()), fmt::format("one of {}", axes));
    return use_of(table, projections);
  }

  Projection projection() {
    if (!cbor_.list_is_next()) return one_of(kNumberedProjections, "a projection");
    const auto at = cbor_.offset();
    std::vector<double> terms = numbers("the coefficients of a projection", 1, 4);
    terms.resize(4);
    const Projection p{.wi = terms[0], .wo = terms[1], .mirror = terms[2], .n = terms[3]};
    return checked(at, [&] { return parse_projection(to_string(p)).projection; });
  }

  std::string notes() {
    const auto at = cbor_.offset();
    const std::string text = cbor_.text("notes", kLongestNotes);
    const std::optional<Json> json = parse_notes(text);
    if (!json)
      cbor_.fail(at, fmt::format("notes that are a JSON object at most {} deep", kMaxNotesDepth), "others");
    return json->dump();
  }

  static constexpr std::size_t kMaxAxes = 3;

  CborReader cbor_;
  std::string name_;
  std::size_t channels_ = 0;
  std::vector<TableKind> kinds_;
  std::vector<Table> tables_;
  std::vector<Product> products_;
  std::size_t use_count_ = 0, factor_count_ = 0;
};

// Throws Error for a model that the reader would refuse.
void check_writable(const Model& model, CompactContent content) {
  const auto check = [](const char* what, std::size_t count) {
    if (count > kMaxCompactItems)
      throw Error(
          fmt::format("compact file: expected at most {} {}, found {}", kMaxCompactItems, what, count));
  };
  const FactoredBrdf& brdf = model.brdf;
  std::size_t factors = 0;
  for (const Lobe& lobe : brdf.lobes()) factors += lobe.factors.size();
  check("tables", brdf.tables().size());
  check("lobes", brdf.lobes().size());
  check("factors", factors);
  for (const Table& table : brdf.tables())
    if (!is_name(table.name))
      throw Error(
          fmt::format("compact file: expected table names of at most {} bytes of UTF-8 without control "
                      "characters, found others",
                      kLongestName));
  if (content == CompactContent::model_and_notes &&
      (model.notes.size() > kLongestNotes || !parse_notes(model.notes)))
    throw Error("compact file: expected notes that are a JSON object of at most 1 MiB, found others");
}

}  // namespace

bool looks_like_compact(std::span<const std::byte> head) noexcept {
  constexpr std::string_view kTag = "\xd9\xd9\xf7", kText =
                                                        "\x67"
                                                        "burnish";
  if (head.size() < kTag.size() + 1 + kText.size()) return false;
  const std::string_view found(reinterpret_cast<const char*>(head.data()), head.size());
  return found.starts_with(kTag) && (found[kTag.size()] & '\xe0') == '\x80' &&
         found.substr(kTag.size() + 1).starts_with(kText);
}

std::string format_compact(const Model& model, CompactContent content) {
  check_writable(model, content);
  return CompactWriter().run(model, content);
}

Model parse_compact(const FileBytes& file) {
  return CompactReader(file).run();
}

std::string format_compact_with(const Model& model, const std::function<void(CborWriter&)>& append) {
  check_writable(model, CompactContent::model_and_notes);
  return CompactWriter().run(model, CompactContent::model_and_notes, append);
}

Model parse_compact_with(const FileBytes& file, const std::function<void(CborReader&, const Model&)>& read) {
  return CompactReader(file).run(read);
}

bool looks_like_extended_compact(std::span<const std::byte> head) noexcept {
  constexpr std::size_t kTagBytes = 3;
  return looks_like_compact(head) && head[kTagBytes] == std::byte{0x80 + kExtendedParts};
}

}  // namespace burnish
