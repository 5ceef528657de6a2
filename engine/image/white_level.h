#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/remark.h"

namespace vantage {

/// The stored value that is white in photographs of one type. Thread rule: pure.
struct WhiteLevel {
  static constexpr std::array<double, 3> kOfTypes = {255, 65535, 1};  ///< as in Photograph::pixels

  std::size_t type = 0;  ///< photographs of other types stay as they are
  double value = kOfTypes[0];
  /// Of readers, and "white level: 4095 (12 bits), from the brightest pixels".
  std::vector<Remark> remarks = {};

  [[nodiscard]] bool scales(const Photograph& photograph) const {
    return photograph.pixels.index() == type && value != kOfTypes[type];
  }
  /// Scales the values in place, so that white is the type's 255, 65535 or 1. Integers beyond are
  /// clipped; the result is their share, 0 to 1. Floats may stay above 1, and keep their alpha.
  double apply(Photograph& photograph) const;
};

/// Finds the white level of photographs of one rig: many files hold 10, 12 or 14 significant bits
/// in 16, or floats of another scale than 0 to 1. What a file states comes first, unless
/// values are above it. Otherwise white
/// of 16-bit photographs is 2ⁿ − 1 with the bits n of their largest value, where that is 14 or
/// fewer; values that are all multiples of 257 were scaled from 8 bits. Floats keep their scale if
/// their brightest pixels are in [1/16, 2), single highlights (above eight times the 99.5th
/// percentile) aside; else white is 2ⁿ − 1, below 1/16 the brightest pixel. 8-bit photographs keep
/// 255. Of several types the widest counts.
class WhiteLevelSearch {
 public:
  /// `given`: instead of all that, for photographs of any type.
  explicit WhiteLevelSearch(std::optional<double> given = {}) : given_(given) {}

  /// Also takes the remarks of its reader, which found() repeats.
  void add(const Photograph& photograph);
  /// Whether more photographs of the rig could change the result.
  [[nodiscard]] bool guesses() const { return type_ != 0 && !given_ && !stated_; }
  /// Throws UsageError unless `given` is above 0 and at most the largest value of the type.
  [[nodiscard]] WhiteLevel found() const;

 private:
  [[nodiscard]] double white_of_floats() const;

  std::optional<double> given_;
  std::optional<double> stated_;
  std::size_t type_ = 0;
  float largest_ = 0;            ///< value whose white is not stated
  bool is_of_8_bits_ = true;     ///< all 16-bit values are multiples of 257
  std::vector<Remark> remarks_;  ///< of readers, one of each kind and subject
  std::vector<float> sample_;    ///< of floats
  std::size_t values_seen_ = 0;  ///< floats
};

/// Scales photographs of one rig in place; returns what there is to say. `given`, errors: see
/// WhiteLevelSearch.
std::vector<Remark> scale_to_white_level(std::span<Photograph* const> photographs,
                                         std::optional<double> given);

}  // namespace vantage
