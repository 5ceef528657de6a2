#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/image/photograph.h"
#include "engine/remark.h"

namespace vantage {

/// The stored value that is white, by type as in Photograph::pixels. Thread rule: pure.
struct WhiteLevel {
  static constexpr std::array<double, 3> kOfTypes = {255, 65535, 1};

  std::array<double, 3> of_type = kOfTypes;
  std::optional<Remark> remark = {};  ///< "white level: 4095 (12 bits), from the brightest pixels"

  [[nodiscard]] bool scales(const Photograph& photograph) const {
    const std::size_t type = photograph.pixels.index();
    return of_type[type] != kOfTypes[type];
  }
  /// Scales the values in place, so that white is the type's 255, 65535 or 1. Integers beyond are
  /// clipped; the result is their share, 0 to 1. Floats may stay above 1, and keep their alpha.
  double apply(Photograph& photograph) const;
};

/// Finds the white level of photographs of one rig: many files hold 10, 12 or 14 significant bits
/// in 16, or floats of another scale than 0 to 1. What a file states comes first. Otherwise white
/// is 2ⁿ − 1 with the bits n of the largest value of all 16-bit photographs, where that is 14 or
/// fewer: of more, photographs are merely dark. Values that are all multiples of 257, or of 4 and
/// more with 13 bits or more, were scaled to 16 bits before. Floats keep their scale if their
/// brightest pixels are in [1/16, 2): single highlights (above eight times the 99.5th percentile)
/// do not count; else white is 2ⁿ − 1 or 2⁻ⁿ. 8-bit photographs keep 255.
class WhiteLevelSearch {
 public:
  /// `given`: instead of all that, for photographs of any type.
  explicit WhiteLevelSearch(std::optional<double> given = {}) : given_(given) {}

  /// Looks at a photograph.
  void add(const Photograph& photograph);
  /// Whether more photographs of the rig could change the result.
  [[nodiscard]] bool guesses() const { return !given_ && (has_values_[1] || has_values_[2]); }
  /// Throws Error where `given` is above the largest value of a type of the photographs.
  [[nodiscard]] WhiteLevel found() const;

 private:
  void look_at(const Image<std::uint16_t>& image);
  void look_at(const Image<float>& image);
  [[nodiscard]] double white_of_16_bits() const;
  [[nodiscard]] double white_of_floats() const;

  std::optional<double> given_;
  std::array<std::optional<double>, 3> stated_;
  std::array<bool, 3> types_seen_ = {};
  std::array<bool, 3> has_values_ = {};  ///< of photographs whose white is not stated
  unsigned largest_ = 0;                 ///< 16-bit value
  unsigned divisor_ = 0;                 ///< greatest common one of all 16-bit values
  float largest_float_ = 0;
  std::vector<float> sample_;  ///< of floats
};

/// Scales photographs of one rig in place, and says so where the level is not that of the type.
/// `given`: see WhiteLevelSearch. Throws Error as that does.
std::optional<Remark> scale_to_white_level(std::span<Photograph* const> photographs,
                                           std::optional<double> given);

/// Throws UsageError unless it is empty or above 0 and finite.
void validate_white_level(std::optional<double> white_level);

}  // namespace vantage
