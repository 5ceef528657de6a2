#include "engine/object_pool.h"

#include "tests/engine/engine_test.h"

namespace vantage::object_pool_test {

/// Borrows an object that suits, or the one that is idle for longest, and gives it back.
int borrowed(ObjectPool<int>& pool, int wanted) {
  const ObjectPool<int>::Loan loan = pool.borrow_best([&](int value) { return value == wanted; });
  return *loan;
}

TEST(ObjectPool, LendsWhatSuitsElseWhatIsIdleForLongest) {
  ObjectPool<int> pool;
  {
    const auto first = pool.borrow(1);
    const auto second = pool.borrow(2);
    const auto third = pool.borrow(3);
  }  // given back: 3, 2, 1
  EXPECT_EQ(borrowed(pool, 2), 2);
  EXPECT_EQ(borrowed(pool, 3), 3);
  EXPECT_EQ(borrowed(pool, 9), 1);  // then 2, 3, 1
  EXPECT_EQ(borrowed(pool, 9), 2);
  EXPECT_EQ(*pool.borrow(9), 2);  // the last one
}

}  // namespace vantage::object_pool_test
