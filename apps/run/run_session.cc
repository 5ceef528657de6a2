#include "apps/run/run_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "apps/inputs/automatic_disparities.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/inputs/rectification_check.h"
#include "apps/process/interrupt.h"
#include "apps/process/outputs.h"
#include "apps/process/progress.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/run/resumed_run.h"
#include "apps/run/stream_run.h"
#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/json_text.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/stated_format.h"
#include "engine/jobs/list_columns.h"
#include "engine/matching/pair_matcher.h"
#include "engine/matching/range_estimation.h"
#include "engine/options/emptied_value.h"
#include "engine/options/frame_step_setting.h"
#include "engine/sequence/journal/delivered_frames.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/pairs/sequence_range.h"
#include "scheduler/interruption.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

void require_no_interrupt() {
  if (interrupt_flag().load()) {
    throw scheduler::Interrupted();
  }
}

/// The first pair that a run takes from a stream; those before it are dropped.
void read_first_streamed_pair(PairSource& pairs, int first, FramePair& pair) {
  pairs.skip_to(first);
  if (!pairs.fetch(pair)) {
    require_no_interrupt();
    throw Error(fmt::format("{}: the stream ends before it", pairs.describe(first)));
  }
  pairs.decode(pair);
  pairs.skip_to(first);
}

RunIdentity identity_of(const RunJob& job, const Settings& settings, const RunSession& session) {
  RunIdentity identity;
  LargeValue all{settings.result_values()};
  SettingValue& values = all.value;
  values["fps"] = to_string(job.sequence.frame_rate);
  for (const auto& [name, poses] :
       {std::pair("pose", &job.views.poses), {"path", &job.views.path}}) {
    if (!poses->empty()) {
      values[name] = to_value(poses->entries);
    }
  }
  identity.settings = values.dump(-1, ' ', false, SettingValue::error_handler_t::replace);
  identity.sources = sources_of(job, settings);
  identity.inputs = session.pairs->identities();
  if (!job.cameras_file().empty()) {
    FileIdentity calibration;
    for (const fs::path& file : calibration_files(job.cameras_file())) {
      calibration.add(file.filename().string(), file);
    }
    identity.inputs.push_back((job.unrectified.empty() ? "calibration: " : "unrectified: ") +
                              calibration.to_string());
  }
  if (!job.poses.empty()) {
    FileIdentity poses;
    poses.add(fs::path(job.poses).filename().string(), job.poses);
    identity.inputs.push_back("poses: " + poses.to_string());
  }
  if (!job.input.pairs.empty()) {
    const std::vector<std::string> columns = column_identities(*session.pairs);
    identity.inputs.insert(identity.inputs.end(), columns.begin(), columns.end());
  }
  identity.frame_count = session.pairs->is_stream() ? kUnknownFrames : session.pairs->pair_count();
  const PairSource::Sound sound = session.pairs->sound();
  identity.frame_times = session.pairs->frame_times();
  if (job.sequence.sound && !sound.file.empty()) {
    identity.sound_file = absolute_path(sound.file);
    identity.sound_first_frame = sound.first_frame;
    identity.sound_rate = session.pairs->frame_rate().value_or(FrameRate());
  }
  return identity;
}

std::string size_text(std::size_t bytes) {
  const double mib = static_cast<double>(bytes) / (1 << 20);
  return mib < 1024 ? fmt::format("{:.0f} MiB", mib) : fmt::format("{:.2f} GiB", mib / 1024);
}

std::string outputs_text(const RunJob& job) {
  std::string text;
  const SequenceLayout layout(job.output, job.sequence);
  for (const OutputStream& stream : layout.streams()) {
    text +=
        (text.empty() ? "" : ", ") + stream.name + (stream.as_video ? "." + stream.extension : "");
  }
  if (job.sequence.saves(SequenceOutput::kComfort)) {
    text += (text.empty() ? "" : ", ") + layout.comfort_report("html").filename().string();
  }
  return text;
}

std::string strips_text(const scheduler::ChainPlan& plan) {
  const scheduler::PassPlan& pass = plan.passes.front();
  std::string text = fmt::format("{} strip{} of {} columns x {} band{} of {} rows", pass.strips,
                                 pass.strips == 1 ? "" : "s", pass.strip_columns, pass.bands,
                                 pass.bands == 1 ? "" : "s", pass.band_rows);
  if (plan.passes.size() > 1) {
    text += fmt::format(", {} passes", plan.passes.size());
  }
  if (plan.steps > 1) {
    text += fmt::format(", {} steps of {} rows", plan.steps, plan.step_rows);
  }
  return text;
}

