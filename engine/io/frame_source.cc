#include "engine/io/frame_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <limits>
#include <string_view>
#include <vector>

#include "engine/error.h"
#include "engine/io/file_bytes.h"
#include "engine/io/natural_order.h"
#include "engine/io/photograph_io.h"
#include "engine/io/video_io.h"
#include "engine/io/wildcard.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

bool has_image_extension(const fs::path& path) {
  constexpr std::array<std::string_view, 13> kExtensions = {
      ".png", ".jpg", ".jpeg", ".tif",  ".tiff", ".bmp", ".ppm",
      ".pgm", ".pnm", ".pbm",  ".webp", ".exr",  ".pfm"};
  const std::string extension = lower_case_extension(path);
  return std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// Image files, one a frame.
class ImageFiles : public FrameSource {
 public:
  bool next(Photograph& frame) final {
    if (next_index_ >= count()) {
      return false;
    }
    frame = read_photograph(path(next_index_++));
    return true;
  }
  [[nodiscard]] std::optional<int> frame_count() const final { return count(); }
  [[nodiscard]] std::string describe(int index) const final { return path(index).string(); }
  [[nodiscard]] std::optional<double> frames_per_second() const final { return std::nullopt; }

 private:
  [[nodiscard]] virtual int count() const = 0;
  [[nodiscard]] virtual fs::path path(int index) const = 0;

  int next_index_ = 0;
};

class ListedFiles : public ImageFiles {
 public:
  explicit ListedFiles(std::vector<fs::path> paths) : paths_(std::move(paths)) {}

 private:
  [[nodiscard]] int count() const override { return static_cast<int>(paths_.size()); }
  [[nodiscard]] fs::path path(int index) const override {
    return paths_.at(static_cast<std::size_t>(index));
  }

  std::vector<fs::path> paths_;
};

/// A file name with one number in it.
struct NumberPattern {
  std::string prefix;
  int digits = 0;  ///< at least, filled with zeros
  std::string suffix;

  [[nodiscard]] std::string name(int number) const {
    return fmt::format("{}{:0{}}{}", prefix, number, digits, suffix);
  }

  /// The number in `name`, if this pattern makes that name.
  [[nodiscard]] std::optional<int> number_in(const std::string& name) const {
    if (name.size() <= prefix.size() + suffix.size() || !name.starts_with(prefix) ||
        !name.ends_with(suffix)) {
      return std::nullopt;
    }
    int number = -1;
    const char* begin = name.data() + prefix.size();
    const char* end = name.data() + name.size() - suffix.size();
    const auto [stopped, error] = std::from_chars(begin, end, number);
    if (error != std::errc() || stopped != end || number < 0 || this->name(number) != name) {
      return std::nullopt;
    }
    return number;
  }
};

/// Takes "%06d" apart; "%%" is a percent sign.
NumberPattern parse_pattern(const std::string& name, const std::string& spec) {
  const auto fail = [&] {
    throw UsageError(
        fmt::format("{}: expected exactly one number like %d or %06d, in the file name", spec));
  };
  NumberPattern pattern;
  bool has_number = false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    std::string& target = has_number ? pattern.suffix : pattern.prefix;
    if (name[i] != '%') {
      target.push_back(name[i]);
      continue;
    }
    ++i;
    if (i < name.size() && name[i] == '%') {
      target.push_back('%');
      continue;
    }
    std::string width;
    while (i < name.size() && name[i] >= '0' && name[i] <= '9') {
      width.push_back(name[i++]);
    }
    const bool valid_width = width.empty() || (width[0] == '0' && width.size() == 2);
    if (i >= name.size() || name[i] != 'd' || has_number || !valid_width) {
      fail();
    }
    has_number = true;
    pattern.digits = width.empty() ? 1 : width[1] - '0';
  }
  if (!has_number) {
    fail();
  }
  return pattern;
}

class NumberedFiles : public ImageFiles {
 public:
  NumberedFiles(fs::path folder, NumberPattern pattern, int first_number, int count)
      : folder_(std::move(folder)),
        pattern_(std::move(pattern)),
        first_number_(first_number),
        count_(count) {}

