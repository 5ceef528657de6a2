#include "engine/sequence/steps/frame_pictures.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace vantage {
namespace {

template <typename T>
void copy_image(const Image<T>& image, Photograph& copy) {
  Image<T> pixels = take_image<T>(copy, {image.width(), image.height(), image.channels()});
  const auto row_values =
      static_cast<std::size_t>(image.width()) * static_cast<std::size_t>(image.channels());
  for (int y = 0; y < image.height(); ++y) {
    std::copy_n(image.row(y), row_values, pixels.row(y));
  }
  copy.pixels = std::move(pixels);
}

}  // namespace

const Photograph* stored_picture(const FrameSlot& slot, const OutputStream& stream) {
  switch (stream.output) {
    case SequenceOutput::kPreview:
      return &slot.preview;
    case SequenceOutput::kViews:
      return &slot.views[static_cast<std::size_t>(stream.view)].image;
    case SequenceOutput::kStereo:
      return &slot.stereo;
    case SequenceOutput::kDepthVideo:
      return &slot.depth;
    default:
      return nullptr;
  }
}

const Mask& mask_of(const FrameSlot& slot, const OutputStream& stream, Side reference) {
  switch (stream.output) {
    case SequenceOutput::kHoles:
      return slot.views[static_cast<std::size_t>(stream.view)].holes;
    case SequenceOutput::kSources:
      return slot.views[static_cast<std::size_t>(stream.view)].sources;
    case SequenceOutput::kCyclopeanOcclusion:
      return slot.cyclopean.seen_by;
    case SequenceOutput::kUnmatched:
      return slot.maps.of(reference).unmatched;
    default:
      return slot.maps.right.unmatched;
  }
}

void copy_picture(const FrameSlot& slot, const OutputStream& stream, Side reference,
                  Photograph& picture) {
  if (const Photograph* stored = stored_picture(slot, stream)) {
    std::visit([&](const auto& image) { copy_image(image, picture); }, stored->pixels);
  } else {
    copy_image(mask_of(slot, stream, reference), picture);
  }
}

}  // namespace vantage
