#pragma once

#include "engine/image/image.h"
#include "engine/image/volume_sink.h"

namespace vantage {

/// Mean and variance of p(d) of each pixel, over the candidates that were searched and have a
/// partner (EQUATIONS §3.19): the sink of an aggregated volume of probabilities, searched along
/// rows.
///
/// Thread rule: write() may be called concurrently, as VolumeSink says; all else one thread at a
/// time.
class PosteriorMoments final : public VolumeSink {
 public:
  /// Throws UsageError for a volume without probabilities or of a two-dimensional search.
  void start(const VolumeShape& shape) override;
  void write(int x, int y, int columns, const float* values) override;

  /// Makes pixels unknown (image/left_out.h), once all is written.
  void erase(const Mask& left_out);

  /// Of the size of the level; NaN where no candidate has a probability. In pixels and pixels².
  [[nodiscard]] const Image<float>& mean_px() const { return mean_px_; }
  [[nodiscard]] const Image<float>& variance_px2() const { return variance_px2_; }

 private:
  VolumeShape shape_;
  Image<float> mean_px_;
  Image<float> variance_px2_;
};

}  // namespace vantage
