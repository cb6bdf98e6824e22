// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <bit>

#include <OpenEXR/ImfStandIn.h>

namespace Imf {

namespace {

constexpr std::uint32_t kMagic = 20000630, kVersion = 2, kSeveralParts = 0x1000, kLongNames = 0x400;
constexpr int kMaxRows = 1 << 20;

std::size_t bytes_of(PixelType type) {
  return type == HALF ? 2 : 4;
}

std::size_t row_bytes(const Header& header) {
  std::size_t bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
    bytes += bytes_of(c.channel().type);
  return bytes * static_cast<std::size_t>(header.dataWindow().max.x + 1);
}

int row_count(const Header& header) {
  return header.dataWindow().max.y + 1;
}

// Writes little-endian numbers, texts that end in a zero byte, and attributes.
class Writer {
 public:
  template <class T>
  void number(T value) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), &value, sizeof(T));
    bytes.append(raw.data(), raw.size());
  }
  void text(const std::string& value) { bytes.append(value).push_back('\0'); }
  void attribute(const std::string& name, const char* type, const std::string& value) {
    text(name);
    text(type);
    number(static_cast<std::int32_t>(value.size()));
    bytes += value;
  }
  std::string bytes;
};

template <class... T>
std::string packed(T... values) {
  Writer writer;
  (writer.number(values), ...);
  return writer.bytes;
}

std::string packed_channels(const ChannelList& channels) {
  Writer list;
  for (auto c = channels.begin(); c != channels.end(); ++c) {
    list.text(c.name());
    list.number(static_cast<std::int32_t>(c.channel().type));
    list.number(std::int32_t{0});  // not linear, reserved
    list.number(std::int32_t{1});
    list.number(std::int32_t{1});
  }
  list.bytes.push_back('\0');
  return list.bytes;
}

std::string packed_box(const Imath::Box2i& box) {
  return packed(box.min.x, box.min.y, box.max.x, box.max.y);
}

std::string packed_header(const Header& header, bool several) {
  Writer writer;
  for (const auto& [name, attribute] : header.attributes()) {
    if (const auto* text = std::get_if<StringAttribute>(&attribute))
      writer.attribute(name, "string", text->value());
    else
      writer.attribute(name, "int", packed(std::get<IntAttribute>(attribute).value()));
  }
  writer.attribute("channels", "chlist", packed_channels(header.channels()));
  writer.attribute("compression", "compression", std::string(1, '\0'));
  writer.attribute("dataWindow", "box2i", packed_box(header.dataWindow()));
  writer.attribute("displayWindow", "box2i", packed_box(header.displayWindow()));
  writer.attribute("lineOrder", "lineOrder", std::string(1, '\0'));
  writer.attribute("pixelAspectRatio", "float", packed(1.0f));
  writer.attribute("screenWindowCenter", "v2f", packed(0.0f, 0.0f));
  writer.attribute("screenWindowWidth", "float", packed(1.0f));
  if (several) {
    writer.attribute("name", "string", header.name());
    writer.attribute("type", "string", SCANLINEIMAGE);
    writer.attribute("chunkCount", "int", packed(row_count(header)));
  }
  writer.bytes.push_back('\0');
  return writer.bytes;
}

void write(OStream& stream, const std::string& bytes) {
  stream.write(bytes.data(), static_cast<int>(bytes.size()));
}

template <class T>
T read(IStream& stream) {
  T value;
  stream.read(reinterpret_cast<char*>(&value), sizeof(T));
  return value;
}

std::string read_text(IStream& stream) {
  std::string text;
  while (const char c = read<char>(stream)) text += c;
  return text;
}

ChannelList read_channels(IStream& stream) {
  ChannelList channels;
  for (std::string name = read_text(stream); !name.empty(); name = read_text(stream)) {
    const auto type = read<std::int32_t>(stream);
    if (type < 0 || type > FLOAT) throw Iex::InputExc("unknown type of a channel");
    Channel channel(static_cast<PixelType>(type));
    read<std::int32_t>(stream);
    channel.xSampling = read<std::int32_t>(stream);
    channel.ySampling = read<std::int32_t>(stream);
    channels.insert(name, channel);
  }
  return channels;
}

Imath::Box2i read_box(IStream& stream) {
  Imath::Box2i box;
  for (int* side : {&box.min.x, &box.min.y, &box.max.x, &box.max.y}) *side = read<std::int32_t>(stream);
  return box;
}

template <class T>
void copy_in(char* to, T value) {
  std::memcpy(to, &value, sizeof(T));
}

template <class T>
T copy_out(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

}  // namespace

void StdOSStream::write(const char source[], int count) {
  const auto n = static_cast<std::size_t>(count);
  if (at_ + n > bytes_.size()) bytes_.resize(at_ + n);
  std::memcpy(bytes_.data() + at_, source, n);
  at_ += n;
}

