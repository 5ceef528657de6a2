#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/image/disparity_range.h"
#include "engine/image/stereo_packing.h"
#include "engine/image/white_level.h"
#include "engine/io/images/scene_mask.h"
#include "engine/io/video/frame_source.h"
#include "engine/io/video/streams/raw_video_shape.h"
#include "engine/rectification/kitti_cameras.h"
#include "engine/sequence/pairs/frame_range.h"

namespace vantage {

/// Size of all images of a run.
struct ImageExtent {
  int width_px = 0;
  int height_px = 0;
};

/// What a list says of one pair beside its images.
struct PairDetails {
  std::string name = {};                   ///< of its result files; empty: its number
  std::filesystem::path calibration = {};  ///< of its cameras; empty: that of the run
  /// Of a calibration of KITTI, by the folders of the images; empty: they name none.
  std::optional<KittiCameras> kitti_cameras = std::nullopt;
  std::optional<DisparityRange> disparities = std::nullopt;  ///< to search; empty: those of the run

  friend bool operator==(const PairDetails&, const PairDetails&) = default;
};

/// A pair of frames from a source: fetched in order by one thread, decoded by any. Memory is reused
/// from pair to pair.
struct FramePair {
  /// Whether the right image is needed. If not, fetch() and decode() save work where they can:
  /// `right` is then undefined, and its errors may go unnoticed.
  bool wants_right = true;
  int index = 0;                   ///< of the pair in its source, counted from 0
  std::array<int, 2> frames = {};  ///< of the left and right camera, see PairSource::frame_of()
  std::array<FetchedFrame, 2> fetched;  ///< decode() makes the pair from it
  Photograph left;
  Photograph right;
  /// Of PairSourceOptions::more; empty if the right image is not needed.
  std::vector<FetchedFrame> more_fetched;
  std::vector<Photograph> more;
  std::array<FetchedFrame, 2> masks;  ///< of `left` and `right`, if they are files
  std::vector<std::string> remarks;   ///< about the frames, and about the pair
  PairDetails details;                ///< see PairSource::details(), of this pair
  /// When it was there, with PairSourceOptions::live.
  std::optional<std::chrono::steady_clock::time_point> arrival;
};

/// Pairs of the input that a run takes: pair `first` and every `pairs`-th after it.
struct FrameStep {
  static constexpr int kMaxPairs = 1000000;

  int pairs = 1;  ///< 1..kMaxPairs
  int first = 0;  ///< below 2³¹ − 1 − kMaxPairs
  /// Instead of `pairs`: the time between two of them, 0.001 to 86400 s, rounded to whole frames
  /// and at least one. Needs an input with a frame rate.
  std::optional<double> seconds;

  [[nodiscard]] bool takes_all() const { return pairs == 1 && first == 0 && !seconds; }
  friend bool operator==(const FrameStep&, const FrameStep&) = default;
};

class PairQueue;

/// What tells which frames of several cameras are of one moment.
enum class PairBy {
  kName,   ///< what the names of image files share: numbers, time stamps, stems
  kTime,   ///< time stamps in names; of films when frames are shown
  kOrder,  ///< the first with the first, the second with the second
};

/// Values of `pair-by`.
const std::vector<std::pair<std::string_view, PairBy>>& pair_by_names();

/// How frames of several cameras became pairs.
struct Pairing {
  PairBy by = PairBy::kOrder;
  /// Frames of each camera without a partner, but for those that follow from offset_frames; empty
  /// for other sources.
  std::vector<int> left_out = {};

  /// Whether that many things of one camera are one for each of its frames, not for each of
  /// `pairs`.
  [[nodiscard]] bool counts_frames(std::size_t camera, int things, int pairs) const {
    return camera < left_out.size() && left_out[camera] > 0 && things == pairs + left_out[camera];
  }
  [[nodiscard]] bool is_whole() const {
    return std::ranges::all_of(left_out, [](int frames) { return frames == 0; });
  }
};

/// Source of the pairs of a run: exactly one of the five.
struct PairSourceOptions {
  /// Two sources of open_frame_source(), or two streams, see pair_frames(): frame i + offset_frames
  /// of the right one belongs to frame i of the left one where no frame is missing.
  std::string left;
  std::string right;
  int offset_frames = 0;
  /// Empty: names of images where they share something, else order; of two films time.
  std::optional<PairBy> pair_by;
  /// With left and right: sources of more cameras, paired with the left one without offset.
  std::vector<std::string> more;
  /// One source whose frames hold both images, or whose two video tracks do; it may be a stream,
  /// see is_stream_name().
  std::string stereo;
  std::optional<StereoPacking> packing;  ///< of `stereo`; empty: as the film says
  /// Of streams: rawvideo of this shape and frame rate (see StreamInput::open()).
  std::optional<RawVideoShape> raw_video;
  FrameRate raw_rate;
  const std::atomic<bool>* stop = nullptr;  ///< of streams: reading ends once it is set
  /// A CSV file with the columns left,right: one pair of image files per line, see
  /// parse_pair_list(). Names are relative
  /// to the file's folder; empty lines and lines that start with # are skipped; quotes as in RFC
  /// 4180, blanks around unquoted fields are dropped. A heading names the columns, in any order:
  /// left, right, and for PairDetails name, calibration (relative to the file's folder),
  /// min-disparity and max-disparity (both or none). Empty fields: as without the column.
  std::string pairs;
  /// One moving camera: frame t is the left image and frame t + step the right one (step < 0: the
  /// camera moved to the left). |step| in 1..1000.
  std::string sequence;
  int step = 1;
  std::shared_ptr<PairQueue> queue;  ///< of a caller in this process
  FrameStep every;
  /// Of a stream: fetch() gives the newest pair, and those that came before it are dropped.
  bool live = false;
  /// What is left out of the images; not of those of `more`.
  SceneMaskOptions masks = {.left = std::string(SceneMaskOptions::kNone)};
  /// Of all images, see WhiteLevelSearch. Empty: what files state, else what up to 8 pairs show,
  /// evenly spaced from the first to the last; of films and streams that of their pixel format.
  std::optional<double> white_level;
  PhotographReading reading;

