// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstring>
#include <sstream>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <burnish/error.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/model_extension.h>
#include <burnish/factors/model_file.h>
#include <burnish/factors/shallow_json.h>
#include <burnish/json_integer.h>

namespace burnish {

namespace {

using Json = nlohmann::json;

constexpr int kVersion = 2, kOldVersion = 1;  // version 1 had one format for all tables
constexpr const char* kAttribute = "burnish";
constexpr const char* kExtension = "burnish_surface";
constexpr int kMaxDepth = 40;  // of a model's JSON, notes in it
constexpr std::array<unsigned char, 4> kExrMagic{0x76, 0x2f, 0x31, 0x01};

/// OpenEXR's input from memory.
class MemoryInput : public Imf::IStream {
 public:
  explicit MemoryInput(const FileBytes& file) : IStream(file.name.c_str()), bytes_(file.bytes) {}

  bool read(char target[], int count) override {
    if (count < 0 || static_cast<std::uint64_t>(count) > bytes_.size() - at_)
      throw Iex::InputExc("unexpected end of file");
    std::memcpy(target, bytes_.data() + at_, static_cast<std::size_t>(count));
    at_ += static_cast<std::uint64_t>(count);
    return at_ < bytes_.size();
  }
  std::uint64_t tellg() override { return at_; }
  void seekg(std::uint64_t at) override {
    if (at > bytes_.size()) throw Iex::InputExc("offset beyond the end of the file");
    at_ = at;
  }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t at_ = 0;
};

/// OpenEXR's output to memory.
class MemoryOutput : public Imf::OStream {
 public:
  MemoryOutput() : OStream("model") {}

  void write(const char source[], int count) override {
    const auto n = static_cast<std::size_t>(count);
    if (at_ + n > bytes.size()) bytes.resize(at_ + n);
    std::memcpy(bytes.data() + at_, source, n);
    at_ += n;
  }
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }

  std::string bytes;

 private:
  std::size_t at_ = 0;
};

/// Walks the headers before OpenEXR sees them. OpenEXR allocates what an attribute's size or a window says
/// before it reads: here sizes must lie within the file, windows and chunk counts within `longest`, the
/// longest side of a table or of any part, and the attributes be those of a model.
class HeaderCheck {
 public:
  HeaderCheck(std::span<const std::byte> bytes, int longest)
      : bytes_(bytes), at_(kExrMagic.size()), longest_(longest) {}

  /// Returns true if the first header has the attribute; the rest is not read.
  bool first_has(std::string_view attribute) {
    number<std::uint32_t>();  // version
    for (;;) {
      const std::string found = name();
      if (found.empty()) return false;
      if (found == attribute) return true;
      name();
      const auto size = number<std::int32_t>();
      if (size < 0) return false;
      skip(static_cast<std::size_t>(size));
    }
  }

  void run() {
    constexpr std::uint32_t kMultiPart = 0x1000, kVersionBits = 0xff;
    const auto version = number<std::uint32_t>();
    if ((version & ~kMultiPart & ~kLongNames) != 2)
      fail(fmt::format("OpenEXR version 2 without tiles or deep data, found {:#x} (version {})", version,
                       version & kVersionBits));
    while (header()) {
      if ((version & kMultiPart) == 0) return;  // one header, no end mark
    }
  }

 private:
  static constexpr std::uint32_t kLongNames = 0x400;
  static constexpr std::size_t kLongestName = 255;

  [[noreturn]] void fail(const std::string& expected) const {
    throw Error(fmt::format("offset {}: expected {}", at_, expected));
  }

  std::size_t remaining() const { return bytes_.size() - at_; }

