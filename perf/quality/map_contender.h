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

/// Maps to time.
enum class TimedMaps { kBoth, kLeft };

/// A contender on one pair; the pair must outlive it.
class MapMaker {
 public:
  virtual ~MapMaker() = default;
  /// The timed work. Vantage: refined maps. OpenCV: maps as its matcher returns them, so that none
  /// of our steps counts against it.
  virtual void match(TimedMaps which) = 0;
  /// Both dense maps of the last match(TimedMaps::kBoth).
  virtual const DisparityMaps& maps() = 0;
};

/// A method to be evaluated.
struct MapContender {
  std::string name;
  std::string note;
  bool is_sgbm;
  std::function<std::unique_ptr<MapMaker>(const ScenePair&, Execution&)> prepare;
};

/// One of sgbm_settings().
MapContender sgbm_contender(const SgbmSetting& setting);

/// The entries of a TOML file, by name: tables with the keys of `vantage match` and a `note`.
/// Throws Error if the file cannot be read, UsageError naming file, entry and key if an entry is
/// not accepted.
std::vector<MapContender> experiments(const std::filesystem::path& file);

}  // namespace vantage::perf
