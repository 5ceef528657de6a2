#include <array>
#include <memory>
#include <vector>

#include "engine/matching/region/matched_part.h"
#include "engine/matching/search/epipolar/rectified_map.h"
#include "engine/matching/search_table.h"
#include "engine/sequence/past/frame_reuse.h"
#include "engine/sequence/past/temporal_state.h"
#include "engine/sequence/shots/shot_matchers.h"
#include "engine/sequence/steps/frame_needs.h"
#include "engine/sequence/steps/step_list.h"

namespace vantage {
namespace {

/// Makes the maps of a frame, unless they need no other frame and can wait for the next step.
class MatchStep final : public RunStep {
 public:
  explicit MatchStep(const FrameTools& tools)
      : options_(tools.options),
        rectifier_(tools.cameras.rectifier),
        execution_(tools.execution),
        matchers_(tools.options.match, tools.shots,
                  tools.options.unrectified != UnrectifiedSearch::kNone ? rectifier_ : nullptr,
                  tools.execution),
        temporal_(tools.options.temporal),
        reuse_(tools.options.temporal.threshold, tools.execution) {}

  [[nodiscard]] bool is_needed(const FrameSlot& slot) const override { return !slot.maps_are_read; }

  void run(FrameSlot& slot) override {
    slot.shot = matchers_.of(slot.frame, slot.pair.details.disparities);
    slot.searched = slot.shot->options.disparities;
    MatchRequest request = match_request(options_);
    const VolumeRequest posterior{.side = options_.match.reference, .sink = &slot.posterior};
    if (options_.saves_posterior()) {
      request.volumes = {&posterior, 1};
    }
    if (slot.shot->unrectified) {
      match_along_lines(slot, request);
    } else if (options_.temporal.uses_past()) {
      match_with_past(slot, request);
    } else {
      match_images(slot, request);
    }
    const Photograph& image = options_.match.reference == Side::kLeft ? *slot.left : *slot.right;
    slot.posterior.erase(image.left_out);
  }

  void add_memory_use(MemoryUse& use) const override {
    matchers_.add_memory_use(use);
    use.add("frame before", reuse_.held_bytes());
  }

 private:
  /// Photographs that are not rectified.
  void match_along_lines(FrameSlot& slot, const MatchRequest& request) const {
    slot.shot->unrectified->match(
        slot.pair.left, slot.pair.right,
        {.left = request.left, .right = request.right, .probability = request.probability},
        slot.maps, &slot.match);
    if (options_.unrectified != UnrectifiedSearch::kOnRectified) {
      return;
    }
    for (const Side side : {Side::kLeft, Side::kRight}) {
      if (side == Side::kLeft ? request.left : request.right) {
        bring_to_rectified(*rectifier_, side, execution_, slot.maps.of(side));
      }
    }
  }

  /// By all images of the frame.
  void match_images(FrameSlot& slot, const MatchRequest& request) const {
    if (options_.baselines.empty()) {
      slot.shot->matcher.match(*slot.left, *slot.right, request, slot.maps, &slot.match);
      return;
    }
    std::vector<const Photograph*> images = {slot.left, slot.right};
    for (const Photograph& image : slot.pair.more) {
      images.push_back(&image);
    }
    std::vector<double> positions = {0};
    positions.insert(positions.end(), options_.baselines.begin(), options_.baselines.end());
    for (const Side side : {Side::kLeft, Side::kRight}) {
      if (!(side == Side::kLeft ? request.left : request.right)) {
        continue;
      }
      // The other image of the pair is the first: disparities are those of the pair.
      const std::size_t reference = index_of(side);
      std::vector<OtherView> others = {
          {images[1 - reference], positions[1 - reference] - positions[reference]}};
      for (std::size_t k = 2; k < images.size(); ++k) {
        others.push_back({images[k], positions[k] - positions[reference]});
      }
      DisparityMaps maps;
      MatchReport report;
      slot.shot->matcher.match_several(*images[reference], others, request, maps, &report);
      slot.maps.of(side) = std::move(maps.of(side));
      slot.match.add(report);
    }
  }

