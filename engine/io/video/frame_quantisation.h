#pragma once

#include <string>

#include "engine/image/photograph_origin.h"

struct AVFrame;

namespace vantage {

/// FFmpeg's name of a codec (an AVCodecID) that loses detail as it is commonly used, "h264"; empty
/// for one that never does.
std::string lossy_codec_of(int codec);

/// How `lossy_codec` coded `frame`: the mean of the QP of its blocks where the decoder exports them
/// (AV_CODEC_EXPORT_DATA_VIDEO_ENC_PARAMS; FFmpeg 5.1: H.264, MPEG-1, -2 and -4, VP9). Thread rule:
/// pure.
LossyCoding coding_of_frame(const AVFrame& frame, const std::string& lossy_codec);

}  // namespace vantage
