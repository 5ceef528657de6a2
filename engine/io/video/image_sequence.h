#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/io/files/numbered_names.h"
#include "engine/io/files/remote_files.h"
#include "engine/io/video/frame_source.h"

namespace vantage {

/// Image files as frames. Nothing is opened before FetchedFrame::decode(), so seeking is free and a
/// missing or bad file is one bad frame.
class ImageSequence : public FrameSource {
 public:
  /// How its files are read.
  void set_reading(const PhotographReading& reading) { reading_ = reading; }
  bool fetch(FetchedFrame& frame) final;
  void skip_to(int index) final;
  [[nodiscard]] int frame_count() const final { return count_; }
  [[nodiscard]] std::string describe(int index) const final { return path(index).string(); }
  [[nodiscard]] std::optional<long long> number_of(int index) const final;
  [[nodiscard]] std::vector<std::filesystem::path> files() const final;
  [[nodiscard]] std::string identity() const final;

 protected:
  /// `name`: the name of the sequence in identity().
  ImageSequence(std::string name, int count) : name_(std::move(name)), count_(count) {}

 private:
  [[nodiscard]] virtual std::filesystem::path path(int index) const = 0;
  /// Name of a frame's file in identity().
  [[nodiscard]] virtual std::string identity_name(int index) const {
    return path(index).filename().string();
  }

  std::string name_;
  int count_;
  int next_index_ = 0;
  int last_index_ = -1;  ///< of the last fetch()
  PhotographReading reading_;
};

/// Files in the order of a list.
class ListedImages : public ImageSequence {
 public:
  /// Relative paths are relative to `folder` ("" is the current one).
  ListedImages(std::string name, std::filesystem::path folder,
               std::vector<std::filesystem::path> paths)
      : ImageSequence(std::move(name), static_cast<int>(paths.size())),
        folder_(std::move(folder)),
        paths_(std::move(paths)) {}

 private:
  [[nodiscard]] std::filesystem::path path(int index) const override {
    return joined_path(folder_, paths_.at(static_cast<std::size_t>(index)));
  }
  [[nodiscard]] std::string identity_name(int index) const override {
    return paths_.at(static_cast<std::size_t>(index)).string();
  }

  std::filesystem::path folder_;
  std::vector<std::filesystem::path> paths_;
};

/// Files with consecutive numbers in their names.
class NumberedImages : public ImageSequence {
 public:
  NumberedImages(std::string name, std::filesystem::path folder, NumberPattern pattern,
                 int first_number, int count)
      : ImageSequence(std::move(name), count),
        folder_(std::move(folder)),
        pattern_(std::move(pattern)),
        first_number_(first_number) {}

 private:
  [[nodiscard]] std::filesystem::path path(int index) const override {
    return folder_ / pattern_.name(first_number_ + index);
  }

  std::filesystem::path folder_;
  NumberPattern pattern_;
  int first_number_;
};

/// Opens a folder's images, a printf pattern or a glob pattern; see open_frame_source().
std::unique_ptr<ImageSequence> open_image_folder(const std::string& folder);
std::unique_ptr<ImageSequence> open_image_pattern(const std::string& spec);
std::unique_ptr<ImageSequence> open_image_glob(const std::string& spec);

/// Whether the extension is that of an image format that read_photograph() supports.
bool has_image_extension(const std::filesystem::path& path);

}  // namespace vantage
