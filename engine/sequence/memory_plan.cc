#include "engine/sequence/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <variant>

#include "engine/error.h"
#include "engine/matching/search_table.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/synthesis/photograph_grid.h"
#include "engine/synthesis/three_step_synthesizer.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {
namespace {

constexpr int kDefaultMaxInFlight = 34;  // more only even out unequal frames
/// The program, its libraries and their one-time initialisation.
constexpr std::size_t kProcessBytes = std::size_t{84} << 20;
/// Per thread: stack, allocator arena.
constexpr std::size_t kThreadBytes = std::size_t{3} << 20;

std::size_t pixels_of(ImageExtent extent) {
  return static_cast<std::size_t>(extent.width_px) * static_cast<std::size_t>(extent.height_px);
}

std::size_t photograph_bytes(ImageExtent extent, const PairShape& shape) {
  return pixels_of(extent) * static_cast<std::size_t>(shape.channels) *
         static_cast<std::size_t>(shape.bytes_per_value);
}

/// What matching one frame stores. level_bytes: see level_bands().
SearchPlan match_plan(const SequenceOptions& options, const PairShape& shape,
                      std::size_t level_bytes = kDefaultLevelBytes) {
  return search_plan(options.match.in_force(),
                     {.image = {shape.source.width_px, shape.source.height_px},
                      .channels = shape.channels,
                      .baselines = options.baselines,
                      .along_lines = options.unrectified != UnrectifiedSearch::kNone,
                      .level_bytes = level_bytes});
}

/// Memory of one frame from reading to the last of its files: the members of FrameSlot, plus the
/// temporary memory of encoding.
std::size_t frame_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t pixels = pixels_of(shape.source);
  const std::size_t photograph = photograph_bytes(shape.source, shape);
  // Fetched and decoded; a packed frame holds both images once more.
  const std::size_t more = options.baselines.empty() ? 0 : options.baselines.size() - 1;
  std::size_t bytes = (4 + 2 * more) * photograph;
  if (shape.is_video) {
    bytes += (2 + more) * photograph;  // decoder output, upper bound
  }
  if (shape.is_rectified_here) {
    bytes += 2 * photograph;
    if (views_show_photographs(options)) {
      bytes += 2 * pixels * sizeof(float);
    }
  }
  // Two maps, their confidence, two masks; for refinement two more maps and an image of four bytes.
  bytes += pixels * (2 * sizeof(float) + 2 * sizeof(float) + 2 + 2 * sizeof(float) + 4);
  const auto add_view = [&](ImageExtent extent) {  // with masks of holes and sources
    bytes += photograph_bytes(extent, shape) + 2 * pixels_of(extent);
  };
  for (const ViewPath& view : options.views) {
    add_view(extent_of(view, shape.source));
  }
  if (options.saves(SequenceOutput::kStereo)) {
    add_view(shape.source);
    add_view(shape.source);
    bytes += 2 * photograph;
  }
  if (options.saves(SequenceOutput::kPreview)) {
    bytes += 3 * pixels;
  }
  if (options.saves_posterior()) {
    bytes += 2 * pixels * sizeof(float);
  }
  if (options.temporal.reuse != Reuse::kNone) {
    bytes += match_plan(options, shape).deferred_bytes;
  }
  if (options.saves_cyclopean()) {
    bytes += pixels * (sizeof(float) + 1);
  }
  if (options.is_metric()) {
    // Points, colours and outlines of all pixels; those that are kept, in vectors that grow, and as
    // a file; triangles of a mesh.
    const auto step = static_cast<std::size_t>(options.cloud.step_px);
    const std::size_t of_point = options.saves(SequenceOutput::kMesh) ? 156 : 57;
    bytes += pixels * 16 + (options.saves_points() ? pixels / (step * step) * of_point : 0);
  }
  if (options.saves(SequenceOutput::kDepthVideo)) {
    bytes += 2 * pixels;
  }
  // A map being written: with unknown pixels replaced, and encoded.
  bytes += 2 * pixels * sizeof(float) + photograph;
  return bytes;
}

/// Converting the pictures of one frame: luma and chroma of every pixel in 16 bits.
std::size_t conversion_bytes(const PairShape& shape) {
  return shape.is_video ? 2 * 3 * sizeof(std::uint16_t) * pixels_of(shape.source) : 0;
}

/// Position maps between rectified pixels and photographs.
std::size_t rectification_bytes(const SequenceOptions& options, const PairShape& shape) {
  if (!shape.is_rectified_here) {
    return 0;
  }
  return static_cast<std::size_t>(shape.cameras_kept) * 2 * 2 * sizeof(float) *
             pixels_of(shape.source) +
         (views_show_photographs(options)
              ? PhotographGrid::held_bytes(shape.source.width_px, shape.source.height_px)
              : 0);
}

bool is_on_baseline(const SequenceOptions& options, const ViewPath& view) {
  return !options.look_at_px && std::ranges::all_of(view.keys, [](const ViewPath::Key& key) {
    const auto* position = std::get_if<BaselinePosition>(&key.pose);
    return position != nullptr && position->y == 0;
  });
}

