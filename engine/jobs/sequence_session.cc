#include "engine/jobs/sequence_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <variant>

#include "engine/error.h"
#include "engine/options/frame_step_setting.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/sequence/pairs/sequence_range.h"

namespace vantage {
namespace {

/// Any frame shows the shape of all frames; the run itself reports a bad one at the start.
constexpr int kFramesTried = 100;

PairShape shape_of(const Photograph& photograph) {
  return {.source = {photograph.width(), photograph.height()},
          .channels = photograph.channels(),
          .bytes_per_value =
              std::visit([](const auto& image) { return static_cast<int>(sizeof(*image.row(0))); },
                         photograph.pixels)};
}

/// Poses of times are checked frame by frame.
void check_number_of_poses(const SequenceJob& job, const FramePair& pair,
                           SequenceSession& session) {
  const std::optional<int> poses = session.poses->numbered(pair);
  if (!poses || session.pairs->is_stream()) {
    return;
  }
  if (session.pairs->pairing().counts_frames(0, *poses, session.pairs->input_frames())) {
    session.poses->count_frames();
    return;
  }
  const int last = session.pairs->index_of(session.selection.all().end - 1);
  if (*poses <= last && !job.keep_going) {
    throw Error(fmt::format("{}: has {} poses, expected one for each pair from 0 to {}", job.poses,
                            *poses, last));
  }
  // A camera that moves has a pose per image.
  const int pairs =
      session.pairs->pair_count() + (job.input.sequence.empty() ? 0 : std::abs(job.input.step));
  if (job.input.every.takes_all() && *poses > pairs) {
    session.poses_note = fmt::format("{} has {} poses for {} pairs, the last {} are not used",
                                     job.poses, *poses, pairs, *poses - pairs);
  }
}

}  // namespace

void SequenceSession::rectify(FramePair& pair, Execution& pool) const {
  std::shared_ptr<const PairCameras::Cameras> own;
  if (!pair.details.calibration.empty()) {
    own = pair_cameras->of(pair.details, {pair.left.width(), pair.left.height()});
  }
  const Rectifier* const used = own != nullptr ? &own->rectifier
                                : rectifier    ? &*rectifier
                                               : nullptr;
  Photograph prepared;
  if (used != nullptr && used->needs_rectification()) {
    used->apply(pair.left, Side::kLeft, prepared, pool);
    std::swap(pair.left, prepared);
    used->apply(pair.right, Side::kRight, prepared, pool);
    std::swap(pair.right, prepared);
  }
  if (!rows.keys.empty()) {
    correct_rows(pair.right, rows.at(pair.index), prepared, pool);
    std::swap(pair.right, prepared);
  }
}

std::optional<SequenceRows> find_rows(SequenceJob& job, Execution& execution,
                                      SequenceSession& session) {
  SequenceOptions& options = job.sequence;
  std::optional<SequenceRows> found;
  // Moments of the right image's pixels are not brought back.
  if (!options.baselines.empty() || options.unrectified != UnrectifiedSearch::kNone ||
      (options.match.reference == Side::kRight && options.saves_posterior())) {
    job.rows = RowMode::kAsIs;
  }
  if (job.rows == RowMode::kAuto && !job.input.pairs.empty()) {
    options.corrects_rows_per_pair = true;
  } else if (job.rows == RowMode::kAuto && options.rows.keys.empty()) {
    SequenceRowSurvey survey;
    // Who sends a stream may wait for the result of its first pair before sending the next.
    const int max_pairs = session.pairs->is_stream() ? 1 : kMaxSampledPairs;
    visit_sampled_pairs(
        *session.pairs,
        [&](FramePair& pair) {
          session.rectify(pair, execution);
          survey.add(pair.index, pair.left, pair.right, execution);
        },
        {}, max_pairs);
    found = survey.result();
    options.rows = found->track;
    job.rows = options.rows.keys.empty() ? RowMode::kAsIs : RowMode::kAuto;
  }
  session.rows = options.rows;
  return found;
}

bool SequenceSession::takes_any_size(const SequenceJob& job) const {
  return !job.input.pairs.empty() && job.sequence.video.empty() &&
         !job.sequence.temporal.uses_past() && !shape.cameras && !map_camera;
}

SequenceRun SequenceSession::run(const SequenceJob& job, PairSource& source, const ShotTable* shots,
                                 int in_flight) const {
  return {.pairs = source,
          .selection = selection,
          .frame_size = takes_any_size(job) ? std::nullopt : std::optional(shape.source),
          .rectifier = rectifier ? &*rectifier : nullptr,
          .pair_cameras = pair_cameras.get(),
          .cameras = shape.cameras ? &*shape.cameras : nullptr,
          .map_camera = map_camera ? &*map_camera : nullptr,
          .poses = poses ? &*poses : nullptr,
          .shots = shots,
          .in_flight = in_flight,
          .keep_going = job.keep_going,
          .is_live = job.input.live,
          .on_progress = {},
          .stop = nullptr};
}

void read_first_pair(PairSource& pairs, FramePair& pair) {
  const int tries = std::min(kFramesTried, pairs.pair_count());
  for (int index = 0; index < tries; ++index) {
    try {
      pairs.skip_to(index);
      if (pairs.fetch(pair)) {
        pairs.decode(pair);
        pairs.skip_to(0);
        return;
      }
    } catch (const Error& error) {
      if (index + 1 == tries) {
        throw Error(fmt::format("none of the first {} frames can be read; the last error is: {}",
                                tries, error.what()));
      }
    }
  }
  throw Error("the sequence has no pair of frames");
}

std::optional<FrameRange> selected_pairs(const SequenceJob& job, const PairSource& pairs) {
  return job.frames ? std::optional(pairs.pairs_of(*job.frames)) : std::nullopt;
}

void open_source(const SequenceJob& job, SequenceSession& session) {
  session.pairs = open_pair_source(job.input);
  session.columns = check_list_columns(job, *session.pairs);
  if (!session.columns.calibrations.empty()) {
    session.pair_cameras = std::make_unique<PairCameras>(pair_camera_options(job));
  }
  session.selection = {.frame_count = session.pairs->pair_count(),
                       .chunk_frames = job.sequence.chunk_frames,
                       .frames = selected_pairs(job, *session.pairs),
                       .shard = std::nullopt};
  if (job.frames && session.selection.all().empty()) {
    throw Error(job.input.every.takes_all()
                    ? fmt::format("--frames starts at {} but the input has {} frames (0 to {})",
                                  job.frames->first, session.selection.frame_count,
                                  session.selection.frame_count - 1)
                    : fmt::format("--frames {}-{} has none of the {} frames that --every {} takes",
                                  job.frames->first, job.frames->end - 1,
                                  session.selection.frame_count, to_text(job.input.every)));
  }
}

void prepare_pairs(const SequenceJob& job, const std::optional<StereoCalibration>& calibration,
                   bool is_metric, FramePair& first, Execution& execution,
                   SequenceSession& session) {
  session.shape = shape_of(first.left);
  session.shape.is_video = !session.pairs->sound().file.empty();
  session.shape.frames_kept = session.pairs->frames_kept();
  session.shape.pair_count = session.pairs->pair_count();
  if (calibration) {
    Rectifier rectifier(*calibration, first.left.width(), first.left.height(), job.rectification);
    session.shape.cameras = rectifier.pair();
    if (is_metric) {
      session.map_camera = map_camera(rectifier.pair(), job.sequence.match.reference,
                                      job.rig.required_unit_of(*calibration));
    }
    if (rectifier.needs_rectification() || !job.unrectified.empty()) {
      session.rectifier.emplace(std::move(rectifier));
      session.shape.is_rectified_here = true;
    }
  }
  if (session.pair_cameras) {
    session.shape.is_rectified_here = true;
    session.shape.cameras_kept = PairCameras::kKept;
  }
  session.rectify(first, execution);
  if (!job.poses.empty()) {
    Trajectory trajectory = read_trajectory(job.poses);
    const bool knows_body = calibration && calibration->left_from_body;
    if (trajectory.is_of_body && knows_body) {
      trajectory = trajectory.of_camera(*calibration->left_from_body);
    } else if (trajectory.is_of_body) {
      session.poses_note = fmt::format(
          "{}: the poses are those of the body (IMU), taken as those of the left camera: no "
          "calibration says where it is on the body (T_BS)",
          job.poses);
    }
    session.poses.emplace(std::move(trajectory), job.poses);
    check_number_of_poses(job, first, session);
  }
  if (!calibration && job.rig.focal_length_px && is_metric) {
    session.map_camera = job.rig.camera(first.left.width(), first.left.height(),
                                        job.sequence.match.reference, false);
  }
}

}  // namespace vantage
