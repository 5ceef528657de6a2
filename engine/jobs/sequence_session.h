#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/execution.h"
#include "engine/jobs/list_columns.h"
#include "engine/jobs/sequence_job.h"
#include "engine/rectification/rectifier.h"
#include "engine/sequence/memory_plan.h"
#include "engine/sequence/pairs/frame_poses.h"
#include "engine/sequence/pairs/pair_cameras.h"
#include "engine/sequence/pairs/pair_source.h"
#include "engine/sequence/sequence_runner.h"
#include "engine/sequence/work_plan.h"

namespace vantage {

/// A sequence whose input has been opened and examined.
struct SequenceSession {
  std::unique_ptr<PairSource> pairs;
  std::optional<Rectifier> rectifier;  ///< if a calibration must be applied
  ListColumns columns;
  std::unique_ptr<PairCameras> pair_cameras;  ///< if pairs have calibrations of their own
  std::optional<MapCamera> map_camera;        ///< of outputs in metres
  std::optional<FramePoses> poses;
  std::string poses_note;  ///< about their number; may be empty
  PairShape shape;         ///< of the first pair that could be read
  FrameSelection selection;
  RowTrack rows;  ///< those of the options, once they are known

  /// Rectifies a pair in place if a calibration, the pair's or that of the job, must be applied,
  /// and corrects its rows.
  void rectify(FramePair& pair, Execution& pool) const;
  /// Whether pairs may differ in size: those of a list, which may be unrelated.
  [[nodiscard]] bool takes_any_size(const SequenceJob& job) const;
  /// The task of the sequence, with pairs from `source`; `shots` if the options need them.
  [[nodiscard]] SequenceRun run(const SequenceJob& job, PairSource& source, const ShotTable* shots,
                                int in_flight) const;
};

/// Finds out how rows are corrected, if `job` leaves that open, from the pairs of
/// visit_sampled_pairs(), of a stream from the first: sets rows and corrects_rows_per_pair of its
/// options, or its RowMode to kAsIs. Returns what was found; empty where nothing was looked at.
std::optional<SequenceRows> find_rows(SequenceJob& job, Execution& execution,
                                      SequenceSession& session);

/// The pairs of --frames, which counts the frames of the input; empty: all.
std::optional<FrameRange> selected_pairs(const SequenceJob& job, const PairSource& pairs);

// Steps of opening a sequence whose job is checked, in this order.
/// Opens the input, looks at the columns of a list of pairs, and selects frames. `job` must outlive
/// the session. Throws Error, also where there are no frames, and as check_list_columns() does.
void open_source(const SequenceJob& job, SequenceSession& session);
/// Reads the first pair that can be read; the source is then at its start. Throws Error.
void read_first_pair(PairSource& pairs, FramePair& pair);
/// Fills in the rest of `session`, and rectifies `first` in place if a calibration must be applied.
/// `is_metric`: what outputs in metres need is known. Throws Error.
void prepare_pairs(const SequenceJob& job, const std::optional<StereoCalibration>& calibration,
                   bool is_metric, FramePair& first, Execution& execution,
                   SequenceSession& session);

}  // namespace vantage
