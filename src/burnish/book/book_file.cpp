// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/factors/cbor.h>
#include <burnish/math/half.h>

namespace burnish {

namespace {

constexpr std::uint64_t kSelfDescribed = 55799;  // [RFC8949, 3.4.6]
constexpr std::string_view kBookName = "burnish book";
constexpr int kBookVersion = 1;
constexpr std::size_t kBookParts = 6, kAxisParts = 5, kLongestMaterial = 255;
constexpr int kMaxBookSide = 64;  // of a book's volume

std::span<const std::byte> bytes_of(const std::vector<std::int8_t>& values) {
  return std::as_bytes(std::span(values));
}

std::vector<std::int8_t> signed_bytes(std::span<const std::byte> bytes) {
  std::vector<std::int8_t> values(bytes.size());
  if (!bytes.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

std::vector<std::byte> halves_of(const std::vector<float>& values) {
  std::vector<std::byte> bytes;
  for (const float value : values) {
    const std::uint16_t bits = Imath::half(value).bits();
    bytes.push_back(static_cast<std::byte>(bits & 0xff));
    bytes.push_back(static_cast<std::byte>(bits >> 8));
  }
  return bytes;
}

std::vector<float> read_halves(std::span<const std::byte> bytes) {
  std::vector<float> values(bytes.size() / 2);
  for (std::size_t i = 0; i < values.size(); ++i) {
    Imath::half half;
    half.setBits(static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[2 * i]) |
                                            std::to_integer<unsigned>(bytes[2 * i + 1]) << 8));
    values[i] = half;
  }
  return values;
}

void write_numbers(CborWriter& cbor, const std::vector<float>& values) {
  cbor.list(values.size());
  for (const float value : values) cbor.number(static_cast<double>(value));
}

/// One file being read.
class BookReader {
 public:
  explicit BookReader(const FileBytes& file) : cbor_(file), name_(file.name) {}

  MaterialBook run() {
    cbor_.tag("a book", kSelfDescribed);
    cbor_.list("a book", kBookParts, kBookParts);
    if (const auto at = cbor_.offset(); cbor_.text("the name of the format", kBookName.size()) != kBookName)
      cbor_.fail(at, "'burnish book'", "another name");
    cbor_.integer("version", kBookVersion, kBookVersion);
    cbor_.list("the sides of a volume", 3, 3);
    std::array<int, 3> sides{};
    for (int& side : sides) {
      side = static_cast<int>(cbor_.integer("nodes of an axis", 2, kMaxBookSide));
      nodes_ *= static_cast<std::size_t>(side);
    }
    cbor_.list("axes of colour", MaterialBook::kAxes, MaterialBook::kAxes);
    std::array<BookAxis, MaterialBook::kAxes> axes;
    for (BookAxis& axis : axes) axis = read_axis();
    std::vector<MaterialBook::Material> materials = read_materials();
    cbor_.end();
    try {
      return {sides, std::move(axes), std::move(materials)};
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", name_, error.what()));
    }
  }

 private:
  float number(std::string_view what) {
    const auto at = cbor_.offset();
    const double value = cbor_.number(what);
    const auto narrow = static_cast<float>(value);
    if (static_cast<double>(narrow) != value)
      cbor_.fail(at, fmt::format("{} that a float holds", what), fmt::format("{}", value));
    return narrow;
  }

  std::vector<float> numbers(std::string_view what, std::size_t count) {
    std::vector<float> values(cbor_.list(what, count, count));
    for (float& value : values) value = number(what);
    return values;
  }

  BookAxis read_axis() {
    cbor_.list("an axis of colour", kAxisParts, kAxisParts);
    BookAxis axis;
    axis.mean = read_halves(cbor_.bytes("the means of the nodes", 2 * nodes_));
    axis.residual = number("what components leave");
    const auto count =
        static_cast<std::size_t>(cbor_.integer("components", 0, std::int64_t{MaterialBook::kMaxComponents}));
    weights_ += count;
    axis.components = signed_bytes(cbor_.bytes("the components", count * nodes_));
    cbor_.list("scales, steps and deviations", 3, 3);
    axis.scales = numbers("a component's scale", count);
    axis.steps = numbers("a weight's step", count);
    axis.deviations = numbers("a weight's deviation", count);
    return axis;
  }

  std::vector<MaterialBook::Material> read_materials() {
    std::vector<MaterialBook::Material> materials(cbor_.list("names", 0, MaterialBook::kMaxMaterials));
    for (auto& material : materials) material.name = cbor_.text("a name", kLongestMaterial);
    const auto weights = cbor_.bytes("the weights of all materials", materials.size() * weights_);
    for (std::size_t i = 0; i < materials.size(); ++i)
      materials[i].weights = signed_bytes(weights.subspan(i * weights_, weights_));
    return materials;
  }

  CborReader cbor_;
  std::string name_;
  std::size_t nodes_ = 1, weights_ = 0;
};

}  // namespace

std::string format_book(const MaterialBook& book) {
  CborWriter cbor;
  cbor.tag(kSelfDescribed);
  cbor.list(kBookParts);
  cbor.text(kBookName);
  cbor.integer(kBookVersion);
  cbor.list(3);
  for (const int side : {book.layout().width, book.layout().height, book.layout().depth}) cbor.integer(side);
  cbor.list(MaterialBook::kAxes);
  for (const BookAxis& axis : book.axes()) {
    cbor.list(kAxisParts);
    cbor.bytes(halves_of(axis.mean));
    cbor.number(static_cast<double>(axis.residual));
    cbor.integer(static_cast<std::int64_t>(axis.component_count()));
    cbor.bytes(bytes_of(axis.components));
    cbor.list(3);
    for (const auto* values : {&axis.scales, &axis.steps, &axis.deviations}) write_numbers(cbor, *values);
  }
  cbor.list(book.materials().size());
  std::vector<std::int8_t> weights;
  for (const MaterialBook::Material& material : book.materials()) {
    cbor.text(material.name);
    weights.insert(weights.end(), material.weights.begin(), material.weights.end());
  }
  cbor.bytes(bytes_of(weights));
  return cbor.written();
}

MaterialBook parse_book(const FileBytes& file) {
  return BookReader(file).run();
}

bool looks_like_book(std::span<const std::byte> head) noexcept {
  constexpr std::string_view kStart =
      "\xd9\xd9\xf7\x86\x6c"
      "burnish book";
  const std::string_view found(reinterpret_cast<const char*>(head.data()), head.size());
  return found.starts_with(kStart);
}

}  // namespace burnish
