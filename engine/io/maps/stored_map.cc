#include "engine/io/maps/stored_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/order_statistics.h"

namespace vantage {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
/// Values per pixel of StereoBM and StereoSGBM.
constexpr double kMatcherScale = 16;
constexpr float kWrap = 65536;
constexpr float kFirstWrapped = 32768;
/// Between positive and wrapped values: an eighth of the range of signed values is far from both.
constexpr float kMinWrapGap = 16384;

template <typename Function>
void for_each_value(Image<float>& image, const Function& function) {
  for (int y = 0; y < image.height(); ++y) {
    std::for_each(image.row(y), image.row(y) + image.width(), function);
  }
}

/// Whether the upper half of unsigned 16-bit values are negative numbers.
bool has_wrapped(StoredMap& stored, double scale) {
  float below = 0;
  float least = kWrap;
  float most = 0;
  for_each_value(stored.values, [&](float value) {
    if (value < kFirstWrapped) {
      below = std::max(below, value);
    } else {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  });
  const double width = stored.values.width();
  const bool can_be_negative = most > 0 && (kWrap - least) / scale < width;
  return can_be_negative &&
         (most / scale >= width || (scale == kMatcherScale && least - below >= kMinWrapGap));
}

/// The value of OpenCV's matchers for pixels without a disparity, if the values have one.
std::optional<float> unmatched_value(StoredMap& stored, double scale) {
  float least = std::numeric_limits<float>::infinity();
  for_each_value(stored.values, [&](float value) { least = std::min(least, value); });
  const auto is_whole = [&](float value) { return std::fmod(value, scale) == 0; };
  bool is_alone = true;
  bool all_whole = true;
  for_each_value(stored.values, [&](float value) {
    is_alone = is_alone && (value == least || value >= least + scale);
    all_whole = all_whole && is_whole(value);
  });
  const bool stands_out =
      least == -scale || (scale == kMatcherScale && is_whole(least) && !all_whole);
  return is_alone && stands_out ? std::optional(least) : std::nullopt;
}

/// Replaces the values of integers that are unknown by NaN.
void mark_unknown(StoredMap& stored, double scale, const std::string& file,
                  std::vector<Remark>* remarks) {
  std::string found;
  if (stored.integer_bits == 16 && !stored.is_signed && scale != stored.default_scale &&
      has_wrapped(stored, scale)) {
    for_each_value(stored.values, [](float& v) { v -= v >= kFirstWrapped ? kWrap : 0; });
    stored.is_signed = true;
    found = "values from 32768 on are taken as negative 16-bit numbers; ";
  }
  const std::optional<float> unmatched =
      stored.integer_bits > 8 ? unmatched_value(stored, scale) : std::nullopt;
  bool has_negative = false;
  std::size_t count = 0;
  for_each_value(stored.values, [&](float value) {
    has_negative = has_negative || value < 0;
    count += value == unmatched ? 1 : 0;
  });
  for_each_value(stored.values, [&](float& value) {
    value = value == unmatched || (value == 0 && !has_negative) ? kUnknown : value;
  });
  if (unmatched && *unmatched != 0) {
    found += fmt::format(
        "{:g} (minDisparity - 1 of OpenCV's matchers, {:g} px) is taken as unknown, "
        "{:.1f} % of the pixels; ",
        *unmatched, *unmatched / scale,
        100.0 * static_cast<double>(count) / stored.values.width() / stored.values.height());
  }
  if (remarks != nullptr && !found.empty()) {
    found.resize(found.size() - 2);
    remarks->push_back({Remark::Kind::kNote, "map", fmt::format("{}: {}", file, found)});
  }
}

}  // namespace

Image<float> disparities_of(StoredMap&& stored, double scale, const std::string& file,
                            std::vector<Remark>* remarks) {
  if (stored.integer_bits == 0) {
    if (remarks != nullptr && scale != 0 && scale != 1) {
      remarks->push_back({Remark::Kind::kNote, "map",
                          fmt::format("{}: holds floats, which are pixels: they are not divided by "
                                      "`disparity-scale`",
                                      file)});
    }
    return with_nan(stored.values.view());
  }
  if (scale == 0 && stored.default_scale == 0) {
    throw Error(fmt::format(
        "{}: holds integers{}, expected a scale to divide them by (`scale`, `disparity-scale`; "
        "{}256 for 16-bit PNG)",
        file, stored.is_signed ? " with a sign" : "",
        stored.integer_bits > 8 ? "16 for maps of OpenCV's matchers, " : ""));
  }
  const double divisor = scale > 0 ? scale : stored.default_scale;
  mark_unknown(stored, divisor, file, remarks);
  for_each_value(stored.values, [&](float& value) {
    value = static_cast<float>(static_cast<double>(value) / divisor);
  });
  return std::move(stored.values);
}

Image<float> depths_of(StoredMap&& stored, double scale, const std::string& file,
                       std::vector<Remark>* remarks) {
  const bool is_float = stored.integer_bits == 0;
  const double divisor = scale > 0 ? scale : is_float ? 1 : 1000;
  for_each_value(stored.values, [&](float& value) {
    value = std::isfinite(value) && value > 0
                ? static_cast<float>(static_cast<double>(value) / divisor)
                : kUnknown;
  });
  std::vector<float> known = finite_values(stored.values.view());
  if (remarks != nullptr) {
    const std::string unit = scale > 0  ? fmt::format("{:g} per metre", scale)
                             : is_float ? "floats, taken as metres"
                                        : "integers, taken as millimetres";
    remarks->push_back(
        {Remark::Kind::kNote, "depth",
         known.empty()
             ? fmt::format("{}: no pixel has a depth", file)
             : fmt::format("{}: depths are {}: median {:.4g} m{}", file, unit, upper_median(known),
                           scale > 0 ? "" : "; `depth-scale` sets values per metre")});
  }
  return std::move(stored.values);
}

}  // namespace vantage