  /// Whether pairs arrive once, see is_stream_name().
  [[nodiscard]] bool is_stream() const;
  /// Throws UsageError naming the field, its value and what was expected.
  void validate() const;
};

/// The pairs of a run, in order. Thread rule: one thread at a time, except for decode().
class PairSource {
 public:
  PairSource() = default;
  PairSource(const PairSource&) = delete;
  PairSource& operator=(const PairSource&) = delete;
  virtual ~PairSource() = default;

  /// Fetches the next pair; false after the last one, which may come a few pairs before
  /// pair_count(), see FrameSource::fetch(). Throws Error naming the file or frame when one of its
  /// frames is bad; the next call continues with the next pair. Bad image files are only detected
  /// by decode().
  virtual bool fetch(FramePair& pair) = 0;
  /// Makes `left` and `right` from the fetched data: reads image files, converts the pictures of
  /// videos, splits packed frames; then scales them to the white level, and remarks on what that
  /// clips. Thread rule: concurrently for different pairs. Throws Error.
  void decode(FramePair& pair) const;
  void set_white_level(WhiteLevel level) { white_level_ = std::move(level); }
  [[nodiscard]] virtual const WhiteLevel& white_level() const { return white_level_; }

  /// Makes pair `index` (0 ≤ index ≤ pair_count()) the result of the next fetch().
  virtual void skip_to(int index) = 0;
  /// Total number of pairs: frames that have a partner. Of a stream an upper bound.
  [[nodiscard]] virtual int pair_count() const = 0;
  /// Whether pairs arrive once, and their number is known when they end. skip_to() then only goes
  /// forward, except to repeatable_pairs().
  [[nodiscard]] virtual bool is_stream() const { return false; }
  /// Pairs that can be fetched again. Of a stream: known after the first pair was fetched, which is
  /// the first of them.
  [[nodiscard]] virtual FrameRange repeatable_pairs() const { return {0, pair_count()}; }
  /// From here on each pair of a stream is fetched once: it holds none for longer.
  virtual void forget_start() {}
  /// Whether fetch() would not have to wait for what others send; waits for that at most `longest`.
  virtual bool is_ready(std::chrono::milliseconds longest) {
    (void)longest;
    return true;
  }
  /// Pairs that a live stream left out so far. Thread rule: any thread.
  [[nodiscard]] virtual int dropped_pairs() const { return 0; }
  /// The pairs that are made of these frames of the input; the range may be empty.
  [[nodiscard]] virtual FrameRange pairs_of(FrameRange input_frames) const { return input_frames; }
  /// FramePair::index of a pair.
  [[nodiscard]] virtual int index_of(int pair) const { return pair; }
  /// Frame of the left (0) or right camera in the pair of this FramePair::index. Of other sources
  /// the index.
  [[nodiscard]] virtual int frame_of(std::size_t camera, int index) const {
    (void)camera;
    return index;
  }
  /// Number of frames that pairs_of() counts. Of a stream an upper bound.
  [[nodiscard]] virtual int input_frames() const { return pair_count(); }
  /// Number of decoded frames, no larger than photographs, that the source itself keeps in memory.
  [[nodiscard]] virtual int frames_kept() const { return 0; }
  /// Of a list with further columns.
  [[nodiscard]] virtual PairDetails details(int index) const {
    (void)index;
    return {};
  }
  /// "left/000012.png, right/000012.png" or "film.mp4 frame 12".
  [[nodiscard]] virtual std::string describe(int index) const = 0;
  /// Remarks on the pairing as a whole, one line each: frames without a partner, file numbers that
  /// are missing, films that did not start together. They name options as `name`.
  [[nodiscard]] virtual std::vector<std::string> remarks() const = 0;
  [[nodiscard]] virtual Pairing pairing() const { return {}; }
  /// Frame rate of the left or packed video; empty for image files.
  [[nodiscard]] virtual std::optional<FrameRate> frame_rate() const = 0;
  /// Times of all pairs if that video has a variable rate; else empty.
  [[nodiscard]] virtual std::optional<FrameTimes> frame_times() const { return std::nullopt; }
  /// What the left or packed film states of its pictures; of image files the default.
  [[nodiscard]] virtual FilmFormat film_format() const { return {}; }
  /// Video file with the sound, and its frame that is pair 0; the file is empty if there is none.
  struct Sound {
    std::filesystem::path file;
    double first_frame = 0;  ///< in pairs: not a whole number where not all pairs are taken
  };
  [[nodiscard]] virtual Sound sound() const = 0;
  /// All files that frames are read from.
  [[nodiscard]] virtual std::vector<std::filesystem::path> files() const = 0;
  /// One line per source: see FrameSource::identity().
  [[nodiscard]] virtual std::vector<std::string> identities() const = 0;

 protected:
  /// decode() without the white level.
  virtual void make_images(FramePair& pair) const;

 private:
  WhiteLevel white_level_;
};

/// Throws Error when a source cannot be opened, UsageError for invalid options.
std::unique_ptr<PairSource> open_pair_source(const PairSourceOptions& options);

}  // namespace vantage