  template <class T>
  T number() {
    if (sizeof(T) > remaining()) fail("more of the header, found the end of the file");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  std::string name() {
    std::string text;
    for (;;) {
      const auto c = number<char>();
      if (c == 0) return text;
      if (text.size() == kLongestName) fail("a name of at most 255 bytes, found a longer one");
      text.push_back(c);
    }
  }

  // The types that a model has. OpenEXR reads a value by its type, whatever its size says: the two must
  // agree.
  void check_value(const std::string& attribute, const std::string& type, std::size_t end) {
    if (type == "string") {
      at_ = end;
    } else if (type == "chlist") {
      constexpr std::size_t kChannelBytes = 16;
      while (!name().empty()) skip(kChannelBytes);
    } else if (type == "box2i") {
      for (int i = 0; i < 4; ++i) check_side(attribute);
    } else if (type == "int") {
      check_side(attribute);
    } else if (type == "float" || type == "v2f") {
      skip(type == "float" ? 4 : 8);
    } else if (type == "compression" || type == "lineOrder") {
      skip(1);
    } else {
      fail(fmt::format("attributes of a model, found '{}' of type '{}'", attribute, type));
    }
  }

  void skip(std::size_t count) {
    if (count > remaining()) fail("more of the header, found the end of the file");
    at_ += count;
  }

  void check_side(const std::string& attribute) {
    if (const auto value = number<std::int32_t>(); value < 0 || value > longest_)
      fail(fmt::format("'{}' within 0 to {}, found {}", attribute, longest_, value));
  }

  // One header; false where the list of headers ends.
  bool header() {
    for (bool first = true;; first = false) {
      const std::string attribute = name();
      if (attribute.empty()) return !first;
      const std::string type = name();
      const auto size = number<std::int32_t>();
      if (size < 0 || static_cast<std::size_t>(size) > remaining())
        fail(fmt::format("an attribute '{}' of at most {} bytes, found {}", attribute, remaining(), size));
      const std::size_t end = at_ + static_cast<std::size_t>(size);
      check_value(attribute, type, end);
      if (at_ != end) fail(fmt::format("'{}' to end at offset {}, found another size", attribute, end));
    }
  }

  std::span<const std::byte> bytes_;
  std::size_t at_;
  int longest_;
};

// EXR keeps channels by name; viewers show Y as grey and R, G, B as colour.
std::string channel_name(std::size_t channels, std::size_t c) {
  if (channels == 1) return "Y";
  if (channels == 3) return std::string(1, "RGB"[c]);
  return fmt::format("c{:04}", c);
}

// All but the pixels.
Json to_json(const Model& model) {
  const FactoredBrdf& brdf = model.brdf;
  Json tables = Json::array(), lobes = Json::array();
  for (const Table& t : brdf.tables()) {
    Json table{{"name", t.name},
               {"shape", to_string(t.layout.shape)},
               {"width", t.layout.width},
               {"height", t.layout.height},
               {"channels", t.channels},
               {"format", to_string(t.format)},
               {"warp", to_string(t.layout.warp)}};
    const int axes = projection_count(t.layout.shape);
    if (axes > 1) table["warp_y"] = to_string(t.layout.warp_y);
    if (axes > 2) table.update({{"depth", t.layout.depth}, {"warp_z", to_string(t.layout.warp_z)}});
    tables.push_back(std::move(table));
  }
  for (const Lobe& l : brdf.lobes()) {
    Json factors = Json::array();
    for (const FactorUse& use : l.factors) {
      const Table& table = brdf.table_of(use);
      Json factor{{"table", table.name}, {"projection", to_string(use.projection)}};
      const int axes = projection_count(table.layout.shape);
      if (axes > 1) factor["projection_y"] = to_string(use.projection_y);
      if (axes > 2) factor["projection_z"] = to_string(use.projection_z);
      factors.push_back(std::move(factor));
    }
    lobes.push_back({{"scale", l.scale}, {"factors", std::move(factors)}});
  }
  return {{"version", kVersion},
          {"channels", brdf.channels()},
          {"lambda_nm", model.lambda_nm},
          {"model", model_expression(brdf)},
          {"tables", std::move(tables)},
          {"lobes", std::move(lobes)},
          {"notes", Json::parse(model.notes)}};
}

// Every rgb9e5 value is a half: at most 9 significant bits, and a multiple of 2^-24 as the halves are.
Imf::PixelType pixel_type(TableFormat format) {
  return format == TableFormat::half || format == TableFormat::rgb9e5 ? Imf::HALF : Imf::FLOAT;
}

// A table as a part of its name.
ExrPart part_of(const Table& t) {
  return {.name = t.name,
          .width = t.layout.width,
          .height = t.layout.rows(),
          .channels = t.channels,
          .half = pixel_type(t.format) == Imf::HALF,
          .values = {}};
}

// Returns the headers of the parts, without attributes of ours.
std::vector<Imf::Header> headers(std::span<const ExrPart> parts) {
  std::vector<Imf::Header> result;
  // OpenEXR asks for one display window for all parts: the smallest that holds every part.
  Imath::Box2i display(Imath::V2i(0, 0));
  for (const ExrPart& part : parts) display.extendBy(Imath::V2i(part.width - 1, part.height - 1));
  for (const ExrPart& part : parts) {
    Imf::Header header(display, Imath::Box2i({0, 0}, {part.width - 1, part.height - 1}));
    header.setName(part.name);
    header.setType(Imf::SCANLINEIMAGE);
    header.compression() = Imf::NO_COMPRESSION;
    for (std::size_t c = 0; c < part.channels; ++c)
      header.channels().insert(channel_name(part.channels, c),
                               Imf::Channel(part.half ? Imf::HALF : Imf::FLOAT));
    result.push_back(std::move(header));
  }
  return result;
}

// A frame buffer over interleaved floats; OpenEXR converts halves.
Imf::FrameBuffer frame_buffer(float* values, int width, std::size_t channels) {
  Imf::FrameBuffer buffer;
  const std::size_t step = sizeof(float) * channels;
  for (std::size_t c = 0; c < channels; ++c)
    buffer.insert(channel_name(channels, c), Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values + c), step,
                                                        step * static_cast<std::size_t>(width)));
  return buffer;
}

