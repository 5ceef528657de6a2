#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/image/memory_use.h"
#include "engine/matching/range_check.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rectifier.h"
#include "engine/remark.h"
#include "engine/reprojection/map_camera.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/latency_meter.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/pairs/frame_poses.h"
#include "engine/sequence/pairs/pair_cameras.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/shots/shots.h"
#include "engine/sequence/work_plan.h"

namespace vantage {

struct FrameSlot;

/// Progress of a run.
struct SequenceProgress {
  int frames_done = 0;   ///< delivered by this process
  int frames_total = 0;  ///< to be processed by this process; 0: not known
  double cells = 0;      ///< matching cells computed for the frames done
};

/// Seconds of one stage, summed over frames (frames overlap, so sums may exceed wall time).
struct SequenceStage {
  std::string name;
  double seconds = 0;
};

/// A remark on one frame.
struct FrameRemark {
  int frame = 0;
  std::string text;
};

/// A remark of matching: of the first frame that has one of its kind and subject.
struct MatchRemark {
  Remark remark;
  int frame = 0;
  int frames = 0;  ///< that have one
};

/// What frames took from the frames before them, with TemporalOptions::reuse.
struct ReuseReport {
  int frames = 0;           ///< of images that are large enough
  int frames_searched = 0;  ///< of these, those of which every tile was searched
  double searched_sum = 0;  ///< of the shares of tiles that were searched

  void add(double searched_share) {
    ++frames;
    frames_searched += searched_share == 1 ? 1 : 0;
    searched_sum += searched_share;
  }
  [[nodiscard]] double mean_share_reused() const { return 1 - searched_sum / frames; }
};

struct SequenceReport {
  int frames = 0;          ///< delivered by this run
  int frames_before = 0;   ///< of its share, delivered by earlier runs
  int pictures_again = 0;  ///< of these, those whose pictures were made again for the videos
  /// Where a continued run resumes the videos, if that is before the delivered frames.
  std::optional<int> videos_from;
  std::vector<FrameRemark> skipped;
  std::vector<FrameRemark> remarks;  ///< frames that repeat the previous one, gaps in time, …
  std::vector<MatchRemark> match_remarks;
  std::map<int, MapShares> map_shares;  ///< by frame, of those that this run matched
  int frames_maybe_cut = 0;             ///< frames whose search range may be too narrow
  /// The worst check of such a frame: the largest share beyond the range. Only the first few frames
  /// that are matched are checked, so it may depend on timing.
  std::optional<CutRange> cut;
  int cut_frame = 0;
  bool interrupted = false;                   ///< `stop` was set before all was done
  std::optional<std::string> stream_problem;  ///< of the frame at which a stream ended the run
  std::optional<ShotTable> shots;             ///< of a stream, if the options need shots
  int in_flight = 0;
  int width_px = 0;  ///< of the last frame
  int height_px = 0;
  double cells = 0;
  /// Time during which at least one frame was being matched or rendered: no reading or writing.
  double compute_seconds = 0;
  std::vector<SequenceStage> stages;  ///< in order of first appearance
  /// Processor time of this process by the accounts of its steps, then "other": codecs with threads
  /// of their own, waiting threads that look for work.
  std::vector<SequenceStage> processor;
  double share_busy = 0;      ///< of the time of all threads of the execution, processor time
  scheduler::ChainPlan plan;  ///< of the last frame
  ReuseReport reuse;
  std::optional<LiveReport> live;  ///< of a live run
  MemoryUse memory;                ///< "frames in flight" and that of matching them
};

/// The mean of the frames of `map_shares`, of which there are some.
MapShares mean_shares(const SequenceReport& sequence);

/// Input and settings of a run.
struct SequenceRun {
  PairSource& pairs;
  FrameSelection selection;
  std::optional<ImageExtent> frame_size;  ///< required for all frames; must be set for videos
  /// Null: the pairs are rectified. Must be set for a search with UnrectifiedSearch.
  const Rectifier* rectifier = nullptr;
  PairCameras* pair_cameras = nullptr;     ///< must be set if pairs have calibrations of their own
  const RectifiedPair* cameras = nullptr;  ///< of the pairs; must be set for camera views
  const MapCamera* map_camera = nullptr;   ///< of the reference's map; must be set if is_metric()
  const FramePoses* poses = nullptr;       ///< with map_camera: points are in their world
  const ShotTable* shots = nullptr;  ///< must be set if the options need shots; not of a stream
  int in_flight = 1;                 ///< frames processed at the same time, 1..64
  bool keep_going = false;           ///< frames that fail are skipped and recorded
  bool is_live = false;              ///< the source drops pairs; in_flight is 1
  std::function<void(const SequenceProgress&)> on_progress;  ///< never concurrently
  /// Each frame that has its results, before they are delivered; in order, never concurrently.
  std::function<void(const FrameSlot&)> on_frame = {};
  const std::atomic<bool>* stop = nullptr;
};

/// What the results of a frame depend on.
FrameDependence dependence_of(const SequenceOptions& options, const SequenceLayout& layout);

/// Converts a sequence of pairs to disparity maps and new views on disk, in order. The strips of
/// several frames share the executor's threads; memory is bounded by the frames in flight, whose
/// buffers are reused. Frames that are done according to journal and files are kept.
///
/// Thread rule: one run() at a time. Files are identical for any ExecutionOptions, in-flight count
/// and division into parts, and after any interruption. Files are written atomically, and recorded
/// in the journal when they are safe.
class SequenceRunner {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the runner.
  SequenceRunner(const SequenceOptions& options, Execution& execution);

  /// Creates the folders of `layout`, then processes the missing frames. Setting `stop` reads no
  /// further frame and finishes those in flight.
  ///
  /// A stream (PairSource::is_stream()) is processed to its end, to a bad frame, which
  /// SequenceReport::stream_problem tells, or to `stop`; then the last segment of its videos is
  /// complete. What needs all frames of a shot before the first is matched is not possible.
  ///
  /// Throws Error at the first bad frame, naming its number and files, after all earlier frames are
  /// delivered and with none after it, unless `keep_going`; OutputError, naming the file, when
  /// results cannot be written.
  SequenceReport run(const SequenceRun& run, const SequenceLayout& layout,
                     RunJournal& journal) const;

 private:
  SequenceOptions options_;
  Execution& execution_;
};

}  // namespace vantage
