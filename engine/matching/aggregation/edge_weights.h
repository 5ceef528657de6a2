#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/method_parameters.h"
#include "kernels/cells/fixed_energy.h"

namespace vantage {

/// How much neighbouring pixels of an image count for each other in Bayesian diffusion that
/// intensity edges mediate (7.3), in [edge_weight, 1]; 1 towards pixels beyond the image.
/// Working memory, reused without allocating. Thread rule: immutable once prepared.
class EdgeWeights {
 public:
  /// `grey`: one channel, at least 1×1. Floats, or, where cells are in fixed point (EnergyFormat),
  /// those times μ in fixed point: the ones that `parameters` have kernels for. Identical for any
  /// `execution`.
  void prepare(ImageView<const float> grey, const MethodParameters& parameters,
               Execution& execution);

  /// [x], x in [0, width]: of the pixels x − 1 and x of row y.
  [[nodiscard]] const float* beside(int y) const { return floats_.beside.row(y); }
  /// [x], x in [0, width): of the pixels in rows y − 1 and y; y in [0, height].
  [[nodiscard]] const float* above(int y) const { return floats_.above.row(y); }
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
  /// store(weights, count, row): keeps weights in a row of `planes`.
  template <typename Weight, typename Store>
  static void make(ImageView<const float> grey, const MethodParameters& parameters,
                   Execution& execution, const Store& store, Planes<Weight>& planes);

  Planes<float> floats_;
  Planes<kernels::FixedWeight> fixed_;
};

/// The weights of an image and of its coarser levels, whose pixels are means of 2×2 pixels of the
/// finer level, of those that are there. Working memory, reused from map to map without allocating.
class EdgeWeightLevels {
 public:
  /// The weights of each level of the image that the map is on, its own first; none where
  /// parameters do not ask for them. Valid until the next call.
  std::span<const EdgeWeights> prepare(const Photograph& reference,
                                       const MethodParameters& parameters, Execution& execution);

  [[nodiscard]] std::size_t held_bytes() const;

 private:
  std::vector<Image<float>> grey_;  ///< of each level
  std::vector<EdgeWeights> levels_;
};

/// What EdgeWeightLevels takes for images of this size.
std::size_t edge_weight_bytes(const MethodParameters& parameters, std::size_t pixels);

}  // namespace vantage
