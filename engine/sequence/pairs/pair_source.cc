#include "engine/sequence/pairs/pair_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/error.h"
#include "engine/image/orientation.h"
#include "engine/io/video/image_sequence.h"
#include "engine/io/video/streams/stream_input.h"
#include "engine/io/video/streams/streamed_video.h"
#include "engine/sequence/pairs/every_nth_pair.h"
#include "engine/sequence/pairs/live_pairs.h"
#include "engine/sequence/pairs/masked_pairs.h"
#include "engine/sequence/pairs/moving_camera_pairs.h"
#include "engine/sequence/pairs/pair_list.h"
#include "engine/sequence/pairs/several_cameras.h"
#include "engine/sequence/pairs/stereo_film.h"
#include "engine/sequence/pairs/streamed_pairs.h"
#include "engine/sequence/pairs/supplied_pairs.h"
#include "engine/sequence/pairs/two_camera_pairs.h"

namespace vantage {
namespace {

constexpr int kMaxOffset = 1000000;
constexpr int kMaxStep = 1000;
constexpr int kPairsForWhiteLevel = 8;
constexpr double kMinTakenSeconds = 0.001;
constexpr double kMaxTakenSeconds = 86400;

std::unique_ptr<PairSource> open_pair_list(const std::filesystem::path& file,
                                           const PhotographReading& reading) {
  std::vector<std::filesystem::path> left;
  std::vector<std::filesystem::path> right;
  std::vector<PairDetails> details;
  FramePairing pairing;
  pairing.first = {0, 0};  // whoever writes a list means it
  for (ListedPair& pair : read_pair_list(file, &pairing.remarks)) {
    left.push_back(std::move(pair.left));
    right.push_back(std::move(pair.right));
    details.push_back(std::move(pair.details));
  }
  const auto open_column = [&](const char* column, std::vector<std::filesystem::path> names) {
    auto images = std::make_unique<ListedImages>(
        fmt::format("{} ({} column)", file.string(), column), file.parent_path(), std::move(names));
    images->set_reading(reading);
    return images;
  };
  pairing.count = static_cast<int>(left.size());
  auto pairs =
      std::make_unique<TwoCameraPairs>(open_column("left", std::move(left)),
                                       open_column("right", std::move(right)), std::move(pairing));
  pairs->set_details(std::move(details));
  return pairs;
}

void validate_step(const FrameStep& every) {
  if (every.pairs < 1 || every.pairs > FrameStep::kMaxPairs) {
    throw UsageError(fmt::format("every is {}, expected 1 to {} frames, or seconds such as 4s",
                                 every.pairs, FrameStep::kMaxPairs));
  }
  if (every.first < 0 || every.first > std::numeric_limits<int>::max() - 1 - FrameStep::kMaxPairs) {
    throw UsageError(fmt::format("every starts at frame {}, expected 0 to {}", every.first,
                                 std::numeric_limits<int>::max() - 1 - FrameStep::kMaxPairs));
  }
  if (every.seconds &&
      !(*every.seconds >= kMinTakenSeconds && *every.seconds <= kMaxTakenSeconds)) {
    throw UsageError(fmt::format("every is {}s, expected {} to {} seconds", *every.seconds,
                                 kMinTakenSeconds, kMaxTakenSeconds));
  }
}

/// In pairs.
int taken_step(const FrameStep& every, const PairSource& pairs) {
  if (!every.seconds) {
    return every.pairs;
  }
  const std::optional<FrameRate> rate = pairs.frame_rate();
  if (!rate) {
    throw UsageError(
        fmt::format("every is {}s, but images have no frame rate; expected a number of frames",
                    *every.seconds));
  }
  const double frames = std::round(*every.seconds * rate->per_second());
  return static_cast<int>(std::clamp(frames, 1.0, static_cast<double>(FrameStep::kMaxPairs)));
}

std::unique_ptr<PairSource> in_order(std::unique_ptr<FrameSource> left,
                                     std::unique_ptr<FrameSource> right, int offset_frames) {
  FramePairing pairing = pair_in_order({left.get(), right.get()}, offset_frames);
  return std::make_unique<TwoCameraPairs>(std::move(left), std::move(right), std::move(pairing));
}

/// All are open before the first is read.
std::unique_ptr<PairSource> open_streams(const PairSourceOptions& options) {
  const auto input_of = [&](const std::string& name) {
    return std::make_unique<StreamInput>(name, options.stop);
  };
  const auto video_of = [&](std::unique_ptr<StreamInput> input) {
    return std::make_unique<StreamedVideo>(std::move(input), options.raw_video, options.raw_rate);
  };
  if (!options.stereo.empty()) {
    return make_packed_pairs(video_of(input_of(options.stereo)), *options.packing);
  }
  if (!options.sequence.empty()) {
    return make_moving_camera_pairs(video_of(input_of(options.sequence)), {.step = options.step});
  }
  std::unique_ptr<StreamInput> left = input_of(options.left);
  std::unique_ptr<StreamInput> right = input_of(options.right);
  auto left_video = video_of(std::move(left));
  return in_order(std::move(left_video), video_of(std::move(right)), options.offset_frames);
}

std::unique_ptr<PairSource> open_all_pairs(const PairSourceOptions& options) {
  if (options.queue != nullptr) {
    return std::make_unique<SuppliedPairs>(options.queue);
  }
  if (options.is_stream()) {
    return open_streams(options);
  }
  std::vector<std::string> notes;
  const auto open = [&](const std::string& spec) {
    return open_noted_source(spec, options.reading, notes);
  };
  const auto noted = [&](std::unique_ptr<PairSource> pairs) -> std::unique_ptr<PairSource> {
    return notes.empty() ? std::move(pairs)
                         : std::make_unique<NotedPairs>(std::move(pairs), std::move(notes));
  };
  if (!options.stereo.empty()) {
    return noted(open_stereo_pairs(options, notes));
  }
  if (!options.pairs.empty()) {
    return open_pair_list(options.pairs, options.reading);
  }
  if (!options.sequence.empty()) {
    return noted(make_moving_camera_pairs(open(options.sequence), {.step = options.step}));
  }
  auto left = open(options.left);
  auto right = open(options.right);
  std::vector<const FrameSource*> cameras = {left.get(), right.get()};
  std::vector<std::unique_ptr<FrameSource>> more;
  for (const std::string& source : options.more) {
    more.push_back(open(source));
    cameras.push_back(more.back().get());
  }
  auto pairs = std::make_unique<TwoCameraPairs>(
      std::move(left), std::move(right),
      pair_frames(cameras, options.offset_frames, options.pair_by));
  if (more.empty()) {
    return noted(std::move(pairs));
  }
  return noted(std::make_unique<SeveralCameras>(std::move(pairs), std::move(more)));
}

}  // namespace

bool PairSourceOptions::is_stream() const {
  return std::ranges::any_of(std::array{&stereo, &left, &right, &sequence},
                             [](const std::string* name) { return is_stream_name(*name); });
}

const std::vector<std::pair<std::string_view, PairBy>>& pair_by_names() {
  static const std::vector<std::pair<std::string_view, PairBy>> kNames = {
      {"name", PairBy::kName}, {"time", PairBy::kTime}, {"order", PairBy::kOrder}};
  return kNames;
}

void PairSourceOptions::validate() const {
  const bool two_cameras = !left.empty() || !right.empty();
  const int kinds = (two_cameras ? 1 : 0) + (stereo.empty() ? 0 : 1) + (pairs.empty() ? 0 : 1) +
                    (sequence.empty() ? 0 : 1) + (queue == nullptr ? 0 : 1);
  if (kinds != 1) {
    throw UsageError(
        fmt::format("{} input{} given, expected exactly one of left and right, stereo, pairs, "
                    "sequence",
                    kinds == 0 ? "no" : "several kinds of", kinds == 0 ? " is" : " are"));
  }
  if (two_cameras && (left.empty() || right.empty())) {
    throw UsageError(left.empty() ? "right is given without left" : "left is given without right");
  }
  if (offset_frames < -kMaxOffset || offset_frames > kMaxOffset) {
    throw UsageError(fmt::format("offset is {}, expected {}..{} frames", offset_frames, -kMaxOffset,
                                 kMaxOffset));
  }
  if (offset_frames != 0 && !two_cameras) {
    throw UsageError(fmt::format("offset is {}, expected 0 without left and right", offset_frames));
  }
  if (two_cameras && is_stream() && !(is_stream_name(left) && is_stream_name(right))) {
    throw UsageError(fmt::format("{} is a stream, expected one for both sides",
                                 is_stream_name(left) ? "left" : "right"));
  }
  if (two_cameras && is_stream() && left == right) {
    throw UsageError("left and right are the same stream, which is read once");
  }
  if (!more.empty() && is_stream()) {
    throw UsageError("more is given and left is a stream, expected files");
  }
  if (pair_by && (!two_cameras || is_stream())) {
    throw UsageError("pair-by is given, expected it with files as left and right only");
  }
  if (!more.empty() && !two_cameras) {
    throw UsageError("more is given, expected it with left and right only");
  }
  if (is_stream_name(stereo) && !packing) {
    throw UsageError("`stereo` needs `packing`, such as sbsl: a stream does not say it");
  }
  if (packing && stereo.empty()) {
    throw UsageError("packing is given without stereo");
  }
  if (step == 0 || step < -kMaxStep || step > kMaxStep) {
    throw UsageError(
        fmt::format("step is {}, expected 1 to {} frames or -1 to -{}", step, kMaxStep, kMaxStep));
  }
  if (step != 1 && sequence.empty()) {
    throw UsageError(fmt::format("step is {}, expected 1 without sequence", step));
  }
  if (queue != nullptr && !every.takes_all()) {
    throw UsageError("every is given, expected it with files only: supply the pairs to take");
  }
  validate_step(every);
  masks.validate();
}

void PairSource::make_images(FramePair& pair) const {
  pair.fetched[0].decode();
  std::swap(pair.left, pair.fetched[0].photograph);
  if (pair.wants_right) {
    pair.fetched[1].decode();
    std::swap(pair.right, pair.fetched[1].photograph);
    try {
      require_equal_turns(pair.left, pair.right);
    } catch (const Error& error) {
      throw Error(fmt::format("{}: {}", describe(pair.index), error.what()));
    }
  }
}

void PairSource::decode(FramePair& pair) const {
  make_images(pair);
  double clipped = white_level_.apply(pair.left);
  if (pair.wants_right) {
    clipped = std::max(clipped, white_level_.apply(pair.right));
    for (Photograph& photograph : pair.more) {
      clipped = std::max(clipped, white_level_.apply(photograph));
    }
  }
  if (clipped > 0) {
    pair.remarks.push_back(
        fmt::format("{:.2g} % of its values are above the white level", 100 * clipped));
  }
}

namespace {

/// Of the whole input, so that parts of a run agree. Pairs that cannot be read do not count.
WhiteLevel white_level_of(PairSource& pairs, std::optional<double> given) {
  WhiteLevelSearch search(given);
  const int count = pairs.pair_count();
  const int looked_at = pairs.is_stream() ? 1 : std::min(count, kPairsForWhiteLevel);
  FramePair pair;
  for (int i = 0; i < looked_at && (i == 0 || search.guesses()); ++i) {
    try {
      pairs.skip_to(static_cast<int>(i * (count - 1LL) / std::max(1, looked_at - 1)));
      pairs.fetch(pair);
      pairs.decode(pair);
      search.add(pair.left);
      search.add(pair.right);
    } catch (const Error&) {
      continue;  // the run itself reports bad frames
    }
  }
  pairs.skip_to(0);
  return search.found();
}

}  // namespace

std::unique_ptr<PairSource> open_pair_source(const PairSourceOptions& options) {
  options.validate();
  std::unique_ptr<PairSource> all = open_all_pairs(options);
  if (!options.every.takes_all()) {
    const int step = taken_step(options.every, *all);
    all = std::make_unique<EveryNthPair>(std::move(all), options.every.first, step);
  }
  if (options.queue != nullptr) {
    // Who supplies pairs may wait for the result of the first.
    all = std::make_unique<StreamedPairs>(std::move(all), 1);
  } else if (options.is_stream()) {
    all = std::make_unique<StreamedPairs>(std::move(all));
  }
  const bool is_film = options.is_stream() || !all->sound().file.empty();
  all->set_white_level(is_film && !options.white_level ? WhiteLevel()
                                                       : white_level_of(*all, options.white_level));
  if (options.live && !all->is_stream()) {
    throw UsageError("live is given, but the input is no stream, expected one such as `stereo` -");
  }
  if (options.live) {
    all = std::make_unique<LivePairs>(std::move(all));
  }
  const bool are_photographs = !options.pairs.empty();
  return std::make_unique<MaskedPairs>(std::move(all), options.masks, are_photographs);
}

}  // namespace vantage
