#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "engine/execution.h"
#include "engine/image/photograph.h"
#include "engine/matching/costs/image_gradient.h"
#include "engine/matching/costs/intensity_planes.h"
#include "engine/matching/parameters/method_parameters.h"
#include "kernels/candidates.h"

namespace vantage {

/// Columns before and after the image.
struct PlaneMargins {
  int before = 0;
  int after = 0;
};

/// Margins for every lane of every candidate of `geometry`, that of a left-reference map.
PlaneMargins margins_of(const kernels::CandidateGeometry& geometry);

/// Columns of an image at x + index / count. If partners lie between pixels, the planes of an image
/// are computed once per phase, each time from the image resampled at those columns.
struct SamplePhase {
  int index = 0;
  int count = 1;

  [[nodiscard]] bool is_whole() const { return index == 0; }
};

/// A photograph as costs read it, and the shape of the planes computed from it.
struct PlaneSource {
  const Photograph& photograph;
  int channels;  ///< 1 (luma) or 3
  PlaneMargins margins;
  bool has_mirrored;
  bool has_unmirrored;  ///< of samples between pixels
  SamplePhase phase;
  Execution& execution;
  bool is_at_phase = false;  ///< the photograph has been sampled at the columns of its phase

  [[nodiscard]] int width() const { return photograph.width(); }
  [[nodiscard]] int height() const { return photograph.height(); }
  /// Writes the intensities of luma.
  void luma_row(int y, float* intensities) const;
  /// Writes the intensities of one channel, or of luma if there are no channels.
  void channel_row(std::size_t channel, int y, float* intensities) const;

  /// Calls body(channel).
  template <typename Body>
  void for_each_channel(const Body& body) const {
    for (int c = 0; c < channels; ++c) {
      body(static_cast<std::size_t>(c));
    }
  }
  /// Calls body(y), in parallel.
  template <typename Body>
  void for_each_row(const Body& body) const {
    execution.for_each_band(height(), [&](int first_row, int end_row) {
      for (int y = first_row; y < end_row; ++y) {
        body(y);
      }
    });
  }
  /// Calls body(channel, y), in parallel.
  template <typename Body>
  void for_each_channel_row(const Body& body) const {
    execution.for_each_band(height(), [&](int first_row, int end_row) {
      for_each_channel([&](std::size_t c) {
        for (int y = first_row; y < end_row; ++y) {
          body(c, y);
        }
      });
    });
  }
};

/// mirrored[x] = row[width − 1 − x]; rows do not overlap.
template <typename T>
void mirror_row(const T* row, int width, T* mirrored) {
  int x = 0;
  if constexpr (sizeof(T) == 1) {  // eight at a time, in an eighth of the time
    for (; x + 8 <= width; x += 8) {
      std::uint64_t bytes = 0;
      std::memcpy(&bytes, row + width - x - 8, sizeof bytes);
      bytes = __builtin_bswap64(bytes);
      std::memcpy(mirrored + x, &bytes, sizeof bytes);
    }
  }
  std::reverse_copy(row, row + width - x, mirrored + x);
}

/// One quantity per pixel. If the image is the partner of a left reference, also a copy with
/// mirrored rows. With several phases, partners have rows of their own, whose samples are those of
/// all phases in order.
template <typename T>
struct FeaturePlane {
  IntensityPlane<T> plain;
  IntensityPlane<T> mirrored;
  IntensityPlane<T> between;  ///< with several phases: not mirrored, for a right reference

  void resize(const PlaneSource& source) {
    const auto [before, after] = source.margins;
    plain.resize(source.width(), source.height(), before, after);
    const int samples = last_sample(source) + 1;
    if (source.has_mirrored) {
      mirrored.resize(samples, source.height(), before, after);
    }
    if (source.has_unmirrored && source.phase.count > 1) {
      between.resize(samples, source.height(), before, after);
    }
  }
  /// Writes the margins of plain row y, whose pixels must be filled, and the samples of partners.
  /// With several phases, phase 0 comes last.
  void finish_row(const PlaneSource& source, int y) {
    plain.fill_margins(y);
    if (source.phase.count > 1) {
      finish_phase(source, y);
    } else if (source.has_mirrored) {
      mirror_row(plain.row(y), source.width(), mirrored.row(y));
      mirrored.fill_margins(y);
    }
  }
  /// The rows of an image that is a partner.
  [[nodiscard]] const IntensityPlane<T>& of_partner(bool is_mirrored, int phases) const {
    return is_mirrored ? mirrored : phases > 1 ? between : plain;
  }
  [[nodiscard]] std::size_t held_bytes() const {
    return plain.held_bytes() + mirrored.held_bytes() + between.held_bytes();
  }

 private:
  static int last_sample(const PlaneSource& source) {
    return source.phase.count * (source.width() - 1);
  }
  void finish_phase(const PlaneSource& source, int y) {
    const auto [index, count] = source.phase;
    const int last = last_sample(source);
    const T* const pixels = plain.row(y);
    // The last column of other phases lies outside the image.
    const int columns = source.width() - (index > 0 ? 1 : 0);
    for (int x = 0; source.has_mirrored && x < columns; ++x) {
      mirrored.row(y)[last - (count * x + index)] = pixels[x];
    }
    for (int x = 0; source.has_unmirrored && x < columns; ++x) {
      between.row(y)[count * x + index] = pixels[x];
    }
    if (index == 0 && source.has_mirrored) {
      mirrored.fill_margins(y);
    }
    if (index == 0 && source.has_unmirrored) {
      between.fill_margins(y);
    }
  }
};

/// `kPlanes` quantities of one channel, and of every channel.
template <typename T, std::size_t kPlanes>
using PlaneSet = std::array<FeaturePlane<T>, kPlanes>;
template <typename T, std::size_t kPlanes>
using ChannelPlanes = std::array<PlaneSet<T, kPlanes>, 3>;

/// Total held bytes of an image or of an array of images, also nested.
template <typename Images>
[[nodiscard]] std::size_t held_bytes_of(const Images& images) {
  if constexpr (requires { images.held_bytes(); }) {
    return images.held_bytes();
  } else {
    std::size_t bytes = 0;
    for (const auto& image : images) {
      bytes += held_bytes_of(image);
    }
    return bytes;
  }
}

/// Intensities that features are computed from, with filter margins; they are not compared.
using FilterIntensities = std::array<IntensityPlane<float>, 3>;
void prepare_filter_intensities(const PlaneSource& source, FilterIntensities& intensities);

/// The planes that a cost reads of one image. Working memory.
class CostPlanes {
 public:
  CostPlanes() = default;
  CostPlanes(const CostPlanes&) = delete;
  CostPlanes& operator=(const CostPlanes&) = delete;
  virtual ~CostPlanes() = default;

  /// Fills the planes. Identical for any source.execution.
  virtual void prepare(const PlaneSource& source, const MethodParameters& parameters) = 0;
  [[nodiscard]] virtual std::size_t held_bytes() const = 0;
};

}  // namespace vantage
