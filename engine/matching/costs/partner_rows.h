#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "engine/matching/costs/cost_image.h"
#include "engine/matching/costs/cost_planes.h"
#include "kernels/candidate_gather/candidate_gather.h"
#include "kernels/candidates.h"
#include "kernels/feature_pairs.h"
#include "scheduler/range.h"

namespace vantage {

/// Memory for the gathered features of one block of columns, taken piece by piece.
class GatherMemory {
 public:
  GatherMemory(std::byte* begin, std::size_t bytes) : next_(begin), end_(begin + bytes) {}

  template <typename T>
  [[nodiscard]] T* take(std::size_t count) {
    auto* const taken = reinterpret_cast<T*>(next_);
    next_ += (count * sizeof(T) + alignof(float) - 1) / alignof(float) * alignof(float);
    if (next_ > end_) {
      throw std::logic_error("a cost gathers more than kMaxFeatureBytes per candidate");
    }
    return taken;
  }

 private:
  std::byte* next_;
  std::byte* end_;
};

/// Rows of a reference image and of one partner, as kernels compare them. Thread rule: immutable.
class PartnerRows {
 public:
  /// Upper limit of the bytes that a cost compares per pixel: three channels of three floats.
  static constexpr std::size_t kMaxFeatureBytes = 3 * 3 * sizeof(float);

  /// `geometry`: of the map. Throws UsageError for a baseline ratio that is 0 or not finite.
  PartnerRows(const CostImage& reference, const CostPartner& partner,
              const kernels::CandidateGeometry& geometry);

  /// Whether candidates are not neighbouring samples, so that partners are looked up one by one.
  [[nodiscard]] bool is_gathered() const { return !offsets_.empty(); }
  /// Bytes of working memory that pairs() needs for this number of columns.
  [[nodiscard]] std::size_t gather_bytes(int columns) const;
  /// Number of compared channels: 1 or 3.
  [[nodiscard]] int channels() const;

  /// Whether the partners of row y lie inside the other image.
  [[nodiscard]] bool has_row(int y) const;
  /// Candidates of pixel (x, y) whose partner's column lies inside.
  [[nodiscard]] kernels::CandidateRange with_partner(int x, int y) const;
  /// Columns where the partners of all candidates lie inside; begin may exceed end.
  [[nodiscard]] kernels::CandidateRange columns_with_all_partners() const;
  /// Candidates as counted in this partner, whose direction may be opposite. Of a gathered partner,
  /// only count and lanes are meaningful.
  [[nodiscard]] const kernels::CandidateGeometry& geometry() const { return geometry_; }

  /// The first `used` of the cost's `planes` for every channel, at the columns of row y and at
  /// their partners. Rows outside are replaced by the nearest one. `memory`: for what is gathered;
  /// null if is_gathered() is false.
  template <typename Planes, typename T, std::size_t kPlanes>
  [[nodiscard]] kernels::FeaturePairs<T, static_cast<int>(kPlanes)> pairs(
      int y, scheduler::Range columns, GatherMemory* memory,
      std::array<std::array<FeaturePlane<T>, kPlanes>, 3> Planes::*planes,
      std::size_t used = kPlanes) const {
    const auto& of_reference = static_cast<const Planes&>(reference_.planes()).*planes;
    auto row = empty_pairs<T, kPlanes>(columns, channels());
    const Part part{y, columns, memory};
    for (int c = 0; c < row.channels; ++c) {
      // With a colour image, a grey image has the same intensity in all channels.
      set_channel(
          of_reference[channel_of(reference_, c)],
          [&](int phase) -> const auto& {
            const CostImage& image = (&partner_)[phase];
            return (static_cast<const Planes&>(image.planes()).*planes)[channel_of(image, c)];
          },
          part, used, row.channel[static_cast<std::size_t>(c)]);
    }
    return row;
  }
  /// As above, for planes of luma.
  template <typename Planes, typename T, std::size_t kPlanes>
  [[nodiscard]] kernels::FeaturePairs<T, static_cast<int>(kPlanes)> pairs(
      int y, scheduler::Range columns, GatherMemory* memory,
      std::array<FeaturePlane<T>, kPlanes> Planes::*planes) const {
    auto row = empty_pairs<T, kPlanes>(columns, 1);
    set_channel(
        static_cast<const Planes&>(reference_.planes()).*planes,
        [&](int phase) -> const auto& {
          return static_cast<const Planes&>((&partner_)[phase].planes()).*planes;
        },
        {y, columns, memory}, kPlanes, row.channel[0]);
    return row;
  }

