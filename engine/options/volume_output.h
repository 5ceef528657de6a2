#pragma once

#include <optional>
#include <string>

#include "engine/io/maps/npy_volume_file.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/volume/volume_request.h"
#include "engine/options/setting_value.h"
#include "engine/options/settings.h"

namespace vantage {

/// What --volume and the options beside it ask for.
struct VolumeOutput {
  std::string file;  ///< empty: no volume
  VolumeKind kind = VolumeKind::kAggregated;
  int level = 0;
  std::optional<VolumeRows> rows;  ///< empty: all
};

void add_volume_settings(Settings& settings, VolumeOutput& output);

/// Throws UsageError where there is no such level, or no such rows.
void check_volume(const VolumeOutput& output, const MatchOptions& options);

/// Throws UsageError unless the level of an image with so many rows has the wanted ones. Call it
/// before the search; the file knows exactly.
void require_volume_rows(const VolumeOutput& output, int image_rows);

/// What a reader of the file has to know: shape, candidates, meaning of the values.
SettingValue volume_report(const VolumeOutput& output, const NpyVolumeFile& volume);
/// volume_report() as one line of text.
std::string volume_summary(const VolumeOutput& output, const NpyVolumeFile& volume);

}  // namespace vantage
