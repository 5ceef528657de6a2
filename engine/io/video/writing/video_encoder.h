#pragma once

#include "engine/io/video/libav.h"
#include "engine/io/video/video_coding.h"
#include "engine/io/video/video_io.h"

struct AVCodec;
struct AVDictionary;

namespace vantage {

/// The encoder of a coding, not open yet, and its options.
class EncoderSetup {
 public:
  EncoderSetup(const VideoEncoding& encoding, int width, int height);
  EncoderSetup(const EncoderSetup&) = delete;
  EncoderSetup& operator=(const EncoderSetup&) = delete;
  ~EncoderSetup();

  /// FFmpeg's name of the encoder: "libx264".
  [[nodiscard]] const char* name() const { return name_; }
  /// Opens it and hands it over; empty where FFmpeg has none. `result` is FFmpeg's code.
  LibavCodec open(int& result);

 private:
  const char* name_;
  const AVCodec* codec_;
  LibavCodec encoder_;
  AVDictionary* options_ = nullptr;
};

}  // namespace vantage
