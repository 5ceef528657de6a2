#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/synthesis/soft_outlines.h"
#include "engine/synthesis/synthesis_options.h"
#include "kernels/intensity_sums/intensity_sums.h"

namespace vantage {

/// A blended scanline of a new view.
struct BlendedScanline {
  int y = 0;
  const kernels::WarpedPairRow& warped;
  const float* disparity_px = nullptr;  ///< NaN = hole
  int holes = 0;                        ///< how many
};

/// Where the outlines of a view lie. Mapped along rows: s of both cameras, see OutlineRow; else
/// what surfaces cover of its pixels.
using OutlinePlaces = std::variant<std::array<double, 2>, EdgeCoverage>;

/// Turns blended scanlines into a finished view: fills holes and softens outlines. In the order
/// that the way of filling needs: most of it row by row, inpainting once all rows are there.
///
/// Thread rule: finish_row() may be called concurrently for different rows, and once for each;
/// finish_view() after all of them. Does not own what it is given, which must outlive it. T is
/// uint8_t, uint16_t or float.
template <typename T>
class ViewFinisher {
 public:
  /// `sources`: which images the pixels of the view are made of; filled ones are marked 0.
  ViewFinisher(const SynthesisOptions& options, double alpha, OutlinePlaces outlines,
               ImageView<T> image, ImageView<std::uint8_t> sources, Execution& execution);

  /// Whether `options` soften the outlines of a view with that α: not where a camera stands, which
  /// shows its own picture.
  static bool softens(const SynthesisOptions& options, double alpha);

  /// BlendWeights::trust_at_ends of such a view.
  static float trust_at_ends(const SynthesisOptions& options, double alpha);

  /// Memory of a view of that shape, beside rows per thread.
  static std::size_t working_bytes(const SynthesisOptions& options, int width, int height,
                                   int channels);
  /// At most what it takes beside that where the outlines are those of surfaces.
  static std::size_t surface_outline_bytes(int width, int height, int channels);

  void finish_row(const BlendedScanline& row);
  void finish_view();

 private:
  // Where a row's disparities with filled holes, its filled pixels and its shares of neighbours go.
  struct RowMemory {
    float* disparity_px;
    std::uint8_t* filled;
    std::uint8_t* shares;
  };
  [[nodiscard]] static std::size_t row_bytes(int width);
  [[nodiscard]] RowMemory row_memory(std::byte* memory) const;
  [[nodiscard]] RowMemory kept_row(int y) const;
  [[nodiscard]] ImageView<const float> kept_disparity() const;
  void fill_row(const BlendedScanline& row, const RowMemory& memory);

  const SynthesisOptions& options_;
  double alpha_;
  bool softens_;
  OutlinePlaces outlines_;
  bool keeps_rows_;
  ImageView<T> image_;
  ImageView<std::uint8_t> sources_;
  Execution& execution_;
  scheduler::ScratchPool::Lease kept_memory_;  // of all rows, for what looks across rows
};

}  // namespace vantage
