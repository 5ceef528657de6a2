#pragma once

#include "engine/matching/options/match_options.h"
#include "tests/engine/engine_test.h"

namespace vantage {
inline namespace test {

/// A whole disparity space (6.1) in double precision: the oracle of all matching methods. Nothing
/// of the engine's kernels, layouts or tricks is used to make one.
struct Volume {
  int width = 0;
  int height = 0;
  DisparityRange range;
  int direction = -1;  ///< the partner of x is x + direction · d
  int steps = 1;       ///< candidates per pixel of disparity
  /// Cells stand for several of the images': there all candidates count as having partners.
  bool is_coarse = false;
  std::vector<double> cells;

  Volume() = default;
  /// All cells are `value`.
  Volume(int width_px, int height_px, DisparityRange disparities, Side reference, double value = 0,
         int steps_per_px = 1);
  /// The shape of `other` and nothing else of it.
  static Volume like(const Volume& other);

  [[nodiscard]] int count() const { return steps * (range.count() - 1) + 1; }
  [[nodiscard]] double& at(int x, int y, int i) { return cells[index(x, y, i)]; }
  [[nodiscard]] double at(int x, int y, int i) const { return cells[index(x, y, i)]; }
  /// Disparity of candidate i.
  [[nodiscard]] double disparity_px(int i) const {
    return range.min + static_cast<double>(i) / steps;
  }
  /// Steps and fractions of them are exact.
  [[nodiscard]] double partner(int x, int i) const { return x + direction * disparity_px(i); }
  [[nodiscard]] bool has_partner(int x, int i) const {
    return is_coarse || (partner(x, i) >= 0 && partner(x, i) <= width - 1);
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int i) const {
    const auto row = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
    return (row + static_cast<std::size_t>(x)) * static_cast<std::size_t>(count()) +
           static_cast<std::size_t>(i);
  }
};

/// Calls visit(x, y, i) for every cell.
template <typename Visit>
void for_each_cell(const Volume& volume, Visit visit) {
  for (const auto [x, y] : positions_of(volume.width, volume.height)) {
    for (int i = 0; i < volume.count(); ++i) {
      visit(x, y, i);
    }
  }
}

/// One channel of a photograph in grey levels.
struct Plane {
  int width = 0;
  int height = 0;
  std::vector<double> values;

  /// Coordinates outside replicate the border.
  [[nodiscard]] double at(int x, int y) const;
};

/// The plane at x + fraction: Keys' cubic convolution (a = −½) of the four pixels around, within
/// their range.
Plane resampled(const Plane& plane, double fraction);

/// What costs compare: luma (EQUATIONS §0), or each colour channel.
std::vector<Plane> planes_of(const Photograph& photograph, ColourUse colour);

/// Gradient of an image (5.9), by correlation with the filters of EQUATIONS §2; each filtering step
/// replicates the border of what it filters.
struct Gradient {
  Plane x;
  Plane y;
};
Gradient gradient_of(const Plane& plane, GradientFilter filter, bool prefilter);

/// |v| by the norm and the components of `parameters` (5.7, 5.8).
double length_of(double x, double y, const MethodParameters& parameters);

/// E0 of (6.1) with the cost `parameters.cost`; at cells whose partner is outside the cost of the
/// clamped coordinate, 0 for evidence, −log ε for the contaminated Gaussian.
Volume plain_costs(const Photograph& reference, const Photograph& other, Side reference_is,
                   DisparityRange range, const MethodParameters& parameters);

/// E0 of Bayesian diffusion (6.26): −log of the likelihood that stage_cost.h states for each cost.
/// Of three channels r² is the mean of the squared differences, for the contaminated Gaussian too.
Volume plain_measurement_energies(const Photograph& reference, const Photograph& other,
                                  Side reference_is, DisparityRange range,
                                  const MethodParameters& parameters);

/// Grey levels, luma of colours, as cells of one candidate.
Volume plain_grey(const Photograph& photograph);

}  // namespace test
}  // namespace vantage
