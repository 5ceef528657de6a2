#pragma once

#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/image/photograph_reading.h"
#include "engine/io/video/film_properties.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/libav.h"
#include "engine/io/video/video_io.h"

namespace vantage {

/// The frames of a video file. fetch() decodes them, each from those before it, and
/// FetchedFrame::decode() converts them to photographs. Damage loses the frames up to the next
/// known random access point.
class VideoFrames : public FrameSource {
 public:
  /// `track`: the number of one of the file's videos. Throws Error as VideoReader does.
  explicit VideoFrames(std::string file, int track = kMainVideo,
                       const PhotographReading& reading = {});

  bool fetch(FetchedFrame& frame) override;
  /// Decodes all frames on the way if there is no known random access point.
  void skip_to(int index) override;
  [[nodiscard]] int frame_count() const override { return frame_count_; }
  [[nodiscard]] std::string describe(int index) const override;
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override {
    return reader_->frame_rate();
  }
  [[nodiscard]] std::optional<FrameTimes> frame_times() const override {
    return reader_->frame_times();
  }
  [[nodiscard]] std::optional<FilmStart> start() const override { return reader_->start(); }
  /// Of the pictures as they are turned.
  [[nodiscard]] FilmFormat film_format() const override;
  [[nodiscard]] std::filesystem::path video_file() const override { return file_; }
  [[nodiscard]] std::string identity() const override;
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] const FilmProperties* film() const override { return &film_; }
  void take_fields_apart() override;

 private:
  /// What fetch_next() gave, or threw.
  struct Fetched {
    FetchedFrame frame;
    bool is_there = false;
    std::exception_ptr problem;
  };
  bool fetch_next(FetchedFrame& frame);
  Fetched look_ahead();
  void skip_reader_to(int index);
  /// Records the problem of the next frame.
  void note_damage(const std::string& problem);

  std::filesystem::path file_;
  int track_;
  std::unique_ptr<VideoReader> reader_;
  FilmProperties film_;
  PictureHandling handling_;
  int frame_count_;
  int next_index_ = 0;  ///< of the reader
  int next_good_ = 0;   ///< frames before it are lost to damage; the reader is there
  std::string damage_;  ///< problem of the last bad frame that was not itself after damage
  // Where pictures are deinterlaced, the reader is one frame ahead:
  int next_fetched_ = 0;
  VideoPicture before_;           ///< the one before it, empty where it is bad
  std::optional<Fetched> ahead_;  ///< that frame
};

}  // namespace vantage
