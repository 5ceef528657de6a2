#pragma once

#include <array>
#include <optional>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/image/photograph.h"
#include "engine/rectification/rectified_pair.h"
#include "engine/synthesis/intensity_fit.h"
#include "engine/synthesis/three_step_synthesizer.h"
#include "engine/synthesis/unrectified_pair.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/view_pose.h"
#include "kernels/intensity_sums/intensity_sums.h"

namespace vantage {

/// Renders a pair from any pose, by the method that suits the pose and the options: with
/// WarpColour::kForward, PosedCamera poses take the book's three steps; everything else is one
/// pass, from the photographs if the source has them. At a camera's own position the view is that
/// camera's photograph, resampled by the view's homography alone, also where its map is unknown and
/// outside the rectified image (with γ = α; except for forward warps of PosedCamera poses).
///
/// Thread rule: everything may be called concurrently for different results. Identical for any
/// ExecutionOptions.
class PoseRenderer {
 public:
  /// `cameras` are those of the rectified pair; null: poses are positions on or off the baseline.
  /// They and `execution` must outlive the renderer. Throws UsageError for invalid options.
  PoseRenderer(const SynthesisOptions& options, const RectifiedPair* cameras, Execution& execution);

  /// Throws the errors of render() for this pose and images of this size.
  void check(const ViewPose& pose, int width_px, int height_px) const;

  /// Errors as new_view() and the synthesizers.
  void render(const ViewSource& source, const ViewPose& pose, SynthesizedView& view,
              const std::array<IntensityFit, 4>* given_fit) const;

  /// The sums of the intensity regression for the view midway between the cameras.
  [[nodiscard]] kernels::IntensitySums intensity_sums(const ViewSource& source) const;

  [[nodiscard]] const SynthesisOptions& options() const { return synthesizer_.options(); }

 private:
  /// The camera of a pose that is rendered in three steps; null: one pass.
  [[nodiscard]] const PosedCamera* three_step_camera(const ViewPose& pose) const;

  const RectifiedPair* cameras_;
  Execution& execution_;
  ViewSynthesizer synthesizer_;
  ThreeStepSynthesizer three_steps_;
};

}  // namespace vantage
