#include "engine/sequence/pairs/frame_poses.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/text_lines.h"

namespace vantage {
namespace {

constexpr double kMaxDistance_s = 0.02;

/// The time that a file is named after; empty if it is named otherwise, such as 000012.png.
std::optional<double> time_of(const std::filesystem::path& file) {
  constexpr std::size_t kNanosecondDigits = 16;  // more than 11 days
  const std::string name = file.stem().string();
  const std::optional<double> number = finite_number(name);
  const bool has_digits_only = name.find_first_not_of("0123456789") == std::string::npos;
  if (!number || (has_digits_only && name.size() < kNanosecondDigits)) {
    return std::nullopt;
  }
  return has_digits_only ? *number * 1e-9 : *number;
}

}  // namespace

FramePoses::FramePoses(Trajectory trajectory, std::string file)
    : trajectory_(std::move(trajectory)), file_(std::move(file)) {}

std::optional<int> FramePoses::numbered(const FramePair& pair) const {
  return trajectory_.times_s.empty() || !time_of(pair.fetched[0].file)
             ? std::optional(static_cast<int>(trajectory_.poses.size()))
             : std::nullopt;
}

const CameraPose& FramePoses::of(const FramePair& pair) const {
  const std::vector<double>& times_s = trajectory_.times_s;
  const std::optional<double> time_s = time_of(pair.fetched[0].file);
  if (times_s.empty() || !time_s) {
    const auto number = static_cast<std::size_t>(counts_frames_ ? pair.frames[0] : pair.index);
    if (number >= trajectory_.poses.size()) {
      throw Error(fmt::format("{}: has {} poses, expected one for pair {} (counted from 0)", file_,
                              trajectory_.poses.size(), pair.index));
    }
    return trajectory_.poses[number];
  }
  const auto nearest =
      std::ranges::min_element(times_s, {}, [&](double time) { return std::abs(time - *time_s); });
  if (!(std::abs(*nearest - *time_s) <= kMaxDistance_s)) {
    throw Error(fmt::format("{}: the nearest pose to {} is {:.3f} s away, expected at most {} s",
                            file_, pair.fetched[0].file.filename().string(),
                            std::abs(*nearest - *time_s), kMaxDistance_s));
  }
  return trajectory_.poses[static_cast<std::size_t>(nearest - times_s.begin())];
}

}  // namespace vantage
