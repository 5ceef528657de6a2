#include "engine/sequence/pairs/masked_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "engine/error.h"
#include "engine/image/black_border.h"

namespace vantage {
namespace {

// Scenes darken and brighten within seconds; a decoder goes so far without an effort.
constexpr int kPairsLookedAt = 5;
constexpr int kPairsApart = 48;

}  // namespace

MaskedPairs::MaskedPairs(std::unique_ptr<PairSource> source, SceneMaskOptions options,
                         bool each_alone)
    : source_(std::move(source)),
      options_(std::move(options)),
      needs_borders_(options_.finds_borders() && !each_alone),
      each_alone_(each_alone) {
  for (const std::size_t i : {0, 1}) {
    if (options_.file(i).empty()) {
      continue;
    }
    masks_[i] = open_frame_source(options_.file(i));
    const int count = masks_[i]->frame_count();
    if (count != 1 && count < source_->input_frames() && !source_->is_stream()) {
      throw Error(fmt::format("{} has {} masks, expected one, or one for each of {} pairs",
                              options_.file(i), count, source_->input_frames()));
    }
  }
}

/// Only of what can be fetched again.
void MaskedPairs::find_borders() {
  needs_borders_ = false;
  std::array<BrightestLevels, 2> levels;
  FramePair pair;
  const int count = source_->is_stream() ? 1 : source_->pair_count();
  for (int i = 0; i < kPairsLookedAt && i * kPairsApart < count; ++i) {
    try {
      source_->skip_to(source_->is_stream() ? next_index_ : i * kPairsApart);
      if (!source_->fetch(pair)) {
        break;
      }
      source_->decode(pair);
      levels[0].add(pair.left);
      levels[1].add(pair.right);
      if (!may_have_black_border(pair.left) && !may_have_black_border(pair.right)) {
        break;
      }
    } catch (const Error&) {
      continue;  // the run itself reports bad frames
    }
  }
  if (!levels[0].levels().empty() && !levels[1].levels().empty()) {
    borders_ = black_borders(levels[0].levels(), levels[1].levels());
  }
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
    if (masks_[i] != nullptr) {
      masks_[i]->skip_to(masks_[i]->frame_count() == 1 ? 0 : pair.index);
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
  std::array<const Photograph*, 2> files = {};
  for (const std::size_t i : {0, 1}) {
    if (masks_[i] != nullptr) {
      pair.masks[i].decode();
      files[i] = &pair.masks[i].photograph;
    }
  }
  leave_out_of_pair(options_, files, each_alone_ ? nullptr : &borders_, pair.left, pair.right);
}

std::vector<std::filesystem::path> MaskedPairs::files() const {
  std::vector<std::filesystem::path> files = source_->files();
  for (const auto& mask : masks_) {
    if (mask != nullptr) {
      const std::vector<std::filesystem::path> more = mask->files();
      files.insert(files.end(), more.begin(), more.end());
    }
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
