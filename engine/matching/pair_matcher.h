#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/disparity_range.h"
#include "engine/image/photograph.h"
#include "engine/matching/options/match_options.h"
#include "engine/matching/search/match_report.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/rectification/rows/row_correction.h"

namespace vantage {

/// `options` with the ranges that are auto replaced by those that the images suggest, as 'vantage
/// match' does. Throws Error where the images suggest none.
MatchOptions with_found_ranges(MatchOptions options, const Photograph& left,
                               const Photograph& right, Execution& execution);

/// Whether the range is given, and most of its disparities are negative.
bool expects_negative_disparities(const MatchOptions& options);

/// A StereoMatcher that finds the range of each pair where `disparities` or `disparities_y` is
/// auto, and corrects its rows as 'vantage match' does. Thread rule: match() may be called
/// concurrently for different results.
class PairMatcher {
 public:
  /// Throws UsageError for invalid options. `execution` must outlive the matcher.
  /// With RowMode::kAsIs rows are not looked at.
  explicit PairMatcher(const MatchOptions& options, Execution& execution = default_execution(),
                       RowMode rows = RowMode::kAuto);

  /// StereoMatcher::match() with the ranges of this pair; returns the options that it used. Throws
  /// as that does, and Error where no range is found. Rows are corrected where the pair shows how,
  /// it pays and `request` allows it: without a vertical search, volumes of the right image,
  /// `prior` and `previous`. Maps are on the pixels of the given images. With `report` it also
  /// examines the map of the reference, and MatchReport::remarks says what was done about rows, and
  /// whether the range is too narrow. The look at rows takes about 5 ms of one thread.
  MatchOptions match(const Photograph& left, const Photograph& right, const MatchRequest& request,
                     DisparityMaps& maps, MatchReport* report = nullptr) const;

  /// The same for StereoMatcher::match_several(); a range is found between `reference` and the
  /// first of `others`.
  MatchOptions match_several(const Photograph& reference, std::span<const OtherView> others,
                             const MatchRequest& request, DisparityMaps& maps,
                             MatchReport* report = nullptr) const;

  /// Computes only the map of options().reference. Reuses the memory of that map.
  MatchOptions match(const Photograph& left, const Photograph& right, MatchedMap& map,
                     MatchReport* report = nullptr) const;

  [[nodiscard]] const MatchOptions& options() const { return options_; }
  [[nodiscard]] RowMode rows() const { return rows_; }

 private:
  /// A matcher of a range. The last one is kept, with its working memory.
  struct Ready {
    Ready(const MatchOptions& with_range, Execution& execution)
        : options(with_range), matcher(with_range, execution) {}
    MatchOptions options;
    StereoMatcher matcher;
  };
  [[nodiscard]] bool may_correct_rows(const Photograph& left, const Photograph& right,
                                      const MatchRequest& request) const;
  [[nodiscard]] MatchOptions match_rows(const Photograph& left, const Photograph& right,
                                        const MatchRequest& request, DisparityMaps& maps,
                                        MatchReport* report) const;
  /// Remarks on a range that is too narrow.
  void check_range(const Photograph& left, const Photograph& right, const DisparityMaps& maps,
                   const MatchOptions& used, MatchReport& report) const;
  [[nodiscard]] std::shared_ptr<const Ready> ready_for(const MatchOptions& options) const;

  MatchOptions options_;
  Execution& execution_;
  RowMode rows_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Ready> ready_;
};

}  // namespace vantage
