// SPDX-License-Identifier: Apache-2.0
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <burnish/io/convert.h>
#include <burnish/io/formats.h>
#include <burnish/io/open_source.h>
#include <burnish/testing/files.h>
#include <burnish/testing/seed_files.h>

namespace burnish {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// Expects that a file looks like this format first, among those recognized in the same way. It may look like no
/// other of them unless they are recognized by columns.
void expect_only(const Format& expected, const FileBytes& file) {
  std::vector<std::string_view> titles;
  for (const Format& format : formats())
    if (format.is_read() && format.told == expected.told && format.looks_like(file))
      titles.push_back(format.title);
  ASSERT_FALSE(titles.empty()) << expected.title;
  EXPECT_EQ(titles.front(), expected.title);
  EXPECT_TRUE(titles.size() == 1 || expected.told == Told::by_columns) << expected.title;
}

TEST(Formats, HaveRowsThatHoldTogether) {
  std::set<std::string_view> titles, names;
  for (const Format& format : formats()) {
    EXPECT_TRUE(titles.insert(format.title).second) << format.title;
    EXPECT_FALSE(format.holds.empty()) << format.title;
    EXPECT_TRUE(format.is_read() || format.is_written()) << format.title;
    EXPECT_EQ(format.looks_like == nullptr, format.parse == nullptr) << format.title;
    EXPECT_EQ(format.write == nullptr, format.to.empty()) << format.title;
    if (format.write) {
      EXPECT_TRUE(names.insert(format.to).second) << format.title;
    }
    for (const std::string& ending : endings_of(format)) EXPECT_TRUE(ending.starts_with('.')) << ending;
    for (const bool option : {format.takes_cells, format.takes_count, format.takes_notes, format.keeps_name,
                              format.keeps_comments, format.keeps_origin, format.entries_first})
      EXPECT_TRUE(!option || format.write) << format.title << " has options of what is written";
  }
  EXPECT_EQ(convert_formats().size(), names.size());
}

TEST(Formats, AreFoundByNameAndEnding) {
  EXPECT_EQ(format_to("zemax")->title, "Zemax");
  EXPECT_EQ(format_to(""), nullptr) << "those that nothing writes have no name";
  EXPECT_EQ(format_to("fred"), nullptr);
  EXPECT_EQ(format_ending_in(".bsdf")->to, "rgl") << "the first of those that end alike";
  EXPECT_EQ(format_ending_in(".exr")->to, "exr");
  EXPECT_EQ(format_ending_in(".dat"), nullptr) << "not written";
  EXPECT_EQ(format_ending_in(".txt"), nullptr) << "no format's first ending";
  EXPECT_EQ(format_ending_in(""), nullptr);
  EXPECT_THAT(endings_of(*format_to("csv")), ElementsAre(".csv", ".txt"));
  EXPECT_THAT(endings_of(*format_to("openmaterial")), ElementsAre(".xompt", ".json"));
  for (const std::string_view ending : naming_endings()) {
    ASSERT_NE(format_ending_in(ending), nullptr) << ending;
    EXPECT_EQ(endings_of(*format_ending_in(ending)).front(), ending);
  }
}

TEST(Formats, LookLikeNoOther) {
  for (const auto& [name, bytes] : seeds::all_seeds()) {
    const FileBytes file = memory_file(bytes);
    const Format* binary = binary_format_of(file);
    const Format* format = binary ? binary : text_format_of(file);
    ASSERT_NE(format, nullptr) << name;
    expect_only(*format, file);
    EXPECT_FALSE(parse_source(file, {}).findings.format.empty()) << name;
  }
}

TEST(Formats, HaveASmallFileEach) {
  std::set<std::string_view> with_seed;
  for (const auto& [name, bytes] : seeds::all_seeds()) {
    const FileBytes file = memory_file(bytes);
    const Format* binary = binary_format_of(file);
    with_seed.insert((binary ? binary : text_format_of(file))->title);
  }
  // UTIA's files are large; the other formats here are no BRDF by themselves.
  const std::set<std::string_view> tried_apart{"UTIA", "surface", "book of a library",
                                               "Neural Processes codes"};
  for (const Format& format : formats())
    if (format.is_read() && !tried_apart.contains(format.title)) {
      EXPECT_TRUE(with_seed.contains(format.title)) << format.title;
    }
}

TEST(Formats, ReadWhatTheyWrite) {
  const Source analytic = open_source("ggx:alpha_x=0.3,alpha_y=0.3", {});
  const Source model = parse_source(memory_file(seeds::model_seed()), {});
  for (const std::string_view name : convert_formats()) {
    const Format& format = *format_to(name);
    const bool of_models = name == "model" || name == "burnish";
    const Converted converted = convert(of_models ? model : analytic, name, {.count = 200, .cells = 8});
    const FileBytes file = memory_file(converted.bytes);
    if (!format.is_read()) continue;
    expect_only(format, file);
  }
  EXPECT_THAT(error_of([&] { convert(analytic, "fred"); }), HasSubstr("expected one of merl, utia, rgl,"));
}

}  // namespace
}  // namespace burnish
