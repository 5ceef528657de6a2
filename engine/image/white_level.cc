#include "engine/image/white_level.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <type_traits>

#include "engine/error.h"
#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr int kMinBits = 8;
constexpr int kMaxBits = 14;
constexpr int kMinBitsOfScaled = 13;
constexpr unsigned kScaledFrom8Bits = 257;
constexpr float kMaxHighlight = 8;
constexpr double kHighlights = 0.995;
constexpr std::size_t kPixelsSampled = 1 << 16;

/// All values but alpha.
template <typename T, typename Take>
void for_each_colour(const Image<T>& image, const Take& take) {
  const int colours = std::min(image.channels(), 3);
  for (int y = 0; y < image.height(); ++y) {
    const T* pixel = image.row(y);
    for (int x = 0; x < image.width(); ++x, pixel += image.channels()) {
      for (int c = 0; c < colours; ++c) {
        take(pixel[c]);
      }
    }
  }
}

std::string bits_text(double white) {
  const int bits = std::ilogb(white + 1);
  return white >= 255 && white + 1 == std::ldexp(1.0, bits) ? fmt::format(" ({} bits)", bits) : "";
}

}  // namespace

double WhiteLevel::apply(Photograph& photograph) const {
  photograph.origin.white_level = kOfTypes[photograph.pixels.index()];
  if (!scales(photograph)) {
    return 0;
  }
  const double white = of_type[photograph.pixels.index()];
  return std::visit(
      [&]<typename T>(Image<T>& image) {
        const int values = image.width() * image.channels();
        const double largest = kOfTypes[photograph.pixels.index()];
        std::size_t clipped = 0;
        for (int y = 0; y < image.height(); ++y) {
          T* row = image.row(y);
          if constexpr (std::is_same_v<T, float>) {
            for (int i = 0; i < values; ++i) {
              const bool is_alpha = image.channels() == 4 && i % 4 == 3;
              row[i] = is_alpha ? row[i] : static_cast<T>(row[i] / white);
            }
          } else {
            for (int i = 0; i < values; ++i) {
              clipped += row[i] > white ? 1 : 0;
              row[i] = static_cast<T>(std::min(largest, row[i] * largest / white) + 0.5);
            }
          }
        }
        return static_cast<double>(clipped) / (static_cast<double>(values) * image.height());
      },
      photograph.pixels);
}

void WhiteLevelSearch::add(const Photograph& photograph) {
  const std::size_t type = photograph.pixels.index();
  const std::optional<double>& stated = photograph.origin.white_level;
  types_seen_[type] = true;
  if (stated) {
    stated_[type] = std::max(*stated, stated_[type].value_or(0));
  } else {
    has_values_[type] = type != 0;
    if (const auto* words = std::get_if<Image<std::uint16_t>>(&photograph.pixels)) {
      look_at(*words);
    } else if (const auto* floats = std::get_if<Image<float>>(&photograph.pixels)) {
      look_at(*floats);
    }
  }
}

void WhiteLevelSearch::look_at(const Image<std::uint16_t>& image) {
  for_each_colour(image, [&](unsigned value) {
    largest_ = std::max(largest_, value);
    divisor_ = divisor_ == 1 ? 1 : std::gcd(divisor_, value);
  });
}

void WhiteLevelSearch::look_at(const Image<float>& image) {
  const auto pixels =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.height());
  const std::size_t step = pixels / kPixelsSampled | 1U;  // odd: it does not fall into columns
  std::size_t next = 0;
  for_each_colour(image, [&](float value) {
    largest_float_ = std::max(largest_float_, value);
    if (next++ % step == 0) {
      sample_.push_back(value);
    }
  });
}

double WhiteLevelSearch::white_of_16_bits() const {
  const int bits = std::max(kMinBits, static_cast<int>(std::bit_width(largest_)));
  const bool is_scaled =
      divisor_ % kScaledFrom8Bits == 0 || (bits >= kMinBitsOfScaled && divisor_ >= 4);
  return bits > kMaxBits || is_scaled ? WhiteLevel::kOfTypes[1] : (1U << bits) - 1U;
}

double WhiteLevelSearch::white_of_floats() const {
  std::vector<float> sample = sample_;
  const float bright = percentile(sample, kHighlights);
  const float brightest = largest_float_ > kMaxHighlight * bright ? bright : largest_float_;
  const int exponent = std::ilogb(brightest);
  if (brightest >= 2) {
    return std::ldexp(1.0, exponent + 1) - 1;
  }
  return brightest > 0 && brightest < 1.0F / 16 ? std::ldexp(1.0, exponent + 1) : 1;
}

WhiteLevel WhiteLevelSearch::found() const {
  WhiteLevel level;
  if (given_) {
    for (std::size_t type = 0; type < 2; ++type) {
      if (types_seen_[type] && *given_ > WhiteLevel::kOfTypes[type]) {
        throw Error(
            fmt::format("`white-level` is {}, expected at most {}, the largest value of "
                        "{}-bit images",
                        *given_, WhiteLevel::kOfTypes[type], type == 0 ? 8 : 16));
      }
    }
    level.of_type.fill(*given_);
    return level;
  }
  for (std::size_t type = 0; type < 3; ++type) {
    if (stated_[type]) {
      level.of_type[type] = *stated_[type];
    } else if (has_values_[type]) {
      level.of_type[type] = type == 1 ? white_of_16_bits() : white_of_floats();
    }
    if (const double white = level.of_type[type]; white != WhiteLevel::kOfTypes[type]) {
      level.remark =
          Remark{stated_[type] ? Remark::Kind::kNote : Remark::Kind::kWarning, "white level",
                 fmt::format("white level: {}{}, {}", white, bits_text(white),
                             stated_[type] ? "as the files say" : "from the brightest pixels")};
    }
  }
  return level;
}

std::optional<Remark> scale_to_white_level(std::span<Photograph* const> photographs,
                                           std::optional<double> given) {
  WhiteLevelSearch search(given);
  for (const Photograph* const photograph : photographs) {
    search.add(*photograph);
  }
  const WhiteLevel level = search.found();
  for (Photograph* const photograph : photographs) {
    level.apply(*photograph);
  }
  return level.remark;
}

void validate_white_level(std::optional<double> white_level) {
  if (white_level && !(*white_level > 0 && std::isfinite(*white_level))) {
    throw UsageError(fmt::format("white-level is {}, expected a number above 0", *white_level));
  }
}

}  // namespace vantage
