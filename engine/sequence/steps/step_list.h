#pragma once

#include <span>

#include "engine/sequence/steps/run_step.h"

/// All steps of a frame, a line each, in the order in which it takes them.
#define VANTAGE_FRAME_STEPS(STEP) \
  STEP(read_step)                 \
  STEP(decode_step)               \
  STEP(rectify_step)              \
  STEP(correct_rows_step)         \
  STEP(find_range_step)           \
  STEP(read_maps_step)            \
  STEP(match_step)                \
  STEP(finish_match_step)         \
  STEP(cyclopean_step)            \
  STEP(views_step)                \
  STEP(stereo_step)               \
  STEP(comfort_step)              \
  STEP(given_rows_step)           \
  STEP(preview_step)              \
  STEP(depth_picture_step)        \
  STEP(depth_resolution_step)     \
  STEP(video_frames_step)         \
  STEP(encode_step)               \
  STEP(write_step)                \
  STEP(deliver_step)

namespace vantage {

// Each is in a file of its name; those that runs do themselves are in ordered_steps.cc.
#define VANTAGE_DECLARE(step) StepEntry step();
VANTAGE_FRAME_STEPS(VANTAGE_DECLARE)
#undef VANTAGE_DECLARE

/// The steps as a table.
std::span<const StepEntry> frame_steps();

}  // namespace vantage
