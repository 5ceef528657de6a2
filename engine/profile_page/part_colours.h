#pragma once

#include <string>
#include <vector>

#include "engine/profiling/profile.h"

namespace vantage {

/// Which colour a part of the work has, everywhere on a page: of the style sheet's classes
/// "part-0" to "part-6" for those that take most time, "part-more" for all others.
class PartColours {
 public:
  explicit PartColours(const Profile& profile);

  [[nodiscard]] std::string class_of(const std::string& part) const;
  /// HTML: every part of the timeline and its colour, the others as one, then waiting.
  [[nodiscard]] std::string timeline_legend(const Profile& profile) const;

 private:
  std::vector<std::string> parts_;  ///< those that have a colour of their own
};

/// HTML: a field of the colour of `classes` and a name, which is plain text.
std::string colour_key(const std::string& classes, const std::string& name);

}  // namespace vantage
