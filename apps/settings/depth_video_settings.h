#pragma once

#include "engine/io/video/video_coding.h"
#include "engine/options/settings.h"
#include "engine/sequence/options/sequence_options.h"

namespace vantage::apps {

/// Binds the settings of the depth video: --depth-range and --depth-codec.
void add_depth_video_settings(Settings& settings, DepthVideoScale& scale, VideoCoding& coding);

}  // namespace vantage::apps
