#pragma once

#include "kernels/feature_pairs.h"
#include "tests/kernels/kernel_test_utils.h"

namespace vantage::kernels {

/// The ways candidates of neighbouring columns follow each other.
enum class PartnerOrder { kPlain, kMirrored, kOwnRows };
inline constexpr PartnerOrder kPartnerOrders[] = {PartnerOrder::kPlain, PartnerOrder::kMirrored,
                                                  PartnerOrder::kOwnRows};

/// Rows to compare, filled by `draw()`, which hold exactly what kernels may read.
template <typename T, int kPlanes>
class FeatureRows {
 public:
  template <typename Draw>
  FeatureRows(std::mt19937& random, int channels, PartnerOrder order, int columns, int lanes,
              const Draw& draw) {
    pairs_.channels = channels;
    pairs_.columns = columns;
    pairs_.lanes = lanes;
    pairs_.count = random_int(random, std::max(1, lanes - 20), lanes);
    pairs_.partner_step = order == PartnerOrder::kPlain      ? 1
                          : order == PartnerOrder::kMirrored ? -1
                                                             : lanes;
    const int partners = order == PartnerOrder::kOwnRows ? columns * lanes : columns - 1 + lanes;
    const int first_partner = order == PartnerOrder::kMirrored ? columns - 1 : 0;
    rows_.reserve(static_cast<std::size_t>(2 * kPlanes * channels));
    for (int c = 0; c < channels; ++c) {
      auto& channel = pairs_.channel[c];
      for (std::size_t p = 0; p < kPlanes; ++p) {
        channel.reference[p] = add_row(random, columns, draw);
        channel.partner[p] = add_row(random, partners, draw) + first_partner;
      }
    }
  }
  FeatureRows(const FeatureRows&) = delete;
  FeatureRows& operator=(const FeatureRows&) = delete;

  [[nodiscard]] const FeaturePairs<T, kPlanes>& pairs() const { return pairs_; }

 private:
  template <typename Draw>
  const T* add_row(std::mt19937& random, int size, const Draw& draw) {
    rows_.emplace_back(static_cast<std::size_t>(size), random() % 5);
    for (int k = 0; k < size; ++k) {
      rows_.back()[k] = draw();
    }
    return rows_.back().data();
  }

  FeaturePairs<T, kPlanes> pairs_;
  std::vector<UnalignedRow<T>> rows_;
};

/// Calls check(random, channels, order, columns, lanes) for rows of every shape.
template <typename Check>
void for_each_row_shape(unsigned seed, const Check& check) {
  std::mt19937 random(seed);
  for (const int channels : {1, 3}) {
    for (const PartnerOrder order : kPartnerOrders) {
      for (const int columns : {1, 2, 7, 19}) {
        for (const int lanes : kLaneCounts) {
          SCOPED_TRACE(testing::Message()
                       << channels << " channels, order " << static_cast<int>(order) << ", "
                       << columns << " columns, " << lanes << " lanes");
          check(random, channels, order, columns, lanes);
          if (testing::Test::HasFatalFailure()) {
            return;
          }
        }
      }
    }
  }
}

/// Calls check(rows) for random rows of every shape, and in the order of `draw(random)`'s values.
template <typename T, int kPlanes, typename Draw, typename Check>
void for_each_feature_rows(const Draw& draw, const Check& check) {
  for_each_row_shape(
      7, [&](std::mt19937& random, int channels, PartnerOrder order, int columns, int lanes) {
        const FeatureRows<T, kPlanes> rows(random, channels, order, columns, lanes,
                                           [&] { return draw(random); });
        check(rows.pairs());
      });
}

template <typename T, int kPlanes>
std::size_t cell_count(const FeaturePairs<T, kPlanes>& row) {
  return static_cast<std::size_t>(row.columns) * static_cast<std::size_t>(row.lanes);
}

}  // namespace vantage::kernels
