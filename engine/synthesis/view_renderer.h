#pragma once

#include <array>
#include <optional>
#include <vector>

#include "engine/execution.h"
#include "engine/image/stereo_display.h"
#include "engine/synthesis/pair_with_maps.h"
#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/pose_renderer.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// Settings for two eyes per pose, packed in one image.
struct TwoEyes {
  StereoDisplay display;
  double separation_baselines = 1;  ///< the pose lies in their middle
};

/// A new view, or two eyes in one image. Reused between calls without allocation.
struct RenderedView {
  std::array<SynthesizedView, 2> eyes;  ///< without TwoEyes the first one is the view
  Photograph both;

  [[nodiscard]] const Photograph& picture(bool has_two_eyes) const {
    return has_two_eyes ? both : eyes[0].image;
  }
};

/// Renders the views of one pair; their colours come from the images as they were read, unless
/// those are moved the book's way. Thread rule: render() may be called concurrently for different
/// results; `pair` and `execution` outlive the renderer.
class ViewRenderer {
 public:
  /// Throws UsageError for invalid options.
  ViewRenderer(const PairWithMaps& pair, const SynthesisOptions& options,
               std::optional<TwoEyes> two_eyes, Execution& execution);

  /// Throws, naming the view, what render() would throw for one of these poses: before any file is
  /// written.
  void check(const std::vector<ViewPose>& poses) const;

  /// One brightness for all views from now on: that of the view half-way between the cameras.
  /// Estimated view by view it would jump in a movie.
  void fix_intensities();

  /// Errors as new_view() and ViewSynthesizer::synthesize().
  void render(const ViewPose& pose, RenderedView& result) const;

 private:
  void synthesize(const ViewPose& pose, SynthesizedView& view) const;
  /// One pose, or those of both eyes.
  [[nodiscard]] std::vector<ViewPose> eyes_of(const ViewPose& pose) const;

  ViewSource source_;
  double baseline_;  ///< 0 without calibration
  std::optional<TwoEyes> two_eyes_;
  PoseRenderer renderer_;
  std::optional<PhotographGrid> photograph_grid_;  ///< where colours come from unrectified images
  std::array<Image<float>, 2> photograph_maps_;
  std::optional<std::array<IntensityFit, 4>> fit_;
};

}  // namespace vantage
