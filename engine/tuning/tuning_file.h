#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/tuning/tuned_settings.h"
#include "engine/tuning/tuning_key.h"

namespace vantage {

/// What a search has found for one use.
struct TunedPlan {
  TunedSettings settings;            ///< all empty: the default plan is the best
  double frame_seconds = 0;          ///< as measured, which may be on lower images
  double default_frame_seconds = 0;  ///< the same of the default plan
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
  /// What could not be used, where and why, one line each.
  std::vector<std::string> warnings;
  /// The file is there but is none of this program's tuning files: it must not be replaced.
  bool is_foreign = false;
};

/// $XDG_CONFIG_HOME/vantage/tuning.json, or $HOME/.config/vantage/tuning.json; empty where neither
/// variable holds an absolute path.
std::optional<std::filesystem::path> default_tuning_path();

/// Never fails: a missing file has no entries; a damaged file or entry, or one of another format,
/// is told of in a warning and left out.
TuningFileContent read_tuning_file(const std::filesystem::path& path);

/// The entry of exactly this key; null if there is none.
const TuningEntry* find_entry(const TuningFileContent& content, const TuningKey& key);

/// Puts `entry` in the place of the one with its key, or beside the others; a use that it has no
/// plan for keeps the old one. The file appears whole or not at all, its folder is made; of several
/// processes at once none loses another's entries. Throws Error when it cannot be written, or when
/// what is there is no tuning file.
void store_entry(const std::filesystem::path& path, const TuningEntry& entry);

/// Removes the entries that `is_unwanted`; returns how many. Errors as store_entry().
int remove_entries(const std::filesystem::path& path,
                   const std::function<bool(const TuningEntry&)>& is_unwanted);

}  // namespace vantage
