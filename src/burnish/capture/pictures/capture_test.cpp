// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <burnish/capture/pictures/capture.h>
#include <burnish/capture/pictures/picture_rows.h>
#include <burnish/error.h>
#include <burnish/image/png.h>
#include <burnish/math/parallel.h>
#include <burnish/math/random.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr int kWidth = 6, kHeight = 5;

Image picture(int width, int height, float first) {
  Image image(width, height, 3);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = first + 0.25f * static_cast<float>(i % 7);
  return image;
}

/// Five pictures under directional lights, whose form `change` alters.
struct Folder {
  TemporaryFolder folder;
  CaptureForm form{.width = kWidth, .height = kHeight, .normals = {}, .pictures = {}};

  explicit Folder(const std::string& name, int count = 5) : folder("capture_" + name) {
    for (int p = 0; p < count; ++p) {
      form.pictures.push_back({.file = std::to_string(p) + ".exr",
                               .light = {.at = normalize({0.1 * p, 0, 1})},
                               .view = {},
                               .mask = {}});
      write(folder.path / form.pictures.back().file,
            encode_half_exr(picture(kWidth, kHeight, static_cast<float>(p))));
    }
    save();
  }
  void save() const { write(folder.path / "capture.json", format_capture(form)); }
  fs::path file(const std::string& name) const { return folder.path / name; }
};

TEST(CaptureForm, IsWhatItWasWritten) {
  const CaptureForm form = parse_capture(memory_file(seeds::kCapture));
  EXPECT_EQ(form.width, 4);
  EXPECT_EQ(form.size_y, 0.15);
  EXPECT_EQ(form.transfer, Transfer::srgb);
  EXPECT_EQ(form.clip, 0.99);
  ASSERT_EQ(form.pictures.size(), 2u);
  EXPECT_EQ(form.pictures[0].scale, Rgb(1, 2, 3));
  EXPECT_EQ(form.pictures[0].mask, "m.png");
  EXPECT_FALSE(form.pictures[0].view.is_direction);
  EXPECT_TRUE(form.pictures[1].held_out);
  EXPECT_FALSE(form.directional());
  EXPECT_EQ(parse_capture(memory_file(format_capture(form))), form);
}

TEST(CaptureForm, RefusesWhatCannotBe) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = seeds::kCapture;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
  };
  const std::pair<const char*, const char*> lies[] = {
      {"\"version\":1", "\"version\":2"},
      {"\"width\":4", "\"width\":-4"},
      {"\"width\":4", "\"width\":1e9"},
      {"\"width\":4", "\"width\":4.5"},
      {"\"height\":3", "\"height\":\"3\""},
      {"[0.2,0.15]", "[0.2]"},
      {"[0.2,0.15]", "[0,1]"},
      {"\"srgb\"", "\"film\""},
      {"\"clip\":0.99", "\"clip\":-1"},
      {"[0,0.6,0.8]", "[0,0.6,0.9]"},
      {"[0,0.6,0.8]", "[0,0.6,-0.8]"},
      {"[0,0.6,0.8]", "[0,1,0]"},
      {"[0,0.6,0.8]", "[0,0.6,null]"},
      {"[0,0,2.5]", "[0,0,0]"},
      {"\"a.png\"", "\"../a.png\""},
      {"\"a.png\"", "\"/etc/passwd\""},
      {"\"a.png\"", "\"\""},
      {"\"b.png\"", "\"a.png\""},
      {"[1,2,3]", "[1,2,0]"},
      {"\"held_out\":true", "\"held_out\":1"},
      {"\"pictures\":[", "\"pictures\":{},\"others\":["},
  };
  for (const auto& [from, to] : lies)
    EXPECT_THAT([&] { parse_capture(memory_file(with(from, to))); },
                ThrowsMessage<Error>(testing::AllOf(HasSubstr("test.file"), HasSubstr("expected"))))
        << to;
}

TEST(CaptureForm, SaysOneNumberWhereThereIsOne) {
  const auto said = [](const char* text) { return error_of([&] { parse_capture(memory_file(text)); }); };
  EXPECT_EQ(said("[]"), "test.file: expected an object, found []");
  EXPECT_EQ(said(R"({"version":2})"), "test.file: expected version: 1, found 2");
  EXPECT_EQ(said(R"({"version":1.0})"), "test.file: expected version: 1, found 1.0");
  EXPECT_EQ(said(R"({"version":1,"width":1,"height":1,"size":[1]})"),
            "test.file: expected size: a list of 2, found [1]");
  EXPECT_EQ(said(R"({"version":1,"width":0})"),
            "test.file: expected width: a number from 1 to 16384, found 0");
}

