#include "apps/inputs/stereo_file.h"

#include <fmt/format.h>

#include "engine/error.h"
#include "engine/io/images/stereo_jpeg.h"

namespace vantage::apps {

void name_views(std::string& left, std::string& right) {
  if (!right.empty()) {
    return;
  }
  if (!is_stereo_jpeg(left)) {
    throw UsageError(
        fmt::format("RIGHT is missing, expected it unless LEFT holds both views (MPO, JPS); '{}' "
                    "does not",
                    left));
  }
  right = left + "#1";
  left += "#0";
}

}  // namespace vantage::apps
