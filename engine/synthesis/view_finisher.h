#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "engine/execution.h"
#include "engine/image/image.h"
#include "engine/synthesis/background_interpolation.h"
#include "engine/synthesis/row_bands.h"
#include "engine/synthesis/soft_outlines.h"
#include "engine/synthesis/synthesis_options.h"
#include "kernels/intensity_sums/intensity_sums.h"

namespace vantage {

/// A blended scanline of a new view.
struct BlendedScanline {
  int y = 0;
  const kernels::WarpedPairRow& warped;
  const float* disparity_px = nullptr;  ///< NaN = hole
  int holes = 0;                        ///< number of holes
};

/// Outlines of a view. Mapped along rows: s of both cameras, see OutlineRow; otherwise the coverage
/// of its pixels.
using OutlinePlaces = std::variant<std::array<double, 2>, EdgeCoverage>;

/// Finishes blended scanlines of a view: fills holes and softens outlines, in the order that the
/// hole filling needs: row by row, interpolation along rows in bands, inpainting, texture and all
/// outlines of surfaces when all rows are complete.
///
/// Thread rule: finish_row() may be called concurrently for different rows, once for each;
/// finish_view() after all of them. Does not own what it is given, which must outlive it. T is
/// uint8_t, uint16_t or float.
template <typename T>
class ViewFinisher {
 public:
  /// `sources`: source images of each pixel of the view; filled ones are set to 0.
  ViewFinisher(const SynthesisOptions& options, double alpha, OutlinePlaces outlines,
               ImageView<T> image, ImageView<std::uint8_t> sources, Execution& execution);

  /// Whether `options` soften the outlines of a view with that α: false at a camera's position,
  /// where the view is its picture.
  static bool softens(const SynthesisOptions& options, double alpha);

  /// BlendWeights::trust_at_ends of such a view.
  static float trust_at_ends(const SynthesisOptions& options, double alpha);

  /// Bytes for a view of that shape, besides rows per thread.
  static std::size_t working_bytes(const SynthesisOptions& options, int width, int height,
                                   int channels);
  /// Upper bound of additional bytes if outlines are those of surfaces.
  static std::size_t surface_outline_bytes(int width, int height, int channels);

  void finish_row(const BlendedScanline& row);
  void finish_view();

 private:
  // Buffers of a row: disparities with filled holes, filled pixels and shares of neighbours.
  struct RowMemory {
    float* disparity_px;
    std::int32_t* outlines;  // their number
    std::uint8_t* filled;
    std::uint8_t* shares;
  };
  [[nodiscard]] static std::size_t row_bytes(int width);
  [[nodiscard]] RowMemory row_memory(std::byte* memory) const;
  [[nodiscard]] RowMemory kept_row(int y) const;
  [[nodiscard]] ImageView<const float> kept_disparity() const;
  [[nodiscard]] ImageView<const std::uint8_t> kept_filled() const;
  void fill_row(const BlendedScanline& row, const RowMemory& memory);
  void make_row(const BlendedScanline& row, const RowMemory& memory);
  void interpolate_rows(int first, int end);
  void mix_outlines(int y, const RowMemory& memory);

  const SynthesisOptions& options_;
  double alpha_;
  bool softens_;
  OutlinePlaces outlines_;
  bool keeps_rows_;
  ImageView<T> image_;
  ImageView<std::uint8_t> sources_;
  Execution& execution_;
  scheduler::ScratchPool::Lease kept_memory_;  // of all rows, for steps over the whole image
  scheduler::ScratchPool::Lease hole_rows_memory_;
  std::span<HoleRow> hole_rows_;   // for interpolation
  std::optional<RowBands> bands_;  // for interpolation, if rows are not kept
};

}  // namespace vantage