  void match_with_past(FrameSlot& slot, MatchRequest request) {
    // A chunk has no state from before it, whichever of its frames is the first good one.
    const int chunk = slot.frame / options_.chunk_frames;
    const bool is_first = chunk != chunk_of_past_;
    chunk_of_past_ = chunk;
    if (options_.temporal.reuse == Reuse::kNone) {
      match_with_prior(slot, request, is_first);
      return;
    }
    reuse_.start_frame(slot.frame % options_.chunk_frames, is_first);
    request.previous = &reuse_;
    request.deferred = &slot.deferred;
    try {
      slot.shot->matcher.match(*slot.left, *slot.right, request, slot.maps, &slot.match);
    } catch (...) {
      reuse_.forget();  // its maps may be those of two frames
      throw;
    }
  }

  void match_with_prior(FrameSlot& slot, MatchRequest request, bool is_first) {
    if (is_first) {
      temporal_.restart();
    }
    request.prior = temporal_.priors_for(*slot.left, *slot.right, execution_);
    match_images(slot, request);
    temporal_.remember(*slot.left, *slot.right, slot.maps, execution_);
  }

  const SequenceOptions& options_;
  const Rectifier* rectifier_;
  Execution& execution_;
  ShotMatchers matchers_;
  TemporalState temporal_;
  FrameReuse reuse_;
  int chunk_of_past_ = -1;  ///< chunk of temporal_ and reuse_
};

/// What matching one frame stores. level_bytes: see level_bands().
SearchPlan match_plan(const SequenceOptions& options, const PairShape& shape,
                      std::size_t level_bytes = kDefaultLevelBytes) {
  constexpr std::array<double, 2> kPair = {0, 1};
  const MatchedPart part(options.match.in_force(), {shape.source.width_px, shape.source.height_px},
                         kPair);
  return search_plan(options_of_part(options.match),
                     {.image = part.extent(),
                      .channels = shape.channels,
                      .baselines = options.baselines,
                      .along_lines = options.unrectified != UnrectifiedSearch::kNone,
                      .level_bytes = level_bytes});
}

/// What both maps keep from the previous frame.
std::size_t reuse_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t pixels = shape.pixels();
  // Of images of half the size: levels, mask of changes. Of maps: pixels without a match; winners,
  // refined, confidence.
  constexpr std::size_t kHalfSizeBytes = 2;
  constexpr std::size_t kMapBytes = 1 + 3 * sizeof(float);
  const SearchPlan plan = match_plan(options, shape, kWithoutBands);
  if (plan.reductions > 0) {
    return 2 * ((kHalfSizeBytes + kMapBytes) * pixels / 4 + plan.levels.bytes());
  }
  // Also the images of half the size, and check maps.
  return 2 * ((kHalfSizeBytes + 1) * pixels / 4 + (kMapBytes + sizeof(float)) * pixels +
              plan.levels.bytes());
}

StepBytes match_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t pixels = shape.pixels();
  const SearchPlan plan = match_plan(options, shape);
  StepBytes bytes{.of_work = plan.bytes()};
  // Two maps, their confidence, two masks; for refinement two more maps and an image of four bytes.
  bytes.of_frame = pixels * (2 * sizeof(float) + 2 * sizeof(float) + 2 + 2 * sizeof(float) + 4);
  if (options.saves_posterior()) {
    bytes.of_frame += 2 * pixels * sizeof(float);
  }
  if (options.temporal.weight > 0) {
    bytes.of_run += 2 * kPastSideBytes * pixels;
  }
  if (options.temporal.reuse != Reuse::kNone) {
    bytes.of_frame += plan.deferred_bytes;
    bytes.of_run += reuse_bytes(options, shape);
  }
  return bytes;
}

std::size_t matched_bytes(const FrameSlot& slot) {
  return held_bytes(slot.maps) + held_bytes(slot.posterior.mean_px()) +
         held_bytes(slot.posterior.variance_px2());
}

}  // namespace

StepEntry match_step() {
  return {.name = "",
          .account = "match",
          .phase = StepPhase::kCompute,
          .make = make_step<MatchStep>,
          .planned_bytes = match_bytes,
          .held_bytes = matched_bytes};
}

}  // namespace vantage
