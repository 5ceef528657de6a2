#pragma once

#include <string>
#include <string_view>

#include "engine/matching/options/match_options.h"
#include "engine/options/settings.h"
#include "engine/rectification/rows/row_correction.h"

namespace vantage {

/// A range given as "MIN:MAX"; throws UsageError that says what was expected.
DisparityRange to_disparity_range(const SettingValue& value, std::string_view expected);
std::string to_text(DisparityRange range);

/// Defaults of commands that match images: the disparity range is estimated unless it is given.
MatchOptions options_with_found_range();

/// All fields of MatchOptions except `reference`.
void add_match_settings(Settings& settings, MatchOptions& options);
/// Positions of the cameras of all images but the first.
void add_baselines_setting(Settings& settings, std::vector<double>& baselines, std::string help);
/// Throws UsageError unless there is one number for each of `others` images.
void check_baselines(const std::vector<double>& baselines, std::size_t others);
/// --rows, in the present group.
Setting& add_rows_setting(Settings& settings, RowMode& rows);
void add_reference_setting(Settings& settings, Side& reference);

/// Settings for the report: the values of `settings` and, under `resolved`, those of
/// add_match_settings() after preset and method have filled in what is not set. `resolved.preset`
/// is the preset used, or "none".
SettingValue reported_settings(const Settings& settings, const MatchOptions& options);

/// --unrectified and --rectified-pixels, in the present group. The file counts as an input that the
/// journal of a run identifies by its content.
void add_unrectified_settings(Settings& settings, std::string& file, bool& rectified_pixels);

}  // namespace vantage
