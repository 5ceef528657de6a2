#include <fmt/format.h>

#include <new>
#include <optional>
#include <utility>

#include "engine/error.h"
#include "engine/io/file_bytes.h"
#include "engine/io/libav_functions.h"
#include "engine/io/mp4_muxer.h"
#include "engine/io/photograph_to_frame.h"
#include "engine/io/video_io.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

void check_video_settings(const std::filesystem::path& path, int width, int height,
                          const VideoEncoding& encoding) {
  if (lower_case_extension(path) != ".mp4") {
    throw UsageError(
        fmt::format("cannot write {}: expected a video name ending in .mp4", path.string()));
  }
  constexpr int kMaxSide = 16384;
  if (width < 2 || height < 2 || width > kMaxSide || height > kMaxSide) {
    throw UsageError(fmt::format("cannot write {}: video of {}x{} pixels, expected 2..{} a side",
                                 path.string(), width, height, kMaxSide));
  }
  const FrameRate& rate = encoding.rate;
  const auto is_term = [](std::int64_t value) { return value >= 1 && value <= 1'000'000; };
  if (!is_term(rate.numerator) || !is_term(rate.denominator) || rate.per_second() > 1000) {
    throw UsageError(fmt::format("cannot write {}: {} frames per second, expected above 0 to 1000",
                                 path.string(), to_string(rate)));
  }
  if (encoding.crf < 0 || encoding.crf > 51) {
    throw UsageError(fmt::format("cannot write {}: rate factor is {}, expected 0 to 51",
                                 path.string(), encoding.crf));
  }
}

/// Options of x264. The preset: photographs of 1226×370 pixels at factor 18 take 23 ms a frame (Zen
/// 4, one thread) with "veryfast". "superfast" takes 14 ms and a tenth more bytes, "faster", "fast"
/// and "medium" take 35, 48 and 63 ms with no fewer bytes. No tuning: views are of any kind.
class EncoderOptions {
 public:
  explicit EncoderOptions(int crf) {
    av_dict_set(&options_, "preset", "veryfast", 0);
    av_dict_set_int(&options_, "crf", crf, 0);
    // One algorithm on every processor; headers that do not depend on the pictures, so that videos
    // can be concatenated.
    av_dict_set(&options_, "x264-params", "cpu-independent=1:stitchable=1", 0);
  }
  EncoderOptions(const EncoderOptions&) = delete;
  EncoderOptions& operator=(const EncoderOptions&) = delete;
  ~EncoderOptions() { av_dict_free(&options_); }
  AVDictionary** get() { return &options_; }

 private:
  AVDictionary* options_ = nullptr;
};

AVRational time_unit_of(FrameRate rate) {
  return {static_cast<int>(rate.denominator), static_cast<int>(rate.numerator)};
}

}  // namespace

struct VideoWriter::State {
  int width;
  int height;
  AVRational time_unit;
  std::optional<PhotographToFrame> conversion;  ///< until encoding has ended
  LibavCodec encoder;
  LibavPacket packet = make_libav_packet();
  Mp4Muxer file;
  int frames_written = 0;

  State(const std::filesystem::path& path, int frame_width, int frame_height,
        const VideoEncoding& encoding)
      : width(frame_width),
        height(frame_height),
        time_unit(time_unit_of(encoding.rate)),
        conversion(std::in_place, frame_width, frame_height),
        file(path) {
    open_encoder(encoding);
    AVCodecParameters* parameters = libav().avcodec_parameters_alloc();
    if (parameters == nullptr ||
        libav().avcodec_parameters_from_context(parameters, encoder.get()) < 0) {
      libav().avcodec_parameters_free(&parameters);
      throw std::bad_alloc();
    }
    file.add_stream(*parameters, time_unit);
    libav().avcodec_parameters_free(&parameters);
    file.begin();
  }

  void open_encoder(const VideoEncoding& encoding);
  /// Encodes a frame, or the delayed ones when it is null, and stores the packets that are ready.
  void encode(const AVFrame* frame);
};

void VideoWriter::State::open_encoder(const VideoEncoding& encoding) {
  const AVCodec* codec = libav().avcodec_find_encoder_by_name("libx264");
  if (codec == nullptr) {
    file.fail("FFmpeg was built without the H.264 encoder libx264");
  }
  encoder.reset(libav().avcodec_alloc_context3(codec));
  if (encoder == nullptr) {
    throw std::bad_alloc();
  }
  encoder->width = (width + 1) / 2 * 2;
  encoder->height = (height + 1) / 2 * 2;
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->color_range = AVCOL_RANGE_MPEG;
  encoder->colorspace = AVCOL_SPC_BT709;
  encoder->color_primaries = AVCOL_PRI_BT709;
  encoder->color_trc = AVCOL_TRC_BT709;
  encoder->chroma_sample_location = AVCHROMA_LOC_LEFT;
  encoder->time_base = time_unit;
  encoder->framerate = {time_unit.den, time_unit.num};
  encoder->thread_count = 1;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_CLOSED_GOP | AV_CODEC_FLAG_BITEXACT;
  EncoderOptions options(encoding.crf);
  if (const int result = libav().avcodec_open2(encoder.get(), codec, options.get()); result < 0) {
    file.fail(fmt::format("no H.264 encoder for {}x{} pixels and {} frames per second ({})", width,
                          height, to_string(encoding.rate), libav_message(result)));
  }
}

void VideoWriter::State::encode(const AVFrame* frame) {
  int result = libav().avcodec_send_frame(encoder.get(), frame);
  while (result >= 0) {
    result = libav().avcodec_receive_packet(encoder.get(), packet.get());
    if (result >= 0) {
      packet->duration = 1;
      file.write(*packet, 0, time_unit);
    }
  }
  if (result != AVERROR(EAGAIN) && result != AVERROR_EOF) {
    file.fail(
        fmt::format("frame {} cannot be encoded ({})", frames_written, libav_message(result)));
  }
}

VideoWriter::VideoWriter(const std::filesystem::path& path, int width, int height,
                         const VideoEncoding& encoding) {
  check_video_settings(path, width, height, encoding);
  state_ = std::make_unique<State>(path, width, height, encoding);
}

VideoWriter::~VideoWriter() = default;

void VideoWriter::write(const Photograph& frame) {
  State& state = *state_;
  if (frame.width() != state.width || frame.height() != state.height) {
    state.file.fail(fmt::format("frame {} is {}x{}, expected {}x{}", state.frames_written,
                                frame.width(), frame.height(), state.width, state.height));
  }
  AVFrame& converted = state.conversion->convert(frame);
  converted.pts = state.frames_written;
  state.encode(&converted);
  ++state.frames_written;
}

void VideoWriter::end_encoding() {
  State& state = *state_;
  if (state.frames_written == 0) {
    state.file.fail("the video has no frames");
  }
  if (state.encoder) {
    state.encode(nullptr);
    state.encoder.reset();
    state.conversion.reset();
  }
}

void VideoWriter::finish() {
  end_encoding();
  State& state = *state_;
  state.file.finish(state.frames_written);
}

}  // namespace vantage
