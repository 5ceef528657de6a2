#include "engine/sequence/memory_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/error.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {
namespace {

constexpr int kMostInFlight = 64;
constexpr int kDefaultMostInFlight = 34;  // more only help to even out unequal frames
/// The program, its libraries and what they set up at first use.
constexpr std::size_t kProcessBytes = std::size_t{77} << 20;
/// Of a thread: stack, arena of the allocator.
constexpr std::size_t kThreadBytes = std::size_t{3} << 20;

std::size_t photograph_bytes(const PairShape& shape) {
  return static_cast<std::size_t>(shape.source.width_px) *
         static_cast<std::size_t>(shape.source.height_px) *
         static_cast<std::size_t>(shape.channels) * static_cast<std::size_t>(shape.bytes_per_value);
}

/// What one frame holds from reading to the last of its files. Sums what FrameSlot has, and what
/// encoding adds while it runs.
std::size_t frame_bytes(const SequenceOptions& options, const PairShape& shape) {
  const auto pixels = static_cast<std::size_t>(shape.source.width_px) *
                      static_cast<std::size_t>(shape.source.height_px);
  const std::size_t photograph = photograph_bytes(shape);
  // Fetched and decoded; a packed frame holds both images once more.
  std::size_t bytes = 4 * photograph;
  if (shape.is_rectified_here) {
    bytes += 2 * photograph;
  }
  // Two maps, their confidence, two masks, and as much again for refining them.
  bytes += pixels * (2 * sizeof(float) + 2 * sizeof(float) + 2 + 2 * sizeof(float));
  std::size_t views = options.views.size();
  if (options.saves(SequenceOutput::kStereo)) {
    views += 2;
    bytes += 2 * photograph;
  }
  bytes += views * (photograph + 2 * pixels);  // with masks of holes and sources
  if (options.saves(SequenceOutput::kPreview)) {
    bytes += 3 * pixels;
  }
  // A map on its way into a file: with unknown pixels replaced, and encoded.
  bytes += 2 * pixels * sizeof(float) + photograph;
  return bytes;
}

/// What matching one frame takes beside its strips: images of what costs compare.
std::size_t match_bytes(const SequenceOptions& options, const PairShape& shape) {
  const auto pixels = static_cast<std::size_t>(shape.source.width_px) *
                      static_cast<std::size_t>(shape.source.height_px);
  const std::size_t channels = options.match.resolved().colour == ColourUse::kChannels
                                   ? static_cast<std::size_t>(shape.channels)
                                   : 1;
  // Levels with lower and upper bounds or gradients, of both images, and mirrored copies.
  constexpr std::size_t kPlanes = 4 * 2;
  return pixels * channels * kPlanes * sizeof(float);
}

/// What rendering the views of one frame, one after the other, takes.
std::size_t view_bytes(const SequenceOptions& options, const PairShape& shape) {
  if (options.views.empty() && !options.saves(SequenceOutput::kStereo)) {
    return 0;
  }
  const int width = shape.source.width_px;
  const int height = shape.source.height_px;
  const std::size_t filling =
      ViewSynthesizer::filling_bytes(options.synthesis, width, height, shape.channels);
  for (const ViewTrack& track : options.views) {
    for (const ViewTrack::Key& key : track.keys) {
      if (key.position.y != 0) {
        return filling + ViewSynthesizer::working_bytes(
                             baseline_view(key.position.x, key.position.y, width, height), width,
                             height, shape.channels);
      }
    }
  }
  return filling + (options.intensity_fit == FitScope::kFrame
                        ? ViewSynthesizer::working_bytes(width, height, shape.channels)
                        : 0);
}

/// What is kept of the frame before, and to compare with it.
std::size_t past_bytes(const SequenceOptions& options, const PairShape& shape) {
  const auto pixels = static_cast<std::size_t>(shape.source.width_px) *
                      static_cast<std::size_t>(shape.source.height_px);
  // Per image: its levels before and now, differences and mask; two maps.
  const std::size_t side = 5 + 2 * sizeof(float);
  std::size_t bytes = options.temporal.weight > 0 ? 2 * side * pixels : 0;
  if (options.measure_flicker) {
    bytes += (side + 3 * options.views.size()) * pixels;
  }
  return bytes;
}

/// What the encoders of the videos hold back and reconstruct.
std::size_t video_bytes(const SequenceOptions& options, const PairShape& shape) {
  const auto pixels = static_cast<std::size_t>(shape.source.width_px) *
                      static_cast<std::size_t>(shape.source.height_px);
  std::size_t videos = 0;
  for (const SequenceOutput output : options.video) {
    const bool per_view = output == SequenceOutput::kViews || output == SequenceOutput::kHoles;
    videos += per_view ? options.views.size() : 1;
  }
  constexpr std::size_t kFramesHeld = 64;
  return videos * (pixels * 3 / 2 * kFramesHeld + (std::size_t{8} << 20));
}

}  // namespace

MemoryPlan plan_memory(const SequenceOptions& options, const MemoryRequest& request,
                       const PairShape& shape, const Photograph& left, const Photograph& right,
                       const ExecutionOptions& execution) {
  ExecutionOptions limited = execution;
  MemoryPlan plan;
  plan.frame_bytes = frame_bytes(options, shape);
  std::size_t fixed = kProcessBytes + video_bytes(options, shape) + past_bytes(options, shape) +
                      static_cast<std::size_t>(shape.frames_kept) * photograph_bytes(shape);
  int threads = 1;
  {
    Execution probe(execution);
    threads = probe.executor().thread_count();
  }
  fixed += static_cast<std::size_t>(threads) * kThreadBytes;
  const int wanted = request.in_flight.value_or(std::min(threads + 2, kDefaultMostInFlight));
  for (plan.in_flight = std::min(wanted, kMostInFlight); plan.in_flight >= 1; --plan.in_flight) {
    const auto matched = static_cast<std::size_t>(std::min(plan.in_flight, threads));
    const std::size_t frames = static_cast<std::size_t>(plan.in_flight) * plan.frame_bytes +
                               matched * (match_bytes(options, shape) + view_bytes(options, shape));
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
    plan.chain = StereoMatcher(options.match, probe).plan(left, right);
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
