#pragma once

#include <cstdint>
#include <optional>

#include "engine/image/image.h"
#include "engine/image/photograph.h"

namespace vantage {

/// IV-PSNR of two pictures of equal size in dB, +inf for equal ones: PSNR that forgives what the
/// eye does in new views, shifts of up to two pixels and a slight difference of the whole picture.
///
/// The components are Y, Cb, Cr (Rec. 601), or luma alone if one picture is grey. The mean
/// difference of each component over the counted pixels, limited to 1 % of the range, is added to
/// the first picture. Each of its pixels is compared with that of the 5×5 pixels around its place
/// in the other (inside the picture) for which the squared differences, weighted 4:1:1, are least.
/// The PSNR of the components, at most 100 dB unless all agree, are weighted 4:1:1; the lower
/// result of both directions counts. Pixels count whose mask is 255 (no mask: all).
///
/// A. Dziembowski, D. Mieloch, J. Stankowski, A. Grzelka: IV-PSNR – the objective quality metric
/// for immersive video applications. IEEE TCSVT 32(11), 2022; constants: defaults of MPEG's
/// software.
///
/// Errors: Error when sizes differ or no pixel counts. Thread rule: pure.
double immersive_psnr_db(const Photograph& view, const Photograph& truth,
                         std::optional<ImageView<const std::uint8_t>> mask = {});

}  // namespace vantage
