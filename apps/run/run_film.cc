#include "apps/run/run_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/reports/run_report.h"
#include "apps/run/resumed_run.h"
#include "apps/settings/command_line.h"
#include "engine/error.h"
#include "engine/io/maps/map_io.h"
#include "engine/rectification/rows/row_correction.h"
#include "engine/sequence/journal/journal_json.h"

namespace vantage::apps {
namespace {

/// Views are made of two maps of rectified pairs. Lists hold pairs that have nothing to do with
/// each other.
void require_film(const RunJob& job, const RunIdentity& identity) {
  const SequenceOptions& options = job.sequence;
  if (identity.is_stream()) {
    throw Error(fmt::format("{}: its input was a stream, which cannot be read again", job.output));
  }
  if (!options.saves(SequenceOutput::kDisparity) ||
      !options.saves(SequenceOutput::kRightDisparity)) {
    throw Error(
        fmt::format("{}: has not the maps of both images, expected a run with '--save "
                    "disparity,right-disparity'",
                    job.output));
  }
  if (!options.baselines.empty() || options.match.disparities_y || !job.unrectified.empty() ||
      !job.input.pairs.empty()) {
    throw Error(fmt::format("{}: expected a run of the rectified pairs of a film or of folders",
                            job.output));
  }
}

}  // namespace

RunFilm::RunFilm(const std::string& folder) {
  // As 'vantage run --resume' takes it up, which told what there is to tell.
  const Arguments arguments = {"--output", folder, "--resume", "--quiet"};
  Settings settings("view", "");
  add_run_settings(settings, job_);
  (void)read_command_line(settings, arguments);
  take_up_run(arguments, settings, job_);
  complete(job_, settings);
  layout_ = std::make_unique<SequenceLayout>(folder, job_.sequence);
  const RunIdentity identity = RunJournal::read_identity(layout_->journal_folder());
  require_film(job_, identity);
  RunReport report(settings.command(), settings.values());
  session_ = open_run(job_, settings, report);
  if (const std::string change = difference(identity, session_.identity); !change.empty()) {
    throw Error(fmt::format("{}: is of another input: {}", folder, change));
  }
  delivered_ = std::make_unique<DeliveredFrames>(*layout_);
}

std::string RunFilm::problem(int frame) const {
  const auto record = delivered_->records().find(frame);
  if (record != delivered_->records().end() && record->second.skipped) {
    return "left out by the run: " + record->second.problem;
  }
  return delivered_->files_of(frame) != nullptr ? "" : "not in the folder of the run";
}

DisparityMap RunFilm::read_map(int frame, SequenceOutput output) const {
  const std::vector<OutputStream>& streams = layout_->streams();
  const auto stream = std::ranges::find(streams, output, &OutputStream::output);
  return read_disparity(layout_->folder() / SequenceLayout::file(*stream, frame,
                                                                 delivered_->files_of(frame)->name,
                                                                 job_.sequence.map_format));
}

PairWithMaps RunFilm::read(int frame, Execution& execution) {
  FramePair pair;
  session_.pairs->skip_to(frame);
  if (!session_.pairs->fetch(pair)) {
    throw Error(fmt::format("{}: the input ends before it", session_.pairs->describe(frame)));
  }
  session_.pairs->decode(pair);
  session_.rectify(pair, execution);
  PairWithMaps result;
  result.cameras = session_.shape.cameras;
  result.left = std::move(pair.left);
  result.right = std::move(pair.right);
  result.maps.left.disparity_px = read_map(frame, SequenceOutput::kDisparity);
  result.maps.right.disparity_px = read_map(frame, SequenceOutput::kRightDisparity);
  if (!session_.rows.keys.empty()) {
    bring_to_corrected_rows(session_.rows.at(pair.index), result.maps.right, execution);
  }
  return result;
}

}  // namespace vantage::apps
