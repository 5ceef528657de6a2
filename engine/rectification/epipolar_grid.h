#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"
#include "engine/rectification/rectifier.h"
#include "scheduler/range.h"

namespace vantage {

/// Where the partners of a photograph's pixels lie (5.3.2): rectification and disparity in one
/// displacement. The other photograph is sampled along epipolar lines, which are rows of the
/// rectified image: kPhases samples per pixel along them, kPhases lines per row. The photograph
/// itself is not resampled.
///
/// Thread rule: immutable; may be used concurrently.
class EpipolarGrid {
 public:
  static constexpr int kPhases = 4;

  /// The sample nearest to what a pixel of the reference has at disparity 0. Rounding is an eighth
  /// of a pixel at most, and of either sign in the support of a pixel.
  struct Place {
    std::int32_t line = 0;  ///< 0 .. line_count() − 1
    std::int32_t sample = 0;
    bool has_line = false;  ///< false: no line passes through the pixel, `line` is the nearest one
  };

  /// `reference`: the photograph whose map is made. Both photographs have the size that `rectifier`
  /// is for. Takes about 0.2 µs per pixel of the two.
  EpipolarGrid(const Rectifier& rectifier, Side reference, Execution& execution);

  [[nodiscard]] Side reference() const { return reference_; }
  [[nodiscard]] int width() const { return width_; }    ///< samples of phase 0 per line
  [[nodiscard]] int height() const { return height_; }  ///< rows; each has kPhases lines
  [[nodiscard]] const Place& place(int x, int y) const {
    return places_[static_cast<std::size_t>(y) * static_cast<std::size_t>(reference_width_) +
                   static_cast<std::size_t>(x)];
  }
  /// Samples of a line that the other photograph shows.
  [[nodiscard]] scheduler::Range seen_samples(int line) const {
    return seen_[static_cast<std::size_t>(line)];
  }
  /// Position in the other photograph of a sample, which may be between samples; NaN where it does
  /// not show it.
  [[nodiscard]] Eigen::Vector2d position_of(double line, double sample) const;

  /// Samples the other photograph at columns along + X · kPhases of the lines down + Y · kPhases.
  void sample(const Photograph& other, int along, int down, Photograph& result,
              Execution& execution) const;

 private:
  void find_window(const Rectifier& rectifier);
  void find_places(const Rectifier& rectifier, Execution& execution);
  void find_positions(const Rectifier& rectifier, Execution& execution);

  Side reference_;
  int reference_width_;
  int reference_height_;
  // Rectified pixel of line 0, sample 0.
  int first_column_ = 0;
  int first_row_ = 0;
  int width_ = 0;
  int height_ = 0;
  std::vector<Place> places_;
  std::vector<scheduler::Range> seen_;
  /// Positions of every kKnotPx-th rectified pixel; between them they are interpolated.
  int knot_columns_ = 0;
  std::vector<Eigen::Vector2d> knots_;
};

/// Of the left and of the right reference.
using EpipolarGrids = std::array<EpipolarGrid, 2>;

/// Grids of both photographs, for matchers to share. Takes 16 bytes per pixel and photograph.
std::shared_ptr<const EpipolarGrids> epipolar_grids(const Rectifier& rectifier,
                                                    Execution& execution);

}  // namespace vantage
