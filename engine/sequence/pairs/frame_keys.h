#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace vantage {

/// What the names of one camera's files tell of their moments.
struct FrameKeys {
  std::vector<std::string> texts;  ///< of each file, all different; empty: they tell nothing
  std::vector<double> numbers;     ///< the same; empty: some are not one number
  bool are_times = false;  ///< the numbers are time stamps: 12 digits or more, or a fraction
};

/// Ways to read names, the most careful first. Numbers count by value, case and separators do not.
enum class NameReading { kWhole, kWithoutSide, kDifference };
inline constexpr std::array kNameReadings = {NameReading::kWhole, NameReading::kWithoutSide,
                                             NameReading::kDifference};

/// Keys of files by their names without extensions: all of them, or without words of a side (left,
/// R, imgL), or what not all of them have at the same place ("cam0_shot2_17": 17 where all are of
/// cam0 and shot2). Seconds with a fraction ("1403636579.763555584") are one number.
FrameKeys frame_keys(const std::vector<std::filesystem::path>& files, NameReading reading);

}  // namespace vantage
