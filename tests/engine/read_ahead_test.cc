#include "engine/io/store/read_ahead.h"

#include <latch>

#include "tests/engine/engine_test.h"

namespace vantage::read_ahead_test {

using Bytes = std::vector<std::uint8_t>;

TEST(ReadAhead, FetchesManyAtATime) {
  constexpr int kMany = 8;
  std::latch all(kMany);
  ReadAhead ahead([&](const std::string& address) {
    all.arrive_and_wait();  // one after the other they would wait without end
    return Bytes(address.begin(), address.end());
  });
  for (int n = 0; n < kMany; ++n) {
    ahead.begin(std::to_string(n));
    ahead.begin(std::to_string(n));  // which has begun
  }
  for (int n = kMany - 1; n >= 0; --n) {
    const std::string address = std::to_string(n);
    EXPECT_EQ(ahead.take(address), Bytes(address.begin(), address.end()));
    EXPECT_EQ(ahead.take(address), std::nullopt);
  }
  EXPECT_EQ(ahead.take("other"), std::nullopt);
}

TEST(ReadAhead, GivesErrorsToWhoeverReads) {
  ReadAhead ahead([](const std::string& address) -> Bytes { throw Error(address + ": gone"); });
  ahead.begin("a");
  EXPECT_THROW(ahead.take("a"), Error);
  EXPECT_EQ(ahead.take("a"), std::nullopt);  // the next attempt asks the store
}

TEST(ReadAhead, HoldsAFewOfWhatNobodyTakes) {
  std::atomic<int> fetched = 0;
  ReadAhead ahead([&](const std::string&) {
    ++fetched;
    return Bytes();
  });
  for (int n = 0; n < 200; ++n) {
    ahead.begin(std::to_string(n));
    while (fetched <= n) {
      std::this_thread::yield();
    }
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  int held = 0;
  for (int n = 0; n < 200; ++n) {
    held += ahead.take(std::to_string(n)) ? 1 : 0;
  }
  EXPECT_LE(held, 32);
  EXPECT_GE(held, 1);
}

}  // namespace vantage::read_ahead_test