TEST(CaptureForm, NamesMembersThatItDoesNotKnow) {
  const auto said = [](const std::string& from, const std::string& to) {
    std::string text = seeds::kCapture;
    text.replace(text.find(from), from.size(), to);
    return error_of([&] { parse_capture(memory_file(text)); });
  };
  EXPECT_EQ(
      said("\"height\":3", "\"heigth\":3"),
      "test.file: expected one of version, width, height, size, transfer, clip, normals, pictures, found "
      "'heigth'; did you mean 'height'?");
  EXPECT_EQ(
      said("held_out", "held_uot"),
      "test.file: pictures[1]: expected one of file, light, view, scale, mask, held_out, found 'held_uot'; "
      "did you mean 'held_out'?");
  EXPECT_EQ(said("\"position\":[0,0,2.5]", "\"position\":[0,0,2.5],\"x\":1"),
            "test.file: pictures[0].view: expected one of direction, position, found 'x'");
  EXPECT_EQ(said("{\"version\":1,", "{\"_camera\":{\"by\":\"me\"},\"version\":1,"), "");
  EXPECT_EQ(said("\"scale\":0.5", "\"scale\":0.5,\"_\":\"dim\""), "");
}

TEST(CaptureForm, TruncatedTextThrows) {
  for (std::size_t length = 0; length < seeds::kCapture.size(); ++length)
    EXPECT_THROW(parse_capture(memory_file(seeds::kCapture.substr(0, length))), Error) << length;
  EXPECT_THROW(parse_capture(memory_file(std::string(100'000, '['))), Error);
}

TEST(Capture, ReadsRowsAsTheyAre) {
  const Folder folder("rows");
  const Capture capture(folder.folder.path);
  EXPECT_TRUE(capture.left_out().empty());
  const Capture::Read all = capture.read(0, kHeight), some = capture.read(2, 2);
  ASSERT_TRUE(all.damaged.empty());
  for (std::size_t p = 0; p < 5; ++p)
    for (std::size_t i = 0; i < 2 * kWidth * 3; ++i) {
      const float value = some.rows.values[p * 2 * kWidth * 3 + i];
      EXPECT_EQ(value, all.rows.values[(p * kHeight + 2) * kWidth * 3 + i]);
      EXPECT_EQ(value, static_cast<float>(p) + 0.25f * static_cast<float>((2 * kWidth * 3 + i) % 7));
    }
}

TEST(Capture, TakesScaleDistanceClipAndMaskIntoAccount) {
  Folder folder("radiometry");
  folder.form.clip = 4.2;
  folder.form.pictures[1].scale = {2, 3, 4};
  folder.form.pictures[2].light = {.is_direction = false, .at = {0, 0, 2}};
  folder.form.pictures[3].mask = "mask.png";
  Image8 mask(kWidth, kHeight, 3);
  for (std::size_t i = 0; i < mask.pixels.size(); ++i) mask.pixels[i] = i / 3 % 2 == 0 ? 255 : 0;
  write_png(folder.file("mask.png"), mask);
  folder.save();
  const Capture capture(folder.folder.path);
  const CaptureRows rows = capture.read(0, kHeight).rows;
  constexpr std::size_t kPixels = kWidth * kHeight;
  EXPECT_EQ(rows.values[3 * kPixels + 1], 3 * 1.25f);
  const Vec3 corner = capture.form().point(0, 0);
  EXPECT_NEAR(rows.values[2 * 3 * kPixels], 2 * (4 + dot(corner, corner)), 1e-5);
  EXPECT_EQ(rows.states[3 * kPixels], PixelState::there);
  EXPECT_EQ(rows.states[3 * kPixels + 1], PixelState::masked);
  const PixelState clipped = rows.states[4 * kPixels];  // 4, 4.25 and 4.5
  EXPECT_TRUE(is_clipped(clipped) && is_there(clipped));
  EXPECT_FALSE(is_clipped(clipped, 0)) << "a channel below";
  EXPECT_TRUE(is_clipped(clipped, 1) && is_clipped(clipped, 2));
}

TEST(Capture, ReadsPngOfEightBits) {
  Folder folder("png");
  Image8 grey(kWidth, kHeight, 3);
  std::ranges::fill(grey.pixels, std::uint8_t{188});
  write_png(folder.file("0.exr"), grey);  // a PNG is recognized by its content
  for (const Transfer transfer : {Transfer::linear, Transfer::srgb}) {
    folder.form.transfer = transfer;
    folder.save();
    const CaptureRows rows = Capture(folder.folder.path).read(1, 1).rows;
    EXPECT_NEAR(rows.values[0], transfer == Transfer::linear ? 188 / 255.0 : 0.5029, 1e-4);
  }
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(value >> shift & 0xff);
  return bytes;
}

std::string png_chunk(const std::string& type, const std::string& content) {
  std::uint32_t sum = 0xffffffff;
  for (const char c : type + content) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320 : 0);
  }
  return big_endian(static_cast<std::uint32_t>(content.size())) + type + content + big_endian(~sum);
}

/// A PNG in which all pixels have one grey, in 8 or 16 bits, with these chunks.
std::string grey_png(double grey, bool wide, const std::string& chunks) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = kWidth;
  image.height = kHeight;
  image.format = wide ? PNG_FORMAT_LINEAR_RGB : PNG_FORMAT_RGB;
  constexpr std::size_t kCount = 3 * kWidth * kHeight;
  const std::vector<std::uint16_t> words(kCount, static_cast<std::uint16_t>(std::lround(65535 * grey)));
  const std::vector<std::uint8_t> bytes(kCount, static_cast<std::uint8_t>(std::lround(255 * grey)));
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);
  std::string png(size, '\0');
  EXPECT_TRUE(png_image_write_to_memory(&image, png.data(), &size, 0,
                                        wide ? static_cast<const void*>(words.data()) : bytes.data(), 0,
                                        nullptr));
  png.resize(size);
  // The file has the header, these chunks, then the data, without the writer's own chunks.
  constexpr std::size_t kHeader = 8 + 25;
  return png.substr(0, kHeader) + chunks + png.substr(png.find("IDAT") - 4);
}

// "transfer" alone decides how numbers are read. A chunk that contradicts it is reported.
TEST(Capture, TakesNumbersOfPngAsTransferSaysWhateverTheirChunksSay) {
  const std::string none,
      linear = png_chunk("gAMA", big_endian(100'000)), srgb = png_chunk("sRGB", std::string(1, '\0')),
      gamma = png_chunk("gAMA", big_endian(45'455)), other = png_chunk("gAMA", big_endian(55'556));
  for (const bool wide : {false, true})
    for (const Transfer transfer : {Transfer::linear, Transfer::srgb})
      for (const std::string& chunks : {none, linear, srgb, gamma, other, srgb + gamma}) {
        Folder folder("chunks");
        write(folder.file("0.exr"), grey_png(0.6, wide, chunks));
        folder.form.transfer = transfer;
        folder.save();
        const Capture capture(folder.folder.path);
        EXPECT_TRUE(capture.left_out().empty());
        EXPECT_NEAR(capture.read(1, 1).rows.values[0], transfer == Transfer::linear ? 0.6 : 0.3185, 1e-4);
        const bool agrees = chunks == none || (chunks == linear) == (transfer == Transfer::linear);
        if (chunks == other || !agrees)
          EXPECT_THAT(capture.disagreement(), HasSubstr("a chunk of 1 of 5 pictures (0.exr first)"));
        else
          EXPECT_EQ(capture.disagreement(), "");
      }
}

// A file that is missing, has another size, is no picture, or is cut in its header is left out and reported.
TEST(Capture, LeavesDamagedPicturesOut) {
  Folder folder("damaged", 9);
  fs::remove(folder.file("0.exr"));
  write(folder.file("1.exr"), encode_half_exr(picture(kWidth + 1, kHeight, 0)));
  write(folder.file("2.exr"), "no picture at all, whatever its name says");
  write(folder.file("3.exr"), read(folder.file("4.exr")).substr(0, 60));
  Capture capture(folder.folder.path);
  EXPECT_EQ(capture.form().pictures.size(), 5u);
  ASSERT_EQ(capture.left_out().size(), 4u);
  EXPECT_EQ(capture.left_out()[1].file, "1.exr");
  EXPECT_THAT(capture.left_out()[1].why, HasSubstr("7 x 5"));

  // A picture whose pixels are cut off is noticed when they are read.
  const std::string whole = read(folder.file("5.exr"));
  write(folder.file("5.exr"), whole.substr(0, whole.size() - 60));
  EXPECT_TRUE(capture.read(0, 2).damaged.empty());
  const Capture::Read cut = capture.read(3, 2);
  ASSERT_EQ(cut.damaged.size(), 1u);
  EXPECT_EQ(cut.damaged.front().file, "5.exr");
  capture.leave_out(cut.damaged);
  EXPECT_EQ(capture.form().pictures.size(), 4u);
  EXPECT_THROW(capture.leave_out({{"6.exr", "a reason"}}), Error);  // too few are left
}

TEST(Capture, CountsPixelsThatAreNoNumbersAsMissing) {
  Folder folder("nan");
  Image image = picture(kWidth, kHeight, 1);
  image.at(1, 0)[2] = NAN;
  image.at(2, 0)[0] = INFINITY;
  image.at(3, 0)[0] = -3;
  image.at(4, 0)[0] = -0.01f;
  std::string bytes = encode_half_exr(image);
  write(folder.file("0.exr"), bytes);
  const CaptureRows rows = Capture(folder.folder.path).read(0, 1).rows;
  EXPECT_EQ(rows.states[0], PixelState::there);
  EXPECT_EQ(rows.states[1], PixelState::missing);
  EXPECT_EQ(rows.states[3], PixelState::missing);
  EXPECT_EQ(rows.states[4], PixelState::there);
  for (const float value : rows.values) EXPECT_TRUE(std::isfinite(value));
}

// The fingerprint changes if any file of the capture is replaced, written again, or removed.
TEST(Capture, IsAnotherOnceAFileOfItWasReplaced) {
  Folder folder("fingerprint", 6);
  folder.form.pictures[1].mask = "mask.png";
  folder.form.normals = "n.exr";
  Image8 mask(kWidth, kHeight, 3);
  write_png(folder.file("mask.png"), mask);
  write(folder.file("n.exr"), read(folder.file("0.exr")));
  folder.save();
  const auto fingerprint = [&] { return Capture(folder.folder.path).fingerprint(); };
  std::uint64_t before = fingerprint();
  EXPECT_EQ(fingerprint(), before);
  const auto is_another = [&] {
    const std::uint64_t now = fingerprint();
    const bool changed = now != before;
    before = now;
    return changed;
  };
  for (const char* name : {"2.exr", "mask.png", "n.exr"}) {
    const auto time = fs::last_write_time(folder.file(name));
    fs::last_write_time(folder.file(name), time + std::chrono::seconds(2));
    EXPECT_TRUE(is_another()) << name << " written again";
    write(folder.file(name), read(folder.file(name)) + "more");
    fs::last_write_time(folder.file(name), time + std::chrono::seconds(2));
    EXPECT_TRUE(is_another()) << name << " of another size";
    fs::remove(folder.file(name));
    EXPECT_TRUE(is_another()) << name << " missing";
  }
  EXPECT_FALSE(is_another());
}

TEST(Capture, SaysOneLineWithoutAFolderOrJson) {
  EXPECT_THAT([] { Capture("/nowhere/at/all"); }, ThrowsMessage<Error>(HasSubstr("capture.json")));
}

TEST(Capture, NormalsAreUnitVectors) {
  Folder folder("normals");
  folder.form.normals = "n.exr";
  folder.save();
  Image normals(kWidth, kHeight, 3);
  for (int i = 0; i < kWidth * kHeight; ++i) {
    normals.pixels[static_cast<std::size_t>(3 * i)] = 0.6f;
    normals.pixels[static_cast<std::size_t>(3 * i + 2)] = 0.8f;
  }
  write(folder.file("n.exr"), encode_half_exr(normals));
  const std::vector<float> found = Capture(folder.folder.path).normals();
  ASSERT_EQ(found.size(), 2u * kWidth * kHeight);
  EXPECT_NEAR(found[0], 0.6, 1e-3);
  write(folder.file("n.exr"), encode_half_exr(picture(kWidth, kHeight, 0)));
  EXPECT_THROW(Capture(folder.folder.path).normals(), Error);
}

// A picture with any damaged bytes is read, or left out with a reason; no other exception leaves the reader.
TEST(Capture, AnyDamagedPictureIsLeftOutOrRead) {
  const Folder folder("hostile");
  const fs::path path = folder.file("0.exr");
  const std::string exr = read(path), png = encode_png(Image8(kWidth, kHeight, 3));
  for (const std::string& good : {exr, png})
    for (std::size_t at = 0; at < std::min<std::size_t>(good.size(), 420); ++at)
      for (const char damage : {'\0', '\xff', 'n'}) {
        std::string bytes = good;
        bytes[at] = damage;
        write(path, bytes);
        try {
          if (picture_size(path).width != kWidth) continue;
          read_picture_rows(path, 1, 2, false);
        } catch (const Error& error) {
          EXPECT_THAT(error.what(), HasSubstr("expected")) << at;
        }
      }
}

TEST(PictureRows, RefuseRowsOutside) {
  const Folder folder("outside");
  EXPECT_THROW(read_picture_rows(folder.file("0.exr"), 3, 3, false), Error);
  EXPECT_THROW(read_picture_rows(folder.file("0.exr"), -1, 2, false), Error);
}

}  // namespace
}  // namespace burnish
