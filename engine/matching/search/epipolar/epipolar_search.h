#pragma once

#include "engine/matching/search/level_map_search.h"

namespace vantage {

/// Both maps of a pair that is not rectified, along epipolar lines (5.3.2, EQUATIONS §3.20). The
/// photograph of a map is not resampled, the other one once. Without windows, which read rows.
class EpipolarSearch final : public LevelMapSearch {
 public:
  explicit EpipolarSearch(SearchJob& job) : LevelMapSearch(job, own_) {}
  static SearchPlan plan(const ResolvedMatchOptions& options, const MatchSize& size);

  void start() override;
  void prepare() override {}  // both maps need all of the memory
  void search(MapTask& task) override;
  void refine(RefinementWork& work) override;

 private:
  const ChainInput& input_of(const MapTask& /*task*/) override { return input_; }
  void prepare_map(const MapTask& task);
  void check(const MapTask& task, const DisparityMap& other_px) const;

  LevelMemory own_;
  ChainInput input_;  ///< of the map being computed
};

}  // namespace vantage
