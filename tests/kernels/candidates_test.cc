// Candidates of several other images, against every image looked at on its own.
#include "kernels/candidates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace vantage::kernels::candidates_test {

constexpr double kRounding = 1e-6;

struct Images {
  CandidateGeometry geometry;
  std::vector<double> ratios;
};

/// Whether an image sees candidate `index` of column x, at least `margin` inside.
bool is_seen(const Images& images, int x, int index, int margin) {
  const CandidateGeometry& geometry = images.geometry;
  if (x < margin || x > geometry.width - 1 - margin) {
    return false;
  }
  const double px = static_cast<double>(geometry.disparity_min + index) / geometry.steps_per_px;
  return std::ranges::any_of(images.ratios, [&](double ratio) {
    const double partner = x + geometry.direction * px * ratio;
    return partner >= margin - kRounding && partner <= geometry.width - 1 - margin + kRounding;
  });
}

std::vector<Images> cases() {
  std::vector<Images> all;
  for (const int direction : {-1, 1}) {
    for (const int steps : {1, 4}) {
      for (const auto& [min, count] : {std::pair{0, 9}, {-7, 20}, {3, 30}, {-40, 33}, {-60, 130}}) {
        for (const std::vector<double>& ratios :
             {std::vector<double>{1, -1}, {1, 0.5}, {1, 2.37}, {1, -2.37, 0.4}, {1, -0.1}}) {
          CandidateGeometry geometry{29, min, count, direction, steps};
          for (const double ratio : ratios) {
            if (ratio > 0) {
              geometry.near_ratio = std::min(geometry.near_ratio, ratio);
            } else {
              geometry.opposite_ratio = -ratio;
            }
          }
          all.push_back({geometry, ratios});
        }
      }
    }
  }
  return all;
}

TEST(Candidates, CountWhereAnyOfSeveralImagesSeesThem) {
  for (const Images& images : cases()) {
    const CandidateGeometry& geometry = images.geometry;
    if (geometry.is_of_one()) {
      continue;  // the first image sees what the others see
    }
    for (const int margin : {0, 2}) {
      for (int x = 0; x < geometry.width; ++x) {
        const CandidateRange range = geometry.with_partner(x, margin);
        for (int i = 0; i < geometry.count; ++i) {
          ASSERT_EQ(i >= range.begin && i < range.end, is_seen(images, x, i, margin))
              << "column " << x << " candidate " << i << " margin " << margin << " min "
              << geometry.disparity_min << " ratio " << images.ratios[1];
        }
      }
    }
  }
}

TEST(Candidates, ColumnsWithAllOfSeveralImagesHaveThem) {
  for (const Images& images : cases()) {
    if (images.geometry.is_of_one()) {
      continue;
    }
    const CandidateRange columns = images.geometry.columns_with_all_partners();
    int columns_with_all = 0;
    for (int x = 0; x < images.geometry.width; ++x) {
      const bool has_all =
          images.geometry.with_partner(x) == CandidateRange{0, images.geometry.count};
      columns_with_all += has_all ? 1 : 0;
      if (x >= columns.begin && x < columns.end) {
        EXPECT_TRUE(has_all) << "column " << x;
      }
    }
    if (images.geometry.opposite_ratio == 0) {
      EXPECT_EQ(std::max(0, columns.end - columns.begin), columns_with_all);
    }
  }
}

}  // namespace vantage::kernels::candidates_test
