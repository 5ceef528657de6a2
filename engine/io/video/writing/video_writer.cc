#include <fmt/format.h>

#include <new>
#include <string>
#include <utility>

#include "engine/error.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/video/libav_functions.h"
#include "engine/io/video/video_io.h"
#include "engine/io/video/writing/frame_conversion.h"
#include "engine/io/video/writing/video_encoder.h"
#include "engine/io/video/writing/video_muxer.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace vantage {
namespace {

void check_video_settings(const std::filesystem::path& path, int width, int height,
                          const VideoEncoding& encoding) {
  const std::string extension = fmt::format(".{}", traits_of(encoding.coding).extension);
  if (lower_case_extension(path) != extension) {
    throw UsageError(fmt::format("cannot write {}: expected a video name ending in {}",
                                 path.string(), extension));
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

AVRational time_unit_of(FrameRate rate) {
  return {static_cast<int>(rate.denominator), static_cast<int>(rate.numerator)};
}

}  // namespace

struct VideoWriter::State {
  int width;
  int height;
  AVRational time_unit;
  FrameConversion convert;  ///< until encoding has ended
  LibavCodec encoder;
  LibavPacket packet = make_libav_packet();
  VideoMuxer file;
  int frames_written = 0;

  State(const std::filesystem::path& path, int frame_width, int frame_height,
        const VideoEncoding& encoding)
      : width(frame_width),
        height(frame_height),
        time_unit(time_unit_of(encoding.rate)),
        convert(make_frame_conversion(encoding.coding, frame_width, frame_height,
                                      encoding.format.colours)),
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
  EncoderSetup setup(encoding, width, height);
  int result = 0;
  encoder = setup.open(result);
  if (result == AVERROR_ENCODER_NOT_FOUND) {
    file.fail(fmt::format("this FFmpeg was built without the encoder {}", setup.name()));
  }
  if (result < 0) {
    file.fail(fmt::format("no encoder {} for {}x{} pixels and {} frames per second ({})",
                          setup.name(), width, height, to_string(encoding.rate),
                          libav_message(result)));
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
  AVFrame& converted = state.convert(frame);
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
    state.convert = nullptr;
  }
}

void VideoWriter::rename(const std::filesystem::path& path) { state_->file.rename(path); }

void VideoWriter::finish() {
  end_encoding();
  State& state = *state_;
  state.file.finish(state.frames_written);
}

}  // namespace vantage
