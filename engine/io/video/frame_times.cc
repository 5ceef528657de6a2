#include "engine/io/video/frame_times.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace vantage {

double FrameTimes::seconds(int frame) const {
  return static_cast<double>(times[static_cast<std::size_t>(frame)]) *
         static_cast<double>(unit_numerator) / static_cast<double>(unit_denominator);
}

FrameTimes FrameTimes::some(int first, int count, int step) const {
  assert(first >= 0 && count > 0 && first + (count - 1) * step < frame_count());
  FrameTimes chosen{{}, unit_numerator, unit_denominator, slowed_down(rate, step)};
  chosen.times.reserve(static_cast<std::size_t>(count) + 1);
  for (int i = 0; i <= count; ++i) {
    const int frame = std::min(first + i * step, frame_count());
    chosen.times.push_back(times[static_cast<std::size_t>(frame)]);
  }
  return chosen;
}

bool are_uneven(const std::vector<std::int64_t>& times, double unit_seconds, FrameRate rate) {
  constexpr double kMaxFramesOff = 0.25;
  const double frames_per_unit = unit_seconds * rate.per_second();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double frames = static_cast<double>(times[i] - times.front()) * frames_per_unit;
    if (std::abs(frames - static_cast<double>(i)) > kMaxFramesOff) {
      return true;
    }
  }
  return false;
}

}  // namespace vantage
