#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/cells/fixed_energy.h"
#include "kernels/star_row.h"

namespace vantage {

/// Weights of neighbouring pixels for each other, in [edge_weight, 1]; 1 towards pixels outside the
/// image. Float weights or, if cells are in fixed point (EnergyFormat), those times μ in fixed
/// point, whichever the kernels read. Thread rule: immutable once prepared.
class EdgeWeightPlanes {
 public:
  /// `grey`: one channel, at least 1×1. Identical for any `execution`.
  void prepare(ImageView<const float> grey, const MethodParameters& parameters,
               Execution& execution);

  /// [x], x in [0, width]: between pixels x − 1 and x of row y.
  [[nodiscard]] const float* beside(int y) const { return floats_.beside.row(y); }
  /// [x], x in [0, width): between the pixels of rows y − 1 and y; y in [0, height].
  [[nodiscard]] const float* above(int y) const { return floats_.above.row(y); }
  /// Those of the pixels from column x of row y on.
  [[nodiscard]] kernels::StarWeights star(int x, int y) const {
    return {.beside = beside(y) + x, .above = above(y) + x, .below = above(y + 1) + x};
  }
  [[nodiscard]] const kernels::FixedWeight* fixed_beside(int y) const {
    return fixed_.beside.row(y);
  }
  [[nodiscard]] const kernels::FixedWeight* fixed_above(int y) const { return fixed_.above.row(y); }
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  template <typename Weight>
  struct Planes {
    Image<Weight> beside;
    Image<Weight> above;
  };
  /// store(weights, count, row) writes weights to a row of `planes`.
  template <typename Weight, typename Store>
  static void make(ImageView<const float> grey, const MethodParameters& parameters,
                   Execution& execution, const Store& store, Planes<Weight>& planes);

  Planes<float> floats_;
  Planes<kernels::FixedWeight> fixed_;
};

/// Weights of neighbouring pixels in the iterations of one level (6.7, 7.3). With edge_diffusion
/// the image is diffused anisotropically along with the support, and each iteration has weights of
/// its own. Working memory, reused without reallocation. Thread rule: immutable once prepared.
class EdgeWeights {
 public:
  /// `grey`: one channel, at least 1×1. `parameters`: of the level. Identical for any `execution`.
  void prepare(ImageView<const float> grey, const MethodParameters& parameters,
               Execution& execution);

  /// Weights that iteration n ≥ 1 reads.
  [[nodiscard]] const EdgeWeightPlanes& of_iteration(int n) const {
    return planes_[std::min(static_cast<std::size_t>(n), planes_.size()) - 1];
  }
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  std::vector<EdgeWeightPlanes> planes_;
  std::array<Image<float>, 2> diffused_;  ///< the image after the last steps
};

/// Of iteration n; n = 0, the start, reads none. `edges` null: null.
inline const EdgeWeightPlanes* weights_of_iteration(const EdgeWeights* edges, int n) {
  return edges != nullptr && n > 0 ? &edges->of_iteration(n) : nullptr;
}

/// The weights of an image and its coarser levels, whose pixels are means of 2×2 pixels of the
/// finer level (fewer at the border). Working memory, reused without reallocation.
class EdgeWeightLevels {
 public:
  /// The weights of each level of the map's image, its own first; empty if parameters do not ask
  /// for them; undefined for levels without iterations. Valid until the next call.
  std::span<const EdgeWeights> prepare(const Photograph& reference,
                                       const MethodParameters& parameters, Execution& execution);

  [[nodiscard]] std::size_t held_bytes() const;

 private:
  std::vector<Image<float>> grey_;  ///< one per level
  std::vector<EdgeWeights> levels_;
};

/// Bytes of EdgeWeightLevels for images of this size.
std::size_t edge_weight_bytes(const MethodParameters& parameters, std::size_t pixels);

}  // namespace vantage
