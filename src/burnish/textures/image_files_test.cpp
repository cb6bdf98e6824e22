// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStdIO.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/image/png.h>
#include <burnish/math/random.h>
#include <burnish/textures/image_files.h>

namespace burnish {
namespace {

Table random_table(TableFormat format, std::size_t channels) {
  Pcg32 random(3);
  Table table{.name = "t",
              .layout = {.shape = TableShape::grid, .width = 7, .height = 5},
              .channels = channels,
              .values = {},
              .format = format};
  for (std::size_t i = 0; i < table.layout.node_count() * channels; ++i)
    table.values.push_back(static_cast<float>(random.uniform()));
  table.values = round_to_format(format, channels, table.values);
  return table;
}

TEST(ImageFiles, ExrHoldsEveryFormatToTheLastBit) {
  for (const TableFormat format :
       {TableFormat::half, TableFormat::single, TableFormat::rgb9e5, TableFormat::unorm8})
    for (const std::size_t channels : {1, 3}) {
      if (format == TableFormat::rgb9e5 && channels == 1) continue;
      const Table table = random_table(format, channels);
      Imf::StdISStream stream;
      stream.str(encode_exr(table));
      Imf::InputFile file(stream);
      ASSERT_EQ(file.header().dataWindow().max.x, 6);
      ASSERT_EQ(file.header().dataWindow().max.y, 4);
      std::vector<float> values(table.values.size());
      Imf::FrameBuffer frame;
      const char* names[] = {"R", "G", "B"};
      const auto step = channels * sizeof(float);
      for (std::size_t c = 0; c < channels; ++c)
        frame.insert(channels == 1 ? "Y" : names[c],
                     Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data() + c), step, 7 * step));
      file.setFrameBuffer(frame);
      file.readPixels(0, 4);
      EXPECT_EQ(values, table.values);
    }
}

TEST(ImageFiles, PngIsWithinHalfAStep) {
  for (const std::size_t channels : {1, 3}) {
    const Table table = random_table(TableFormat::single, channels);
    const Image8 image = decode_png(encode_png_table(table), "table");
    ASSERT_EQ(image.width, 7);
    ASSERT_EQ(image.height, 5);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      EXPECT_NEAR(image.pixels[i] / 255.0, table.values[channels == 1 ? i / 3 : i], 1 / 510.0 + 1e-9);
  }
}

TEST(ImageFiles, HaveOneOrThreeChannels) {
  EXPECT_THROW(encode_exr(random_table(TableFormat::half, 2)), Error);
  EXPECT_THROW(encode_png_table(random_table(TableFormat::half, 2)), Error);
}

}  // namespace
}  // namespace burnish