 private:
  /// Part of a row to pair, with the memory for what is gathered.
  struct Part {
    int y;
    scheduler::Range columns;
    GatherMemory* memory;
  };
  template <typename T, std::size_t kPlanes>
  [[nodiscard]] kernels::FeaturePairs<T, static_cast<int>(kPlanes)> empty_pairs(
      scheduler::Range columns, int channels) const {
    kernels::FeaturePairs<T, static_cast<int>(kPlanes)> row;
    row.channels = channels;
    row.lanes = geometry_.lanes();
    row.partner_step = is_gathered() ? row.lanes : step();
    row.columns = columns.size();
    row.count = geometry_.count;
    return row;
  }
  /// of_partner(phase): the planes of a line between rows; phase 0 unless there are epipolar lines.
  template <typename T, std::size_t kPlanes, typename OfPartner, typename Channel>
  void set_channel(const PlaneSet<T, kPlanes>& of_reference, const OfPartner& of_partner,
                   const Part& part, std::size_t used, Channel& channel) const {
    const auto [y, columns, memory] = part;
    const auto samples = [&](int phase, std::size_t p, int row) -> const T* {
      return of_partner(phase)[p].of_partner(mirrored(), partner_.phases()).row(row);
    };
    for (std::size_t p = 0; p < used; ++p) {
      channel.reference[p] = of_reference[p].plain.row(y) + columns.begin;
      if (epipolar_ != nullptr) {
        channel.partner[p] = gathered_along_lines<T>(
            [&](int phase, int row) { return samples(phase, p, row); }, y, columns, *memory);
        continue;
      }
      const T* const row = samples(0, p, partner_row(y));
      channel.partner[p] = is_gathered() ? gathered(row, columns, *memory)
                                         : row + sample(columns.begin) + geometry_.disparity_min;
    }
  }
  template <typename T>
  [[nodiscard]] const T* gathered(const T* samples, scheduler::Range columns,
                                  GatherMemory& memory) const {
    T* const values = memory.take<T>(static_cast<std::size_t>(columns.size()) * offsets_.size());
    kernels::gather_candidates(
        {last_sample(), sample(columns.begin), step(), columns.size(), geometry_.lanes()},
        offsets_.data(), samples, values);
    return values;
  }
  /// Each pixel's partners lie on a line of its own.
  template <typename T, typename Line>
  [[nodiscard]] const T* gathered_along_lines(const Line& line, int y, scheduler::Range columns,
                                              GatherMemory& memory) const {
    T* const values = memory.take<T>(static_cast<std::size_t>(columns.size()) * offsets_.size());
    for (int x = columns.begin; x < columns.end; ++x) {
      const LineSample place = line_sample(x, y);
      kernels::gather_candidates(
          {last_sample(), place.sample, step(), 1, geometry_.lanes()}, offsets_.data(),
          line(place.phase, place.row),
          values + static_cast<std::size_t>(x - columns.begin) * offsets_.size());
    }
    return values;
  }
  static std::size_t channel_of(const CostImage& image, int channel) {
    return static_cast<std::size_t>(std::min(channel, image.channels() - 1));
  }
  [[nodiscard]] int partner_row(int y) const;
  [[nodiscard]] int last_sample() const { return partner_.phases() * (partner_.width() - 1); }
  /// The sample of a pixel at disparity 0, mirrored or not, and its line: row + phase / kPhases.
  struct LineSample {
    int phase = 0;
    int row = 0;
    int sample = 0;
  };
  [[nodiscard]] LineSample line_sample(int x, int y) const;
  /// Number of the sample at column x and shift 0 in a row of the partner, mirrored or not.
  [[nodiscard]] int sample(int x) const;
  /// Samples from column to column.
  [[nodiscard]] int step() const { return mirrored() ? -partner_.phases() : partner_.phases(); }
  [[nodiscard]] bool mirrored() const { return geometry_.direction < 0; }

  const CostImage& reference_;
  const CostImage& partner_;
  const EpipolarGrid* epipolar_;
  /// One step is one sample unless is_gathered().
  kernels::CandidateGeometry geometry_;
  int rows_down_;
  /// Sample of each lane at column 0 of the row; empty if it is disparity_min + lane.
  std::vector<int> offsets_;
};

}  // namespace vantage
