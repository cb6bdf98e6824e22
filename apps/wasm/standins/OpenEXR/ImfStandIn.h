// SPDX-License-Identifier: Apache-2.0
#pragma once

// These classes stand in for OpenEXR. They have the part that writes models, tables and slices, and reads models. Parts
// are flat scan-line parts, never compressed, of halves and floats. Windows begin at the origin.
// Source: [OpenEXR], file layout.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include <Imath/ImathBox.h>
#include <Imath/half.h>

namespace Iex {
struct InputExc : std::runtime_error {
  using std::runtime_error::runtime_error;
};
}  // namespace Iex

namespace Imf {

enum PixelType { UINT, HALF, FLOAT };
enum Compression { NO_COMPRESSION, RLE_COMPRESSION, ZIPS_COMPRESSION, ZIP_COMPRESSION };
inline constexpr const char* SCANLINEIMAGE = "scanlineimage";

class IStream {
 public:
  explicit IStream(const char*) {}
  virtual ~IStream() = default;
  virtual bool read(char target[], int count) = 0;
  virtual std::uint64_t tellg() = 0;
  virtual void seekg(std::uint64_t at) = 0;
};

class OStream {
 public:
  explicit OStream(const char*) {}
  virtual ~OStream() = default;
  virtual void write(const char source[], int count) = 0;
  virtual std::uint64_t tellp() = 0;
  virtual void seekp(std::uint64_t at) = 0;
};

class StdOSStream : public OStream {
 public:
  StdOSStream() : OStream("") {}
  void write(const char source[], int count) override;
  std::uint64_t tellp() override { return at_; }
  void seekp(std::uint64_t at) override { at_ = at; }
  std::string str() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

struct Channel {
  explicit Channel(PixelType t = HALF) : type(t) {}
  PixelType type;
  int xSampling = 1, ySampling = 1;
};

class ChannelList {
 public:
  using Map = std::map<std::string, Channel>;
  class ConstIterator {
   public:
    explicit ConstIterator(Map::const_iterator at) : at_(at) {}
    const Channel& channel() const { return at_->second; }
    const char* name() const { return at_->first.c_str(); }
    ConstIterator& operator++() {
      ++at_;
      return *this;
    }
    bool operator==(const ConstIterator&) const = default;

   private:
    Map::const_iterator at_;
  };
  void insert(const std::string& name, const Channel& channel) { channels_[name] = channel; }
  const Channel* findChannel(const std::string& name) const {
    const auto found = channels_.find(name);
    return found == channels_.end() ? nullptr : &found->second;
  }
  ConstIterator begin() const { return ConstIterator(channels_.begin()); }
  ConstIterator end() const { return ConstIterator(channels_.end()); }

 private:
  Map channels_;
};

template <class T>
class TypedAttribute {
 public:
  explicit TypedAttribute(T value) : value_(std::move(value)) {}
  const T& value() const { return value_; }

 private:
  T value_;
};
using StringAttribute = TypedAttribute<std::string>;
using IntAttribute = TypedAttribute<int>;

class Header {
 public:
  Header() = default;
  Header(int width, int height)
      : Header(Imath::Box2i({0, 0}, {width - 1, height - 1}), Imath::Box2i({0, 0}, {width - 1, height - 1})) {
  }
  Header(const Imath::Box2i& display, const Imath::Box2i& data) : display_(display), data_(data) {}

  void setName(const std::string& name) { name_ = name; }
  const std::string& name() const { return name_; }
  void setType(const std::string&) {}
  /// Writing ignores this setting: nothing is compressed.
  Compression& compression() { return compression_; }
  const Compression& compression() const { return compression_; }
  ChannelList& channels() { return channels_; }
  const ChannelList& channels() const { return channels_; }
  const Imath::Box2i& displayWindow() const { return display_; }
  const Imath::Box2i& dataWindow() const { return data_; }
  Imath::Box2i& displayWindow() { return display_; }
  Imath::Box2i& dataWindow() { return data_; }

  template <class A>
  void insert(const std::string& name, const A& attribute) {
    attributes_.insert_or_assign(name, attribute);
  }
  template <class A>
  const A* findTypedAttribute(const std::string& name) const {
    const auto found = attributes_.find(name);
    return found == attributes_.end() ? nullptr : std::get_if<A>(&found->second);
  }
  const auto& attributes() const { return attributes_; }

 private:
  std::string name_;
  Imath::Box2i display_, data_;
  Compression compression_ = NO_COMPRESSION;
  ChannelList channels_;
  std::map<std::string, std::variant<StringAttribute, IntAttribute>> attributes_;
};

struct Slice {
  explicit Slice(PixelType t = HALF, char* b = nullptr, std::size_t x = 0, std::size_t y = 0)
      : type(t), base(b), xStride(x), yStride(y) {}
  PixelType type;
  char* base;
  std::size_t xStride, yStride;
};

class FrameBuffer {
 public:
  void insert(const std::string& name, const Slice& slice) { slices_[name] = slice; }
  const std::map<std::string, Slice>& slices() const { return slices_; }

 private:
  std::map<std::string, Slice> slices_;
};

class MultiPartOutputFile {
 public:
  MultiPartOutputFile(OStream& stream, const Header* headers, int parts, bool, int);

 private:
  friend class OutputPart;
  friend class OutputFile;
  void write_pixels(int part, const FrameBuffer& frame);
  OStream& stream_;
  std::vector<Header> headers_;
  std::vector<std::uint64_t> offset_tables_;
  bool several_;
};

class OutputPart {
 public:
  OutputPart(MultiPartOutputFile& file, int part) : file_(file), part_(part) {}
  void setFrameBuffer(const FrameBuffer& frame) { frame_ = frame; }
  /// Writes all rows, whatever the number.
  void writePixels(int) { file_.write_pixels(part_, frame_); }

 private:
  MultiPartOutputFile& file_;
  int part_;
  FrameBuffer frame_;
};

class OutputFile {
 public:
  OutputFile(OStream& stream, const Header& header, int = 0) : file_(stream, &header, 1, false, 0) {}
  void setFrameBuffer(const FrameBuffer& frame) { frame_ = frame; }
  void writePixels(int) { file_.write_pixels(0, frame_); }

 private:
  MultiPartOutputFile file_;
  FrameBuffer frame_;
};

class MultiPartInputFile {
 public:
  MultiPartInputFile(IStream& stream, int);
  int parts() const { return static_cast<int>(headers_.size()); }
  const Header& header(int part) const { return headers_.at(static_cast<std::size_t>(part)); }

 private:
  friend class InputPart;
  bool read_header(bool several);
  void read_pixels(int part, const FrameBuffer& frame);
  IStream& stream_;
  std::vector<Header> headers_;
  std::vector<std::vector<std::uint64_t>> rows_;  // their offsets in the file
  bool several_ = false;
};

class InputPart {
 public:
  InputPart(MultiPartInputFile& file, int part) : file_(file), part_(part) {}
  void setFrameBuffer(const FrameBuffer& frame) { frame_ = frame; }
  /// Reads all rows, whatever the range.
  void readPixels(int, int) { file_.read_pixels(part_, frame_); }

 private:
  MultiPartInputFile& file_;
  int part_;
  FrameBuffer frame_;
};

}  // namespace Imf
