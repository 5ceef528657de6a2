#include "engine/figures/figure_table.h"

#include "engine/evaluation/method_comparison.h"
#include "engine/figures/figure_images.h"
#include "tests/engine/engine_test.h"

namespace vantage::figure_table_test {

std::vector<std::string> keys_of(std::string_view name) {
  std::vector<std::string> keys;
  for (const BookFigure* figure : figures_named(name)) {
    keys.emplace_back(figure->key);
  }
  return keys;
}

std::string refusal_of(const std::vector<const BookFigure*>& figures,
                       const FigureSettings& settings) {
  return error_of([&] { check_settings(figures, settings); });
}

TEST(FigureTable, ListsEveryFigureOnceInTheOrderOfTheBook) {
  const auto all = keys_of("all");
  EXPECT_EQ(std::set(all.begin(), all.end()).size(), all.size());
  const auto place = [&all](const std::string& key) {
    return std::ranges::find(all, key) - all.begin();
  };
  EXPECT_LT(place("3.9"), place("5.3"));
  EXPECT_LT(place("6.9"), place("6.10"));
  EXPECT_EQ(place("6.19") + 1, static_cast<std::ptrdiff_t>(all.size()));
  for (const BookFigure& figure : book_figures()) {
    EXPECT_FALSE(figure.title.empty() || figure.book.empty() || figure.section.empty());
    EXPECT_NE(figure.make, nullptr);
    // A figure of photographs says how large its stand-in is.
    EXPECT_TRUE(figure.images == BookImages::kNone || figure.defaults.size_px.has_value());
    for (const std::string& method : figure.defaults.methods) {
      EXPECT_NO_THROW(compared_method(method));
    }
  }
}

TEST(FigureTable, NamesAreKeysChaptersOrAll) {
  EXPECT_THAT(keys_of("6.16"), testing::ElementsAre("6.16"));
  EXPECT_THAT(keys_of("5"), testing::Contains("5.6"));
  EXPECT_THAT(keys_of("5"), testing::Not(testing::Contains("6.5")));
  EXPECT_THROW(figures_named("6.1"), UsageError);
  EXPECT_THROW(figures_named(""), UsageError);
}

TEST(FigureSettings, ChosenValuesReplaceDefaultsThatAFigureReads) {
  const BookFigure& support = *figures_named("6.9").front();
  FigureSettings chosen{.size_px = 30, .iterations = {4}};
  chosen.parameters.beta = 0.2;
  const FigureSettings settings = settings_in_force(support, chosen);
  EXPECT_FALSE(settings.size_px.has_value());
  EXPECT_THAT(settings.iterations, testing::ElementsAre(4));
  EXPECT_EQ(settings.parameters.beta, 0.2);
}

TEST(FigureSettings, RefusesWhatNoFigureReads) {
  const auto support = figures_named("6.9");
  const auto both = std::vector{support.front(), figures_named("6.16").front()};
  EXPECT_THAT(refusal_of(support, {.size_px = 30}), HasSubstr("--size has no effect"));
  EXPECT_EQ(refusal_of(both, {.size_px = 30}), "");
  FigureSettings mu;
  mu.parameters.mu = 0.4;
  EXPECT_THAT(refusal_of(support, mu), HasSubstr("--mu has no effect"));
  EXPECT_EQ(refusal_of(both, mu), "");
  mu.methods = {"ssd"};
  EXPECT_THAT(refusal_of(both, mu),
              HasSubstr("the figures do not read it, with methods membrane, ssd"));
  EXPECT_THAT(refusal_of(both, {.size_px = 3}), HasSubstr("size is 3"));
  EXPECT_THAT(refusal_of(both, {.methods = {"guess"}}), HasSubstr("'guess' is unknown"));
}

TEST(FigureImages, StandInsScaleWithTheirWidth) {
  Execution execution({.threads = 2});
  for (const BookImages which : {BookImages::kKids, BookImages::kStreet, BookImages::kTown}) {
    const FigureSettings settings{.size_px = default_width(which) / 4, .seed = 1};
    const auto images = images_of(which, {.settings = settings, .execution = execution});
    EXPECT_EQ(images->is_transposed, which == BookImages::kTown);
    EXPECT_EQ(images->is_transposed ? images->left.height() : images->left.width(),
              *settings.size_px);
    EXPECT_EQ(images->right.width(), images->left.width());
    EXPECT_EQ(images->baselines.size(), images->more.size() + 1);
    // The truth lies in the range to search, and visible pixels agree with it in both images.
    for (const auto [x, y] : positions_of(*images->left_truth)) {
      const float d = images->left_truth->at(x, y);
      ASSERT_GE(d, static_cast<float>(images->disparities.min));
      ASSERT_LE(d, static_cast<float>(images->disparities.max));
      const bool visible = images->left_visible->at(x, y) != 0;
      ASSERT_TRUE(!visible || static_cast<float>(x) - d > -1);
    }
  }
}

TEST(FigureImages, GivenImagesTakeTheirPlace) {
  Execution execution({.threads = 1});
  const FigureSettings settings{.size_px = 100, .seed = 1};
  FigureImages given{.description = "mine", .left = {}, .right = {}, .disparities = {0, 7}};
  const auto images =
      images_of(BookImages::kTree, {.settings = settings, .execution = execution, .given = &given});
  EXPECT_EQ(images.get(), &given);
}

}  // namespace vantage::figure_table_test
