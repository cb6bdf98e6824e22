// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <burnish/book/book_file.h>
#include <burnish/error.h>
#include <burnish/fitting/book/complete.h>
#include <burnish/fitting/book/make_book.h>
#include <burnish/fitting/fit.h>
#include <burnish/math/parallel.h>
#include <burnish/metrics/error_figures.h>
#include <burnish/reflectance/goniometer.h>
#include <burnish/testing/books.h>

namespace burnish {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr FigureOptions kQuick{.count = 2000, .image_size = 64};

// Gloss of several widths over several colours; `skipped` is left out.
std::vector<std::string> library(std::size_t skipped) {
  std::vector<std::string> specs;
  for (int width = 0; width < 4; ++width)
    for (int colour = 0; colour < 4; ++colour)
      specs.push_back(fmt::format("ggx:alpha_x={0},alpha_y={0},f0={1}/{2}/0.3", 0.15 + 0.08 * width,
                                  0.1 + 0.2 * colour, 0.8 - 0.15 * colour));
  if (skipped < specs.size()) specs.erase(specs.begin() + static_cast<std::ptrdiff_t>(skipped));
  return specs;
}

MaterialBook book_of(const std::vector<std::string>& specs, const BookOptions& options) {
  std::vector<BookMaterial> materials;
  for (const std::string& spec : specs)
    materials.push_back(book_material(analytic_source(spec), spec, book_sides(options), options.seed));
  return make_book(book_sides(options), materials, options);
}

constexpr BookOptions kSmall{.bytes = 24 << 10, .bytes_a_material = 16};
constexpr std::size_t kSkipped = 6;

class CompletedByABook : public testing::Test {
 protected:
  static const MaterialBook& book() {
    static const MaterialBook made = book_of(library(kSkipped), kSmall);
    return made;
  }
  Source unseen = analytic_source(library(99)[kSkipped]);
};

TEST_F(CompletedByABook, HoldsItsMaterialsInTheBytesAskedFor) {
  EXPECT_LE(book().shared_bytes(), kSmall.bytes);
  EXPECT_LE(book().bytes_a_material(), kSmall.bytes_a_material);
  EXPECT_EQ(book().materials().size(), 15u);
  const Source first = analytic_source(library(kSkipped)[0]);
  EXPECT_GT(error_figures(first.ref(), book().brdf(0), kQuick).psnr, 30);
}

TEST_F(CompletedByABook, FindsTheWeightsOfAKnownBook) {
  // samples of a material of the book are explained by its weights
  const FactoredBrdf known = book().brdf(3);
  const Completion completion = complete(book(), measure(known, {.count = 60}));
  EXPECT_LT(error_figures(known, completion.brdf, kQuick).relative, 0.08);
}

TEST_F(CompletedByABook, PredictsAMaterialOfTheKindAndSaysHowWell) {
  const Samples pairs = measure(unseen.ref(), {.count = 20});
  const Completion completion = complete(book(), pairs);
  EXPECT_TRUE(completion.brdf.reciprocal());
  const double relative = error_figures(unseen.ref(), completion.brdf, kQuick).relative;
  EXPECT_LT(relative, 0.1);
  EXPECT_LT(completion.report.relative_left_out, 4 * relative);
  EXPECT_GT(completion.report.relative_left_out, relative / 4);
}

TEST_F(CompletedByABook, FollowsThePairsWhereTheBookKnowsNothing) {
  const Source other = analytic_source("lambert:kd=0.02/0.6/0.9");
  const Samples pairs = measure(other.ref(), {.count = 300});
  EXPECT_LT(error_figures(other.ref(), complete(book(), pairs).brdf, kQuick).relative, 0.25);
}

TEST_F(CompletedByABook, HasTheSameBitsForAnyNumberOfThreads) {
  const Samples pairs = measure(unseen.ref(), {.count = 40});
  const FactoredBrdf completed = complete(book(), pairs).brdf;
  const ThreadLimit one(1);
  EXPECT_EQ(completed, complete(book(), pairs).brdf);
  EXPECT_EQ(format_book(book()), format_book(book_of(library(kSkipped), kSmall)));
}

TEST_F(CompletedByABook, IsAFormOfFit) {
  const auto shared = std::make_shared<const MaterialBook>(book());
  const Fit completed = fit(unseen, {.form = FromBook{shared}, .samples = 200});
  const auto& report = std::get<CompletionReport>(completed.report.how);
  EXPECT_EQ(report.samples, 200u);
  ASSERT_TRUE(completed.report.held_out);
  EXPECT_GT(completed.report.held_out->psnr, 25);
  EXPECT_THAT(to_json(completed.report), HasSubstr("relative_left_out"));
  EXPECT_THROW(fit(unseen, {.form = FromBook{shared}, .smooth = 1e-3}), Error);
}

TEST_F(CompletedByABook, RefusesWhatItCannotComplete) {
  Samples pairs = measure(unseen.ref(), {.count = 5});
  EXPECT_THROW(complete(MaterialBook({4, 3, 2}, random_book().axes(), {}), pairs), Error);
  pairs.isotropic = false;
  EXPECT_THAT([&] { complete(book(), pairs); }, ThrowsMessage<Error>(HasSubstr("an anisotropic one")));
  EXPECT_THAT([] { book_sides({.bytes = 100}); }, ThrowsMessage<Error>(HasSubstr("at least")));
  EXPECT_THAT([] { make_book({4, 3, 2}, {}, {}); }, ThrowsMessage<Error>(HasSubstr("at least 3 materials")));
  EXPECT_THAT(
      [] {
        book_material(analytic_source("ggx:alpha_x=0.1,alpha_y=0.4"), "brushed", {4, 3, 2}, 1);
      },
      ThrowsMessage<Error>(HasSubstr("an anisotropic one")));
}

TEST_F(CompletedByABook, TakesOtherMaterialsIntoWhatIsShared) {
  const MaterialBook with = with_materials(
      book(), {book_material(unseen, "unseen",
                             {book().layout().width, book().layout().height, book().layout().depth}, 1)});
  EXPECT_EQ(with.axes(), book().axes());
  ASSERT_EQ(with.materials().size(), 1u);
  EXPECT_GT(error_figures(unseen.ref(), with.brdf(0), kQuick).psnr, 28);
}

TEST_F(CompletedByABook, GivesAMaterialWeightsOfItsOwnWhateverElseIsListed) {
  const std::array sides = {book().layout().width, book().layout().height, book().layout().depth};
  const BookMaterial one = book_material(unseen, "one", sides, 1);
  BookMaterial other = book_material(analytic_source("lambert:kd=0.5/0.2/0.1"), "other", sides, 1);
  for (std::size_t n = 0; n < other.weights.size(); ++n) other.weights[n] *= n % 3 == 0 ? 50 : 1;
  EXPECT_EQ(with_materials(book(), {one}).weights(0), with_materials(book(), {other, one}).weights(1));
}

// Few pairs of a material that is not in the book: what is said of the error is not less than it is, on average.
TEST_F(CompletedByABook, ExpectsNoLessErrorOfFewPairsThanThereIs) {
  double said = 0, found = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Completion completion = complete(book(), measure(unseen.ref(), {.count = 4, .seed = seed}));
    said += std::log1p(completion.report.relative_left_out);
    found += std::log1p(error_figures(unseen.ref(), completion.brdf, kQuick).relative);
  }
  EXPECT_GT(said, 0.9 * found);
  EXPECT_LT(said, 2 * found);
}

}  // namespace
}  // namespace burnish
