#include "engine/tuning/sequence_subject.h"

#include <algorithm>
#include <utility>

#include "engine/io/files/file_bytes.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/maps/map_io.h"
#include "engine/sequence/memory_plan.h"
#include "engine/tuning/candidate_ladder.h"
#include "scheduler/frame_pipeline.h"

namespace vantage {
namespace {

// Enough for the pipeline to be full most of the time.
constexpr int kMinFrames = 8;

}  // namespace

SequenceSubject::SequenceSubject(const MatchSubjectOptions& options, const TuningPair& pair)
    : MatchSubject(options, pair),
      frames_(std::clamp(2 * default_frames_in_flight(threads_of({})), kMinFrames,
                         kMaxFramesInFlight)) {
  encode_photograph("left.png", pair.left, left_file_);
  encode_photograph("right.png", pair.right, right_file_);
}

int SequenceSubject::in_flight_of(const TunedSettings& settings) const {
  return settings.frames_in_flight.value_or(default_frames_in_flight(threads_of(settings)));
}

std::vector<int> SequenceSubject::more_values(const TuningCoordinate& coordinate,
                                              const TunedSettings& incumbent, bool finely) const {
  if (coordinate.field != &TunedSettings::frames_in_flight) {
    return {};
  }
  return finely ? fine_ladder(in_flight_of(incumbent), frames_) : coarse_ladder(frames_);
}

int SequenceSubject::work(Runner& runner) {
  const int in_flight = in_flight_of(runner.settings);
  if (slots_.size() < static_cast<std::size_t>(in_flight)) {
    slots_.resize(static_cast<std::size_t>(in_flight));
  }
  const auto at = [&](int slot) -> Slot& { return slots_[static_cast<std::size_t>(slot)]; };
  int frames = 0;
  scheduler::FrameSteps steps;
  steps.read = [&](int /*slot*/) { return frames++ < frames_; };
  steps.prepare = [&](int slot) {
    const auto decode = [](const std::vector<std::uint8_t>& file, const char* name,
                           Photograph& photograph) {
      photograph = decode_image(FileBytes(file, name), {}, std::move(photograph)).photograph;
    };
    decode(left_file_, "left.png", at(slot).left);
    decode(right_file_, "right.png", at(slot).right);
  };
  steps.compute = [&](int slot) {
    runner.matcher.match(at(slot).left, at(slot).right, {.right = false, .unmatched = false},
                         at(slot).maps);
  };
  steps.encode = [&](int slot) {
    encode_disparity("map.pfm", at(slot).maps.left.disparity_px.view(), at(slot).file);
  };
  steps.write = [](int /*slot*/) {};
  scheduler::run_frames(runner.execution.executor(), in_flight, steps);
  return frames_;
}

}  // namespace vantage
