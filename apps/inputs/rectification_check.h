#pragma once

#include <optional>
#include <string_view>

#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/options/settings.h"
#include "engine/rectification/rows/row_correction.h"

namespace vantage::apps {

/// What is done about the rows of a pair.
struct RowSettings {
  RowMode mode = RowMode::kAuto;
  bool check = true;  ///< false: rows are not examined
};

/// --rows and --no-rectification-check.
void add_row_settings(Settings& settings, RowSettings& rows);
/// --no-rectification-check alone, with its help text.
void add_rectification_check_setting(Settings& settings, bool& wanted, const char* text);

/// How rows are looked at, and what is told.
struct RowTask {
  const CommonOptions& common;
  RowMode mode = RowMode::kAuto;
  bool expects_negative = false;    ///< images are not exchanged where most disparities are
  std::string_view lines = "rows";  ///< or "columns" of a transposed pair
  bool is_of_sequence = false;      ///< only warn: the sequence corrects all of its pairs alike
};

/// What a correction replaced.
struct CorrectedRows {
  RowField field;
  Photograph given;  ///< the right image
};

/// Looks at the rows of a pair, and corrects `right` in place with RowMode::kAuto where that pays.
/// A line on stderr says so. Warns if the rows are off by more than can be corrected, or than
/// kMaxMoreBad_percent with kAsIs, and if nearly all disparities are negative. The report gets
/// `results.rows` and `results.rectification`, and the stage "check", which is no compute time; the
/// correction is. Nothing is done for images of different sizes, which the user of the pair
/// reports.
std::optional<CorrectedRows> correct_rows(const RowTask& task, const Photograph& left,
                                          Photograph& right, Execution& execution,
                                          RunReport& report);

/// What was found about rows, as values of a report (`results.rows`).
SettingValue row_values(const RowEstimate& rows, bool is_corrected);
}  // namespace vantage::apps
