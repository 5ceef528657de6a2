#pragma once

#include <string>

#include "engine/io/video/libav.h"

namespace vantage {

/// A chain of filters of libavfilter, such as "bwdif=mode=send_frame", for frames of one shape and
/// format. The library is opened with the first chain. Thread rule: one thread at a time.
class LibavFilter {
 public:
  /// For frames like `first`. Throws Error, without a name, when the library cannot be opened or
  /// does not know the chain.
  LibavFilter(const std::string& chain, const AVFrame& first);

  /// Another reference to the frame, as the next one; its times are ignored.
  void put(const AVFrame& frame);
  /// No frame follows.
  void end();
  /// The next filtered frame; null when another one is needed first, or after the last one.
  LibavFrame take();

 private:
  LibavFilterGraph graph_;
  AVFilterContext* source_ = nullptr;
  AVFilterContext* sink_ = nullptr;
  std::int64_t frames_put_ = 0;
};

}  // namespace vantage