MultiPartOutputFile::MultiPartOutputFile(OStream& stream, const Header* headers, int parts, bool, int)
    : stream_(stream), headers_(headers, headers + parts), several_(parts > 1 || !headers[0].name().empty()) {
  Writer head;
  head.number(kMagic);
  head.number(kVersion | (several_ ? kSeveralParts : 0));
  for (const Header& header : headers_) head.bytes += packed_header(header, several_);
  if (several_) head.bytes.push_back('\0');
  write(stream_, head.bytes);
  // The sizes of rows give their places: parts follow each other.
  std::uint64_t at = stream_.tellp();
  for (const Header& header : headers_) at += 8 * static_cast<std::uint64_t>(row_count(header));
  for (std::size_t part = 0; part < headers_.size(); ++part) {
    offset_tables_.push_back(at);
    Writer table;
    const std::uint64_t chunk = row_bytes(headers_[part]) + (several_ ? 12 : 8);
    for (int y = 0; y < row_count(headers_[part]); ++y, at += chunk) table.number(at);
    write(stream_, table.bytes);
  }
}

void MultiPartOutputFile::write_pixels(int part, const FrameBuffer& frame) {
  const Header& header = headers_[static_cast<std::size_t>(part)];
  stream_.seekp(offset_tables_[static_cast<std::size_t>(part)]);
  for (int y = 0; y < row_count(header); ++y) {
    Writer chunk;
    if (several_) chunk.number(static_cast<std::int32_t>(part));
    chunk.number(static_cast<std::int32_t>(y));
    chunk.number(static_cast<std::int32_t>(row_bytes(header)));
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      const Slice& slice = frame.slices().at(c.name());
      for (int x = 0; x <= header.dataWindow().max.x; ++x)
        chunk.bytes.append(slice.base + static_cast<std::size_t>(x) * slice.xStride +
                               static_cast<std::size_t>(y) * slice.yStride,
                           bytes_of(slice.type));
    }
    write(stream_, chunk.bytes);
  }
}

MultiPartInputFile::MultiPartInputFile(IStream& stream, int) : stream_(stream) {
  if (read<std::uint32_t>(stream_) != kMagic) throw Iex::InputExc("not an OpenEXR file");
  const auto version = read<std::uint32_t>(stream_);
  if ((version & ~(kSeveralParts | kLongNames)) != kVersion) throw Iex::InputExc("not flat scan lines");
  several_ = (version & kSeveralParts) != 0;
  while (read_header(several_) && several_) {
  }
  for (const Header& header : headers_) {
    if (row_count(header) < 1 || row_count(header) > kMaxRows) throw Iex::InputExc("a window too large");
    auto& rows = rows_.emplace_back(static_cast<std::size_t>(row_count(header)));
    for (std::uint64_t& row : rows) row = read<std::uint64_t>(stream_);
  }
}

bool MultiPartInputFile::read_header(bool several) {
  Header header;
  std::string name = read_text(stream_);
  if (several && name.empty()) return false;
  for (; !name.empty(); name = read_text(stream_)) {
    const std::string type = read_text(stream_);
    const auto size = read<std::int32_t>(stream_);
    if (size < 0) throw Iex::InputExc("an attribute of negative size");
    const std::uint64_t end = stream_.tellg() + static_cast<std::uint64_t>(size);
    if (type == "chlist") {
      header.channels() = read_channels(stream_);
    } else if (type == "box2i") {
      (name == "dataWindow" ? header.dataWindow() : header.displayWindow()) = read_box(stream_);
    } else if (type == "compression") {
      header.compression() = static_cast<Compression>(read<char>(stream_));
    } else if (type == "string") {
      std::string text(static_cast<std::size_t>(size), '\0');
      stream_.read(text.data(), size);
      if (name == "name") header.setName(text);
      header.insert(name, StringAttribute(std::move(text)));
    }
    stream_.seekg(end);
  }
  headers_.push_back(std::move(header));
  return true;
}

void MultiPartInputFile::read_pixels(int part, const FrameBuffer& frame) {
  const auto p = static_cast<std::size_t>(part);
  const Header& header = headers_.at(p);
  std::string row(row_bytes(header), '\0');
  for (const std::uint64_t at : rows_[p]) {
    stream_.seekg(at);
    if (several_ && read<std::int32_t>(stream_) != part) throw Iex::InputExc("a row of another part");
    const auto y = read<std::int32_t>(stream_);
    if (y < 0 || y >= row_count(header)) throw Iex::InputExc("a row outside the window");
    if (read<std::int32_t>(stream_) != static_cast<std::int32_t>(row.size()))
      throw Iex::InputExc("a row of another size");
    stream_.read(row.data(), static_cast<int>(row.size()));
    const char* from = row.data();
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
      const Slice& slice = frame.slices().at(c.name());
      const std::size_t size = bytes_of(c.channel().type);
      for (int x = 0; x <= header.dataWindow().max.x; ++x, from += size) {
        Imath::half half;
        if (c.channel().type == HALF) half.setBits(copy_out<std::uint16_t>(from));
        copy_in(slice.base + static_cast<std::size_t>(x) * slice.xStride +
                    static_cast<std::size_t>(y) * slice.yStride,
                c.channel().type == HALF ? static_cast<float>(half) : copy_out<float>(from));
      }
    }
  }
}

}  // namespace Imf
