#include "apps/reports/examination_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/image/side.h"
#include "engine/options/match_settings.h"
#include "engine/rectification/vertical_error.h"

namespace vantage::apps {
namespace {

std::string line(std::string_view label, const std::string& text) {
  return fmt::format("{:<12} {}\n", label, text);
}

double percent(double share) { return 100 * share; }

std::string exposure_text(const PairExamination& found) {
  const auto& [left, right] = found.images;
  return fmt::format(
      "mean grey level {:.0f} and {:.0f}; {:.1f} and {:.1f} % black, {:.1f} and {:.1f} % white",
      left.mean_grey, right.mean_grey, percent(left.black_share), percent(right.black_share),
      percent(left.white_share), percent(right.white_share));
}

std::string rows_text(const std::optional<VerticalError>& rows) {
  if (!rows) {
    return "unknown: too few points in common";
  }
  return (is_rectified(*rows) ? "correspond: " : cost_text(*rows, "they") + ": ") +
         vertical_error_text(*rows);
}

std::string sides_text(const std::optional<VerticalError>& rows) {
  if (!rows) {
    return "unknown: too few points in common";
  }
  return rows->looks_exchanged() ? exchanged_text(*rows)
                                 : fmt::format(
                                       "left is left: {:.0f} % of {} points have positive "
                                       "disparities",
                                       percent(1 - rows->negative_share), rows->inliers);
}

std::string pixels_text(const ImageStatistics& image) {
  std::string text = fmt::format("{}x{}, {}, {} bits", image.width_px, image.height_px,
                                 image.channels == 1   ? "grey"
                                 : image.channels == 3 ? "colour"
                                                       : "colour and alpha",
                                 image.bits);
  if (const auto& coding = image.origin.coding) {
    text += ", " + coding->codec;
    if (coding->step_grey_levels > 0) {
      text += fmt::format(" in steps of {:.1f} grey levels", coding->step_grey_levels);
    }
  }
  return text;
}

std::string noise_text(const FoundNoise& noise) {
  switch (noise.kind) {
    case NoiseKind::kNone:
      break;
    case NoiseKind::kSensor:
      return fmt::format("{:.1f} grey levels", noise.grey_levels);
    case NoiseKind::kCodec:
      return "blocks of a lossy codec";
  }
  return "none that matters";
}

std::string pair_text(const PairExamination& found) {
  const auto& [left, right] = found.images;
  const std::string size = pixels_text(left);
  std::string text =
      line("size", pixels_text(right) == size ? size : size + "; right " + pixels_text(right));
  text += line("exposure", exposure_text(found));
  text += line("texture",
               fmt::format("{:.0f} and {:.0f} % of the pixels have none",
                           percent(left.textureless_share), percent(right.textureless_share)));
  text += line("sides", sides_text(found.rows));
  text += line("rows", rows_text(found.rows));
  if (found.disparities) {
    text += line("noise", noise_text(found.noise));
    text += line("range", to_text(*found.disparities));
    text += line("match", fmt::format("{} in {:.2f} s", to_text(found.shares), found.seconds));
  }
  for (const Remark& remark : found.remarks) {
    text += line(remark.is_warning() ? "warning" : "note", with_dashes(remark.text));
  }
  for (const std::string& problem : found.problems) {
    text += line("problem", with_dashes(problem));
  }
  return text;
}

SettingValue image_values(const ImageStatistics& image) {
  SettingValue values = {
      {"channels", image.channels},       {"bits", image.bits},
      {"mean_grey", image.mean_grey},     {"black_share", image.black_share},
      {"white_share", image.white_share}, {"textureless_share", image.textureless_share}};
  if (const auto& coding = image.origin.coding) {
    values["codec"] = coding->codec;
    values["step_grey_levels"] = coding->step_grey_levels;
  }
  return values;
}

SettingValue pair_values(const ExaminedPair& pair) {
  const PairExamination& found = pair.found;
  SettingValue values = {{"index", pair.index},
                         {"name", pair.name},
                         {"width_px", found.images[0].width_px},
                         {"height_px", found.images[0].height_px},
                         {"left", image_values(found.images[0])},
                         {"right", image_values(found.images[1])},
                         {"problems", found.problems}};
  if (found.rows) {
    values["rectification"] = vertical_error_values(*found.rows);
    values["rectification"]["is_rectified"] = is_rectified(*found.rows);
    values["rectification"]["looks_exchanged"] = found.rows->looks_exchanged();
  }
  if (found.disparities) {
    values["disparities"] = to_text(*found.disparities);
    values["noise"] = noise_values(found.noise);
    values["map"] = map_values(found.shares);
    values["seconds"] = found.seconds;
  }
  return values;
}

std::string calibration_text(const CheckedInput& checked) {
  if (!checked.cameras) {
    return "none: disparities, no depths";
  }
  return fmt::format("focal length {:.1f} px, baseline {:.4g} in its unit{}",
                     checked.cameras->left.matrix(0, 0), checked.cameras->baseline,
                     checked.is_rectified_here ? "; the pair is rectified by it" : "");
}

/// "0.20 s for a pair, 10 s for all 51 on 2 threads; 305 MiB".
std::string costs_text(const CheckedInput& checked) {
  const std::string all =
      checked.pair_count == 1
          ? ""
          : fmt::format(", {:.0f} s for all {}", std::ceil(checked.seconds() * checked.pair_count),
                        checked.pair_count);
  return fmt::format("{:.2f} s for a pair{} on {} thread{}; {:.0f} MiB", checked.seconds(), all,
                     checked.threads, checked.threads == 1 ? "" : "s",
                     static_cast<double>(checked.memory_bytes) / (1 << 20));
}

}  // namespace

bool CheckedInput::makes_sense() const {
  return std::ranges::any_of(pairs,
                             [](const ExaminedPair& pair) { return pair.found.problems.empty(); });
}

bool CheckedInput::looks_exchanged() const {
  int votes = 0;
  for (const ExaminedPair& pair : pairs) {
    votes += !pair.found.rows ? 0 : pair.found.rows->looks_exchanged() ? 1 : -1;
  }
  return votes > 0;
}

bool CheckedInput::is_unrectified() const {
  return std::ranges::any_of(pairs, [](const auto& pair) { return pair.found.rows.has_value(); }) &&
         std::ranges::none_of(pairs, [](const auto& pair) {
           return pair.found.rows && is_rectified(*pair.found.rows);
         });
}

std::optional<DisparityRange> CheckedInput::disparities() const {
  std::optional<DisparityRange> all;
  for (const ExaminedPair& pair : pairs) {
    if (const auto& own = pair.found.disparities) {
      all = all ? DisparityRange{std::min(all->min, own->min), std::max(all->max, own->max)} : *own;
    }
  }
  return all;
}

double CheckedInput::seconds() const {
  double longest = 0;
  for (const ExaminedPair& pair : pairs) {
    longest = std::max(longest, pair.found.seconds);
  }
  return longest;
}

std::string examination_text(const CheckedInput& checked) {
  std::string text;
  for (const ExaminedPair& pair : checked.pairs) {
    text += line("pair", checked.pair_count == 1 ? pair.name
                                                 : fmt::format("{} ({} of {})", pair.name,
                                                               pair.index, checked.pair_count));
    text += pair_text(pair.found);
  }
  text += line("calibration", calibration_text(checked));
  if (checked.makes_sense()) {
    text += line("cost", costs_text(checked));
  }
  if (!checked.command.empty()) {
    text += line("command", checked.command);
  }
  return text;
}

SettingValue examination_values(const CheckedInput& checked) {
  SettingValue pairs = SettingValue::array();
  for (const ExaminedPair& pair : checked.pairs) {
    pairs.push_back(pair_values(pair));
  }
  SettingValue values = {{"pairs", std::move(pairs)},
                         {"pair_count", checked.pair_count},
                         {"is_rectified_here", checked.is_rectified_here},
                         {"makes_sense", checked.makes_sense()}};
  if (checked.makes_sense()) {
    values["disparities"] = to_text(*checked.disparities());
    values["seconds_per_pair"] = checked.seconds();
    values["memory_bytes"] = checked.memory_bytes;
  }
  if (!checked.command.empty()) {
    values["command"] = checked.command;
  }
  return values;
}

}  // namespace vantage::apps
