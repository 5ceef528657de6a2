#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/vantage.h"
#include "python/arrays.h"

namespace vantage::python {

/// The images of a match, kept for what is computed of them later. Thread rule: pure, but made and
/// destroyed with the GIL.
class MatchedImages {
 public:
  /// Arrays of the caller, read in place where their layout allows: two, or with `baselines` as
  /// many more as there are numbers, see StereoMatcher::match_several().
  /// `masks`: of the first two, 255 where they show no scene; empty: all do.
  MatchedImages(std::vector<PixelArray> arrays, std::vector<double> baselines,
                std::array<Mask, 2> masks, bool finds_borders, std::optional<double> white_level);
  /// A pair that nobody else can change.
  MatchedImages(Photograph left, Photograph right);

  /// The photographs at their white level, to be read while this lives. The first call remembers
  /// what they are.
  [[nodiscard]] std::vector<Photograph> read();
  /// The same later; throws Error that names `asked_for` where arrays have changed since read().
  [[nodiscard]] std::vector<Photograph> read_again(const char* asked_for) const;

  /// What read() found out.
  [[nodiscard]] const std::vector<Remark>& remarks() const { return white_level_.remarks; }

  /// The map's image: of the pair the left one, unless the second camera is on the left.
  [[nodiscard]] Side side(Side reference) const {
    return baselines_.empty() ? reference : baselines_.front() > 0 ? Side::kLeft : Side::kRight;
  }
  [[nodiscard]] bool is_pair() const { return baselines_.empty(); }
  /// Number of the image that the map of this side belongs to.
  [[nodiscard]] std::size_t reference(Side side) const { return is_pair() ? index_of(side) : 0; }

  /// PairMatcher::match(), or match_several(), of photographs from read().
  MatchOptions match(const PairMatcher& matcher, const std::vector<Photograph>& photographs,
                     const MatchRequest& request, DisparityMaps& maps,
                     MatchReport* report = nullptr) const;

 private:
  [[nodiscard]] std::vector<std::uint32_t> checksums() const;
  [[nodiscard]] std::vector<Photograph> photographs() const;

  std::vector<PixelArray> arrays_;  ///< empty: `own_`
  std::vector<Photograph> own_;
  std::vector<double> baselines_;
  std::array<Mask, 2> masks_;   ///< of arrays_
  bool finds_borders_ = false;  ///< of arrays_
  std::optional<double> white_level_given_;
  WhiteLevel white_level_;
  std::vector<std::uint32_t> checksums_;  ///< of arrays_
};

}  // namespace vantage::python
