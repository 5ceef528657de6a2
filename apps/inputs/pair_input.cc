#include "apps/inputs/pair_input.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "apps/inputs/automatic_disparities.h"
#include "apps/inputs/given_maps.h"
#include "apps/inputs/kitti_cameras_choice.h"
#include "apps/reports/remarks.h"
#include "engine/error.h"
#include "engine/image/orientation.h"
#include "engine/image/white_level.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/images/stereo_jpeg.h"
#include "engine/matching/pair_matcher.h"
#include "engine/options/calibration_settings.h"
#include "engine/options/match_settings.h"
#include "engine/options/pair_source_settings.h"
#include "engine/options/scene_mask_settings.h"
#include "engine/rectification/stereo_calibration.h"

namespace vantage::apps {
namespace {

void refuse_idle_match_options(const Settings& settings) {
  Settings matching("match", "");
  MatchOptions unused;
  add_match_settings(matching, unused);
  constexpr std::string_view kWithMaps = "with --left-disparity and --right-disparity";
  settings.refuse_idle(
      {"strip-width", "band-height", "iterations-per-pass", "mask", "mask-right", "no-data"},
      kWithMaps);
  const SettingValue options = matching.values();
  for (const auto& [name, value] : options.items()) {
    settings.refuse_idle({name.c_str()}, kWithMaps);
  }
}

RectifiedPair rectify(const StereoCalibration& calibration, const RectificationOptions& options,
                      const CommonOptions& common, Execution& execution, RunReport& report,
                      PairWithMaps& pair) {
  Rectifier rectifier(calibration, pair.left.width(), pair.left.height(), options);
  RectifiedPair cameras = rectifier.pair();
  tell_remarks(cameras.remarks, common, report);
  if (rectifier.needs_rectification()) {
    const UnrectifiedImages& read = pair.unrectified.emplace(
        UnrectifiedImages{std::move(rectifier), std::move(pair.left), std::move(pair.right)});
    report.timed_compute("rectify", [&] {
      read.rectifier.apply(read.left, Side::kLeft, pair.left, execution);
      read.rectifier.apply(read.right, Side::kRight, pair.right, execution);
    });
  }
  return cameras;
}

}  // namespace

void name_views(std::string& left, std::string& right) {
  if (!right.empty()) {
    return;
  }
  if (!is_stereo_jpeg(left)) {
    throw UsageError(
        fmt::format("RIGHT is missing, expected it unless LEFT holds both views (MPO, JPS); '{}' "
                    "does not",
                    left));
  }
  right = left + "#1";
  left += "#0";
}

void add_pair_settings(Settings& settings, PairInput& pair) {
  settings.positional("left", pair.left, "Left image").required = true;
  settings.positional("right", pair.right,
                      "Right image of the same size; not with an MPO or JPS file");
  settings.input_path("left-disparity", pair.left_disparity, "FILE",
                      "Disparity map of the left image; without maps, the pair is matched");
  settings.input_path("right-disparity", pair.right_disparity, "FILE",
                      "Disparity map of the right image");
  add_given_map_settings(settings, pair.given);
  settings.input_path(
      "calibration", pair.calibration, "FILE",
      "Cameras, to rectify the pair first if needed: file of any tool, or two (A,B); "
      "given maps belong to rectified images");
  add_kept_outline_setting(settings, pair.rectification);
  add_calibration_choice_settings(settings, pair.calibration_choice);
  add_rig_scale_settings(settings, pair.rig, RigUse::kDepths);
  add_scene_mask_settings(settings, pair.masks);
  add_white_level_setting(settings, pair.white_level);
  add_reading_settings(settings, pair.reading);
  add_row_settings(settings, pair.rows);
}

void check_pair(const PairInput& pair, const Settings& settings) {
  if (pair.left_disparity.empty() != pair.right_disparity.empty()) {
    throw UsageError(
        "one of --left-disparity and --right-disparity is missing, expected both or none");
  }
  pair.given.validate(settings);
  pair.rig.validate(pair.calibration);
  if (pair.has_maps()) {
    refuse_idle_match_options(settings);
  } else {
    pair.match.validate();
    if (pair.match.disparities_y) {
      throw UsageError("--disparities-y cannot be used here: views need rectified pairs");
    }
    settings.refuse_idle({"disparity-scale", "given"}, "without --left-disparity");
  }
  if (pair.given.holds_depths()) {
    pair.rig.require_given(pair.calibration, "given");
  } else {
    settings.refuse_idle({"calibration-unit", "focal-length", "baseline", "doffs"},
                         "without --given depth");
  }
  pair.rectification.validate();
  pair.masks.validate();
  if (pair.calibration.empty()) {
    settings.refuse_idle({"kept-outline", "kitti-cameras", "lens"}, "without --calibration");
  }
}

SettingValue reported_settings(const Settings& settings, const PairInput& pair) {
  return pair.has_maps() ? settings.values() : reported_settings(settings, pair.match);
}

PairWithMaps read_pair(PairInput& pair, const Settings& settings, const CommonOptions& common,
                       Execution& execution, RunReport& report) {
  name_views(pair.left, pair.right);
  PairWithMaps result;
  report.timed_file_access("read", [&] {
    result.left = read_photograph(pair.left, pair.reading);
    result.right = read_photograph(pair.right, pair.reading);
    require_equal_turns(result.left, result.right);
  });
  Photograph* const images_read[] = {&result.left, &result.right};
  tell_remarks(scale_to_white_level(images_read, pair.white_level), common, report);
  if (!pair.has_maps()) {
    leave_out_of_pair(pair.masks, result.left, result.right);
  }
  std::optional<StereoCalibration> calibration;
  if (!pair.calibration.empty()) {
    const std::filesystem::path images[] = {pair.left, pair.right};
    choose_kitti_cameras(settings, common, pair.calibration, images, pair.calibration_choice);
    calibration = pair.rig.read(pair.calibration, pair.calibration_choice);
    result.cameras = rectify(*calibration, pair.rectification, common, execution, report, result);
  }
  if (pair.has_maps()) {
    std::vector<Remark> remarks;
    report.timed_file_access("read", [&] {
      const auto camera = [&](int width, int height) {
        return calibration ? map_camera(*result.cameras, Side::kLeft,
                                        pair.rig.required_unit_of(*calibration))
                                 .scale
                           : pair.rig.camera(width, height, Side::kLeft, false).scale;
      };
      result.maps.left.disparity_px =
          read_given_map(pair.left_disparity, pair.given, camera, execution, remarks);
      result.maps.right.disparity_px =
          read_given_map(pair.right_disparity, pair.given, camera, execution, remarks);
    });
    require_agreeing_maps(result.maps);
    tell_remarks(remarks, common, report);
  }
  if (pair.rows.check) {
    const auto rows = correct_rows({.common = common,
                                    .mode = pair.rows.mode,
                                    .expects_negative = expects_negative_disparities(pair.match)},
                                   result.left, result.right, execution, report);
    if (rows) {
      follow_corrected_rows(rows->field, execution, result);
    }
  }
  if (!pair.has_maps()) {
    const bool is_found = pair.match.disparities_auto;
    choose_disparities(settings, common, result.left, result.right, pair.match, execution, report);
    const StereoMatcher matcher(pair.match, execution);
    MatchReport match;
    report.timed_compute(
        [&] { matcher.match(result.left, result.right, {}, result.maps, &match); });
    tell_match(match, common, report);
    tell_shares(match, common, report);
    warn_of_cut_range(common, result.left, result.right, result.maps, pair.match, is_found,
                      execution, report);
  }
  return result;
}

}  // namespace vantage::apps
