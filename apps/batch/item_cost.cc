#include "apps/batch/item_cost.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <vector>

#include "apps/batch/picture_header.h"
#include "engine/error.h"
#include "engine/examination/pair_examination.h"
#include "engine/io/files/remote_files.h"
#include "engine/jobs/sequence_session.h"
#include "engine/sequence/memory_plan.h"
#include "engine/sequence/options/sequence_layout.h"

namespace vantage::apps {
namespace {

namespace fs = std::filesystem;

/// Where nothing could be measured: `balanced` on one core of 2024, and what is usual.
constexpr double kUsualSecondsPerCell = 5e-9;
constexpr double kUsualCandidatesPerPx = 1.0 / 8;
constexpr double kUsualMemoryPerPixel = 300;

std::uint64_t bytes_of_files(const std::vector<fs::path>& files) {
  std::uint64_t bytes = 0;
  for (const fs::path& file : files) {
    bytes += bytes_of_file(file);
  }
  return bytes;
}

/// Bytes of a pixel of an output, as files usually have them.
double output_bytes(const OutputStream& stream, const std::string& map_format) {
  if (stream.as_video) {
    return 0.03;
  }
  switch (stream.output) {
    case SequenceOutput::kDisparity:
    case SequenceOutput::kRightDisparity:
      return map_format == "png" ? 1.5 : sizeof(float);
    case SequenceOutput::kConfidence:
    case SequenceOutput::kPosteriorMean:
    case SequenceOutput::kPosteriorVariance:
    case SequenceOutput::kCyclopean:
    case SequenceOutput::kDepthResolution:
      return sizeof(float);
    case SequenceOutput::kCloud:
    case SequenceOutput::kMesh:
      return 16;
    case SequenceOutput::kViews:
    case SequenceOutput::kStereo:
    case SequenceOutput::kDepth:
      return 1.5;
    default:
      return 0.2;
  }
}

double bytes_per_pixel(const RunJob& job) {
  double bytes = 0;
  const SequenceLayout layout(job.output, job.sequence);
  for (const OutputStream& stream : layout.streams()) {
    bytes += output_bytes(stream, job.sequence.map_format);
  }
  return bytes;
}

struct Opened {
  std::unique_ptr<PairSource> pairs;  ///< null: the header said enough
  ImageExtent size;
  int frames = 1;
  bool knows_white = false;  ///< without looking at pixels
  std::uint64_t bytes_in = 0;
};

ImageExtent size_of_first(PairSource& pairs, FramePair& pair) {
  read_first_pair(pairs, pair);
  return {pair.left.width(), pair.left.height()};
}

Opened open_item(const BatchItem& item) {
  const RunJob& job = item.job();
  Opened opened;
  if (item.is_pair()) {
    const auto left = read_picture_header(job.input.left);
    const auto right = read_picture_header(job.input.right);
    if (left && right) {
      opened.size = {left->width_px, left->height_px};
      opened.knows_white = std::max(left->bits, right->bits) <= 8 || job.input.white_level;
      opened.bytes_in = bytes_of_files({job.input.left, job.input.right});
      return opened;
    }
  }
  opened.pairs = open_pair_source(job.input);
  FrameSelection selection;
  selection.frame_count = opened.pairs->pair_count();
  selection.frames = selected_pairs(job, *opened.pairs);
  opened.frames = selection.all().count();
  opened.bytes_in = bytes_of_files(opened.pairs->files());
  FramePair first;
  opened.size = size_of_first(*opened.pairs, first);
  return opened;
}

}  // namespace

CostModel::Sample CostModel::sample_of(const BatchItem& item, std::uint64_t options_hash,
                                       const ImageExtent& size, PairSource* pairs) {
  const std::scoped_lock lock(mutex_);
  const auto [known, is_new] = samples_.try_emplace(options_hash);
  Sample& sample = known->second;
  if (!is_new) {
    return sample;
  }
  sample = {kUsualSecondsPerCell, kUsualCandidatesPerPx, kUsualMemoryPerPixel};
  const RunJob& job = item.job();
  try {
    std::unique_ptr<PairSource> own;
    if (pairs == nullptr) {
      own = open_pair_source(job.input);
      pairs = own.get();
    }
    FramePair first;
    (void)size_of_first(*pairs, first);
    Execution one_thread(ExecutionOptions{.threads = 1});
    const PairExamination found =
        examine_pair(first.left, first.right, job.sequence.match, one_thread);
    if (found.disparities && found.seconds > 0) {
      sample.candidates_per_px = static_cast<double>(found.disparities->count()) / size.width_px;
      sample.seconds_per_cell = found.seconds / size.width_px / size.height_px /
                                static_cast<double>(found.disparities->count());
    }
    PairShape shape{.source = size, .channels = first.left.channels()};
    shape.is_video = !pairs->sound().file.empty();
    shape.is_rectified_here = !job.cameras_file().empty();
    const MemoryPlan plan =
        plan_memory(job.sequence, {.in_flight = job.in_flight, .memory_bytes = {}}, shape, first,
                    job.common.execution);
    sample.memory_per_pixel =
        static_cast<double>(plan.total_bytes) / static_cast<double>(shape.pixels());
  } catch (const Error&) {
    // The item itself will say so; the usual values stand.
  }
  return sample;
}

ItemCost CostModel::cost_of(const BatchItem& item) {
  ItemCost cost;
  cost.is_pair = item.is_pair();
  cost.options_hash = item.options_hash();
  cost.chunk_frames = item.job().sequence.chunk_frames;
  try {
    const Opened opened = open_item(item);
    const MatchOptions& match = item.job().sequence.match;
    const Sample sample = sample_of(item, cost.options_hash, opened.size, opened.pairs.get());
    const double pixels = static_cast<double>(opened.size.width_px) * opened.size.height_px;
    const double candidates = match.disparities_auto
                                  ? sample.candidates_per_px * opened.size.width_px
                                  : static_cast<double>(match.disparities.count());
    cost.frames = opened.frames;
    cost.core_seconds = opened.frames * pixels * candidates * sample.seconds_per_cell;
    cost.memory_bytes = static_cast<std::size_t>(pixels * sample.memory_per_pixel);
    cost.goes_with_others = opened.knows_white && item.goes_with_others();
    cost.bytes_in = opened.bytes_in;
    cost.bytes_out =
        static_cast<std::uint64_t>(opened.frames * pixels * bytes_per_pixel(item.job()));
  } catch (const Error& error) {
    cost.problem = error.what();
  }
  return cost;
}

}  // namespace vantage::apps
