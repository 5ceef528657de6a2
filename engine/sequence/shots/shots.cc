#include "engine/sequence/shots/shots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <set>

#include "engine/error.h"
#include "engine/image/finite_values.h"
#include "engine/matching/range_estimation.h"
#include "engine/matching/stereo_matcher.h"
#include "engine/order_statistics.h"
#include "engine/sequence/shots/preview_range.h"
#include "engine/sequence/shots/shot_cuts.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage {
namespace {

constexpr double kViewOfFit = 0.5;  // baselines
constexpr double kOutside = 0.01;   // share of the disparities on either side of the range
constexpr float kWidening = 0.05F;
constexpr float kMinWideningPx = 0.5F;
constexpr std::size_t kMaxSamples = 3;  // of a shot
constexpr int kMaxRangeSamples = 5;

/// The disparities of some maps, and their preview range.
class DisparitySamples {
 public:
  void add(ImageView<const float> map_px) {
    // At once: growing would take twice the memory.
    values_.reserve(kMaxSamples * static_cast<std::size_t>(map_px.width()) *
                    static_cast<std::size_t>(map_px.height()));
    add_finite_values(map_px, values_);
  }
  [[nodiscard]] bool empty() const { return values_.empty(); }
  [[nodiscard]] PreviewRange range() {
    const float min = percentile(values_, kOutside);
    const float max = percentile(values_, 1 - kOutside);
    const float margin = std::max(kMinWideningPx, kWidening * (max - min));
    return {min - margin, max + margin};
  }
  void clear() { values_.clear(); }

 private:
  std::vector<float> values_;
};

/// One survey.
class Survey {
 public:
  Survey(PairSource& pairs, const SequenceOptions& options, const SurveyHooks& hooks,
         Execution& execution)
      : pairs_(pairs),
        options_(options),
        hooks_(hooks),
        execution_(execution),
        synthesizer_(options.synthesis, execution) {}

  [[nodiscard]] std::optional<ShotTable> run(int first_frame, int end_frame) {
    progress_.frames_total = end_frame - first_frame;
    const std::optional<ShotCuts> cuts = find_cuts(first_frame, end_frame);
    if (!cuts) {
      return std::nullopt;
    }
    ShotTable table = shots_at(*cuts, {first_frame, end_frame}, options_);
    for (const Shot& shot : table.shots) {
      progress_.frames_total += static_cast<int>(
          (options_.search_scope == SearchScope::kShot ? range_samples_of(shot).size() : 0) +
          (options_.needs_matched_shots() ? samples_of(shot).size() : 0));
    }
    // Each step in the order of the frames: videos without an index are decoded from their start.
    for (Shot& shot : table.shots) {
      if (options_.search_scope == SearchScope::kShot && !find_range(shot)) {
        return std::nullopt;
      }
    }
    for (Shot& shot : table.shots) {
      if (options_.needs_matched_shots() && !fit(shot)) {
        return std::nullopt;
      }
    }
    return table;
  }

 private:
  [[nodiscard]] bool is_stopped() const { return hooks_.stop != nullptr && hooks_.stop->load(); }
  void report(int frames) {
    progress_.frames_done += frames;
    if (hooks_.progress) {
      hooks_.progress(progress_);
    }
  }

  /// False at the end of the sequence; a pair that cannot be fetched has no thumbnail.
  bool fetch(FramePair& pair, bool& is_good) {
    try {
      is_good = true;
      return pairs_.fetch(pair);
    } catch (const Error&) {
      is_good = false;
      return true;
    }
  }

  /// Frames are fetched one after the other, and processed in parallel in batches.
  [[nodiscard]] std::optional<ShotCuts> find_cuts(int first_frame, int end_frame) {
    struct Slot {
      FramePair pair;
      bool is_good = false;
      std::optional<Thumbnail> thumbnail;
    };
    std::vector<Slot> slots(static_cast<std::size_t>(
        std::clamp(execution_.executor().thread_count(), 1, hooks_.in_flight)));
    ShotCuts cuts;
    pairs_.skip_to(first_frame);
    for (int frame = first_frame; frame < end_frame;) {
      if (is_stopped()) {
        return std::nullopt;
      }
      int count = 0;
      while (count < static_cast<int>(slots.size()) && frame < end_frame) {
        Slot& slot = slots[static_cast<std::size_t>(count)];
        slot.pair.wants_right = false;
        if (!fetch(slot.pair, slot.is_good)) {
          frame = end_frame;
          break;
        }
        ++count;
        ++frame;
      }
      execution_.executor().parallel_for(count, [&](int k) {
        Slot& slot = slots[static_cast<std::size_t>(k)];
        slot.thumbnail = slot.is_good ? thumbnail_of(slot.pair) : std::nullopt;
      });
      for (int k = 0; k < count; ++k) {
        cuts.add(slots[static_cast<std::size_t>(k)].thumbnail);
      }
      report(count);
    }
    return cuts;
  }

