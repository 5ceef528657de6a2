#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/execution.h"
#include "engine/matching/stereo_matcher.h"
#include "perf/quality/sgbm_settings.h"
#include "perf/quality/true_scenes.h"

namespace vantage::perf {

/// What is timed.
enum class TimedMaps { kBoth, kLeft };

/// A contender at one pair, which outlives it.
class MapMaker {
 public:
  virtual ~MapMaker() = default;
  /// What is timed. Ours: refined maps. OpenCV's: maps as its matcher leaves them, so that nothing
  /// of ours counts against it.
  virtual void match(TimedMaps which) = 0;
  /// Both dense maps of the last match() of both.
  virtual const DisparityMaps& maps() = 0;
};

/// A way to make maps that is judged.
struct MapContender {
  std::string name;
  std::string note;
  bool is_sgbm;
  std::function<std::unique_ptr<MapMaker>(const ScenePair&, Execution&)> prepare;
};

/// One of sgbm_settings().
MapContender sgbm_contender(const SgbmSetting& setting);

/// The entries of a TOML file, by name: tables with the keys of `vantage match` and a `note`.
/// Throws Error where the file cannot be read, UsageError naming file, entry and key for what is
/// not accepted.
std::vector<MapContender> experiments(const std::filesystem::path& file);

}  // namespace vantage::perf
