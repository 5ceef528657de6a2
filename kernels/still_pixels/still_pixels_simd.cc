#include "kernels/simd-inl.h"

#include <algorithm>
#include <cstdlib>

#include "kernels/still_pixels/still_pixels.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

using Tag16 = hn::ScalableTag<std::int16_t>;
using Vec16 = hn::VFromD<Tag16>;
constexpr int kStep = static_cast<int>(hn::MaxLanes(Tag16()));

// Copies the border columns to the columns outside the image.
HWY_INLINE void replicate_border(std::int16_t* row, int width) {
  row[-1] = row[0];
  row[width] = row[width - 1];
}

void box_change(const FrameRows& rows, std::int16_t* HWY_RESTRICT work,
                std::int16_t* HWY_RESTRICT change) {
  const Tag16 d;
  const hn::Rebind<std::uint8_t, Tag16> d8;
  const auto difference = [&](int k, int x) HWY_ATTR {
    return hn::Sub(hn::PromoteTo(d, hn::LoadU(d8, rows.now[k] + x)),
                   hn::PromoteTo(d, hn::LoadU(d8, rows.before[k] + x)));
  };
  for (int x = 0; x < rows.width; x += kStep) {
    const Vec16 sum = hn::Add(hn::Add(difference(0, x), difference(1, x)), difference(2, x));
    hn::StoreU(sum, d, work + x);
  }
  replicate_border(work, rows.width);
  for (int x = 0; x < rows.width; x += kStep) {
    const Vec16 sum = hn::Add(hn::Add(hn::LoadU(d, work + x - 1), hn::LoadU(d, work + x)),
                              hn::LoadU(d, work + x + 1));
    hn::StoreU(hn::Abs(sum), d, change + x);
  }
  replicate_border(change, rows.width);
}

void still(const std::int16_t* const changes[3], int width, std::int16_t limit,
           std::uint8_t* HWY_RESTRICT mask) {
  const Tag16 d;
  const hn::Rebind<std::int8_t, Tag16> d8;
  const Vec16 too_much = hn::Set(d, static_cast<std::int16_t>(limit + 1));
  const auto largest = [&](int k, int x) HWY_ATTR {
    return hn::Max(hn::Max(hn::LoadU(d, changes[k] + x - 1), hn::LoadU(d, changes[k] + x)),
                   hn::LoadU(d, changes[k] + x + 1));
  };
  for (int x = 0; x < width; x += kStep) {
    const Vec16 change = hn::Max(hn::Max(largest(0, x), largest(1, x)), largest(2, x));
    const auto is_still = hn::VecFromMask(d, hn::Lt(change, too_much));
    hn::StoreU(hn::DemoteTo(d8, is_still), d8, reinterpret_cast<std::int8_t*>(mask) + x);
  }
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(box_change);
HWY_EXPORT(still);

void box_change_row(const FrameRows& rows, std::int16_t* work, std::int16_t* change) {
  HWY_DYNAMIC_DISPATCH(box_change)(rows, work, change);
}
void still_row(const std::int16_t* const changes[3], int width, std::int16_t limit,
               std::uint8_t* still) {
  HWY_DYNAMIC_DISPATCH(still)(changes, width, limit, still);
}

}  // namespace vantage::kernels
#endif
