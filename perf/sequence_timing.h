#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "engine/execution.h"
#include "engine/sequence/journal/run_journal.h"
#include "engine/sequence/options/sequence_layout.h"
#include "engine/sequence/options/sequence_options.h"
#include "engine/sequence/sequence_runner.h"
#include "perf/opencv_loop.h"
#include "perf/sequence_inputs.h"
#include "perf/stopwatch.h"

namespace vantage::perf {

/// Frames fetched before a run's clock starts: by then memory is allocated, the encoder of a video
/// looks as far ahead as it does, and the queue of frames waiting for the disk has its final
/// length.
inline constexpr int kWarmUpFrames = 24;

struct RunTiming {
  FrameTime frame;  ///< without the warm-up
  SequenceReport report;
};

/// A run from files to files, `frames` of them with the warm-up. The clock runs between fetching
/// the first frame after the warm-up and the last one: the rate at which frames enter, and
/// therefore leave.
inline RunTiming time_run(const PairSourceOptions& input, const SequenceOptions& options,
                          int frames, int threads, int in_flight,
                          const std::filesystem::path& folder) {
  std::filesystem::remove_all(folder);
  std::optional<Stopwatch> watch;
  RunTiming timing;
  RepeatedPairs pairs(input, frames, [&](int index) {
    if (index == kWarmUpFrames) {
      watch.emplace();
    } else if (index == frames - 1) {
      timing.frame = watch->per_frame(index - kWarmUpFrames);
    }
  });
  Execution execution({.threads = threads});
  FramePair first;
  pairs.fetch(first);
  pairs.decode(first);
  const ImageExtent size{first.left.width(), first.left.height()};
  pairs.skip_to(0);
  const SequenceLayout layout(folder, options);
  RunIdentity identity;
  identity.frame_count = frames;
  RunJournal journal(layout.journal_folder(), identity, JournalOpening::kNew, "all");
  const SequenceRun run{.pairs = pairs,
                        .selection = {.frame_count = frames,
                                      .chunk_frames = options.chunk_frames,
                                      .frames = std::nullopt,
                                      .shard = std::nullopt},
                        .frame_size = size,
                        .in_flight = in_flight,
                        .on_progress = {}};
  timing.report = SequenceRunner(options, execution).run(run, layout, journal);
  return timing;
}

/// The loop over PNG files or over a packed video, which OpenCV's own reader would decode with the
/// same library.
inline FrameTime time_opencv(const SequenceInputs& inputs, DisparityRange range, bool from_video,
                             int frames, int threads, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  cv::setNumThreads(threads);
  OpenCvLoop loop(range);
  std::optional<Stopwatch> watch;
  std::optional<VideoReader> reader;
  Photograph packed;
  cv::Mat left;
  cv::Mat right;
  for (int frame = 0; frame < frames; ++frame) {
    if (frame == 1) {
      watch.emplace();
    }
    if (from_video) {
      if (!reader || !reader->read(packed)) {
        reader.emplace(inputs.video_file);
        reader->read(packed);
      }
      const auto& image = std::get<Image<std::uint8_t>>(packed.pixels);
      const cv::Mat both(image.height(), image.width(), CV_8UC(image.channels()),
                         const_cast<std::uint8_t*>(image.row(0)), image.view().stride());
      left = both.colRange(0, both.cols / 2);
      right = both.colRange(both.cols / 2, both.cols);
    } else {
      const auto& files =
          inputs.image_pairs[static_cast<std::size_t>(frame) % inputs.image_pairs.size()];
      left = cv::imread(files[0].string(), cv::IMREAD_UNCHANGED);
      right = cv::imread(files[1].string(), cv::IMREAD_UNCHANGED);
    }
    loop.work(left, right, folder, fmt::format("{:06}", frame));
  }
  cv::setNumThreads(1);
  return watch->per_frame(frames - 1);
}

}  // namespace vantage::perf
