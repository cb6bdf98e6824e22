// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/file.h>
#include <burnish/io/slice_image.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

TEST(SliceImage, ShowsEveryEntryAtItsPlace) {
  HalfDiffTable table{3, 4, 5, false, 3, {}};
  for (int i = 0; i < 3 * 4 * 5 * 3; ++i) table.values.push_back(static_cast<float>(i));
  const float hole = std::numeric_limits<float>::quiet_NaN();
  const std::size_t gap = table.offset(1, 2, 3);
  for (std::size_t c = 0; c < 3; ++c) table.values[gap + c] = hole;

  const TemporaryFolder folder("slices");
  const auto path = folder.path / "slices.exr";
  write_then_rename(path, format_slice_image(table));
  Imf::InputFile file(path.c_str());
  // The picture has 3 slices across and 2 down.
  ASSERT_EQ(file.header().dataWindow().max.x, 11);
  ASSERT_EQ(file.header().dataWindow().max.y, 5);
  std::vector<float> green(12 * 6), alpha(12 * 6);
  Imf::FrameBuffer frame;
  frame.insert("G", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(green.data()), 4, 48));
  frame.insert("A", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(alpha.data()), 4, 48));
  file.setFrameBuffer(frame);
  file.readPixels(0, 5);
  for (int p = 0; p < 5; ++p)
    for (int h = 0; h < 3; ++h)
      for (int d = 0; d < 4; ++d) {
        const auto pixel = static_cast<std::size_t>((p / 3 * 3 + h) * 12 + p % 3 * 4 + d);
        const bool is_hole = table.offset(h, d, p) == gap;
        EXPECT_EQ(green[pixel], is_hole ? 0 : table.values[table.offset(h, d, p) + 1]);
        EXPECT_EQ(alpha[pixel], is_hole ? 0 : 1);
      }
  EXPECT_EQ(alpha.back(), 0);  // the sixth place is empty
}

TEST(SliceImage, RefusesSpectra) {
  EXPECT_THROW(format_slice_image(HalfDiffTable{1, 1, 1, false, 2, {1, 2}}), Error);
}

}  // namespace
}  // namespace burnish
