#include "engine/sequence/view_track.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "engine/error.h"

namespace vantage {
namespace {

constexpr double kFarthestView = 16;  // baselines

template <typename T>
bool read_number(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

BaselinePosition ViewTrack::at(int frame) const {
  const auto next = std::ranges::upper_bound(keys, frame, {}, &Key::frame);
  if (next == keys.begin()) {
    return keys.front().position;
  }
  const Key& before = *std::prev(next);
  if (next == keys.end() || before.frame == frame) {
    return before.position;
  }
  const double share = static_cast<double>(frame - before.frame) / (next->frame - before.frame);
  return {before.position.x + share * (next->position.x - before.position.x),
          before.position.y + share * (next->position.y - before.position.y)};
}

void ViewTrack::validate() const {
  if (keys.empty()) {
    throw UsageError("view path is empty, expected keys like 0=0,48=1");
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (const double coordinate : {keys[i].position.x, keys[i].position.y}) {
      if (!(std::abs(coordinate) <= kFarthestView)) {
        throw UsageError(fmt::format("view is {}, expected numbers within ±{}",
                                     to_string(keys[i].position), kFarthestView));
      }
    }
    if (keys[i].frame < 0 || (i > 0 && keys[i].frame <= keys[i - 1].frame)) {
      throw UsageError(fmt::format(
          "view path has frame {} as key {}, expected frames from 0 that grow from key to key",
          keys[i].frame, i + 1));
    }
  }
}

ViewTrack parse_view_track(std::string_view text) {
  ViewTrack track;
  bool may_have_y = false;  // XS of the last key has just been read
  for (std::string_view rest = text;;) {
    const std::size_t end = rest.find(',');
    const std::string_view part = rest.substr(0, end);
    const std::size_t equals = part.find('=');
    bool is_read = false;
    if (equals != std::string_view::npos) {
      ViewTrack::Key key;
      is_read = read_number(part.substr(0, equals), key.frame) &&
                read_number(part.substr(equals + 1), key.position.x);
      track.keys.push_back(key);
      may_have_y = true;
    } else if (may_have_y) {
      is_read = read_number(part, track.keys.back().position.y);
      may_have_y = false;
    }
    if (!is_read) {
      throw UsageError(
          fmt::format("is '{}', expected keys FRAME=XS or FRAME=XS,YS like 0=0,48=1,96=0 (at '{}')",
                      text, part));
    }
    if (end == std::string_view::npos) {
      return track;
    }
    rest.remove_prefix(end + 1);
  }
}

std::string to_string(const ViewTrack& track) {
  std::vector<std::string> keys;
  for (const ViewTrack::Key& key : track.keys) {
    keys.push_back(fmt::format("{}={}", key.frame, to_string(key.position)));
  }
  return fmt::format("{}", fmt::join(keys, ","));
}

}  // namespace vantage
