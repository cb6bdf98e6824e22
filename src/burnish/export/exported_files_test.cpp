// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <burnish/error.h>
#include <burnish/export/exported_files.h>
#include <burnish/shaders/frame_function.h>

namespace burnish {
namespace {

TEST(ExportTarget, RoundTripsThroughItsName) {
  for (const std::string_view name : export_target_names()) EXPECT_EQ(to_string(export_target(name)), name);
  EXPECT_THROW(export_target("fbx"), Error);
  EXPECT_THROW(export_target(""), Error);
}

TEST(ExportTarget, OfAShaderHasTheLanguageOfItsName) {
  std::size_t languages = 0;
  for (const std::string_view name : export_target_names())
    if (const auto language = language_of(export_target(name))) {
      EXPECT_EQ(to_string(*language), name);
      ++languages;
    }
  EXPECT_EQ(languages, kShaderLanguages.size());
}

TEST(ExportName, IsAnIdentifierOfWhateverText) {
  for (const char* text : {"", "paint", "9 lives", "__a__b__", "\xc3\xa9t\xc3\xa9", "../../etc", "a-b.c"})
    EXPECT_TRUE(is_identifier(export_name(text))) << text << " became " << export_name(text);
  EXPECT_EQ(export_name("paint"), "paint");
  EXPECT_EQ(export_name("..."), "brdf");
}

}  // namespace
}  // namespace burnish