  [[nodiscard]] std::optional<Thumbnail> thumbnail_of(FramePair& pair) const {
    try {
      pairs_.decode(pair);
      return make_thumbnail(pair.left);
    } catch (const UsageError&) {
      throw;
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  /// First, middle and last frame, without duplicates.
  [[nodiscard]] static std::vector<int> samples_of(const Shot& shot) {
    const std::set<int> frames = {shot.first_frame,
                                  shot.first_frame + (shot.end_frame - 1 - shot.first_frame) / 2,
                                  shot.end_frame - 1};
    return {frames.begin(), frames.end()};
  }

  /// Evenly spaced from the first to the last frame.
  [[nodiscard]] static std::vector<int> range_samples_of(const Shot& shot) {
    const int count = std::min(shot.end_frame - shot.first_frame, kMaxRangeSamples);
    std::vector<int> frames;
    for (int i = 0; i < count; ++i) {
      const long long span = shot.end_frame - 1 - shot.first_frame;
      frames.push_back(shot.first_frame +
                       (count == 1 ? 0 : static_cast<int>(span * i / (count - 1))));
    }
    return frames;
  }

  /// False when stopped.
  bool find_range(Shot& shot) {
    for (const int frame : range_samples_of(shot)) {
      if (is_stopped()) {
        return false;
      }
      try {
        if (const auto range = take_pair(frame)
                                   ? find_disparity_range(pair_.left, pair_.right, execution_,
                                                          {0, 0}, Infinity::kAnywhere)
                                   : std::nullopt) {
          shot.search = shot.search ? DisparityRange{std::min(shot.search->min, range->min),
                                                     std::max(shot.search->max, range->max)}
                                    : *range;
        }
      } catch (const UsageError&) {
        throw;
      } catch (const Error&) {
        // The run will report the problem.
      }
      report(1);
    }
    return true;
  }

  /// False after the end of the input.
  bool take_pair(int frame) {
    pairs_.skip_to(frame);
    if (!pairs_.fetch(pair_)) {
      return false;
    }
    pairs_.decode(pair_);
    if (hooks_.prepare) {
      hooks_.prepare(pair_);
    }
    return true;
  }

  /// False when stopped.
  bool fit(Shot& shot) {
    kernels::IntensitySums sums;
    int channels = 0;
    disparities_.clear();
    MatchOptions options = options_.match;
    options.disparities = shot.search.value_or(options.disparities);
    const StereoMatcher matcher(options, execution_);
    for (const int frame : samples_of(shot)) {
      if (is_stopped()) {
        return false;
      }
      try {
        add_sample(frame, matcher, sums);
        channels = pair_.left.channels();
      } catch (const UsageError&) {
        throw;
      } catch (const Error&) {
        // The run will report the problem.
      }
      report(1);
    }
    shot.intensity = fit_channels(sums, channels, 1);
    if (!disparities_.empty()) {
      shot.preview_range = disparities_.range();
    }
    return true;
  }

  void add_sample(int frame, const StereoMatcher& matcher, kernels::IntensitySums& sums) {
    if (!take_pair(frame)) {
      return;
    }
    matcher.match(pair_.left, pair_.right, {}, maps_);
    const bool is_left = options_.match.reference == Side::kLeft;
    disparities_.add(is_left ? maps_.left.disparity_px.view() : maps_.right.disparity_px.view());
    sums.add(synthesizer_.intensity_sums(
        {pair_.left, pair_.right, maps_.left.disparity_px.view(), maps_.right.disparity_px.view()},
        kViewOfFit));
  }

  PairSource& pairs_;
  const SequenceOptions& options_;
  const SurveyHooks& hooks_;
  Execution& execution_;
  ViewSynthesizer synthesizer_;
  SurveyProgress progress_;
  FramePair pair_;
  DisparityMaps maps_;
  DisparitySamples disparities_;
};

}  // namespace

ShotTable shots_at(const ShotCuts& cuts, FrameRange frames, const SequenceOptions& options) {
  const auto shot_from = [&](int first_frame) {
    return Shot{.first_frame = first_frame,
                .end_frame = frames.end,
                .preview_range = preview_range_of(options.match.disparities),
                .search = std::nullopt};
  };
  ShotTable table;
  table.shots.push_back(shot_from(frames.first));
  for (const int start : cuts.shot_starts()) {
    if (start > 0) {
      table.shots.back().end_frame = frames.first + start;
      table.shots.push_back(shot_from(frames.first + start));
    }
  }
  return table;
}

const Shot& ShotTable::shot_of(int frame) const {
  const auto after =
      std::upper_bound(shots.begin(), shots.end(), frame,
                       [](int number, const Shot& shot) { return number < shot.first_frame; });
  return after == shots.begin() ? shots.front() : *std::prev(after);
}

std::optional<ShotTable> survey_shots(PairSource& pairs, int first_frame, int end_frame,
                                      const SequenceOptions& options, const SurveyHooks& hooks,
                                      Execution& execution) {
  return Survey(pairs, options, hooks, execution).run(first_frame, end_frame);
}

}  // namespace vantage