Projection read_projection(const Json& factor, const char* key) {
  return parse_projection(factor.at(key).get<std::string>()).projection;
}

std::size_t count_at(const Json& json, const char* key) {
  return static_cast<std::size_t>(integer_at(json, key));
}

// Everything but the pixels, from the JSON; `old` files have one format for all.
std::vector<Table> read_tables(const Json& json, bool old, std::uint64_t file_size, std::size_t channels) {
  std::vector<Table> tables;
  std::uint64_t total = 0;
  for (const Json& t : json.at("tables")) {
    Table table{.name = t.at("name").get<std::string>(),
                .layout = {.shape = parse_table_shape(t.at("shape").get<std::string>()),
                           .width = integer_at(t, "width"),
                           .height = integer_at(t, "height"),
                           .warp = parse_warp(t.at("warp").get<std::string>())},
                .channels = count_at(t, "channels"),
                .values = {},
                .format = parse_table_format((old ? json : t).at("format").get<std::string>())};
    const int axes = projection_count(table.layout.shape);
    if (axes > 1) table.layout.warp_y = parse_warp(t.at("warp_y").get<std::string>());
    if (axes > 2) {
      table.layout.depth = integer_at(t, "depth");
      table.layout.warp_z = parse_warp(t.at("warp_z").get<std::string>());
    }
    check_layout(table.layout, table.name);
    if (table.channels != 1 && table.channels != channels)
      throw Error(fmt::format("table '{}': expected 1 or {} channels, found {}", table.name, channels,
                              table.channels));
    // the tables are stored uncompressed, in halves or floats: they cannot be larger than the file
    total += table.layout.node_count() * table.channels * 2;
    if (total > file_size)
      throw Error(fmt::format("table '{}': expected tables that fit the file's {} bytes, found {} or more",
                              table.name, file_size, total));
    tables.push_back(std::move(table));
  }
  return tables;
}

// The values of a part, which must have this name, size and channels.
void read_pixels(Imf::MultiPartInputFile& input, int number, ExrPart& part) {
  const Imf::Header& header = input.header(number);
  const Imath::Box2i window = header.dataWindow();
  if (header.name() != part.name)
    throw Error(fmt::format("part {}: expected name '{}', found '{}'", number, part.name, header.name()));
  if (window.min != Imath::V2i(0, 0) || window.max != Imath::V2i(part.width - 1, part.height - 1))
    throw Error(fmt::format("part '{}': expected a window of {} x {} at the origin, found another", part.name,
                            part.width, part.height));
  if (header.compression() != Imf::NO_COMPRESSION)
    throw Error(fmt::format("part '{}': expected no compression, found compression {}", part.name,
                            static_cast<int>(header.compression())));
  std::size_t found = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++found)
    if (c.channel().xSampling != 1 || c.channel().ySampling != 1 || c.channel().type == Imf::UINT)
      throw Error(fmt::format("part '{}': expected half or float channels without subsampling", part.name));
  for (std::size_t c = 0; c < part.channels; ++c)
    if (!header.channels().findChannel(channel_name(part.channels, c)) || found != part.channels)
      throw Error(fmt::format("part '{}': expected channels {}…, found others", part.name,
                              channel_name(part.channels, c)));

  part.values.resize(static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height) *
                     part.channels);
  Imf::InputPart pixels(input, number);
  pixels.setFrameBuffer(frame_buffer(part.values.data(), part.width, part.channels));
  pixels.readPixels(0, part.height - 1);
}

