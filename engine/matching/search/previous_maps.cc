#include "engine/matching/search/previous_maps.h"

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <variant>

#include "engine/combinations/combinations.h"
#include "engine/image/memory_use.h"
#include "engine/matching/options/method_fields.h"

namespace vantage {

std::string_view reuse_obstacle(const ResolvedMatchOptions& options) {
  OptionValues values = values_of(options.parameters, {});
  values.set("reuse", "frame");
  if (options.disparities_y) {
    values.set("disparities-y", "given");
  }
  constexpr std::string_view kExpected = "expected none with ";
  const Combination* const row = first_case(CombinationScope::kReuse, values);
  return row == nullptr ? std::string_view() : row->message.substr(kExpected.size());
}

void copy_winners(const MatchedMap& map, Execution& execution, MatchedMap& copy) {
  const auto copy_rows = [&execution](const Image<float>& from, Image<float>& to) {
    to.resize(from.width(), from.height());
    execution.for_each_band(from.height(), [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        std::copy_n(from.row(y), from.width(), to.row(y));
      }
    });
  };
  copy_rows(map.disparity_px, copy.disparity_px);
  copy_rows(map.confidence, copy.confidence);
}

bool PreviousMaps::choose(const Photograph& left, const Photograph& right, const Content& content) {
  const bool is_first = content_ != content;
  if (is_first) {
    forget();
  }
  content_ = content;
  if (!choose_tiles(std::get<Image<std::uint8_t>>(left.pixels),
                    std::get<Image<std::uint8_t>>(right.pixels), is_first, half_size_)) {
    forget_maps();
    return false;
  }
  const int scale = content.map.columns > left.width() ? 2 : 1;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    TileMask& searched = sides_[i].searched;
    searched.assign(content.map.columns, content.map.rows, false, scale * TileMask::kSidePx);
    for (int row = 0; row < searched.rows(); ++row) {
      for (int column = 0; column < searched.columns(); ++column) {
        searched.set(column, row, !has_maps_ || half_size_[i].at(column, row));
      }
    }
    sides_[i].refinement.start(searched);
  }
  has_maps_ = true;
  return true;
}

void PreviousMaps::forget() {
  content_.reset();
  forget_maps();
}

void PreviousMaps::forget_maps() {
  has_maps_ = false;
  for (OfSide& side : sides_) {
    side.refinement.restart();
  }
}

std::size_t PreviousMaps::held_bytes() const {
  std::size_t bytes = 0;
  for (const OfSide& side : sides_) {
    bytes += vantage::held_bytes(side.winners) + side.refinement.held_bytes() +
             side.levels.held_bytes() + vantage::held_bytes(side.check_px);
  }
  return bytes;
}

}  // namespace vantage
