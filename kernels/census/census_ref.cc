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

void small_census_code_row_ref(const SmallCensusRows& rows, int width,
                               const SmallCensusCodes& codes) {
  for (int x = 0; x < width; ++x) {
    const float centre = rows[kSmallCensusRadius][x];
    std::uint32_t code = 0;
    for (const float* row : rows) {
      for (int u = -kSmallCensusRadius; u <= kSmallCensusRadius; ++u) {
        if (u != 0 || row != rows[kSmallCensusRadius]) {
          code = 2 * code + (row[x + u] < centre ? 1 : 0);
        }
      }
    }
    codes[0][x] = static_cast<std::uint8_t>(code >> 16U);
    codes[1][x] = static_cast<std::uint8_t>(code >> 8U);
    codes[2][x] = static_cast<std::uint8_t>(code);
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
