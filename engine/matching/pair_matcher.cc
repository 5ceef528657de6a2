#include "engine/matching/pair_matcher.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "engine/matching/range_check.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/search/match_inputs.h"
#include "engine/matching/vertical_range.h"
#include "engine/rectification/rows/row_remarks.h"

namespace vantage {

MatchOptions with_found_ranges(MatchOptions options, const Photograph& left,
                               const Photograph& right, Execution& execution) {
  const bool finds_any = options.disparities_auto || options.disparities_y_auto;
  if (options.disparities_y_auto) {
    options.disparities_y = require_vertical_range(find_vertical_range(left, right, execution));
    options.disparities_y_auto = false;
  }
  if (options.disparities_auto) {
    options.disparities = require_disparity_range(find_disparity_range(
        left, right, execution, options.disparities_y.value_or(DisparityRange{0, 0})));
    options.disparities_auto = false;
  }
  if (finds_any) {
    options.validate();
  }
  return options;
}

bool expects_negative_disparities(const MatchOptions& options) {
  return !options.disparities_auto && -options.disparities.min > options.disparities.max;
}

PairMatcher::PairMatcher(const MatchOptions& options, Execution& execution, RowMode rows)
    : options_(options), execution_(execution), rows_(rows) {
  options_.validate();
}

bool PairMatcher::may_correct_rows(const Photograph& left, const Photograph& right,
                                   const MatchRequest& request) const {
  const bool has_right_volumes =
      std::ranges::any_of(request.volumes, [](const VolumeRequest& volume) {
        return volume.side == Side::kRight;
      });  // which are not brought back
  return rows_ == RowMode::kAuto && !options_.disparities_y && !options_.disparities_y_auto &&
         !has_right_volumes && request.prior.empty() && request.previous == nullptr &&
         left.width() == right.width() && left.height() == right.height();
}

MatchOptions PairMatcher::match(const Photograph& left, const Photograph& right,
                                const MatchRequest& request, DisparityMaps& maps,
                                MatchReport* report) const {
  if (!may_correct_rows(left, right, request)) {
    return match_rows(left, right, request, maps, report);
  }
  const RowCheck check = check_rows(left, right, &execution_);
  Photograph corrected;
  if (check.pays()) {
    correct_rows(right, check.rows->field, corrected, execution_);
  }
  MatchOptions used = match_rows(left, check.pays() ? corrected : right, request, maps, report);
  if (check.pays()) {
    bring_to_given_rows(check.rows->field, maps.right, execution_);
  }
  if (report != nullptr) {
    std::ranges::move(
        row_remarks(check, {.is_corrected = check.pays(),
                            .expects_negative = expects_negative_disparities(options_)}),
        std::back_inserter(report->remarks));
  }
  return used;
}

MatchOptions PairMatcher::match_rows(const Photograph& left, const Photograph& right,
                                     const MatchRequest& request, DisparityMaps& maps,
                                     MatchReport* report) const {
  const auto ready = ready_for(with_found_ranges(options_, left, right, execution_));
  ready->matcher.match(left, right, request, maps, report);
  if (report != nullptr) {
    check_range(left, right, maps, ready->options, *report);
  }
  return ready->options;
}

void PairMatcher::check_range(const Photograph& left, const Photograph& right,
                              const DisparityMaps& maps, const MatchOptions& used,
                              MatchReport& report) const {
  const bool is_found = options_.disparities_auto;
  const MatchesAtEnds matches = matches_at_ends(maps, used);
  if (!may_be_cut(matches, used, is_found)) {
    return;
  }
  const CutRange cut = look_beyond(matches, left, right, used, execution_);
  if (cut.any()) {
    report.remarks.push_back(cut_range_remark(cut, used.disparities, is_found));
  }
}

MatchOptions PairMatcher::match_several(const Photograph& reference,
                                        std::span<const OtherView> others,
                                        const MatchRequest& request, DisparityMaps& maps,
                                        MatchReport* report) const {
  require_different_baselines(others);
  const Photograph& other = *others.front().photograph;
  const bool is_left = others.front().baseline > 0;
  const auto ready = ready_for(with_found_ranges(options_, is_left ? reference : other,
                                                 is_left ? other : reference, execution_));
  ready->matcher.match_several(reference, others, request, maps, report);
  return ready->options;
}

std::shared_ptr<const PairMatcher::Ready> PairMatcher::ready_for(
    const MatchOptions& options) const {
  const std::lock_guard lock(mutex_);
  // All else is as in options_.
  if (!ready_ || ready_->options.disparities != options.disparities ||
      ready_->options.disparities_y != options.disparities_y) {
    ready_ = std::make_shared<const Ready>(options, execution_);
  }
  return ready_;
}

MatchOptions PairMatcher::match(const Photograph& left, const Photograph& right, MatchedMap& map,
                                MatchReport* report) const {
  const Side side = options_.reference;
  DisparityMaps maps;
  std::swap(maps.of(side), map);
  MatchOptions used = match(
      left, right, {.left = side == Side::kLeft, .right = side == Side::kRight}, maps, report);
  std::swap(maps.of(side), map);
  return used;
}

}  // namespace vantage
