#include "apps/match/rectified_files.h"

#include <fmt/format.h>

#include <map>
#include <utility>
#include <variant>

#include "apps/process/outputs.h"
#include "engine/error.h"
#include "engine/io/images/photograph_io.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

std::string image_name(Side side, const FramePair& pair) {
  const fs::path& file = pair.fetched[index_of(side)].file;
  return file.empty() ? fmt::format("{:06}", pair.index) : file.stem().string();
}

}  // namespace

RectifiedFiles::RectifiedFiles(fs::path folder, const PairSource& pairs, const FramePair& first)
    : folder_(std::move(folder)),
      has_folders_(pairs.pair_count() > 1 ||
                   image_name(Side::kLeft, first) == image_name(Side::kRight, first)) {
  for (const Side side : {Side::kLeft, Side::kRight}) {
    first_[index_of(side)] = path(side, first);
  }
}

fs::path RectifiedFiles::path(Side side, const FramePair& pair) const {
  const fs::path folder =
      has_folders_ ? folder_ / (side == Side::kLeft ? "left" : "right") : folder_;
  return folder / image_name(side, pair);
}

void RectifiedFiles::check(const PairSource& pairs, FileChecks& files) const {
  for (const fs::path& first : first_) {
    if (pairs.pair_count() > 1) {
      files.add_made_folder(first.parent_path(), "--output");
      continue;
    }
    for (const char* extension : {".png", ".pfm"}) {
      files.add_made_file(first.string() + extension, "--output");
    }
  }
  std::map<fs::path, fs::path> without_extension;
  for (const fs::path& file : pairs.files()) {
    const auto [other, is_new] =
        without_extension.try_emplace(file.parent_path() / file.stem(), file);
    if (!is_new && other->second != file) {
      throw UsageError(
          fmt::format("{} and {} would get one name, expected names that differ in "
                      "more than the extension",
                      other->second.string(), file.string()));
    }
  }
}

void RectifiedFiles::write(Side side, const FramePair& pair) const {
  const fs::path name = path(side, pair);
  make_folder(name.parent_path());
  const Photograph& image = side == Side::kLeft ? pair.left : pair.right;
  const bool is_float = std::holds_alternative<Image<float>>(image.pixels);
  write_photograph(name.string() + (is_float ? ".pfm" : ".png"), image);
}

}  // namespace vantage::apps
