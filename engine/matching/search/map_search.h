#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "engine/image/side.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/deferred_match.h"
#include "engine/matching/search/match_report.h"
#include "engine/matching/search/match_request.h"
#include "engine/matching/search/previous_maps.h"
#include "engine/matching/search/search_plan.h"
#include "engine/matching/search/stage_clock.h"
#include "engine/rectification/epipolar_grid.h"
#include "engine/refinement/refine_maps.h"

namespace vantage {

/// What a search can do beside maps along the rows of a pair. Texts: why it cannot, as the refusal
/// says it; empty: it can.
struct SearchAbilities {
  std::string_view name;
  std::string_view no_vertical_range = {};
  std::string_view no_symmetric_selection = {};
  std::string_view no_prior = {};
  std::string_view no_volumes = {};
  bool reuse = false;       ///< of the maps of the pair before
  bool check_maps = false;  ///< a map may be checked against less than the other (CheckMap)
};

/// An image of a call.
struct SearchedPhotograph {
  const Photograph* photograph;
  double place = 0;  ///< 0: the reference; in the distance of the first other image, of its sign
};

/// What is computed of an image's map: the map, and what is used to check the other one.
struct MapNeed {
  bool whole = false;  ///< the map, unless check_is_only
  bool check = false;  ///< a check map
  bool check_is_only = false;
};

/// One image and the map to compute for it.
struct MapTask {
  Side side;
  const Photograph* image;  ///< of the map's size
  MatchedMap* map;
  std::string_view name;  ///< of the report's stage
  bool is_result = true;  ///< the map is requested
  bool wants_confidence = false;
  std::span<const VolumeRequest> volumes = {};
  MapNeed need = {};
  ImageView<const float> check_px = {};  ///< made by the search; empty: not needed
};

/// One call: what searches read, and what is known of its maps. All references must outlive it.
struct SearchJob {
  const ResolvedMatchOptions& options;
  Execution& execution;
  const MatchRequest& request;
  DisparityMaps& maps;
  MatchReport& report;
  StageClock& clock;
  std::vector<SearchedPhotograph> images;  ///< a pair: left, right; several: the reference first
  Side reference_side = Side::kLeft;       ///< several: kLeft if the second one is to its right
  const EpipolarGrids* grids = nullptr;    ///< of a pair that is not rectified

  MethodParameters parameters;  ///< those in force, but for what the search does without
  SearchPlan plan = {};
  std::vector<MapTask> tasks = {};   ///< in the order of their searches
  PreviousMaps* previous = nullptr;  ///< of both maps; null: everything is searched

  [[nodiscard]] scheduler::Extent extent() const {
    return {images.front().photograph->width(), images.front().photograph->height()};
  }
  [[nodiscard]] bool is_checked() const {
    return options.refinement && options.refinement->cross_check;
  }
  [[nodiscard]] bool wants_confidence() const {
    return request.confidence || (options.refinement && uses_confidence(*options.refinement));
  }
  [[nodiscard]] bool is_symmetric() const {
    return options.parameters.selection == Selection::kSymmetric;
  }
  [[nodiscard]] MapTask& task_of(Side side) { return tasks[tasks.front().side == side ? 0 : 1]; }
};

/// A way to find the winners of maps, at work on one call. Its functions are called in this order,
/// those without a comment "always" only if they are needed.
class MapSearch {
 public:
  explicit MapSearch(SearchJob& job) : job_(job) {}
  MapSearch(const MapSearch&) = delete;
  MapSearch& operator=(const MapSearch&) = delete;
  virtual ~MapSearch() = default;

  /// Always, unless resume() takes over what defer() of an earlier call has left: sets the tasks.
  virtual void start() = 0;
  virtual void resume(DeferredMatch& deferred) {
    deferred = {};
    start();
  }
  /// 8-bit grey, half the size of both images, in which changes since the pair before are found.
  virtual std::array<const Photograph*, 2> half_size_images() { return {}; }
  /// Leaves the call for later.
  virtual void defer(DeferredMatch& deferred) { deferred.is_pending = true; }
  /// Always: prepares what the searches of all maps read.
  virtual void prepare() = 0;
  /// Always, for each task: its winners.
  virtual void search(MapTask& task) = 0;
  /// Always: checks and refines the maps.
  virtual void refine(RefinementWork& work) = 0;

  /// After prepare(), instead of the rest: the plans of the map of `task`, one for each of
  /// `executions`; none where images of several sizes are searched.
  [[nodiscard]] virtual std::vector<scheduler::ChainPlan> plans(
      const MapTask& /*task*/, std::span<const ExecutionOptions> /*executions*/) {
    return {};
  }

 protected:
  SearchJob& job_;
};

}  // namespace vantage
