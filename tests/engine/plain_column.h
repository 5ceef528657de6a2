#pragma once

#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// The energies of one pixel's candidates, and §3 written out for them in double.
class PlainColumn {
 public:
  /// By candidate, NaN where it may not win; −log p for probabilities, infinite for 0.
  explicit PlainColumn(std::vector<double> energies) : energies_(std::move(energies)) {
    for (int i = 0; i < static_cast<int>(energies_.size()); ++i) {
      if (!std::isnan(energy(i))) {
        sorted_.push_back(energy(i));
        winner_ = winner_ < 0 || energy(i) < energy(winner_) ? i : winner_;
      }
    }
    std::sort(sorted_.begin(), sorted_.end());
  }

  [[nodiscard]] bool has_candidate() const { return winner_ >= 0; }
  [[nodiscard]] int winner() const { return winner_; }
  [[nodiscard]] double min() const { return energy(winner_); }
  /// The winner's index, moved to the lowest point of the parabola through its neighbours.
  [[nodiscard]] double refined_winner() const {
    const double below = energy(winner_ - 1);
    const double above = energy(winner_ + 1);
    const double curvature = below - 2 * min() + above;
    const bool moves = std::isfinite(curvature) && curvature > 0;
    return moves ? winner_ + (below - above) / (2 * curvature) : winner_;
  }
  /// (6.13)
  [[nodiscard]] double margin() const {
    double sum = 0;
    for (const double e : sorted_) {
      sum += e;
    }
    return sorted_.size() < 2 || sum == 0 ? 0 : (sorted_[1] - sorted_[0]) / sum;
  }
  /// (6.15)
  [[nodiscard]] double entropy(double scale) const {
    double sum = 0;
    for (const double e : sorted_) {
      sum += std::exp(-scale * (e - min()));
    }
    double entropy = 0;
    for (const double e : sorted_) {
      const double p = std::exp(-scale * (e - min())) / sum;
      entropy += p > 0 ? p * std::log(p) : 0;
    }
    return entropy;
  }

 private:
  [[nodiscard]] double energy(int i) const {
    return i < 0 || i >= static_cast<int>(energies_.size())
               ? std::numeric_limits<double>::quiet_NaN()
               : energies_[static_cast<std::size_t>(i)];
  }

  std::vector<double> energies_;
  std::vector<double> sorted_;
  int winner_ = -1;
};

}  // namespace test
}  // namespace vantage
