#pragma once

#include <functional>
#include <string>

#include "apps/match/view_output.h"
#include "apps/reports/run_report.h"
#include "apps/settings/common_options.h"
#include "engine/execution.h"
#include "engine/options/setting_value.h"
#include "engine/synthesis/view_renderer.h"

namespace vantage::apps {

/// The steps that produce a view. Each view in flight has its own slot.
struct ViewSteps {
  /// Reads the inputs of a view. Called in the order of the views, never concurrently with itself
  /// or `prepare`. May be empty.
  std::function<void(int slot, int view)> read;
  /// Prepares rendering; called like `read`, after it. May be empty.
  std::function<void(int slot, int view)> prepare;
  /// Concurrently for different slots.
  std::function<void(int slot, int view, RenderedView& result)> render;
  /// Returns the report entry of a view; called in order.
  std::function<SettingValue(int slot, int view, const RenderedView& result)> describe;
};

struct ViewPipelineResult {
  SettingValue views = SettingValue::array();  ///< descriptions of those that were written
  int width_px = 0;                            ///< of the last picture
  int height_px = 0;
  bool interrupted = false;
};

/// Number of views in flight: two more than threads, one being encoded and one waiting for it.
int views_in_flight(Execution& execution, int views);

/// Renders and writes views 0 .. views − 1, several at a time, so that reading, rendering and
/// encoding overlap; finishes `outputs` unless interrupted. Adds the stages read, views and write
/// and the compute time to `report`. `command` is named in the progress and when interrupted.
/// Throws what the steps throw, with all views before that one written.
ViewPipelineResult render_views(const std::string& command, int views, const ViewSteps& steps,
                                bool has_two_eyes, ViewOutputs& outputs,
                                const CommonOptions& common, Execution& execution,
                                RunReport& report);

}  // namespace vantage::apps
