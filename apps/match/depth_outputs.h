#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/process/outputs.h"
#include "apps/reports/run_report.h"
#include "engine/execution.h"
#include "engine/options/rig_scale.h"
#include "engine/options/settings.h"
#include "engine/reprojection/point_cloud.h"

namespace vantage::apps {

/// Files in metres that one disparity map is turned into.
struct DepthOutputs {
  std::string depth;  ///< empty, as the next two: not wanted
  std::string cloud;
  std::string mesh;
  CloudOptions options;

  [[nodiscard]] bool any() const { return !(depth.empty() && cloud.empty() && mesh.empty()); }
  [[nodiscard]] bool has_points() const { return !(cloud.empty() && mesh.empty()); }
  [[nodiscard]] bool reads_confidence() const { return has_points() && options.reads_confidence(); }
  [[nodiscard]] bool reads_unmatched() const { return has_points() && !options.keeps_filled; }
  /// "depth", the first that is wanted.
  [[nodiscard]] std::string first_option() const {
    return !depth.empty() ? "depth" : !cloud.empty() ? "cloud" : "mesh";
  }
};

/// --depth, --cloud and --mesh.
void add_depth_output_settings(Settings& settings, DepthOutputs& outputs);

/// Throws UsageError for wrong fields and for options without effect. Adds the files to `files`.
void check_depth_outputs(const DepthOutputs& outputs, const Settings& settings, FileChecks& files);

/// The content of the wanted files: made before any is written.
struct DepthFiles {
  std::vector<std::uint8_t> depth;
  std::vector<std::uint8_t> cloud;
  std::vector<std::uint8_t> mesh;
  std::vector<std::string> summaries;  ///< a line for each
};

/// Makes them, and adds what they hold to the report. Throws Error for an empty cloud.
DepthFiles make_depth_files(const DepthOutputs& outputs, const CloudSource& source,
                            Execution& execution, RunReport& report);
void write_depth_files(const DepthOutputs& outputs, const DepthFiles& files);

}  // namespace vantage::apps