// The text of an attribute of the first part; none: nullptr.
const std::string* text_of(Imf::MultiPartInputFile& input, const char* attribute) {
  const auto* found = input.header(0).findTypedAttribute<Imf::StringAttribute>(attribute);
  return found ? &found->value() : nullptr;
}

// `extension`, without parts' values: of a file that is more than a model.
Model read_model(Imf::MultiPartInputFile& input, std::uint64_t file_size, ModelExtension& extension) {
  // the form of the model is JSON in the first part's header
  const std::string* const text = text_of(input, kAttribute);
  if (!text) throw Error("expected a string attribute 'burnish', found an OpenEXR file without it");
  const Json json = parse_shallow(*text, kMaxDepth);
  const int version = integer_at(json, "version");
  if (version != kVersion && version != kOldVersion)
    throw Error(fmt::format("expected version {} or {}, found {}", kOldVersion, kVersion, version));

  const std::size_t channels = count_at(json, "channels");
  // a part a table
  std::vector<Table> tables = read_tables(json, version == kOldVersion, file_size, channels);
  if (const std::size_t parts = tables.size() + extension.parts.size();
      static_cast<std::size_t>(input.parts()) != parts)
    throw Error(fmt::format("expected {} parts, found {}", parts, input.parts()));
  int number = 0;
  for (Table& table : tables) {
    ExrPart part = part_of(table);
    read_pixels(input, number++, part);
    table.values = std::move(part.values);
  }
  for (ExrPart& part : extension.parts) read_pixels(input, number++, part);

  // lobes name their tables
  std::vector<Lobe> lobes;
  for (const Json& l : json.at("lobes")) {
    Lobe lobe{.scale = l.at("scale").get<std::vector<double>>(), .factors = {}};
    for (const Json& f : l.at("factors")) {
      const auto name = f.at("table").get<std::string>();
      const auto table =
          std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.name == name; });
      if (table == tables.end())
        throw Error(fmt::format("factor: expected the name of a table, found '{}'", name));
      FactorUse use{.table = static_cast<std::size_t>(table - tables.begin()),
                    .projection = read_projection(f, "projection"),
                    .projection_y = {},
                    .projection_z = {}};
      const int axes = projection_count(table->layout.shape);
      if (axes > 1) use.projection_y = read_projection(f, "projection_y");
      if (axes > 2) use.projection_z = read_projection(f, "projection_z");
      lobe.factors.push_back(use);
    }
    lobes.push_back(std::move(lobe));
  }

  // the constructor checks how all of it fits together
  Model model{.brdf = FactoredBrdf(channels, std::move(tables), std::move(lobes)),
              .lambda_nm = json.at("lambda_nm").get<std::vector<double>>(),
              .notes = json.at("notes").dump()};
  if (!model.lambda_nm.empty() && model.lambda_nm.size() != channels)
    throw Error(fmt::format("lambda_nm: expected none or {} wavelengths, found {}", channels,
                            model.lambda_nm.size()));
  return model;
}

// Calls read(input) with the opened file; OpenEXR sees only what has been checked.
template <class Read>
auto with_checked_file(const FileBytes& file, int longest, const Read& read) {
  if (!looks_like_exr(file.bytes))
    throw Error(file.name, 0, "a model, an OpenEXR or .burnish file", "other bytes");
  try {
    HeaderCheck(file.bytes, longest).run();
    MemoryInput stream(file);
    Imf::MultiPartInputFile input(stream, 0);
    return read(input);
  } catch (const Error& error) {
    throw Error(fmt::format("{}: {}", file.name, error.what()));
  } catch (const std::exception& error) {  // OpenEXR's and JSON's own
    throw Error(fmt::format("{}: expected a burnish model, found: {}", file.name, error.what()));
  }
}

