#include "kernels/simd-inl.h"

#include <cstddef>

#include "kernels/window_correlation/window_correlation.h"

HWY_BEFORE_NAMESPACE();
namespace vantage::kernels::HWY_NAMESPACE {

// Calls body(d, x) for vectors of columns [x, end), then for single ones.
template <class Body>
HWY_INLINE void for_each_vector(int x, int end, const Body& body) {
  const hn::ScalableTag<float> d;
  for (; x + static_cast<int>(hn::Lanes(d)) <= end; x += static_cast<int>(hn::Lanes(d))) {
    body(d, x);
  }
  for (; x < end; ++x) {
    body(hn::CappedTag<float, 1>(), x);
  }
}

void correlation(const CorrelationRow& row, float here, float* best, float* place) {
  float* const sums = row.sums;
  for_each_vector(row.begin - 1, row.end + 1, [&](auto d, int x) HWY_ATTR {
    auto sum = hn::Zero(d);
    for (std::size_t i = 0; i < static_cast<std::size_t>(row.rows); ++i) {
      sum =
          hn::Add(sum, hn::Mul(hn::LoadU(d, row.values[i] + x), hn::LoadU(d, row.partners[i] + x)));
    }
    hn::StoreU(sum, d, sums + x);
  });
  for_each_vector(row.begin, row.end, [&](auto d, int x) HWY_ATTR {
    const auto window = hn::Add(hn::Add(hn::LoadU(d, sums + x - 1), hn::LoadU(d, sums + x)),
                                hn::LoadU(d, sums + x + 1));
    const auto r =
        hn::Mul(hn::Mul(window, hn::LoadU(d, row.scale + x)), hn::LoadU(d, row.partner_scale + x));
    const auto before = hn::LoadU(d, best + x);
    const auto is_better = hn::Gt(r, before);
    hn::StoreU(hn::IfThenElse(is_better, hn::Set(d, here), hn::LoadU(d, place + x)), d, place + x);
    hn::StoreU(hn::IfThenElse(is_better, r, before), d, best + x);
  });
}

void add_partners(const float* correlation, const float* place, const float* before, float offset,
                  float peak_radius, int width, const BestPartners& best) {
  for_each_vector(0, width, [&](auto d, int x) HWY_ATTR {
    const auto here = hn::Set(d, offset);
    const auto now = hn::LoadU(d, correlation + x);
    const auto known = hn::LoadU(d, best.correlation + x);
    const auto at = hn::LoadU(d, best.offset + x);
    const auto second = hn::LoadU(d, best.second + x);
    const auto is_better = hn::Gt(now, known);
    const auto is_apart = hn::Gt(hn::Sub(here, at), hn::Set(d, peak_radius));
    const auto larger = hn::IfThenElse(hn::And(is_apart, hn::Gt(now, second)), now, second);
    hn::StoreU(hn::IfThenElse(is_better, hn::LoadU(d, before + x), larger), d, best.second + x);
    hn::StoreU(hn::IfThenElse(is_better, now, known), d, best.correlation + x);
    hn::StoreU(hn::IfThenElse(is_better, here, at), d, best.offset + x);
    hn::StoreU(hn::IfThenElse(is_better, hn::LoadU(d, place + x), hn::LoadU(d, best.place + x)), d,
               best.place + x);
  });
}

}  // namespace vantage::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vantage::kernels {
HWY_EXPORT(correlation);
HWY_EXPORT(add_partners);

void correlation_row(const CorrelationRow& row, float here, float* best, float* place) {
  HWY_DYNAMIC_DISPATCH(correlation)(row, here, best, place);
}
void add_partners_row(const float* correlation, const float* place, const float* before,
                      float offset, float peak_radius, int width, const BestPartners& best) {
  HWY_DYNAMIC_DISPATCH(add_partners)(correlation, place, before, offset, peak_radius, width, best);
}

}  // namespace vantage::kernels
#endif
