#include "engine/view_geometry/view_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <variant>

#include "engine/error.h"
#include "engine/quoted_text.h"

namespace vantage {
namespace {

template <typename T>
bool read_number(std::string_view text, T& number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

ViewPose ViewPath::at(int frame) const {
  const auto next = std::ranges::upper_bound(keys, frame, {}, &Key::frame);
  if (next == keys.begin()) {
    return keys.front().pose;
  }
  const Key& before = *std::prev(next);
  if (next == keys.end() || before.frame == frame) {
    return before.pose;
  }
  return pose_between(before.pose, next->pose,
                      static_cast<double>(frame - before.frame) / (next->frame - before.frame));
}

void ViewPath::validate() const {
  if (keys.empty()) {
    throw UsageError("view path is empty, expected at least one pose");
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].frame < 0 || (i > 0 && keys[i].frame <= keys[i - 1].frame)) {
      throw UsageError(fmt::format(
          "view path has frame {} as key {}, expected frames from 0 that grow from key to key",
          keys[i].frame, i + 1));
    }
    require_alike(keys.front().pose, keys[i].pose);
  }
}

ViewPath parse_view_path(std::string_view text) {
  ViewPath path;
  bool may_have_y = false;  // the XS of the last key was just parsed
  for (std::string_view rest = text;;) {
    const std::size_t end = rest.find(',');
    const std::string_view part = rest.substr(0, end);
    const std::size_t equals = part.find('=');
    bool is_read = false;
    if (equals != std::string_view::npos) {
      int frame = 0;
      BaselinePosition position;
      is_read = read_number(part.substr(0, equals), frame) &&
                read_number(part.substr(equals + 1), position.x);
      path.keys.push_back({frame, position});
      may_have_y = true;
    } else if (may_have_y) {
      is_read = read_number(part, std::get<BaselinePosition>(path.keys.back().pose).y);
      may_have_y = false;
    }
    if (!is_read) {
      throw UsageError(
          fmt::format("is '{}', expected keys FRAME=XS or FRAME=XS,YS like 0=0,48=1,96=0 (at '{}')",
                      quotable(text), quotable(part)));
    }
    if (end == std::string_view::npos) {
      return path;
    }
    rest.remove_prefix(end + 1);
  }
}

std::string to_string(const ViewPath& path) {
  std::vector<std::string> keys;
  for (const ViewPath::Key& key : path.keys) {
    keys.push_back(
        fmt::format("{}={}", key.frame, to_string(std::get<BaselinePosition>(key.pose))));
  }
  return fmt::format("{}", fmt::join(keys, ","));
}

}  // namespace vantage
