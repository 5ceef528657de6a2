#include "engine/io/video/writing/picture_group.h"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "engine/error.h"
#include "engine/io/video/libav_functions.h"

namespace vantage {

void PictureGroup::add(LibavFrame frame) {
  frame->pts = frames_++;
  waiting_.push_back(std::move(frame));
}

LibavFrame PictureGroup::take_frame() {
  LibavFrame frame;
  if (!waiting_.empty()) {
    frame = std::move(waiting_.front());
    waiting_.pop_front();
  }
  return frame;
}

void PictureGroup::encode(const AVFrame* frame, const std::function<LibavCodec()>& open) {
  if (encoder_ == nullptr) {
    encoder_ = open();
  }
  int result = 0;
  if (frame != nullptr || !std::exchange(is_draining_, true)) {
    result = libav().avcodec_send_frame(encoder_.get(), frame);
  }
  while (result >= 0) {
    LibavPacket packet = make_libav_packet();
    result = libav().avcodec_receive_packet(encoder_.get(), packet.get());
    if (result >= 0) {
      packet->pts += first_;
      packet->duration = 1;
      new_packets_.push_back(std::move(packet));
      if (frame == nullptr) {
        return;  // the others are the work of the next calls
      }
    }
  }
  if (frame == nullptr || result != AVERROR(EAGAIN)) {
    throw Error(fmt::format("frame {} cannot be encoded ({})",
                            first_ + (frame == nullptr ? 0 : frame->pts), libav_message(result)));
  }
}

void PictureGroup::note_packets() {
  packets_.insert(packets_.end(), std::make_move_iterator(new_packets_.begin()),
                  std::make_move_iterator(new_packets_.end()));
  new_packets_.clear();
}

}  // namespace vantage
