#include "apps/reports/examination_report.h"

#include <fmt/format.h>

#include "apps/inputs/rectification_check.h"
#include "apps/process/tell.h"
#include "apps/reports/remarks.h"
#include "apps/reports/vertical_error_report.h"
#include "engine/options/match_settings.h"
#include "engine/rectification/rows/row_remarks.h"

namespace vantage::apps {
namespace {

int bits_of(const Photograph& photograph) {
  return std::visit([](const auto& image) { return static_cast<int>(8 * sizeof(*image.row(0))); },
                    photograph.pixels);
}

std::string pixels_text(const Photograph& photograph) {
  std::string text =
      fmt::format("{}x{}, {}, {} bits", photograph.width(), photograph.height(),
                  photograph.channels() < 3 ? "grey" : "colour", bits_of(photograph));
  if (const auto& coding = photograph.origin.coding) {
    text += ", " + coding->codec;
    if (coding->step_grey_levels > 0) {
      text += fmt::format(" in steps of {:.1f} grey levels", coding->step_grey_levels);
    }
  }
  return text;
}

std::string noise_text(const FoundNoise& noise) {
  return noise.kind == NoiseKind::kSensor  ? fmt::format("{:.1f} grey levels", noise.grey_levels)
         : noise.kind == NoiseKind::kCodec ? "blocks of a lossy codec"
                                           : "none that matters";
}

std::string rows_text(const RowCheck& check) {
  if (check.pays()) {
    return fmt::format("{}; --rows auto corrects them, points agree to {:.2f} px",
                       row_text(*check.rows, "rows"), check.rows->residual_px);
  }
  return !check.error ? "unknown: too few points in common"
                      : (rows_correspond(check) ? "correspond" : cost_text(*check.error, "they")) +
                            ": " + vertical_error_text(*check.error);
}

SettingValue image_values(const Photograph& photograph, const ImageStatistics& image) {
  SettingValue values = {
      {"channels", photograph.channels()}, {"bits", bits_of(photograph)},
      {"mean_grey", image.mean_grey},      {"black_share", image.black_share},
      {"white_share", image.white_share},  {"textureless_share", image.textureless_share}};
  if (const auto& coding = photograph.origin.coding) {
    values["codec"] = coding->codec;
    values["step_grey_levels"] = coding->step_grey_levels;
  }
  return values;
}

}  // namespace

bool rows_correspond(const RowCheck& check) {
  return check.rows || (check.error && is_rectified(*check.error));
}

std::string table_line(std::string_view label, const std::string& text) {
  return fmt::format("{:<12} {}\n", label, text);
}

std::string examination_text(const FramePair& pair, const PairExamination& found) {
  const auto& [left, right] = found.images;
  std::string text = table_line("left", pixels_text(pair.left));
  text += table_line("right", pixels_text(pair.right));
  text += table_line("exposure", fmt::format("mean grey level {:.0f} and {:.0f}; {:.1f} and {:.1f} "
                                             "% black, {:.1f} and {:.1f} % white",
                                             left.mean_grey, right.mean_grey,
                                             100 * left.black_share, 100 * right.black_share,
                                             100 * left.white_share, 100 * right.white_share));
  text += table_line("texture",
                     fmt::format("{:.0f} and {:.0f} % of the pixels have none",
                                 100 * left.textureless_share, 100 * right.textureless_share));
  if (const auto& error = found.rows.error) {
    text += table_line("sides", error->looks_exchanged() ? exchanged_text(*error) : "left is left");
  }
  text += table_line("rows", rows_text(found.rows));
  if (found.disparities) {
    text += table_line("noise", noise_text(found.noise));
    text += table_line("range", to_text(*found.disparities));
    text +=
        table_line("match", fmt::format("{} in {:.2f} s", to_text(found.shares), found.seconds));
  }
  for (const Remark& remark : found.remarks) {
    text += table_line(remark.is_warning() ? "warning" : "note", with_dashes(remark.text));
  }
  for (const std::string& problem : found.problems) {
    text += table_line("problem", with_dashes(problem));
  }
  return text;
}

SettingValue examination_values(const FramePair& pair, const PairExamination& found) {
  SettingValue values = {{"index", pair.index},
                         {"width_px", pair.left.width()},
                         {"height_px", pair.left.height()},
                         {"left", image_values(pair.left, found.images[0])},
                         {"right", image_values(pair.right, found.images[1])},
                         {"problems", found.problems}};
  if (const auto& error = found.rows.error) {
    values["rectification"] = vertical_error_values(*error);
    values["rectification"]["is_rectified"] = rows_correspond(found.rows);
    values["rectification"]["looks_exchanged"] = error->looks_exchanged();
  }
  if (found.rows.rows) {
    values["rows"] = row_values(*found.rows.rows, found.rows.pays());
  }
  if (found.disparities) {
    values["disparities"] = to_text(*found.disparities);
    values["noise"] = noise_values(found.noise);
    values["map"] = map_values(found.shares);
    values["seconds"] = found.seconds;
  }
  return values;
}

}  // namespace vantage::apps
