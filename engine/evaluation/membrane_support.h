#pragma once

#include <vector>

namespace vantage {

/// A function of integer offsets dx and dy, −radius..radius each.
class SupportFunction {
 public:
  explicit SupportFunction(int radius);

  [[nodiscard]] int radius() const { return radius_; }
  [[nodiscard]] double& at(int dx, int dy) { return values_[index(dx, dy)]; }
  [[nodiscard]] double at(int dx, int dy) const { return values_[index(dx, dy)]; }
  [[nodiscard]] double sum() const;

 private:
  [[nodiscard]] std::size_t index(int dx, int dy) const {
    const int side = 2 * radius_ + 1;
    return static_cast<std::size_t>((dy + radius_) * side + dx + radius_);
  }

  int radius_;
  std::vector<double> values_;
};

/// Limit of the membrane's iterations (6.9) from an impulse: the inverse Fourier transform of β /
/// (β + 4 − 2 cos ωx − 2 cos ωy) (6.12), on a torus much larger than the support. 0.01 ≤ β, 1 ≤
/// radius ≤ 256: UsageError otherwise. Thread rule: pure.
SupportFunction membrane_support(double beta, int radius);

/// Result of n iterations of (6.9) on an impulse, cell by cell, on a grid of that radius whose
/// border cells lack neighbours. 0 < λ ≤ 1/(4 + β), iterations ≥ 0; else UsageError.
SupportFunction membrane_impulse_response(double beta, double lambda, int iterations, int radius);

/// Largest |a − b| over the offsets; equal radii.
double largest_difference(const SupportFunction& a, const SupportFunction& b);

}  // namespace vantage
