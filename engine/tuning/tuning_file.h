#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/tuning/tuned_settings.h"
#include "engine/tuning/tuning_key.h"

namespace vantage {

/// Search result for one use.
struct TunedPlan {
  TunedSettings settings;            ///< all empty: the default plan is best
  double frame_seconds = 0;          ///< as measured, possibly on lower images
  double default_frame_seconds = 0;  ///< of the default plan, measured the same way
  double ratio_to_default = 1;
  int measurements = 0;
  int measured_rows = 0;  ///< height of the images that were measured
  std::string date = {};  ///< "2026-11-22T00:15:30Z"
};

/// Whether pairs are matched one by one or as a sequence of frames in flight.
enum class TunedUse { kMatch, kRun };

struct TuningEntry {
  TuningKey key;
  std::optional<TunedPlan> match;
  std::optional<TunedPlan> run;

  [[nodiscard]] const std::optional<TunedPlan>& plan_for(TunedUse use) const {
    return use == TunedUse::kMatch ? match : run;
  }
};

struct TuningFileContent {
  std::vector<TuningEntry> entries;
  /// Unusable content, with position and reason, one line each.
  std::vector<std::string> warnings;
  /// The file exists but is not a tuning file of this program: it must not be overwritten.
  bool is_foreign = false;
};

/// $XDG_CONFIG_HOME/vantage/tuning.json, or $HOME/.config/vantage/tuning.json; empty if neither
/// variable holds an absolute path.
std::optional<std::filesystem::path> default_tuning_path();

/// Never fails: a missing file has no entries; a damaged file or entry, or one of another format,
/// is reported as a warning and skipped.
TuningFileContent read_tuning_file(const std::filesystem::path& path);

/// The entry with exactly this key; null if there is none.
const TuningEntry* find_entry(const TuningFileContent& content, const TuningKey& key);

/// Replaces the entry with the same key or adds `entry`; a use for which it has no plan keeps the
/// old one. Writes atomically and creates the folder; concurrent processes do not lose each other's
/// entries. Throws Error when the file cannot be written or is not a tuning file.
void store_entry(const std::filesystem::path& path, const TuningEntry& entry);

}  // namespace vantage
