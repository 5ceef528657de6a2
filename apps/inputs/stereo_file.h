#pragma once

#include <string>

namespace vantage::apps {

/// Where one file of a stereo camera (MPO, JPS) stands for a pair, `right` being empty, names its
/// views FILE#0 and FILE#1. Throws UsageError where the right image is missing.
void name_views(std::string& left, std::string& right);

}  // namespace vantage::apps
