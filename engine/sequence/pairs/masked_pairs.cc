#include "engine/sequence/pairs/masked_pairs.h"

#include <fmt/format.h>

#include <cstddef>
#include <utility>

#include "engine/error.h"
#include "engine/io/images/black_border.h"

namespace vantage {
namespace {

// Scenes darken and brighten within seconds; a decoder goes so far without an effort.
constexpr int kPairsLookedAt = 5;
constexpr int kPairsApart = 48;

}  // namespace

MaskedPairs::MaskedPairs(std::unique_ptr<PairSource> source, SceneMaskOptions options,
                         bool each_alone)
    : ForwardedPairs(std::move(source)),
      options_(std::move(options)),
      needs_borders_(options_.finds_borders() && !each_alone),
      each_alone_(each_alone) {
  for (const std::size_t i : {0, 1}) {
    const std::string file = options_.files()[i];
    if (file.empty()) {
      continue;
    }
    masks_[i] = open_frame_source(file);
    const int count = masks_[i]->frame_count();
    if (count != 1 && count < source_->input_frames() && !source_->is_stream()) {
      throw Error(fmt::format("{} has {} masks, expected one, or one for each of {} pairs", file,
                              count, source_->input_frames()));
    }
  }
}

void MaskedPairs::skip_to(int index) {
  next_index_ = index;
  source_->skip_to(index);
}

/// Of a stream only in its first pair.
void MaskedPairs::find_borders() {
  needs_borders_ = false;
  std::array<Image<std::uint8_t>, 2> brightest;
  FramePair pair;
  const int count = source_->is_stream() ? 1 : source_->pair_count();
  for (int i = 0; i < kPairsLookedAt && i * kPairsApart < count; ++i) {
    try {
      source_->skip_to(source_->is_stream() ? next_index_ : i * kPairsApart);
      if (source_->fetch(pair)) {
        source_->decode(pair);
        take_brightest(pair.left, brightest[0]);
        take_brightest(pair.right, brightest[1]);
      }
    } catch (const Error&) {
      continue;  // the run itself reports bad frames
    }
  }
  borders_ = {black_border(brightest[0]), black_border(brightest[1])};
  source_->skip_to(next_index_);
}

bool MaskedPairs::fetch(FramePair& pair) {
  if (needs_borders_) {
    find_borders();
  }
  ++next_index_;
  if (!source_->fetch(pair)) {
    return false;
  }
  for (const std::size_t i : {0, 1}) {
    pair.frames[i] = source_->frame_of(i, pair.index);
    if (masks_[i] != nullptr) {
      const int count = masks_[i]->frame_count();
      const bool is_of_frame = source_->pairing().counts_frames(i, count, source_->input_frames());
      masks_[i]->skip_to(count == 1 ? 0 : is_of_frame ? pair.frames[i] : pair.index);
      masks_[i]->fetch(pair.masks[i]);
    }
  }
  return true;
}

void MaskedPairs::make_images(FramePair& pair) const {
  source_->decode(pair);
  if (!pair.wants_right) {
    return;  // only its shot is looked for
  }
  std::array<Mask, 2> masks;
  for (const std::size_t i : {0, 1}) {
    if (masks_[i] != nullptr) {
      pair.masks[i].decode();
      masks[i] = black_pixels(pair.masks[i].photograph);
    } else if (each_alone_ && options_.finds_borders()) {
      masks[i] = black_border(i == 0 ? pair.left : pair.right);
    } else {
      masks[i] = borders_[i].copy();
    }
  }
  leave_out_of_pair(options_, std::move(masks), pair.left, pair.right);
}

std::vector<std::filesystem::path> MaskedPairs::files() const {
  std::vector<std::filesystem::path> files = source_->files();
  for (const auto& mask : masks_) {
    const auto more = mask != nullptr ? mask->files() : std::vector<std::filesystem::path>();
    files.insert(files.end(), more.begin(), more.end());
  }
  return files;
}

std::vector<std::string> MaskedPairs::identities() const {
  std::vector<std::string> identities = source_->identities();
  for (const auto& mask : masks_) {
    if (mask != nullptr) {
      identities.push_back(mask->identity());
    }
  }
  return identities;
}

}  // namespace vantage
