#include "engine/jobs/sequence_job.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "engine/combinations/combinations.h"
#include "engine/error.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/frame_step_setting.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/scene_mask_settings.h"
#include "engine/sequence/memory_plan.h"
#include "engine/sequence/options/sequence_values.h"

namespace vantage {
namespace {

constexpr std::string_view kAutomatic = "auto";

std::string known_outputs() {
  std::string names;
  for (const auto& [name, output] : sequence_output_names()) {
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  return names;
}

void add_stereo_views_setting(Settings& settings, std::array<double, 2>& views_x) {
  Setting& setting = settings.add("stereo-views", "XL,XR",
                                  "Positions of the two views of the stereo output, in baselines; "
                                  "0,1: the photographs themselves");
  setting.kind = ValueKind::kPoint;
  setting.set = [&views_x](const SettingValue& value) {
    views_x = from_parts(
        value, ',', 2, "two positions on the baseline such as 0.25,0.75", [](const auto& parts) {
          return std::optional(std::array{to_number(parts[0]), to_number(parts[1])});
        });
  };
  setting.get = [&views_x] { return fmt::format("{},{}", views_x[0], views_x[1]); };
}

RowTrack::Key to_row_key(const SettingValue& values) {
  constexpr std::size_t kFirst = 3;
  if (!values.is_array() || values.size() != kFirst + RowField::kMaxTerms) {
    reject_value(values, "auto or as-is");
  }
  RowField::Terms terms = {};
  for (std::size_t i = 0; i < terms.size(); ++i) {
    terms[i] = to_number(values[kFirst + i]);
  }
  return {static_cast<int>(to_number(values[0])),
          {static_cast<int>(to_number(values[1])), static_cast<int>(to_number(values[2])), terms}};
}

/// --frames A-B:N also says which frames are taken, for all parts of the run.
void apply_step_of_frames(SequenceJob& job) {
  if (!job.step_of_frames) {
    return;
  }
  const FrameStep step{.pairs = *job.step_of_frames,
                       .first = job.frames->first % *job.step_of_frames,
                       .seconds = std::nullopt};
  if (!job.input.every.takes_all() && job.input.every != step) {
    throw UsageError(fmt::format("--every is {} and --frames {}-{}:{}, expected one of the two",
                                 to_text(job.input.every), job.frames->first, job.frames->end - 1,
                                 *job.step_of_frames));
  }
  job.input.every = step;
}

}  // namespace

std::vector<SequenceOutput> to_outputs(const SettingValue& value) {
  std::vector<SequenceOutput> outputs;
  for (const SettingValue& member : to_list(value)) {
    for (const std::string& name : split(to_text(member), ',')) {
      const auto known = std::ranges::find(sequence_output_names(), name,
                                           &std::pair<std::string_view, SequenceOutput>::first);
      if (known == sequence_output_names().end()) {
        reject_value(name, "some of " + known_outputs());
      }
      if (std::ranges::find(outputs, known->second) == outputs.end()) {
        outputs.push_back(known->second);
      }
    }
  }
  return outputs;
}

SettingValue output_names(const std::vector<SequenceOutput>& outputs) {
  SettingValue names = SettingValue::array();
  for (const SequenceOutput output : outputs) {
    names.push_back(std::ranges::find(sequence_output_names(), output,
                                      &std::pair<std::string_view, SequenceOutput>::second)
                        ->first);
  }
  return names;
}

void add_sequence_rows_setting(Settings& settings, SequenceJob& job) {
  Setting& rows = add_rows_setting(settings, job.rows);
  rows.set = [&job, set_mode = rows.set](const SettingValue& value) {
    job.sequence.rows.keys.clear();
    if (!value.is_array()) {
      set_mode(value);
      return;
    }
    for (const SettingValue& key : value) {
      job.sequence.rows.keys.push_back(to_row_key(key));
    }
  };
  rows.get = [&job, mode = rows.get]() -> SettingValue {
    if (job.sequence.rows.keys.empty()) {
      return mode();
    }
    SettingValue keys = SettingValue::array();
    for (const RowTrack::Key& key : job.sequence.rows.keys) {
      SettingValue values = {key.pair, key.field.width(), key.field.height()};
      for (const double coefficient_px : key.field.coefficients_px()) {
        values.push_back(coefficient_px);
      }
      keys.push_back(std::move(values));
    }
    return keys;
  };
}

void add_input_settings(Settings& settings, SequenceJob& job) {
  settings.start_group("Input: one of --left with --right, --stereo, --pairs, --sequence");
  add_pair_source_settings(settings, job.input);
  Setting& more =
      settings.add("more", "SOURCE",
                   "With --left and --right: frames of a camera on the same line, whose "
                   "frame i belongs to left frame i; repeatable, needs --baselines");
  more.path = PathRole::kInput;
  more.list = true;
  more.changes_results = false;
  more.set = [&job](const SettingValue& value) {
    job.input.more.clear();
    for (const SettingValue& member : to_list(value)) {
      job.input.more.push_back(to_text(member));
    }
  };
  more.get = [&job] { return job.input.more; };
  add_baselines_setting(settings, job.sequence.baselines,
                        "Positions of the right camera and of those of --more, relative to the "
                        "left camera, positive to the right: all images of a frame are matched at "
                        "once; disparities are those of left and right");
  settings
      .input_path("calibration", job.calibration, "FILE",
                  "Cameras, to rectify the pairs first: file of any tool, or two (A,B)")
      .changes_results = false;  // the journal identifies inputs by their content
  add_kept_outline_setting(settings, job.rectification);
  add_scene_mask_settings(settings, job.input.masks, true);
  add_sequence_rows_setting(settings, job);
}

Setting& add_save_setting(Settings& settings, SequenceJob& job) {
  Setting& save = settings.add(
      "save", "LIST", "Outputs per frame: " + known_outputs() + "; auto: disparity and views");
  save.kind = ValueKind::kWord;
  save.words = {std::string(kAutomatic)};
  for (const auto& [name, output] : sequence_output_names()) {
    save.words.emplace_back(name);
  }
  save.list = true;
  save.set = [&job](const SettingValue& value) {
    const auto members = to_list(value);
    if (members.size() == 1 && members.front() == kAutomatic) {
      job.save.reset();
    } else {
      job.save = to_outputs(value);
    }
  };
  save.get = [&job] { return job.save ? output_names(*job.save) : SettingValue(kAutomatic); };
  return save;
}

void add_picture_settings(Settings& settings, SequenceJob& job) {
  add_sequence_view_settings(settings, job.views, job.sequence.look_at_px);
  add_stereo_views_setting(settings, job.sequence.stereo_views_x);
  settings.choice<StereoDisplay>("stereo-packing", job.sequence.stereo_packing,
                                 stereo_display_names(),
                                 "Layout of the stereo output: side by side, above/below, "
                                 "interleaved or anaglyph, using ffmpeg's stereo3d names");
}

void add_poses_setting(Settings& settings, SequenceJob& job) {
  settings
      .input_path("poses", job.poses, "FILE",
                  "Poses of the left camera in metres, one per pair (TUM or KITTI trajectory): "
                  "clouds and meshes are in their world")
      .changes_results = false;  // the journal identifies inputs by their content
}

void add_steadiness_settings(Settings& settings, SequenceJob& job) {
  SequenceOptions& options = job.sequence;
  settings.start_group("Temporal stability");
  settings.choice<FitScope>("intensity-fit", options.intensity_fit,
                            {{"frame", FitScope::kFrame}, {"shot", FitScope::kShot}},
                            "Match the brightness of both images once per frame or once per shot");
  settings.choice<SearchScope>(
      "search-range", job.search_scope,
      {{"film", SearchScope::kFilm}, {"shot", SearchScope::kShot}, {"pair", SearchScope::kPair}},
      "Search all frames in one range of disparities, or each shot, or "
      "each pair of a list, in the range found there; auto: shot for "
      "depth-video and comfort with --disparities auto, else film");
  settings.choice<bool>("preview-range", options.preview_range_per_shot,
                        {{"search", false}, {"shot", true}},
                        "Colour scale of previews: the search range or the disparities of a shot");
  settings.number("temporal-prior", options.temporal.weight, "W",
                  "Weight that keeps the disparity of unchanged pixels from frame to frame, 0 to "
                  "100; 0: off, 1: as strong as their own costs");
  settings.number("temporal-threshold", options.temporal.threshold, "G",
                  "A pixel counts as unchanged if it differs by at most this many grey levels");
  settings.choice<Reuse>("reuse", options.temporal.reuse,
                         {{"none", Reuse::kNone}, {"frame", Reuse::kFrame}},
                         "With presets and methods like theirs: frame keeps the disparities of the "
                         "frame before where the images do not change, which is faster and "
                         "steadier");
}

void add_chunk_frames_setting(Settings& settings, SequenceJob& job) {
  settings
      .integer("chunk-frames", job.sequence.chunk_frames, "N",
               "Frames per chunk, 1 to 100000. Parts of a run consist of whole chunks. Videos are "
               "written chunk by chunk, so an interruption loses one chunk at most. A temporal "
               "prior starts again with each chunk")
      .changes_results = true;
}

void add_in_flight_setting(Settings& settings, SequenceJob& job) {
  settings.integer(
      "in-flight", job.in_flight, "N",
      "Number of frames in flight, 1 to 64; auto: threads + 2, fewer if memory is short");
}

void add_live_setting(Settings& settings, SequenceJob& job) {
  settings.flag("live", job.input.live,
                "Of a stream: one frame in flight, always the newest pair; pairs that come while "
                "one is in work are dropped and counted, the report has the latency");
}

void complete_sequence(SequenceJob& job, bool is_streamed) {
  SequenceOptions& sequence = job.sequence;
  sequence.views = paths_of(job.views);
  sequence.unrectified = job.unrectified.empty() ? UnrectifiedSearch::kNone
                         : job.rectified_pixels  ? UnrectifiedSearch::kOnRectified
                                                 : UnrectifiedSearch::kOnPhotographs;
  if (job.save) {
    sequence.save = *job.save;
  } else {
    sequence.save = {SequenceOutput::kDisparity};
    if (!sequence.views.empty()) {
      sequence.save.push_back(SequenceOutput::kViews);
    }
  }
  if (!job.search_scope && sequence.is_film()) {
    // Stays as it is when the range has been found, or the run is continued.
    const bool is_per_shot =
        sequence.match.disparities_auto && !sequence.temporal.uses_past() && !is_streamed;
    job.search_scope = is_per_shot ? SearchScope::kShot : SearchScope::kFilm;
  }
  sequence.search_scope = job.search_scope.value_or(SearchScope::kFilm);
  sequence.validate();
}

OptionValues values_of(const SequenceJob& job, const Settings& settings) {
  OptionValues values = settings.option_values();
  values.take(values_of(job.sequence));
  for (const auto& [option, file] :
       {std::pair{"calibration", &job.calibration}, std::pair{"unrectified", &job.unrectified}}) {
    if (!file->empty()) {
      values.set(option, *file);
    }
  }
  if (job.input.is_stream()) {
    values.set("stream", "given");
  }
  // A list of pairs may have them; checked when it has been read.
  if (!job.input.pairs.empty() && job.cameras_file().empty() && !job.rig.replaces_calibration()) {
    values.set("column calibration", "possible");
  }
  return values;
}

void check_sequence(SequenceJob& job, const Settings& settings) {
  const OptionValues values = values_of(job, settings);
  refuse_combinations(CombinationScope::kJob, values);
  if (!job.sequence.baselines.empty() || !job.input.more.empty()) {
    check_baselines(job.sequence.baselines, 1 + job.input.more.size());
  }
  check_views(job.views, job.sequence.views, job.sequence.look_at_px, !job.cameras_file().empty());
  apply_step_of_frames(job);
  if (job.input.live) {
    job.in_flight = 1;
  }
  job.input.validate();
  job.rectification.validate();
  const bool may_be_listed = values.find("column calibration") != nullptr;
  job.rig.validate(may_be_listed ? job.input.pairs : job.cameras_file());
  if (job.sequence.is_metric() && !may_be_listed) {
    job.rig.require_given(job.cameras_file(), "save depth, depth-resolution, cloud or mesh");
  }
  if (job.in_flight && (*job.in_flight < 1 || *job.in_flight > kMaxFramesInFlight)) {
    throw UsageError(fmt::format("--in-flight is {}, expected a number from 1 to {}",
                                 *job.in_flight, kMaxFramesInFlight));
  }
}

}  // namespace vantage
