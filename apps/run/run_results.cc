#include "apps/run/run_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/inputs/automatic_disparities.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/settings/depth_settings.h"
#include "engine/order_statistics.h"
#include "engine/sequence/journal/sequence_join.h"

namespace vantage::apps {
namespace {

/// More lines would hide the other messages; the report has all.
constexpr std::size_t kRemarksPrinted = 5;

SettingValue remark_values(const std::vector<FrameRemark>& remarks) {
  SettingValue values = SettingValue::array();
  for (const FrameRemark& remark : remarks) {
    values.push_back({{"frame", remark.frame}, {"text", remark.text}});
  }
  return values;
}

void print_remarks(const char* kind, const std::vector<FrameRemark>& remarks) {
  for (std::size_t i = 0; i < std::min(remarks.size(), kRemarksPrinted); ++i) {
    tell("run: {}frame {}: {}\n", kind, remarks[i].frame, remarks[i].text);
  }
  if (remarks.size() > kRemarksPrinted) {
    tell("run: {}… and {} more, see --report\n", kind, remarks.size() - kRemarksPrinted);
  }
}

/// Per frame delivered or pictured by this run.
double per_frame(const SequenceReport& sequence, double seconds) {
  return seconds / (sequence.frames + sequence.pictures_again);
}

/// Steps that take no time are left out.
void print_processor_time(const SequenceReport& sequence) {
  std::string line;
  double total = 0;
  for (const SequenceStage& step : sequence.processor) {
    const double milliseconds = 1e3 * per_frame(sequence, step.seconds);
    total += milliseconds;
    if (milliseconds >= 0.05) {
      line += fmt::format(", {} {:.1f}", step.name, milliseconds);
    }
  }
  tell("run: processor ms per frame: {:.1f}{}; processors busy {:.0f} % of the time\n", total, line,
       100 * sequence.share_busy);
}

/// Depth resolution in the report: the values of each delivered frame, and, if all have one scale,
/// those at the nearest and the farthest disparity of any and the median of their medians. Null
/// where no disparity is known.
SettingValue depth_resolution_of(const RunJob& job, const DeliveredFrames& delivered) {
  const double step_px = job.sequence.used_disparity_step_px();
  SettingValue frames = SettingValue::array();
  std::vector<float> medians;
  std::optional<DisparitiesAndScale> all;
  bool has_one_scale = true;
  for (const auto& [frame, record] : delivered.records()) {
    if (!record.disparities) {
      continue;
    }
    const auto& [here, scale] = *record.disparities;
    const SettingValue values = depth_resolution_values(here, scale, step_px);
    frames.push_back({{"frame", frame},
                      {"nearest", values["nearest"]},
                      {"median", values["median"]},
                      {"farthest", values["farthest"]}});
    if (!all) {
      all = record.disparities;
    }
    has_one_scale = has_one_scale && scale == all->scale;
    all->disparities.nearest_px = std::max(all->disparities.nearest_px, here.nearest_px);
    all->disparities.farthest_px = std::min(all->disparities.farthest_px, here.farthest_px);
    medians.push_back(here.median_px);
  }
  if (!all) {
    return nullptr;
  }
  all->disparities.median_px = upper_median(medians);
  SettingValue values = has_one_scale
                            ? depth_resolution_values(all->disparities, all->scale, step_px)
                            : SettingValue{{"disparity_resolution_px", step_px}};
  values["frames"] = std::move(frames);
  return values;
}

/// How the frames of several cameras became pairs; null where there is one source.
SettingValue pairing_of(const PairSource& pairs) {
  const Pairing pairing = pairs.pairing();
  if (pairing.left_out.empty()) {
    return nullptr;
  }
  const auto name =
      std::ranges::find(pair_by_names(), pairing.by, &std::pair<std::string_view, PairBy>::second);
  return {{"by", name->first}, {"frames_left_out", pairing.left_out}};
}

/// The mean of all frames, and each frame's.
SettingValue maps_of(const SequenceReport& sequence) {
  SettingValue values = map_values(mean_shares(sequence));
  values["frames"] = SettingValue::array();
  for (const auto& [frame, shares] : sequence.map_shares) {
    SettingValue of_frame = map_values(shares);
    of_frame["frame"] = frame;
    values["frames"].push_back(std::move(of_frame));
  }
  return values;
}

}  // namespace

SettingValue processor_values(const SequenceReport& sequence) {
  SettingValue values = SettingValue::object();
  for (const SequenceStage& step : sequence.processor) {
    values[step.name] = per_frame(sequence, step.seconds);
  }
  return values;
}

std::vector<Remark> remarks_of(const RunJob& job, const SequenceReport& sequence) {
  std::vector<Remark> remarks;
  for (const auto& [remark, frame, frames] : sequence.match_remarks) {
    remarks.push_back(remark);
    remarks.back().text = fmt::format("frame {}: {}{}", frame, remark.text,
                                      frames == 1 ? "" : fmt::format("; {} frames alike", frames));
  }
  if (sequence.cut) {
    remarks.push_back(
        {Remark::Kind::kWarning, "range",
         fmt::format("frame {}: {}; the range looks as narrow for {} of {} frames; {}",
                     sequence.cut_frame, to_text(*sequence.cut, job.sequence.match.disparities),
                     sequence.frames_maybe_cut, sequence.frames, kCutRangeAdvice)});
  }
  return remarks;
}

void fill_report(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                 const DeliveredFrames& delivered, const std::string& sound_problem,
                 RunReport& report) {
  for (const SequenceStage& stage : sequence.stages) {
    report.add_stage(stage.name, stage.seconds);
  }
  report.add_compute_seconds(sequence.compute_seconds);
  report.add_cells(sequence.cells);
  report.set_plan(sequence.frames > 0 ? sequence.plan : session.memory.chain);
  const int frames_of_part = session.pairs->is_stream()
                                 ? sequence.frames + static_cast<int>(sequence.skipped.size())
                                 : session.selection.own().count();
  SettingValue results = {{"frames", sequence.frames},
                          {"frames_before", sequence.frames_before},
                          {"pictures_again", sequence.pictures_again},
                          {"frames_of_part", frames_of_part},
                          {"frames_of_input", input_frames(session.identity, delivered).count()},
                          {"interrupted", sequence.interrupted},
                          {"skipped", remark_values(sequence.skipped)},
                          {"remarks", remark_values(sequence.remarks)},
                          {"pairing", session.pairs->remarks()},
                          {"paired", pairing_of(*session.pairs)},
                          {"frames_maybe_cut", sequence.frames_maybe_cut},
                          {"sound_problem", sound_problem},
                          {"in_flight", sequence.in_flight},
                          {"planned_memory_bytes", session.memory.total_bytes},
                          {"width_px", session.shape.source.width_px},
                          {"height_px", session.shape.source.height_px},
                          {"frames_per_second_of_video", to_string(job.sequence.frame_rate)}};
  if (sequence.frames + sequence.pictures_again > 0) {
    results["processor_seconds_per_frame"] = processor_values(sequence);
    results["share_busy"] = sequence.share_busy;
  }
  if (sequence.reuse.frames > 0) {
    results["reuse"] = {{"mean_share_of_tiles", sequence.reuse.mean_share_reused()},
                        {"frames", sequence.reuse.frames},
                        {"frames_searched_whole", sequence.reuse.frames_searched}};
  }
  if (job.sequence.saves(SequenceOutput::kDepthResolution)) {
    results["depth_resolution"] = depth_resolution_of(job, delivered);
  }
  if (!sequence.map_shares.empty()) {
    results["map"] = maps_of(sequence);
  }
  if (sequence.live) {
    results["live"] = live_values(*sequence.live);
  }
  if (sequence.cut) {
    results["cut_range"] = cut_range_values(*sequence.cut);
    results["cut_range"]["frame"] = sequence.cut_frame;
  }
  report.set_results(std::move(results));
}

void print_sound_problem(const std::string& command, const std::string& problem) {
  if (!problem.empty()) {
    tell("{}: note: the videos have no sound: {}\n", command, with_dashes(problem));
  }
}

SettingValue live_values(const LiveReport& live) {
  return {{"frames", live.frames},
          {"dropped", live.dropped},
          {"latency_ms",
           {{"p50", live.median_ms}, {"p95", live.percentile_95_ms}, {"max", live.max_ms}}}};
}

void print_live(const SequenceReport& sequence) {
  if (sequence.live) {
    const LiveReport& live = *sequence.live;
    tell("run: live: {} frame{} delivered, {} dropped; latency {:.1f} ms (p50), {:.1f} ms (p95)\n",
         live.frames, live.frames == 1 ? "" : "s", live.dropped, live.median_ms,
         live.percentile_95_ms);
  }
}

void print_summary(const RunJob& job, const RunSession& session, const SequenceReport& sequence,
                   double wall_seconds) {
  print_remarks("", sequence.remarks);
  print_remarks("skipped ", sequence.skipped);
  std::string line =
      fmt::format("run: {} frame{}{}", sequence.frames, sequence.frames == 1 ? "" : "s",
                  session.takes_any_size(job) ? "" : text_of_size(job, session));
  if (sequence.frames > 0) {
    line += fmt::format(", {:.2f} frames/s", sequence.frames / wall_seconds);
  }
  if (sequence.frames_before > 0) {
    line += fmt::format(", {} were already done", sequence.frames_before);
  }
  if (sequence.pictures_again > 0) {
    line += fmt::format(" ({} of them added to the videos now)", sequence.pictures_again);
  }
  if (!sequence.skipped.empty()) {
    line += fmt::format(", {} skipped", sequence.skipped.size());
  }
  line += " -> " + job.output;
  if (sequence.interrupted) {
    line += session.pairs->is_stream() ? " (interrupted)" : " (interrupted, --resume continues)";
  }
  tell("{}\n", line);
  if (sequence.frames + sequence.pictures_again > 0) {
    print_processor_time(sequence);
  }
  if (!sequence.map_shares.empty()) {
    tell("run: {}\n", to_text(mean_shares(sequence)));
  }
  print_live(sequence);
  if (sequence.reuse.frames > 0) {
    tell("run: {:.0f} % of the tiles kept the disparities of the frame before\n",
         100 * sequence.reuse.mean_share_reused());
  }
  if (sequence.interrupted && sequence.videos_from) {
    tell("run: all files of frames are kept, the videos continue at frame {}\n",
         *sequence.videos_from);
  }
}

}  // namespace vantage::apps
