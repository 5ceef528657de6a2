#include <bit>
#include <cstddef>

#include "kernels/census/census.h"

namespace vantage::kernels {

void census_code_row_ref(const CensusRows& rows, int width, std::uint32_t* first_half,
                         std::uint32_t* second_half) {
  for (int x = 0; x < width; ++x) {
    const float centre = rows[kCensusRadiusY][x];
    std::uint64_t code = 0;
    for (const float* row : rows) {
      for (int u = -kCensusRadiusX; u <= kCensusRadiusX; ++u) {
        if (u != 0 || row != rows[kCensusRadiusY]) {
          code = 2 * code + (row[x + u] < centre ? 1 : 0);
        }
      }
    }
    first_half[x] = static_cast<std::uint32_t>(code >> 31U);
    second_half[x] = static_cast<std::uint32_t>(code & 0x7FFFFFFFU);
  }
}

void ray_census_code_row_ref(const RayCensusRows& rows, int width, int thresholds,
                             const RayCensusCodes& codes) {
  for (int x = 0; x < width; ++x) {
    const float centre = rows[kRayCensusRadius][x];
    std::uint32_t upper = 0;
    std::uint32_t lower = 0;
    for (const PixelOffset& offset : kRayCensusOffsets) {
      const float level =
          rows[static_cast<std::size_t>(kRayCensusRadius + offset.rows)][x + offset.columns];
      const int more_than = (level < centre - kRayCensusMargin ? 1 : 0) + (level < centre ? 1 : 0) +
                            (level < centre + kRayCensusMargin ? 1 : 0);
      upper = 2 * upper + (more_than >= 2 ? 1U : 0U);
      lower = 2 * lower + (more_than % 2 == 1 ? 1U : 0U);
    }
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      const std::size_t shift = 8 * (kRayCensusBytes - 1 - p);
      codes[p][x] = static_cast<std::uint8_t>(upper >> shift);
      if (thresholds > 1) {
        codes[kRayCensusBytes + p][x] = static_cast<std::uint8_t>(lower >> shift);
      }
    }
  }
}

void byte_ray_census_code_row_ref(const ByteRayCensusRows& rows, int width,
                                  const RayCensusCodes& codes) {
  for (int x = 0; x < width; ++x) {
    for (std::size_t p = 0; p < kRayCensusBytes; ++p) {
      unsigned code = 0;
      for (std::size_t bit = 0; bit < 8; ++bit) {
        const auto [columns, down] = kRayCensusOffsets[8 * p + bit];
        const std::uint8_t* const row = rows[static_cast<std::size_t>(kRayCensusRadius + down)];
        code = 2 * code + (row[x + columns] < rows[kRayCensusRadius][x] ? 1U : 0U);
      }
      codes[p][x] = static_cast<std::uint8_t>(code);
    }
  }
}

void hamming_row_ref(const CensusPairs& row, float* cells) {
  for (int j = 0; j < row.columns; ++j) {
    for (int i = 0; i < row.lanes; ++i) {
      const int k = j * row.partner_step + i;
      int different = 0;
      for (int c = 0; c < row.channels; ++c) {
        const auto& [reference, partner] = row.channel[static_cast<std::size_t>(c)];
        different += std::popcount(reference[0][j] ^ partner[0][k]) +
                     std::popcount(reference[1][j] ^ partner[1][k]);
      }
      const auto distance = static_cast<float>(different);
      cells[j * row.lanes + i] = row.channels > 1 ? distance * (1.0F / 3.0F) : distance;
    }
  }
}

}  // namespace vantage::kernels
