#include "engine/io/maps/stored_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

template <typename Function>
void for_each_value(Image<float>& image, const Function& function) {
  for (int y = 0; y < image.height(); ++y) {
    std::for_each(image.row(y), image.row(y) + image.width(), function);
  }
}

/// Whether the upper half of unsigned 16-bit values (sorted) are negative numbers.
bool has_wrapped(const std::vector<float>& sorted, double scale, double width) {
  const auto least = std::ranges::lower_bound(sorted, kFirstWrapped);
  if (least == sorted.end() || (kWrap - *least) / scale >= width) {
    return false;
  }
  return scale == kMatcherScale || sorted.back() / scale >= width;
}

/// Whether the least of sorted values is what OpenCV's matchers write without a match.
bool begins_unmatched(const std::vector<float>& sorted, double scale) {
  const auto is_whole = [&](float value) { return std::fmod(value, scale) == 0; };
  const auto next = std::ranges::upper_bound(sorted, sorted[0]);
  return (next == sorted.end() || *next >= sorted[0] + scale) &&
         (sorted[0] == -scale || (scale == kMatcherScale && is_whole(sorted[0]) &&
                                  !std::all_of(next, sorted.end(), is_whole)));
}

/// Replaces integers that are unknown by NaN, wrapped ones by what they were. Returns what was
/// assumed, or nothing.
std::string mark_unknown(StoredMap& stored, double scale) {
  std::string assumed;
  float unmatched = 0;
  bool has_negative = false;
  // Not for maps of a format that says how to read them.
  std::vector<float> sorted;
  if ((stored.integer_bits > 8 || stored.is_signed) && scale != stored.default_scale) {
    sorted = finite_values(stored.values.view());
    std::ranges::sort(sorted);
  }
  if (!sorted.empty()) {
    if (stored.integer_bits == 16 && !stored.is_signed &&
        has_wrapped(sorted, scale, stored.values.width())) {
      const auto unwrap = [](float& v) { v -= v >= kFirstWrapped ? kWrap : 0; };
      for_each_value(stored.values, unwrap);
      std::ranges::for_each(sorted, unwrap);
      std::ranges::sort(sorted);
      assumed = "values from 32768 on are taken as negative 16-bit numbers; ";
    }
    has_negative = sorted[0] < 0;
    if (sorted[0] != 0 && begins_unmatched(sorted, scale)) {
      unmatched = sorted[0];
      const auto count = std::ranges::upper_bound(sorted, unmatched) - sorted.begin();
      assumed += fmt::format(
          "{:g} (minDisparity - 1 of OpenCV's matchers, {:g} px) is taken as unknown, "
          "{:.1f} % of the pixels; ",
          unmatched, unmatched / scale,
          100 * static_cast<double>(count) / static_cast<double>(sorted.size()));
    }
  }
  for_each_value(stored.values, [&](float& value) {
    if ((value == 0 && !has_negative) || (value == unmatched && unmatched != 0)) {
      value = kUnknown;
    }
  });
  return assumed.substr(0, assumed.size() - std::min<std::size_t>(assumed.size(), 2));
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
  const std::string assumed = mark_unknown(stored, divisor);
  if (remarks != nullptr && !assumed.empty()) {
    remarks->push_back({Remark::Kind::kNote, "map", fmt::format("{}: {}", file, assumed)});
  }
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
