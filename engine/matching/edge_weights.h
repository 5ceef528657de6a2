#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/matching/method_parameters.h"
#include "kernels/edge_weights/edge_weights.h"

namespace vantage {

/// How much neighbouring pixels of an image count for each other in Bayesian diffusion that
/// intensity edges mediate (7.3), in [edge_weight, 1]; 1 towards pixels beyond the image.
class EdgeWeights {
 public:
  /// `grey`: one channel, at least 1×1. Identical for any `execution`.
  void prepare(ImageView<const float> grey, const kernels::EdgeModel& model, Execution& execution);

  /// [x], x in [0, width]: of the pixels x − 1 and x of row y.
  [[nodiscard]] const float* beside(int y) const { return beside_.row(y); }
  /// [x], x in [0, width): of the pixels in rows y − 1 and y; y in [0, height].
  [[nodiscard]] const float* above(int y) const { return above_.row(y); }
  [[nodiscard]] std::size_t held_bytes() const;

 private:
  Image<float> beside_;
  Image<float> above_;
};

/// Whether the neighbours of a pixel count by the edges between them.
bool uses_edge_weights(const MethodParameters& parameters);

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
