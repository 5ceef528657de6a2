#include "engine/io/video/image_sequence.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>
#include <limits>
#include <string_view>

#include "engine/error.h"
#include "engine/io/files/checksum.h"
#include "engine/io/files/file_bytes.h"
#include "engine/io/files/numbered_names.h"
#include "engine/io/files/remote_files.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxMissingPerFile = 100;
constexpr int kFramesAhead = 8;

/// Names of the regular files in `folder` ("" is the current one) that `wanted` accepts.
template <typename Wanted>
std::vector<fs::path> list_names(const fs::path& folder, const Wanted& wanted) {
  std::vector<fs::path> names;
  if (is_address(folder)) {
    std::ranges::copy_if(remote_files(folder).names(folder.string()), std::back_inserter(names),
                         wanted);
    std::sort(names.begin(), names.end(), comes_before_naturally);
    return names;
  }
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    std::error_code not_there;
    const fs::path name = entry->path().filename();
    if (wanted(name.string()) && entry->is_regular_file(not_there)) {
      names.push_back(name);
    }
  }
  if (error) {
    throw Error(fmt::format("cannot read the folder '{}': {}", folder.string(), error.message()));
  }
  std::sort(names.begin(), names.end(), comes_before_naturally);
  return names;
}

}  // namespace

bool ImageSequence::fetch(FetchedFrame& frame) {
  if (next_index_ >= count_) {
    return false;
  }
  // Only of frames that follow each other: those that are looked at singly may be the only ones.
  if (next_index_ > 0 && next_index_ == last_index_ + 1) {
    for (int ahead = 1; ahead <= kFramesAhead && next_index_ + ahead < count_; ++ahead) {
      read_ahead(path(next_index_ + ahead));
    }
  }
  last_index_ = next_index_;
  frame.file = path(next_index_++);
  frame.reading = reading_;
  frame.frames_missing = 0;
  frame.remarks.clear();
  return true;
}

void ImageSequence::skip_to(int index) {
  assert(index >= 0 && index <= count_);
  next_index_ = index;
}

std::optional<long long> ImageSequence::number_of(int index) const {
  return frame_number(path(index));
}

std::vector<fs::path> ImageSequence::files() const {
  std::vector<fs::path> files;
  for (int i = 0; i < count_; ++i) {
    files.push_back(path(i));
  }
  return files;
}

std::string ImageSequence::identity() const {
  FileIdentity files;
  for (int i = 0; i < count_; ++i) {
    files.add(identity_name(i), path(i));
  }
  return fmt::format("images {}: {}", name_, files.to_string());
}

std::unique_ptr<ImageSequence> open_image_folder(const std::string& folder) {
  std::vector<fs::path> names = list_names(folder, [](const std::string& name) {
    return !name.starts_with('.') && has_image_extension(name);
  });
  if (names.empty()) {
    throw Error(fmt::format("folder {} holds no image files", folder));
  }
  return std::make_unique<ListedImages>(folder, folder, std::move(names));
}

std::unique_ptr<ImageSequence> open_image_pattern(const std::string& spec) {
  const fs::path path = spec;
  NumberPattern pattern = parse_number_pattern(path.filename().string(), spec);
  std::optional<int> smallest;
  int largest = 0;
  std::int64_t present = 0;
  for (const fs::path& name : list_names(path.parent_path(), [&](const std::string& candidate) {
         return pattern.number_in(candidate).has_value();
       })) {
    const int number = *pattern.number_in(name.string());
    smallest = std::min(smallest.value_or(number), number);
    largest = std::max(largest, number);
    ++present;
  }
  if (!smallest) {
    throw Error(fmt::format("{}: no file matches", spec));
  }
  if (largest == std::numeric_limits<int>::max()) {
    throw Error(fmt::format("{}: number {} is too large", spec, largest));
  }
  // Each missing number is a missing frame, but time stamps have millions between them.
  if (std::int64_t{largest} - *smallest + 1 - present > kMaxMissingPerFile * present) {
    throw Error(
        fmt::format("{}: {} files have numbers from {} to {}, expected at most {} missing numbers "
                    "per file; '{}' reads the files in order, ignoring gaps",
                    spec, present, *smallest, largest, kMaxMissingPerFile,
                    (path.parent_path() / pattern.wildcard()).string()));
  }
  return std::make_unique<NumberedImages>(spec, path.parent_path(), std::move(pattern), *smallest,
                                          largest - *smallest + 1);
}

std::unique_ptr<ImageSequence> open_image_glob(const std::string& spec) {
  const fs::path path = spec;
  const std::string pattern = path.filename().string();
  // No escapes: a backslash is an ordinary character.
  std::vector<fs::path> names = list_names(path.parent_path(), [&](const std::string& name) {
    return ::fnmatch(pattern.c_str(), name.c_str(), FNM_PERIOD | FNM_NOESCAPE) == 0;
  });
  if (names.empty()) {
    throw Error(fmt::format("{}: no file matches", spec));
  }
  return std::make_unique<ListedImages>(spec, path.parent_path(), std::move(names));
}

bool has_image_extension(const fs::path& path) {
  constexpr std::array<std::string_view, 19> kExtensions = {
      ".png",  ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".ppm", ".pgm", ".pnm", ".pbm",
      ".webp", ".exr", ".pfm",  ".mpo", ".jps",  ".jp2", ".j2k", ".btf", ".tf8"};
  const std::string extension = lower_case_extension(path);
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

}  // namespace vantage
