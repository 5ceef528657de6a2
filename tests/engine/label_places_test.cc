#include "engine/profile_page/label_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vantage {
namespace label_places_test {

constexpr ChartArea kArea = {{50, 20}, 480, 340};

bool touch(const LabelPlace& a, const LabelPlace& b) {
  return a.corner.x < b.corner.x + b.width && b.corner.x < a.corner.x + a.width &&
         a.corner.y < b.corner.y + b.height && b.corner.y < a.corner.y + a.height;
}

double distance(const LabelledDisc& disc, const LabelPlace& label) {
  const double dx =
      disc.centre.x - std::clamp(disc.centre.x, label.corner.x, label.corner.x + label.width);
  const double dy =
      disc.centre.y - std::clamp(disc.centre.y, label.corner.y, label.corner.y + label.height);
  return std::hypot(dx, dy) - disc.radius;
}

void expect_clear(const std::vector<LabelledDisc>& discs) {
  const std::vector<LabelPlace> places = place_labels(discs, kArea);
  ASSERT_EQ(places.size(), discs.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (discs[i].label.empty()) {
      continue;
    }
    EXPECT_GE(places[i].corner.x, kArea.corner.x) << discs[i].label;
    EXPECT_GE(places[i].corner.y, kArea.corner.y) << discs[i].label;
    EXPECT_LE(places[i].corner.x + places[i].width, kArea.corner.x + kArea.width);
    EXPECT_LE(places[i].corner.y + places[i].height, kArea.corner.y + kArea.height);
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_FALSE(!discs[k].label.empty() && touch(places[i], places[k])) << i << " and " << k;
    }
    for (const LabelledDisc& disc : discs) {
      EXPECT_GE(distance(disc, places[i]), -1e-9) << discs[i].label;
    }
  }
}

TEST(LabelPlaces, ALoneLabelIsBesideItsDisc) {
  const LabelledDisc disc = {{200, 150}, 8, "cost"};
  const LabelPlace place = place_labels({disc}, kArea)[0];
  EXPECT_GT(place.corner.x, 208);
  EXPECT_LT(place.corner.x, 216);
  EXPECT_FALSE(place.is_far);
}

TEST(LabelPlaces, StayInTheChart) {
  expect_clear({{{50, 20}, 5, "top left"},
                {{530, 20}, 5, "top right"},
                {{50, 360}, 5, "bottom left"},
                {{530, 360}, 5, "bottom right"}});
}

TEST(LabelPlaces, DiscsInOnePlaceHaveReadableLabels) {
  std::vector<LabelledDisc> discs;
  for (int i = 0; i < 9; ++i) {
    discs.push_back({{300.0 + i % 3, 200.0 + i / 3}, 4.0 + i, "stage number " + std::to_string(i)});
  }
  expect_clear(discs);
}

TEST(LabelPlaces, KeepClearOfWhatHasNoLabel) {
  std::vector<LabelledDisc> discs = {{{300, 200}, 6, "window selection"}};
  for (int i = 0; i < 60; ++i) {  // a line that comes in from the right
    discs.push_back({{310.0 + 3 * i, 200}, 1.5, ""});
  }
  expect_clear(discs);
}

}  // namespace label_places_test
}  // namespace vantage
