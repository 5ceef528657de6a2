#include "engine/sequence/shots/shot_matchers.h"

#include "tests/engine/engine_test.h"

namespace vantage::shot_matchers_test {

TEST(ShotMatchers, FramesOfOneRangeShareAMatcherThatLivesWhileReferenced) {
  MatchOptions options;
  options.disparities = {0, 15};
  ShotTable shots;
  shots.shots.resize(4);
  for (int i = 0; i < 4; ++i) {
    Shot& shot = shots.shots[static_cast<std::size_t>(i)];
    shot.first_frame = 10 * i;
    shot.end_frame = 10 * (i + 1);
    if (i % 2 == 1) {
      shot.search = DisparityRange{0, 20 + i};
    }
  }
  const ShotMatchers matchers(options, &shots, nullptr, execution());
  const std::shared_ptr<const ShotMatcher> first = matchers.of(3, {});
  EXPECT_EQ(first->options.disparities, (DisparityRange{0, 15}));
  EXPECT_EQ(matchers.of(25, {}), first);  // the third shot has the range of the run, too
  const std::shared_ptr<const ShotMatcher> second = matchers.of(12, {});
  EXPECT_EQ(second->options.disparities, (DisparityRange{0, 21}));
  EXPECT_EQ(second->matcher.in_force().disparities, (DisparityRange{0, 21}));
  EXPECT_EQ(matchers.of(39, {})->options.disparities, (DisparityRange{0, 23}));
  // A pair may have a range of its own.
  EXPECT_EQ(matchers.of(39, DisparityRange{0, 21}), second);
  // The first one had to go, but not what it was used for.
  EXPECT_EQ(matchers.of(12, {}), second);
  EXPECT_NE(matchers.of(3, {}), first);
  EXPECT_EQ(first->options.disparities, (DisparityRange{0, 15}));

  const ShotMatchers of_film(options, nullptr, nullptr, execution());
  EXPECT_EQ(of_film.of(3, {}), of_film.of(99, {}));
}

}  // namespace vantage::shot_matchers_test