 private:
  [[nodiscard]] int count() const override { return count_; }
  [[nodiscard]] fs::path path(int index) const override {
    return folder_ / pattern_.name(first_number_ + index);
  }

  fs::path folder_;
  NumberPattern pattern_;
  int first_number_;
  int count_;
};

class VideoFrames : public FrameSource {
 public:
  explicit VideoFrames(fs::path path) : path_(std::move(path)), reader_(path_) {}

  bool next(Photograph& frame) override { return reader_.read(frame); }
  [[nodiscard]] std::optional<int> frame_count() const override { return reader_.frame_count(); }
  [[nodiscard]] std::string describe(int index) const override {
    return fmt::format("{} frame {}", path_.string(), index);
  }
  [[nodiscard]] std::optional<double> frames_per_second() const override {
    return reader_.frames_per_second();
  }

 private:
  fs::path path_;
  VideoReader reader_;
};

/// The regular files in `folder` ("" is the current one) whose names `wanted` accepts.
template <typename Wanted>
std::vector<fs::path> list_files(const fs::path& folder, const Wanted& wanted) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? fs::path(".") : folder, error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (wanted(name) && is_file(entry->path())) {
      paths.push_back(folder / name);
    }
  }
  if (error) {
    throw Error(fmt::format("cannot read the folder '{}': {}", folder.string(), error.message()));
  }
  std::sort(paths.begin(), paths.end(), comes_before_naturally);
  return paths;
}

std::unique_ptr<FrameSource> open_folder(const fs::path& folder) {
  std::vector<fs::path> paths = list_files(folder, [](const std::string& name) {
    return !name.starts_with('.') && has_image_extension(name);
  });
  if (paths.empty()) {
    throw Error(fmt::format("folder {} holds no image files", folder.string()));
  }
  return std::make_unique<ListedFiles>(std::move(paths));
}

std::unique_ptr<FrameSource> open_pattern(const fs::path& spec) {
  const NumberPattern pattern = parse_pattern(spec.filename().string(), spec.string());
  const fs::path folder = spec.parent_path();
  std::optional<int> smallest;
  int largest = 0;
  for (const fs::path& path : list_files(
           folder, [&](const std::string& name) { return pattern.number_in(name).has_value(); })) {
    const int number = *pattern.number_in(path.filename().string());
    smallest = std::min(smallest.value_or(number), number);
    largest = std::max(largest, number);
  }
  if (!smallest) {
    throw Error(fmt::format("{}: no file matches", spec.string()));
  }
  if (largest == std::numeric_limits<int>::max()) {
    throw Error(fmt::format("{}: number {} is too large", spec.string(), largest));
  }
  return std::make_unique<NumberedFiles>(folder, pattern, *smallest, largest - *smallest + 1);
}

std::unique_ptr<FrameSource> open_glob(const fs::path& spec) {
  const std::string pattern = spec.filename().string();
  std::vector<fs::path> paths = list_files(
      spec.parent_path(), [&](const std::string& name) { return matches_wildcard(pattern, name); });
  if (paths.empty()) {
    throw Error(fmt::format("{}: no file matches", spec.string()));
  }
  return std::make_unique<ListedFiles>(std::move(paths));
}

}  // namespace

std::unique_ptr<FrameSource> open_frame_source(const std::string& spec) {
  std::error_code ignored;
  if (fs::is_directory(spec, ignored)) {
    return open_folder(spec);
  }
  if (fs::exists(spec, ignored)) {
    if (has_image_extension(spec)) {
      return std::make_unique<ListedFiles>(std::vector<fs::path>{spec});
    }
    return std::make_unique<VideoFrames>(spec);
  }
  if (spec.find('%') != std::string::npos) {
    return open_pattern(spec);
  }
  if (spec.find_first_of("*?[") != std::string::npos) {
    return open_glob(spec);
  }
  throw Error(fmt::format("{}: no such file or folder, expected images or a video", spec));
}

}  // namespace vantage
