#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/options/setting_value.h"

namespace vantage::apps {

/// How a run of this program ended.
struct ChildEnding {
  int exit_code = 0;
  std::string problem = {};   ///< its last message
  SettingValue results = {};  ///< of its report; null: there is none
  int attempts = 1;
  double seconds = 0;  ///< of the last attempt

  /// Perhaps without some frames.
  [[nodiscard]] bool is_done() const;
  /// Processor time of a frame.
  [[nodiscard]] double core_seconds_per_frame() const;
};

/// Runs this program as a child, again where it fails, but not for wrong usage. Thread rule: may be
/// used concurrently.
class ChildRuns {
 public:
  /// `patience`: from a stop until a child is killed.
  ChildRuns(int attempts, std::chrono::duration<double> patience);

  /// `words`: of the command line; `report`: the file for its report.
  [[nodiscard]] ChildEnding run(const std::vector<std::string>& words,
                                const std::filesystem::path& report,
                                const std::atomic<bool>& stop) const;

 private:
  [[nodiscard]] ChildEnding run_once(const std::vector<std::string>& words,
                                     const std::filesystem::path& report,
                                     const std::atomic<bool>& stop) const;

  int attempts_;
  std::chrono::duration<double> patience_;
  std::string program_;
};

}  // namespace vantage::apps
