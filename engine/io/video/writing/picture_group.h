#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "engine/io/video/libav.h"

namespace vantage {

/// Consecutive frames of a video that are encoded by an encoder of their own, so that they can be
/// decoded alone: a closed group of pictures. Thread rule: one thread at a time; different groups
/// are independent.
class PictureGroup {
 public:
  /// `first`: the number of its first frame in the video.
  explicit PictureGroup(std::int64_t first) : first_(first) {}

  /// The next frame; it belongs to the group from now on.
  void add(LibavFrame frame);
  /// It has all its frames.
  void close() { is_closed_ = true; }

  [[nodiscard]] int frames() const { return frames_; }
  [[nodiscard]] int frames_waiting() const { return static_cast<int>(waiting_.size()); }
  [[nodiscard]] bool is_closed() const { return is_closed_; }
  [[nodiscard]] bool is_coded() const { return is_closed_ && std::ssize(packets_) == frames_; }
  /// Whether it has an encoder; to be asked when it is at rest.
  [[nodiscard]] bool is_open() const { return encoder_ != nullptr; }
  [[nodiscard]] bool has_work() const { return !is_coded() && (is_closed_ || !waiting_.empty()); }

  /// What encode() does, chosen when the group is at rest: a frame, or null: the next packet of
  /// those that the encoder still holds back.
  LibavFrame take_frame();
  /// Encodes it. add(), close() and the questions above may be called meanwhile, by threads that
  /// exclude each other; is_coded() may be false although it is. Throws Error, without a name.
  void encode(const AVFrame* frame, const std::function<LibavCodec()>& open);
  /// To be called after encode(), with those threads excluded.
  void note_packets();

  /// In decoding order; times in frames of the video, without dts.
  [[nodiscard]] const std::vector<LibavPacket>& packets() const { return packets_; }
  /// For another group, if it held nothing back.
  LibavCodec take_encoder() { return std::move(encoder_); }

 private:
  std::int64_t first_;
  int frames_ = 0;
  bool is_closed_ = false;
  std::deque<LibavFrame> waiting_;
  std::vector<LibavPacket> packets_;
  // Only encode() touches them.
  LibavCodec encoder_;
  bool is_draining_ = false;
  std::vector<LibavPacket> new_packets_;
};

}  // namespace vantage