/// Rendering a view on the baseline.
std::size_t baseline_view_bytes(const SequenceOptions& options, const PairShape& shape) {
  const int width = shape.source.width_px;
  const int height = shape.source.height_px;
  return ViewSynthesizer::filling_bytes(options.synthesis, width, height, shape.channels) +
         (options.intensity_fit == FitScope::kFrame
              ? ViewSynthesizer::working_bytes(width, height, shape.channels)
              : 0);
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

int frames_that_differ(const ViewPath& view, const PairShape& shape) {
  return view.moves() ? std::min(view.frames(), shape.pair_count) : 1;
}

/// Rendering the views of one frame, one after the other.
std::size_t view_bytes(const SequenceOptions& options, const PairShape& shape) {
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
    for (int frame = 0; frame < frames_that_differ(view, shape); ++frame) {
      max = std::max(max, bytes_at(frame, view));
    }
  }
  return max;
}

/// What both maps keep from the previous frame.
std::size_t reuse_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t pixels = pixels_of(shape.source);
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

/// State of the previous frame, and the comparison with it.
std::size_t past_bytes(const SequenceOptions& options, const PairShape& shape) {
  const std::size_t pixels = pixels_of(shape.source);
  // Per image: its levels before and now, differences and mask; two maps.
  const std::size_t side = 5 + 2 * sizeof(float);
  std::size_t bytes = options.temporal.weight > 0 ? 2 * side * pixels : 0;
  if (options.temporal.reuse != Reuse::kNone) {
    bytes += reuse_bytes(options, shape);
  }
  if (options.measure_flicker) {
    bytes += side * pixels;
    for (const ViewPath& view : options.views) {
      bytes += 3 * pixels_of(extent_of(view, shape.source));
    }
  }
  return bytes;
}

/// Delayed and reference frames of the video encoders.
std::size_t video_bytes(const SequenceOptions& options, const PairShape& shape) {
  std::size_t bytes = 0;
  const auto add_video = [&](ImageExtent extent) {
    constexpr std::size_t kFramesHeld = 64;
    bytes += pixels_of(extent) * 3 / 2 * kFramesHeld + (std::size_t{8} << 20);
  };
  for (const SequenceOutput output : options.video) {
    if (!is_per_view(output)) {
      add_video(shape.source);
      continue;
    }
    for (const ViewPath& view : options.views) {
      add_video(extent_of(view, shape.source));
    }
  }
  return bytes;
}

/// Plan of one map.
scheduler::ChainPlan chain_of(const SequenceOptions& options, const FramePair& first,
                              Execution& execution) {
  const StereoMatcher matcher(options.match, execution);
  if (options.baselines.empty()) {
    return matcher.plan(first.left, first.right);
  }
  std::vector<OtherView> others = {{&first.right, options.baselines.front()}};
  for (std::size_t k = 0; k < first.more.size(); ++k) {
    others.push_back({&first.more[k], options.baselines[k + 1]});
  }
  return matcher.plan_several(first.left, others);
}

}  // namespace

int default_frames_in_flight(int threads) { return std::min(threads + 2, kDefaultMaxInFlight); }

MemoryPlan plan_memory(const SequenceOptions& options, const MemoryRequest& request,
                       const PairShape& shape, const FramePair& first,
                       const ExecutionOptions& execution) {
  ExecutionOptions limited = execution;
  MemoryPlan plan;
  plan.frame_bytes = frame_bytes(options, shape);
  std::size_t fixed =
      kProcessBytes + video_bytes(options, shape) + past_bytes(options, shape) +
      rectification_bytes(options, shape) +
      static_cast<std::size_t>(shape.frames_kept) * photograph_bytes(shape.source, shape);
  int threads = 1;
  {
    Execution probe(execution);
    threads = probe.executor().thread_count();
  }
  fixed += static_cast<std::size_t>(threads) * kThreadBytes;
  const std::size_t of_worked_on =
      match_plan(options, shape).bytes() + view_bytes(options, shape) + conversion_bytes(shape);
  const int wanted = request.in_flight.value_or(default_frames_in_flight(threads));
  for (plan.in_flight = std::min(wanted, kMaxFramesInFlight); plan.in_flight >= 1;
       --plan.in_flight) {
    const auto matched = static_cast<std::size_t>(std::min(plan.in_flight, threads));
    const std::size_t frames =
        static_cast<std::size_t>(plan.in_flight) * plan.frame_bytes + matched * of_worked_on;
    plan.chain_bytes = scheduler::kDefaultMemoryBytes;
    if (request.memory_bytes) {
      const std::size_t limit = *request.memory_bytes;
      if (limit <= fixed + frames && plan.in_flight > 1) {
        continue;
      }
      const std::size_t rest = limit > fixed + frames ? limit - fixed - frames : 1;
      plan.chain_bytes = std::min(plan.chain_bytes, std::max<std::size_t>(1, rest / matched));
    }
    limited.chain_memory_bytes = plan.chain_bytes;
    Execution probe(limited);
    plan.chain = chain_of(options, first, probe);
    std::size_t scratch = 0;
    for (const scheduler::PassPlan& pass : plan.chain.passes) {
      scratch = std::max(scratch, pass.scratch_bytes);
    }
    plan.total_bytes = fixed + frames + static_cast<std::size_t>(threads) * scratch +
                       matched * plan.chain.stored_bytes;
    if (!request.memory_bytes || plan.total_bytes <= *request.memory_bytes) {
      return plan;
    }
  }
  throw Error(fmt::format("memory is {} MiB, expected at least {} MiB for one frame of {}x{}",
                          *request.memory_bytes >> 20, (plan.total_bytes >> 20) + 1,
                          shape.source.width_px, shape.source.height_px));
}

}  // namespace vantage
