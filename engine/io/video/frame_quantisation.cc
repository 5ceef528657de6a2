#include "engine/io/video/frame_quantisation.h"

#include <algorithm>
#include <cmath>

#include "engine/io/video/libav_functions.h"
#include "engine/io/video/libav_scaler.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libavutil/video_enc_params.h>
}

namespace vantage {
namespace {

/// Of the blocks, by their area.
double mean_qp(AVVideoEncParams& parameters) {
  double sum = 0;
  double area = 0;
  for (unsigned i = 0; i < parameters.nb_blocks; ++i) {
    const AVVideoBlockParams& block = *av_video_enc_params_block(&parameters, i);
    const double block_area = static_cast<double>(block.w) * block.h;
    sum += block_area * block.delta_qp;
    area += block_area;
  }
  return parameters.qp + (area > 0 ? sum / area : 0);
}

/// In units of the samples.
double step_of(AVVideoEncParamsType type, double qp) {
  switch (type) {
    case AV_VIDEO_ENC_PARAMS_H264:
      return std::exp2((qp - 4) / 6);
    case AV_VIDEO_ENC_PARAMS_MPEG2:
      return qp;  // of a weight of 16, which the lowest frequencies have
    case AV_VIDEO_ENC_PARAMS_VP9:
      // The standard's table to within 8 %; its transforms are 8 times orthonormal ones.
      return (qp <= 95 ? qp + 7 : 102 * std::exp(0.018 * (qp - 95))) / 8;
    default:
      return 0;
  }
}

}  // namespace

std::string lossy_codec_of(int codec) {
  const AVCodecDescriptor* descriptor =
      libav().avcodec_descriptor_get(static_cast<AVCodecID>(codec));
  const bool is_lossy = descriptor != nullptr && (descriptor->props & AV_CODEC_PROP_LOSSY) != 0;
  return is_lossy ? descriptor->name : "";
}

LossyCoding coding_of_frame(const AVFrame& frame, const std::string& lossy_codec) {
  LossyCoding coding{.codec = lossy_codec};
  const AVFrameSideData* exported = av_frame_get_side_data(&frame, AV_FRAME_DATA_VIDEO_ENC_PARAMS);
  if (exported == nullptr) {
    return coding;
  }
  auto& parameters = *reinterpret_cast<AVVideoEncParams*>(exported->data);
  const int extra_bits = describe_pixel_format(frame.format).comp[0].depth - 8;
  coding.step_grey_levels =
      std::max(0.0, std::ldexp(step_of(parameters.type, mean_qp(parameters)), -extra_bits));
  coding.block_px = parameters.type == AV_VIDEO_ENC_PARAMS_MPEG2 ? 8 : 4;
  return coding;
}

}  // namespace vantage
