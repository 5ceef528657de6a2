#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/options/setting_value.h"

namespace vantage::apps {

/// A line of a manifest.
struct ManifestItem {
  int line = 0;             ///< counted from 1
  std::string output = {};  ///< folder of its results, relative to that of the batch: "a/b"
  SettingValue options = SettingValue::object();  ///< name of an option of run → value
};

/// Reads a manifest: CSV with a heading, or JSON lines, an object each. The column `output` is
/// needed; the others are named as options of run. Empty fields are as without the column. Paths of
/// inputs are relative to the manifest's folder, here they are absolute or as in the manifest if
/// that is absolute. Throws Error naming file and line: no `output`, one that is no relative path,
/// is given twice or inside another one; UsageError for what is no option of an item.
std::vector<ManifestItem> read_manifest(const std::filesystem::path& file);

}  // namespace vantage::apps