AppliedTuning find_tuning(const RunJob& job, const FramePair& first, const Settings& settings) {
  if (!job.sequence.baselines.empty()) {
    return no_tuning("tuning is for pairs, but there are more images");
  }
  if (!job.unrectified.empty()) {
    return no_tuning("tuning is for rectified pairs");
  }
  if (job.memory_bytes) {
    return no_tuning("--memory is given, so the cost model plans");
  }
  return apply_tuning(job.tuning,
                      {.use = TunedUse::kRun,
                       .match = job.sequence.match,
                       .execution = job.common.execution,
                       .in_flight_given = job.in_flight.has_value(),
                       .left = first.left,
                       .right = first.right},
                      settings.command(), job.common.quiet);
}

std::string counted_frames(const RunJob& job, int frame_count) {
  if (job.input.is_stream()) {
    return "a stream of pairs";
  }
  return job.sequence.baselines.size() < 2 ? fmt::format("{} pairs", frame_count)
                                           : fmt::format("{} frames of {} images", frame_count,
                                                         job.sequence.baselines.size() + 1);
}

/// The range of disparities of all pairs; where each pair has its own, that of the first, by which
/// memory is planned.
std::optional<DisparityRange> find_range(const RunJob& job, const RunSession& session,
                                         const FramePair& first, Execution& execution,
                                         const std::string& command) {
  if (job.sequence.search_scope == SearchScope::kPair) {
    constexpr int kUsualPart = 8;  // of the width, where this pair has no texture
    return find_disparity_range(first.left, first.right, execution)
        .value_or(DisparityRange{0, first.left.width() / kUsualPart});
  }
  Progress progress(command + ": range", "pairs", job.shown_progress());
  const auto found = find_sequence_range(
      *session.pairs, [&](FramePair& pair) { session.rectify(pair, execution); }, execution,
      job.sequence.is_film() ? Infinity::kAnywhere : Infinity::kAtZero,
      [&](int done, int total) { progress.update(done, total, 0); });
  if (session.pairs->is_stream()) {
    require_no_interrupt();
  }
  return found;
}

/// Warns of the first pair, finds out how rows are corrected, and tells.
void choose_rows(RunJob& job, FramePair& first, Execution& execution, RunSession& session,
                 RunReport& report) {
  take_up_rows(job);
  if (!job.check_rectification) {
    job.rows = RowMode::kAsIs;
  } else if (job.unrectified.empty()) {
    correct_rows({.common = job.common,
                  .mode = job.sequence.baselines.empty() ? job.rows : RowMode::kAsIs,
                  .expects_negative = expects_negative_disparities(job.sequence.match),
                  .is_of_sequence = true},
                 first.left, first.right, execution, report);
  }
  const auto found =
      report.timed_compute("rows", [&] { return find_rows(job, execution, session); });
  if (session.pairs->is_stream()) {
    require_no_interrupt();
  }
  const std::vector<RowTrack::Key>& keys = job.sequence.rows.keys;
  if (found && found->rows) {
    report.add_result("rows", row_values(*found->rows, !keys.empty()));
  }
  if (keys.empty() || job.common.quiet) {
    return;
  }
  const RowField& last = keys.back().field;
  const std::string text =
      found && found->rows
          ? fmt::format("{}; corrected, points of {} pairs agree to {:.2f} px",
                        row_text(*found->rows), found->pairs, found->rows->residual_px)
      : keys.size() > 1
          ? fmt::format(
                "right image from {:.2f} to {:.2f} px lower; corrected, followed over {} "
                "pairs",
                keys.front().field.offset_px(), last.offset_px(), keys.size())
          : fmt::format("right image {:.2f} px lower; corrected as before", last.offset_px());
  tell("run: rows: {}\n", text);
}

