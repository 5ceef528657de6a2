#include "engine/profile_page/part_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "engine/io/markup_text.h"

namespace vantage {
namespace {

constexpr std::size_t kPartColours = 7;

/// Parts of the timeline, most time first.
std::vector<std::string> parts_of(const std::vector<TimelineRow>& timeline) {
  std::map<std::string, double> seconds;
  for (const TimelineRow& row : timeline) {
    for (const TimelineSpan& span : row.spans) {
      if (!span.is_wait) {
        seconds[span.name] += span.end_s - span.begin_s;
      }
    }
  }
  std::vector<std::pair<std::string, double>> sorted(seconds.begin(), seconds.end());
  std::ranges::stable_sort(sorted, std::ranges::greater{}, &std::pair<std::string, double>::second);
  std::vector<std::string> names;
  for (const auto& [name, total_s] : sorted) {
    names.push_back(name);
  }
  return names;
}

}  // namespace

PartColours::PartColours(const Profile& profile) {
  // What is seen in the timeline needs colours most.
  std::vector<std::string> names = parts_of(profile.timeline);
  if (!profile.thread_counts.empty()) {
    for (const PartProfile& part : profile.thread_counts.back().parts) {
      names.push_back(part.name);
    }
  }
  for (const std::string& name : names) {
    if (parts_.size() < kPartColours && std::ranges::find(parts_, name) == parts_.end()) {
      parts_.push_back(name);
    }
  }
}

std::string PartColours::class_of(const std::string& part) const {
  const auto found = std::ranges::find(parts_, part);
  return found == parts_.end() ? "part-more" : fmt::format("part-{}", found - parts_.begin());
}

std::string PartColours::timeline_legend(const Profile& profile) const {
  std::string result = "<p class=\"legend\">";
  bool has_more = false;
  for (const std::string& name : parts_of(profile.timeline)) {
    const std::string classes = class_of(name);
    if (classes == "part-more") {
      has_more = true;
    } else {
      result += colour_key(classes, name);
    }
  }
  if (has_more) {
    result += colour_key("part-more", "other work");
  }
  return result + colour_key("wait", "waiting") + "</p>\n";
}

std::string colour_key(const std::string& classes, const std::string& name) {
  return fmt::format("<span class=\"key\"><span class=\"field {}\"></span>{}</span> ", classes,
                     escaped_markup(name));
}

}  // namespace vantage
