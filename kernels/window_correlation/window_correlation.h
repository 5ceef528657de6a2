#pragma once

#include <array>

namespace vantage::kernels {

inline constexpr int kCorrelationRows = 7;

/// Rows of two images of deviations from local means, and the columns of one whose windows of 3
/// columns are compared with those of the other.
struct CorrelationRow {
  std::array<const float*, kCorrelationRows> values{};
  /// At the partners of column 0; readable, like `values`, from begin − 1 to end.
  std::array<const float*, kCorrelationRows> partners{};
  int rows = 0;  ///< that lie in both images
  /// 1 / √(sum of squares in the window) of columns, and of their partners.
  const float* scale = nullptr;
  const float* partner_scale = nullptr;
  int begin = 0;  ///< > 0
  int end = 0;
  float* sums = nullptr;  ///< working memory, up to column `end`
};

/// best[x] becomes the correlation of column x, and place[x] the given one, where it is larger.
/// Identical on every instruction set.
void correlation_row(const CorrelationRow& row, float here, float* best, float* place);

/// The best of all partners so far, of a row of columns.
struct BestPartners {
  float* correlation = nullptr;
  float* second = nullptr;  ///< the best of those more than `peak_radius` away from the best
  float* offset = nullptr;
  float* place = nullptr;
};
/// Adds partners at `offset`; before: the best of those more than peak_radius before. Identical on
/// every instruction set.
void add_partners_row(const float* correlation, const float* place, const float* before,
                      float offset, float peak_radius, int width, const BestPartners& best);

}  // namespace vantage::kernels