/// What videos state of their pictures, and a line of what becomes of what the input states.
void take_film_format(const RunSession& session, RunJob& job, RunReport& report) {
  SequenceOptions& options = job.sequence;
  options.film = session.pairs->film_format();
  std::string stated = to_text(options.film);
  if (stated.empty()) {
    return;
  }
  if (session.rectifier && options.unrectified != UnrectifiedSearch::kOnPhotographs &&
      options.film.pixel_aspect != PixelAspect()) {
    options.film.pixel_aspect = {};
    stated += "; rectified pixels are square";
  }
  const bool in_videos = options.saves_as_video(SequenceOutput::kViews) ||
                         options.saves_as_video(SequenceOutput::kStereo);
  const char* const fate = writes_stream(job) ? "y4m states the shape of pixels and the range alone"
                           : in_videos
                               ? written_as(options.film.colours)
                               : "images of views would have its values, and state nothing of it";
  tell_remarks({{{Remark::Kind::kNote, "film",
                  fmt::format("the film has {}: matched as it is coded; {}", stated, fate)}}},
               job.common, report);
}

}  // namespace

std::string RunSession::part_name(const RunJob& job) {
  std::string name;
  if (job.frames) {
    name = fmt::format("frames-{}-{}", job.frames->first, job.frames->end - 1);
  }
  if (job.shard) {
    name += fmt::format("{}{}-of-{}", name.empty() ? "" : "-", job.shard->index, job.shard->count);
  }
  return name.empty() ? "all" : name;
}

RunSession open_run(RunJob& job, const Settings& settings, RunReport& report) {
  FileChecks files = check_files(job, settings);
  RunSession session;
  if (job.input.is_stream()) {
    job.input.stop = &interrupt_flag();
  }
  open_source(job, session);
  session.selection.shard = job.shard;
  tell_remarks(session.pairs->white_level().remarks, job.common, report);
  for (const fs::path& file : session.pairs->files()) {
    files.add_input(file);
  }
  for (const auto& [file, cameras] : session.columns.calibrations) {
    files.add_input(file);
  }
  const int input_frames = session.pairs->input_frames();
  if (job.frames && job.frames->end > input_frames && !job.common.quiet) {
    tell("run: warning: --frames {}-{} ends after the input, which has {} frames (0 to {})\n",
         job.frames->first, job.frames->end - 1, input_frames, input_frames - 1);
  }
  FramePair first;
  report.timed_file_access("open", [&] {
    if (session.pairs->is_stream()) {
      const FrameRun frames = run_of(
          session.selection, dependence_of(job.sequence, SequenceLayout(job.output, job.sequence)),
          session.selection.own());
      read_first_streamed_pair(*session.pairs, frames.frames.first - frames.lead_in, first);
    } else {
      read_first_pair(*session.pairs, first);
    }
  });
  Execution execution(job.common.execution);
  warn_of_grey_cameras(settings, job.common, session.columns, job.calibration_choice);
  std::optional<StereoCalibration> calibration;
  if (!job.cameras_file().empty()) {
    choose_kitti_cameras(settings, job.common, job.cameras_file(), session.pairs->files(),
                         job.calibration_choice);
    report.set_settings(reported_settings(settings, job.sequence.match));
    calibration = job.rig.read(job.cameras_file(), job.calibration_choice);
  }
  prepare_pairs(job, calibration, job.sequence.is_metric(), first, execution, session);
  if (session.shape.cameras) {
    tell_remarks(session.shape.cameras->remarks, job.common, report);
  }
  choose_rows(job, first, execution, session, report);
  MatchOptions& match = job.sequence.match;
  use_ranges(session.columns, match);
  report.set_settings(reported_settings(settings, match));
  choose_disparities(
      settings, job.common,
      [&] {
        // Estimating the range of a video without an index decodes the whole video.
        const std::optional<DisparityRange> known = range_of_run_to_resume(job);
        return known ? known : find_range(job, session, first, execution, settings.command());
      },
      match, report);
  job.sequence.validate();
  job.sequence.frame_rate =
      job.frame_rate.value_or(session.pairs->frame_rate().value_or(FrameRate()));
  take_film_format(session, job, report);
  session.identity = identity_of(job, settings, session);
  session.tuning = find_tuning(job, first, settings);
  session.execution = with_tuned(job.common.execution, session.tuning.settings);
  const int threads = thread_count(session.execution, execution.machine());
  session.executor = fmt::format("{} thread{} ({})", threads, threads == 1 ? "" : "s",
                                 execution.executor().name());
  const std::optional<int> in_flight =
      job.in_flight ? job.in_flight : session.tuning.settings.frames_in_flight;
  SequenceOptions planned = job.sequence;
  planned.match.disparities = session.columns.widest_with(planned.match.disparities);
  const MemoryRequest request = memory_request(in_flight, job.memory_bytes);
  session.free_bytes = request.free_bytes;
  session.memory = plan_memory(planned, request, session.shape, first, session.execution);
  if (!request.allows(session.memory)) {
    tell_remarks(std::vector{Remark{
                     .kind = Remark::Kind::kWarning,
                     .subject = "memory",
                     .text = fmt::format(
                         "one frame needs about {}, and {} are free here: the system may end "
                         "the run; a smaller range or another preset needs less",
                         size_text(session.memory.total_bytes), size_text(session.free_bytes))}},
                 job.common, report);
  }
  session.pairs->forget_start();
  return session;
}

