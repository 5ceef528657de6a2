#include "engine/image/white_level.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "engine/error.h"
#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr int kMinBits = 8;
constexpr int kMaxBits = 14;
constexpr unsigned kScaledFrom8Bits = 257;
constexpr float kMaxHighlight = 8;
constexpr double kHighlights = 0.995;
constexpr std::size_t kFloatsPerSample = 61;  // prime: it does not fall into columns

/// 2ⁿ − 1 with the bits n of `value`.
double largest_of_bits(double value) { return std::ldexp(1.0, std::ilogb(value) + 1) - 1; }

}  // namespace

double WhiteLevel::apply(Photograph& photograph) const {
  if (!scales(photograph)) {
    return 0;
  }
  photograph.origin.white_level = kOfTypes[type];
  return std::visit(
      [&]<typename T>(Image<T>& image) {
        const int values = image.width() * image.channels();
        std::size_t clipped = 0;
        for (int y = 0; y < image.height(); ++y) {
          T* row = image.row(y);
          for (int i = 0; i < values; ++i) {
            if constexpr (std::is_same_v<T, float>) {
              const bool is_alpha = image.channels() == 4 && i % 4 == 3;
              row[i] = is_alpha ? row[i] : static_cast<T>(row[i] / value);
            } else {
              clipped += row[i] > value ? 1 : 0;
              const double scaled = row[i] * kOfTypes[type] / value;
              row[i] = static_cast<T>(std::min(scaled, kOfTypes[type]) + 0.5);
            }
          }
        }
        return static_cast<double>(clipped) / (static_cast<double>(values) * image.height());
      },
      photograph.pixels);
}

void WhiteLevelSearch::add(const Photograph& photograph) {
  for (const Remark& remark : photograph.origin.remarks) {
    if (std::none_of(remarks_.begin(), remarks_.end(), [&](const Remark& other) {
          return other.kind == remark.kind && other.subject == remark.subject;
        })) {
      remarks_.push_back(remark);
    }
  }
  const std::size_t type = photograph.pixels.index();
  if (type > type_) {
    std::vector<Remark> remarks = std::move(remarks_);
    *this = WhiteLevelSearch(given_);
    remarks_ = std::move(remarks);
    type_ = type;
  }
  if (type < type_ || type == 0 || given_) {
    return;
  }
  if (const std::optional<double>& white = photograph.origin.white_level) {
    stated_ = std::max(*white, stated_.value_or(0));
  }
  std::visit(
      [&]<typename T>(const Image<T>& image) {
        const int channels = image.channels();
        for (int y = 0; y < image.height(); ++y) {
          for (int i = 0; i < image.width() * channels; ++i) {
            const T value = image.row(y)[i];
            if (channels == 4 && i % 4 == 3) {
              continue;  // alpha
            }
            largest_ = std::max(largest_, static_cast<float>(value));
            if constexpr (std::is_integral_v<T>) {
              is_of_8_bits_ = is_of_8_bits_ && value % kScaledFrom8Bits == 0;
            } else if (values_seen_++ % kFloatsPerSample == 0) {
              sample_.push_back(value);
            }
          }
        }
      },
      photograph.pixels);
}

double WhiteLevelSearch::white_of_floats() const {
  std::vector<float> sample = sample_;
  const float bright = percentile(sample, kHighlights);
  const float brightest = largest_ > kMaxHighlight * bright ? bright : largest_;
  if (brightest >= 2) {
    return largest_of_bits(brightest);
  }
  return brightest > 0 && brightest < 1.0F / 16 ? brightest : 1;
}

WhiteLevel WhiteLevelSearch::found() const {
  WhiteLevel level{type_, WhiteLevel::kOfTypes[type_], remarks_};
  if (given_) {
    const double max = type_ < 2 ? level.value : std::numeric_limits<float>::max();
    if (!(*given_ > 0 && *given_ <= max)) {
      throw UsageError(
          fmt::format("`white-level` is {}, expected above 0 and at most {:g}, the "
                      "largest value of the images",
                      *given_, max));
    }
    level.value = *given_;
    return level;
  }
  const bool is_stated = stated_ && *stated_ >= largest_;
  if (is_stated) {
    level.value = *stated_;
  } else if (type_ == 1 && largest_ < (1 << kMaxBits) && !is_of_8_bits_) {
    level.value = largest_of_bits(std::max(largest_, static_cast<float>(1 << (kMinBits - 1))));
  } else if (type_ == 2) {
    level.value = white_of_floats();
  }
  if (level.value != WhiteLevel::kOfTypes[type_]) {
    const int bits = std::ilogb(level.value + 1);
    const bool has_bits = bits >= kMinBits && level.value + 1 == std::ldexp(1.0, bits);
    level.remarks.push_back(
        {is_stated ? Remark::Kind::kNote : Remark::Kind::kWarning, "white level",
         fmt::format("white level: {:g}{}, {}", level.value,
                     has_bits ? fmt::format(" ({} bits)", bits) : "",
                     is_stated ? "as the files say" : "from the brightest pixels")});
  }
  return level;
}

std::vector<Remark> scale_to_white_level(std::span<Photograph* const> photographs,
                                         std::optional<double> given) {
  WhiteLevelSearch search(given);
  for (const Photograph* const photograph : photographs) {
    search.add(*photograph);
  }
  WhiteLevel level = search.found();
  for (Photograph* const photograph : photographs) {
    level.apply(*photograph);
  }
  return std::move(level.remarks);
}

}  // namespace vantage
