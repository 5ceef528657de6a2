#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <variant>

#include "engine/error.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"
#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/pose_renderer.h"
#include "engine/synthesis/three_step_synthesizer.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {
namespace {

/// Makes the new views, and those of the stereo picture that are no photographs.
class ViewsStep final : public RunStep {
 public:
  explicit ViewsStep(const FrameTools& tools)
      : options_(tools.options),
        cameras_(tools.cameras.rectified),
        shots_(tools.shots),
        renderer_(tools.options.synthesis, cameras_, tools.execution) {
    const Rectifier* const rectifier = tools.cameras.rectifier;
    if (rectifier != nullptr && rectifier->needs_rectification() &&
        views_show_photographs(options_)) {
      photograph_grid_.emplace(*rectifier, tools.execution);
    }
  }

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override {
    const bool is_stereo_made = options_.saves(SequenceOutput::kStereo) &&
                                std::ranges::any_of(options_.stereo_views_x, [&](double view_x) {
                                  return slot.photograph_at(view_x) == nullptr;
                                });
    return needs_views(options_, slot) && (!options_.views.empty() || is_stereo_made);
  }

  void run(FrameSlot& slot) override {
    for (const ViewPath& path : options_.views) {
      slot.view_poses.push_back(placed(path.at(slot.frame), options_.look_at_px, cameras_,
                                       slot.left->width(), slot.left->height()));
    }
    if (options_.saves(SequenceOutput::kStereo)) {
      for (const double view_x : options_.stereo_views_x) {
        if (slot.photograph_at(view_x) == nullptr) {
          slot.view_poses.emplace_back(BaselinePosition{view_x, 0});
        }
      }
    }
    slot.views.resize(slot.view_poses.size());
    ViewSource source{*slot.left,
                      *slot.right,
                      slot.maps.left.disparity_px.view(),
                      slot.maps.right.disparity_px.view(),
                      {}};
    if (photograph_grid_) {
      photograph_grid_->bring(slot.maps, slot.photograph_maps);
      source.photographs.emplace(
          photograph_grid_->pair_of(slot.pair.left, slot.pair.right, slot.photograph_maps));
    }
    const std::array<IntensityFit, 4>* fit = options_.intensity_fit == FitScope::kShot
                                                 ? &shots_->shot_of(slot.frame).intensity
                                                 : nullptr;
    for (std::size_t view = 0; view < slot.views.size(); ++view) {
      renderer_.render(source, slot.view_poses[view], slot.views[view], fit);
    }
  }

 private:
  const SequenceOptions& options_;
  const RectifiedPair* cameras_;
  const ShotTable* shots_;
  PoseRenderer renderer_;
  std::optional<PhotographGrid> photograph_grid_;  ///< if views_show_photographs()
};

bool is_on_baseline(const SequenceOptions& options, const ViewPath& view) {
  return !options.look_at_px && std::ranges::all_of(view.keys, [](const ViewPath::Key& key) {
    const auto* position = std::get_if<BaselinePosition>(&key.pose);
    return position != nullptr && position->y == 0;
  });
}

/// Rendering a view on the baseline.
std::size_t baseline_view_bytes(const SequenceOptions& options, const PairShape& shape) {
  return ViewSynthesizer::filling_bytes(options.synthesis, shape.source.width_px,
                                        shape.source.height_px, shape.channels);
}

/// Rendering a view at any `pose`.
std::size_t surface_view_bytes(const SequenceOptions& options, const PairShape& shape,
                               const ViewPose& pose) {
  const RectifiedPair* cameras = shape.cameras ? &*shape.cameras : nullptr;
  const int width = shape.source.width_px;
  const int height = shape.source.height_px;
  const ViewPose place = placed(pose, options.look_at_px, cameras, width, height);
  const auto* camera = std::get_if<PosedCamera>(&place);
  if (options.synthesis.warp == WarpColour::kForward && camera != nullptr && cameras != nullptr) {
    return ThreeStepSynthesizer::working_bytes(options.synthesis, *cameras, *camera, shape.channels,
                                               shape.bytes_per_value);
  }
  const NewView view = new_view(place, cameras, width, height);
  return ViewSynthesizer::filling_bytes(options.synthesis, view, width, height, shape.channels) +
         ViewSynthesizer::working_bytes(view, width, height, shape.channels);
}

/// Rendering the views of one frame, one after the other.
std::size_t rendering_bytes(const SequenceOptions& options, const PairShape& shape) {
  const auto bytes_at = [&](int frame, const ViewPath& view) {
    try {
      return surface_view_bytes(options, shape, view.at(frame));
    } catch (const UsageError&) {
      throw;
    } catch (const Error& error) {
      throw Error(view.moves() ? fmt::format("frame {}: {}", frame, error.what()) : error.what());
    }
  };
  std::size_t max =
      options.saves(SequenceOutput::kStereo) ? baseline_view_bytes(options, shape) : 0;
  for (const ViewPath& view : options.views) {
    if (is_on_baseline(options, view)) {
      max = std::max(max, baseline_view_bytes(options, shape));
      continue;
    }
    const int frames_that_differ = view.moves() ? std::min(view.frames(), shape.pair_count) : 1;
    for (int frame = 0; frame < frames_that_differ; ++frame) {
      max = std::max(max, bytes_at(frame, view));
    }
  }
  return max;
}

StepBytes view_bytes(const SequenceOptions& options, const PairShape& shape) {
  StepBytes bytes;
  const auto add_view = [&](ImageExtent extent) {  // with masks of holes and sources
    bytes.of_frame += shape.photograph_bytes(extent) + 2 * PairShape::pixels_of(extent);
  };
  for (const ViewPath& view : options.views) {
    add_view(extent_of(view, shape.source));
  }
  if (options.saves(SequenceOutput::kStereo)) {
    add_view(shape.source);
    add_view(shape.source);
  }
  if (shape.is_rectified_here && views_show_photographs(options)) {
    bytes.of_frame += 2 * shape.pixels() * sizeof(float);
    bytes.of_run = PhotographGrid::held_bytes(shape.source.width_px, shape.source.height_px);
  }
  bytes.of_work = rendering_bytes(options, shape);
  return bytes;
}

std::size_t held_of_views(const FrameSlot& slot) {
  std::size_t bytes = held_bytes(slot.photograph_maps[0]) + held_bytes(slot.photograph_maps[1]);
  for (const SynthesizedView& view : slot.views) {
    bytes += held_bytes(view.image) + held_bytes(view.holes) + held_bytes(view.sources);
  }
  return bytes;
}

}  // namespace

StepEntry views_step() {
  return {.name = "views",
          .account = "views",
          .make = make_step<ViewsStep>,
          .planned_bytes = view_bytes,
          .held_bytes = held_of_views};
}

}  // namespace vantage
