#pragma once

#include <cstddef>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/posed_camera.h"

namespace vantage {

/// Renders the view of any camera in the three steps of the book's chapter 3: both images and their
/// maps are rectified together with the new camera (3.8), warped to its position (3.5) and
/// combined, and the result is derectified. Colours are resampled in each step, where a NewView
/// from camera_view() resamples once: this is the book's method, for comparison.
///
/// Thread rule: synthesize() may be called concurrently for different results. Identical for any
/// ExecutionOptions.
class ThreeStepSynthesizer {
 public:
  /// As ViewSynthesizer.
  ThreeStepSynthesizer(const SynthesisOptions& options, Execution& execution);

  /// `source` as for ViewSynthesizer, its photographs are not used; `pair`: its geometry; `camera`:
  /// the new one in the frame of the left. The view has the camera's size. Throws Error as
  /// trifocal_rectification() does, in particular if the plane through the three cameras intersects
  /// the field of view of one; otherwise as ViewSynthesizer.
  void synthesize(const ViewSource& source, const RectifiedPair& pair, const PosedCamera& camera,
                  SynthesizedView& view,
                  const std::array<IntensityFit, 4>* given_fit = nullptr) const;

  /// Upper bound of the working memory of synthesize() in bytes, for photographs with this many
  /// channels and bytes per value. Throws Error as trifocal_rectification().
  [[nodiscard]] static std::size_t working_bytes(const SynthesisOptions& options,
                                                 const RectifiedPair& pair,
                                                 const PosedCamera& camera, int channels,
                                                 int bytes_per_value);

 private:
  ViewSynthesizer synthesizer_;
  Execution& execution_;
};

}  // namespace vantage
