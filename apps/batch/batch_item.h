#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/batch/batch_settings.h"
#include "apps/batch/manifest.h"
#include "apps/run/run_settings.h"
#include "engine/options/settings.h"

namespace vantage::apps {

/// A manifest's item as a run: the options of the batch, then its own. Not movable: settings refer
/// to the job.
class BatchItem {
 public:
  /// Throws UsageError naming the item for options that are invalid or do not go together. Reads no
  /// files but poses.
  BatchItem(const ManifestItem& item, const BatchJob& batch, const SettingValue& options_of_all);
  BatchItem(const BatchItem&) = delete;
  BatchItem& operator=(const BatchItem&) = delete;

  [[nodiscard]] const RunJob& job() const { return job_; }
  /// Whether the item is two images. Its result files then have no numbers: DIR/disparity.pfm.
  [[nodiscard]] bool is_pair() const;
  /// Whether a pair can be run together with others of equal options_hash(), without changing its
  /// result. Its white level must be known.
  [[nodiscard]] bool goes_with_others() const;
  /// A hash of everything but the inputs, the range and the output.
  [[nodiscard]] std::uint64_t options_hash() const;
  /// A file of settings for 'vantage run', which goes on with what is in `output`.
  [[nodiscard]] std::string to_job_file(const std::string& output);
  /// The same for a list of pairs with these options. The run skips bad pairs.
  [[nodiscard]] std::string to_job_file_of_list(const std::string& list, const std::string& output);

 private:
  RunJob job_;
  Settings settings_;
};

/// Throws UsageError for the first item that is invalid.
void check_items(const BatchJob& batch, const std::vector<ManifestItem>& items,
                 const SettingValue& options_of_all);

/// The options of the command line that hold for all items.
SettingValue options_of_all(const Settings& settings);

}  // namespace vantage::apps
