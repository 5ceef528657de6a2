#pragma once

#include <string>
#include <vector>

#include "engine/options/setting_value.h"
#include "engine/sequence/journal/run_journal.h"

namespace vantage::apps {

/// What became of an item, or of a part of one.
struct ItemResult {
  int item = 0;  ///< of the manifest, counted from 0
  bool failed = false;
  std::string problem = {};  ///< why it failed, or what was skipped; a line
  int frames = 0;            ///< that are done
  int skipped = 0;           ///< bad frames that were left out
  int attempts = 1;
  double seconds = 0;
  double core_seconds = 0;
  std::vector<FileRecord> files = {};  ///< of a pair, relative to the folder of the batch
  std::string command = {};            ///< that repeats it alone; of a failed item
};

/// A JSON object and back. The second throws nlohmann's exceptions.
SettingValue to_values(const ItemResult& result);
ItemResult result_from_values(const SettingValue& values);

}  // namespace vantage::apps
