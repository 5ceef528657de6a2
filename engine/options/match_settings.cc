#include "engine/options/match_settings.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "engine/error.h"
#include "engine/matching/options/method_fields.h"
#include "engine/matching/options/method_names.h"
#include "engine/options/parameter_settings.h"

namespace vantage {
namespace {

void add_parameter_settings(Settings& settings, MatchOptions& options) {
  add_method_parameters(settings, options.parameters);
  settings.start_group("Refinement");
  settings.flag("raw", options.raw, "Winner-take-all map without any step of this group");
  add_refinement_options(settings, options.refinement);
}

void add_method_settings(Settings& settings, MatchOptions& options) {
  settings.choice(
      "method", options.method, names_of(MatchMethod{}),
      "A method of Scharstein's book, for comparison; for photographs use --preset; auto: the "
      "preset's, without a preset ssd");
  Setting& preset = settings.choice(
      "preset", options.preset, names_of(MatchPreset{}),
      "Parameters for photographs, shown by --print-config:\nrealtime  0.35 times the time of "
      "balanced, 8.2 % bad pixels\nbalanced  the default, 7.4 % bad pixels (mean of 18 "
      "scenes)\nquality   1.8 times the time of balanced, 7.3 % bad pixels\nauto: balanced; with "
      "--method, --aggregate, --disparities-y: none");
  preset.set = [set = std::move(preset.set)](const SettingValue& value) {
    if (is_word(value, "fast")) {
      throw UsageError(
          "is fast, which is no longer there: realtime takes half its time and errs as little, "
          "balanced errs less");
    }
    set(value);
  };
}

void add_part_settings(Settings& settings, MatchOptions& options) {
  Setting& roi = settings.add(
      "roi", "X,Y,W,H",
      "Match only this rectangle of the left image (with several images: of the reference): first "
      "column and row, width and height; pixels outside are unknown. none: the whole image");
  roi.kind = ValueKind::kRectangle;
  roi.words = {"none"};
  roi.set = [&options](const SettingValue& value) {
    constexpr std::string_view kExpected = "X,Y,W,H in whole pixels, such as 100,50,640,480";
    options.roi.reset();
    if (!is_word(value, "none")) {
      options.roi = from_parts(value, ',', 4, kExpected, [](const auto& parts) {
        return std::optional(ImageRegion{to_integer(parts[0]), to_integer(parts[1]),
                                         to_integer(parts[2]), to_integer(parts[3])});
      });
    }
  };
  roi.get = [&options]() -> SettingValue {
    return options.roi ? fmt::format("{},{},{},{}", options.roi->x_px, options.roi->y_px,
                                     options.roi->width_px, options.roi->height_px)
                       : "none";
  };
  settings.number("scale", options.scale, "S",
                  "Match images of S times the size, above 0 to 1, and bring maps back to the "
                  "pixels of the given ones; --disparities and all files are in these");
}

void add_noise_setting(Settings& settings, MatchOptions& options) {
  Setting& noise = settings.add(
      "noise", "auto|none|LEVEL",
      "Noise of the images, which are smoothed before they are compared: standard deviation in "
      "grey "
      "levels, 0 to 64; none: images are compared as they are; auto: with a preset, noise and "
      "traces of lossy compression are looked for in each pair, clean images stay as they are");
  noise.kind = ValueKind::kNumber;
  noise.words = {"auto", "none"};
  noise.set = [&options](const SettingValue& value) {
    if (is_word(value, "auto")) {
      options.noise.reset();
    } else {
      options.noise = is_word(value, "none") ? 0 : to_number(value);
    }
  };
  noise.get = [&options]() -> SettingValue {
    if (!options.noise) {
      return "auto";
    }
    return *options.noise == 0 ? SettingValue("none") : SettingValue(*options.noise);
  };
}

/// Name → value in force of all parameters that are read.
SettingValue resolved_parameters(const MatchOptions& options) {
  MatchOptions in_force = options.fully_resolved();
  Settings resolved;
  add_parameter_settings(resolved, in_force);
  SettingValue values = resolved.values();
  const MethodParameters parameters = options.resolved();
  visit_fields(
      [&](const MethodField& field, const auto& /*value*/) {
        if (!field.is_read(parameters)) {
          values.erase(std::string(field.option));
        }
      },
      parameters);
  if (options.disparities_auto && !options.preset_in_force()) {
    values.erase("cross-check");  // depends on the range, which is estimated later
  }
  return values;
}

}  // namespace

DisparityRange to_disparity_range(const SettingValue& value, std::string_view expected) {
  return from_parts(value, ':', 2, expected, [](const auto& parts) {
    return std::optional(DisparityRange{to_integer(parts[0]), to_integer(parts[1])});
  });
}

std::string to_text(DisparityRange range) { return fmt::format("{}:{}", range.min, range.max); }

MatchOptions options_with_found_range() {
  MatchOptions options;
  options.disparities_auto = true;
  return options;
}

void add_match_settings(Settings& settings, MatchOptions& options) {
  settings.start_group("Matching");
  Setting& disparities =
      settings.add("disparities", "MIN:MAX|auto",
                   "Search range x_left - x_right in whole pixels, ends included; auto: estimated "
                   "from the pair, in sequences from up to 16 pairs");
  disparities.kind = ValueKind::kRange;
  disparities.words = {"auto"};
  disparities.set = [&options](const SettingValue& value) {
    options.disparities_auto = is_word(value, "auto");
    if (!options.disparities_auto) {
      options.disparities =
          to_disparity_range(value, "MIN:MAX in whole pixels, such as 0:63 or -16:15, or auto");
    }
  };
  disparities.get = [&options] {
    return options.disparities_auto ? "auto" : to_text(options.disparities);
  };
  Setting& disparities_y = settings.add(
      "disparities-y", "MIN:MAX|auto",
      "Also search vertical disparities, y_left - y_right, for pairs that are not rectified; auto: "
      "estimated from the pair; none: rows only");
  disparities_y.kind = ValueKind::kRange;
  disparities_y.words = {"auto", "none"};
  disparities_y.set = [&options](const SettingValue& value) {
    options.disparities_y_auto = is_word(value, "auto");
    if (is_word(value, "none")) {
      options.disparities_y.reset();
    } else if (options.disparities_y_auto) {
      options.disparities_y = DisparityRange{0, 0};
    } else {
      options.disparities_y =
          to_disparity_range(value, "MIN:MAX in whole pixels, such as -2:2, or auto");
    }
  };
  disparities_y.get = [&options] {
    return options.disparities_y_auto ? "auto"
           : options.disparities_y    ? to_text(*options.disparities_y)
                                      : "none";
  };
  add_part_settings(settings, options);
  add_noise_setting(settings, options);
  add_method_settings(settings, options);
  add_parameter_settings(settings, options);
  settings.show_resolved([&options] { return resolved_parameters(options); });
}

Setting& add_rows_setting(Settings& settings, RowMode& rows) {
  return settings.choice<RowMode>(
      "rows", rows, {{"auto", RowMode::kAuto}, {"as-is", RowMode::kAsIs}},
      "Rows that do not correspond. auto: where pairs themselves show a smooth offset of up to a "
      "few pixels, right images are resampled, and their maps are brought back to their pixels");
}

void add_baselines_setting(Settings& settings, std::vector<double>& baselines, std::string help) {
  Setting& setting = settings.add("baselines", "B1,B2,...", std::move(help));
  setting.kind = ValueKind::kNumbers;
  setting.set = [&baselines](const SettingValue& value) {
    std::vector<double> numbers;
    for (const SettingValue& member : to_list(value)) {
      if (member.is_string()) {
        for (const std::string& part : split(member.get<std::string>(), ',')) {
          numbers.push_back(to_number(part));
        }
      } else {
        numbers.push_back(to_number(member));
      }
    }
    baselines = std::move(numbers);
  };
  setting.get = [&baselines] { return baselines; };
}

void check_baselines(const std::vector<double>& baselines, std::size_t others) {
  if (baselines.size() != others) {
    throw UsageError(
        fmt::format("--baselines has {} number{}, expected {}: one for each image but the first",
                    baselines.size(), baselines.size() == 1 ? "" : "s", others));
  }
}

void add_reference_setting(Settings& settings, Side& reference) {
  settings.start_group("Matching");
  settings.choice<Side>("reference", reference, {{"left", Side::kLeft}, {"right", Side::kRight}},
                        "Image that the disparity map belongs to");
}

SettingValue reported_settings(const Settings& settings, const MatchOptions& options) {
  MatchOptions in_force = options.fully_resolved();
  Settings resolved;
  add_match_settings(resolved, in_force);
  SettingValue values = settings.values();
  values["resolved"] = resolved.values();
  const std::optional<MatchPreset> preset = options.preset_in_force();
  values["resolved"]["preset"] = preset ? std::string(name_of(*preset)) : "none";
  return values;
}

void add_unrectified_settings(Settings& settings, std::string& file, bool& rectified_pixels) {
  settings
      .input_path(
          "unrectified", file, "FILE",
          "Cameras of photographs that are not rectified (OpenCV, Middlebury or KITTI file, "
          "or the matrices of 'vantage rectify'): epipolar lines are searched instead of "
          "rows. Maps are on the pixels of the photographs, disparities those of the "
          "rectified pair")
      .changes_results = false;
  settings.flag("rectified-pixels", rectified_pixels,
                "With --unrectified: bring maps to the pixels of the rectified images, as 'vantage "
                "synth --calibration' takes them");
}

}  // namespace vantage