void write_pixels(Imf::MultiPartOutputFile& output, int number, ExrPart& part) {
  Imf::OutputPart pixels(output, number);
  if (!part.half) {
    pixels.setFrameBuffer(frame_buffer(part.values.data(), part.width, part.channels));
    pixels.writePixels(part.height);
    return;
  }

  // what halves hold is written as halves
  std::vector<Imath::half> halves(part.values.begin(), part.values.end());
  Imf::FrameBuffer buffer;
  const std::size_t step = sizeof(Imath::half) * part.channels;
  for (std::size_t c = 0; c < part.channels; ++c)
    buffer.insert(channel_name(part.channels, c),
                  Imf::Slice(Imf::HALF, reinterpret_cast<char*>(halves.data() + c), step,
                             step * static_cast<std::size_t>(part.width)));
  pixels.setFrameBuffer(buffer);
  pixels.writePixels(part.height);
}

std::string written(const Model& model, ModelExtension extension) {
  if (model.brdf.tables().empty()) throw Error("model: expected at least one table to write, found none");
  std::vector<ExrPart> parts;
  for (const Table& table : model.brdf.tables()) {
    parts.push_back(part_of(table));
    parts.back().values = table.values;  // OpenEXR wants them mutable
  }
  for (ExrPart& part : extension.parts) {
    if (std::ranges::find(parts, part.name, &ExrPart::name) != parts.end())
      throw Error(fmt::format("model: expected tables of other names than parts, found '{}'", part.name));
    parts.push_back(std::move(part));
  }
  std::vector<Imf::Header> form = headers(parts);
  form.front().insert(kAttribute, Imf::StringAttribute(to_json(model).dump()));
  if (!extension.json.empty()) form.front().insert(kExtension, Imf::StringAttribute(extension.json));
  MemoryOutput stream;
  {
    Imf::MultiPartOutputFile output(stream, form.data(), static_cast<int>(form.size()), false, 0);
    for (std::size_t i = 0; i < parts.size(); ++i) write_pixels(output, static_cast<int>(i), parts[i]);
  }
  return std::move(stream.bytes);
}

}  // namespace

bool looks_like_exr(std::span<const std::byte> head) noexcept {
  return head.size() >= kExrMagic.size() && std::memcmp(head.data(), kExrMagic.data(), kExrMagic.size()) == 0;
}

bool looks_like_model(std::span<const std::byte> head) noexcept {
  return looks_like_exr(head) || looks_like_compact(head);
}

std::string format_model_as(const std::filesystem::path& name, const Model& model) {
  return name.extension() == ".burnish" ? format_compact(model) : format_model(model);
}

std::string format_model(const Model& model) {
  return written(model, {});
}

std::string format_extended_model(const Model& model, ModelExtension extension) {
  return written(model, std::move(extension));
}

Model parse_model(const FileBytes& file) {
  if (looks_like_compact(file.bytes)) return parse_compact(file);
  if (looks_like_extended_model(file.bytes)) throw Error::in_file(file.name, "a model", "a surface");
  return with_checked_file(file, kMaxSide, [&](Imf::MultiPartInputFile& input) {
    ModelExtension none;
    return read_model(input, file.bytes.size(), none);
  });
}

ExtendedModel parse_extended_model(
    const FileBytes& file, const std::function<std::vector<ExrPart>(const std::string& json)>& parts_of) {
  return with_checked_file(file, kMaxPartSide, [&](Imf::MultiPartInputFile& input) {
    const std::string* const text = text_of(input, kExtension);
    if (!text) throw Error("expected a surface, found a model");
    ModelExtension extension{.json = *text, .parts = parts_of(*text)};
    std::uint64_t least = 0;  // bytes of the parts
    for (const ExrPart& part : extension.parts) {
      if (part.width < 1 || part.height < 1 || part.width > kMaxPartSide || part.height > kMaxPartSide)
        throw Error(fmt::format("part '{}': expected sides of 1 to {}, found {} x {}", part.name,
                                kMaxPartSide, part.width, part.height));
      least += 2 * static_cast<std::uint64_t>(part.width) * static_cast<std::uint64_t>(part.height) *
               part.channels;
    }
    if (least > file.bytes.size())
      throw Error(fmt::format("expected parts that fit the file's {} bytes, found {} or more",
                              file.bytes.size(), least));
    Model model = read_model(input, file.bytes.size(), extension);
    return ExtendedModel{std::move(model), std::move(extension)};
  });
}

bool looks_like_extended_model(std::span<const std::byte> head) noexcept {
  if (!looks_like_exr(head)) return false;
  try {
    return HeaderCheck(head, kMaxPartSide).first_has(kExtension);
  } catch (const Error&) {  // no header of an OpenEXR file
    return false;
  }
}

}  // namespace burnish