std::string text_of_size(const RunJob& job, const RunSession& session) {
  return fmt::format("{} of {}x{} pixels", session.takes_any_size(job) ? ", the first" : "",
                     session.shape.source.width_px, session.shape.source.height_px);
}

std::string describe_plan(const RunJob& job, const RunSession& session) {
  const FrameRange own = session.selection.own();
  std::string text;
  const auto line = [&](const std::string& content) { text += "run: " + content + "\n"; };
  line(fmt::format(
      "{}{}{}{}{}", counted_frames(job, session.selection.frame_count), text_of_size(job, session),
      job.input.every.takes_all() ? "" : ", one every " + to_text(job.input.every),
      !job.unrectified.empty()          ? ", rectified in the search"
      : session.shape.is_rectified_here ? ", rectified on the fly"
                                        : "",
      own == FrameRange{0, session.selection.frame_count}
          ? ""
          : fmt::format("; this part: {}", own.empty() ? "none" : "frames " + to_string({own}))));
  for (const std::string& remark : session.pairs->remarks()) {
    line("note: " + with_dashes(remark));
  }
  if (session.identity.times_at(job.sequence.frame_rate) != nullptr && job.output != "-" &&
      SequenceLayout(job.output, job.sequence).has_videos()) {
    line("note: the input has a variable frame rate; videos keep its times");
  }
  if (!session.poses_note.empty()) {
    line("note: " + session.poses_note);
  }
  const std::string range = to_text(job.sequence.match.disparities);
  line(fmt::format("{}, disparities {}, {}", job.sequence.match.chosen(),
                   session.columns.all_have_ranges ? "of the list"
                   : job.sequence.search_scope == SearchScope::kPair
                       ? session.columns.widest ? "of each pair or of the list" : "of each pair"
                   : session.columns.widest ? range + " or of the list"
                                            : range,
                   strips_text(session.memory.chain)));
  line(fmt::format(
      "{}, {} frame{} in flight; memory about {}{}{}", session.executor, session.memory.in_flight,
      session.memory.in_flight == 1 ? "" : "s", size_text(session.memory.total_bytes),
      session.takes_any_size(job) ? " for pairs of this size" : "",
      job.memory_bytes         ? " of " + size_text(*job.memory_bytes)
      : session.free_bytes > 0 ? fmt::format(" of {} free", size_text(session.free_bytes))
                               : ""));
  if (!session.tuning.summary.empty()) {
    line(fmt::format("{} ({})", session.tuning.summary,
                     session.tuning.report["file"].get<std::string>()));
  }
  line(fmt::format("writes {} to {}", outputs_text(job),
                   job.output == "-" ? "standard output" : job.output));
  return text;
}

RunIdentity read_run(const std::string& folder, RunJob& job, FileChecks& files) {
  Settings settings("run", "");
  add_run_settings(settings, job);
  const fs::path journal = fs::path(folder) / ".vantage";
  RunIdentity identity = RunJournal::read_identity(journal);
  try {
    settings.set_values(parse_json(identity.settings, "settings"));
    job.output = folder;
    complete_sequence(job, false);
  } catch (const UsageError& error) {
    throw Error(fmt::format("{}: cannot be read as the settings of a run: {}",
                            (journal / "run.json").string(), error.what()));
  }
  job.sequence.frame_rate = job.frame_rate.value_or(FrameRate());
  add_run_outputs(SequenceLayout(folder, job.sequence),
                  job.sequence.saves(SequenceOutput::kComfort), "DIR", files);
  return identity;
}

}  // namespace vantage::apps
