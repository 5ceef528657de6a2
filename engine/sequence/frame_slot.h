#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/sequence/pair_source.h"
#include "engine/sequence/pending_files.h"
#include "engine/sequence/run_journal.h"
#include "engine/synthesis/view_synthesizer.h"
#include "engine/view_geometry/view_pose.h"

namespace vantage {

/// What one frame under way needs; reused by a later frame.
struct FrameSlot {
  int frame = 0;
  bool is_lead_in = false;  ///< computed for the frames behind it only
  bool is_absent = false;   ///< the input ends before it: nothing is made of it
  /// The files that are there of the frame, where only its pictures for the videos are wanted; null
  /// where they are to be written.
  const FrameRecord* stored = nullptr;
  FramePair pair;
  std::array<Photograph, 2> rectified;  ///< where a calibration is applied
  const Photograph* left = nullptr;     ///< what is matched: of `pair` or `rectified`
  const Photograph* right = nullptr;
  std::array<std::uint64_t, 2> content = {};  ///< content_hash() of the pair
  DisparityMaps maps;
  /// The maps as `pair` sees them, where its colours go into the views (PhotographGrid).
  std::array<Image<float>, 2> photograph_maps;
  MatchReport match;
  /// The new views of SequenceOptions::views, then those of the stereo picture that are no
  /// photographs.
  std::vector<SynthesizedView> views;
  std::vector<ViewPose> view_poses;  ///< of `views`, as new_view() takes them
  Photograph preview;
  Photograph stereo;
  std::vector<std::uint8_t> encoded;  ///< the file being written
  PendingFiles files;
  std::vector<FileRecord> file_records;  ///< of `files`
  std::vector<StageTime> times;          ///< of everything but matching
};

}  // namespace vantage
