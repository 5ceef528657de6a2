#include "kernels/symmetric_path/symmetric_path.h"

#include <algorithm>

#include "kernels/winner/winner.h"

namespace vantage::kernels {
namespace {

constexpr std::int32_t kNever = SymmetricRow::kNever;

/// The sums of all states (t, d): t = (x_left + 1) + (x_right + 1) pixels are decided, the last
/// ones x_left and x_right. t and d are both even or both odd, so a row of t holds every second d.
/// One more d than there are candidates lets pairs of opposite pixels stay unmatched; d = 0 is
/// where paths start and end.
class Sums {
 public:
  Sums(const SymmetricRow& row, std::int32_t* sums)
      : min_(std::min(row.disparity_min, 0)),
        max_(std::max(row.disparity_min + row.count, 0)),
        pitch_(row_sums(min_, max_)),
        steps_(2 * row.width),
        sums_(sums) {}
  static int row_sums(int min, int max) { return (max - min + 1) / 2 + 1 + 2; }

  [[nodiscard]] int steps() const { return steps_; }
  [[nodiscard]] int pitch() const { return pitch_; }
  /// The smallest and largest d of t that images have pixels for, of the parity of t.
  [[nodiscard]] int first(int t) const {
    const int least = std::max(min_, -reach(t));
    return least + ((least ^ t) & 1);
  }
  [[nodiscard]] int last(int t) const {
    const int most = std::min(max_, reach(t));
    return most - ((most ^ t) & 1);
  }
  /// The row of t such that row[d >> 1] is the sum of d; one d beyond first() and last() may be
  /// read.
  [[nodiscard]] std::int32_t* row(int t) const {
    return sums_ + static_cast<std::ptrdiff_t>(t) * pitch_ + 1 - (min_ >> 1);
  }
  void clear(int t) const {
    std::fill_n(sums_ + static_cast<std::ptrdiff_t>(t) * pitch_, pitch_, kNever);
  }

 private:
  [[nodiscard]] int reach(int t) const { return std::min(t, steps_ - t); }

  int min_;
  int max_;
  int pitch_;
  int steps_;
  std::int32_t* sums_;
};

/// What a match that leads to (t, d) costs.
std::int32_t match_cost(const SymmetricRow& row, int t, int d) {
  const int candidate = d - row.disparity_min;
  // Both pixels exist as |d| ≤ reach(t), but for a match also before it.
  const int left = (t + d) / 2 - 1;
  const int right = left - d;
  return candidate < 0 || candidate >= row.count || left < 0 || right < 0
             ? kNever
             : row.cost(left, candidate);
}

void add_up(const SymmetricRow& row, const Sums& sums) {
  sums.clear(0);
  sums.row(0)[0] = 0;
  for (int t = 1; t <= sums.steps(); ++t) {
    sums.clear(t);
    std::int32_t* const of = sums.row(t);
    const std::int32_t* const before = sums.row(t - 1);
    // d − 1 and d + 1 lie at d >> 1 less the parity, and one further.
    const int shift = (t & 1) == 0 ? -1 : 0;
    const int last = sums.last(t);
    for (int d = sums.first(t); d <= last; d += 2) {
      const int k = d >> 1;
      std::int32_t sum = std::min(before[k + shift], before[k + shift + 1]) + row.unmatched;
      const std::int32_t cost = match_cost(row, t, d);
      if (cost != kNever) {
        sum = std::min(sum, sums.row(t - 2)[k] + cost);
      }
      of[k] = std::min(sum, kNever);
    }
  }
}

}  // namespace

std::size_t symmetric_path_sums(const SymmetricRow& row) {
  return static_cast<std::size_t>(2 * row.width + 1) *
         static_cast<std::size_t>(Sums(row, nullptr).pitch());
}

void symmetric_matches_row(const SymmetricRow& row, std::int32_t* sums, std::int32_t* left_matches,
                           std::int32_t* right_matches) {
  const Sums all(row, sums);
  add_up(row, all);
  std::fill_n(left_matches, row.width, kNoWinner);
  std::fill_n(right_matches, row.width, kNoWinner);
  int d = 0;
  for (int t = all.steps(); t > 0;) {
    const std::int32_t sum = all.row(t)[d >> 1];
    const int shift = (t & 1) == 0 ? -1 : 0;
    const std::int32_t* const before = all.row(t - 1) + (d >> 1) + shift;
    if (before[0] + row.unmatched == sum) {  // the left pixel is unmatched
      --d;
      --t;
      continue;
    }
    const std::int32_t cost = match_cost(row, t, d);
    if (cost != kNever && all.row(t - 2)[d >> 1] + cost == sum) {
      const int left = (t + d) / 2 - 1;
      left_matches[left] = right_matches[left - d] = d - row.disparity_min;
      t -= 2;
      continue;
    }
    ++d;  // the right pixel is unmatched
    --t;
  }
}

}  // namespace vantage::kernels
