#pragma once

#include "engine/generation/book_pairs.h"
#include "engine/sequence/pairs/pair_source.h"
#include "tests/engine/engine_test.h"

namespace vantage {

/// Random-dot pairs of 37×23 pixels made up on the spot, another one per frame.
class MadeUpPairs : public PairSource {
 public:
  explicit MadeUpPairs(int count) : count_(count) {}

  std::set<int> bad_to_fetch;
  std::set<int> bad_to_decode;
  std::set<int> narrow;  ///< pairs of another size
  std::set<int> uneven;  ///< whose left image has another size
  std::set<int> repeat;  ///< that are the pair before
  int ends_at = 1 << 30;
  int fetched = 0;
  std::function<void()> after_fetch = [] {};

  bool fetch(FramePair& pair) override {
    if (next_ >= std::min(count_, ends_at)) {
      return false;
    }
    pair.index = next_++;
    pair.remarks.clear();
    ++fetched;
    after_fetch();
    if (bad_to_fetch.contains(pair.index)) {
      throw Error("the stream is damaged");
    }
    return true;
  }
  void make_images(FramePair& pair) const override {
    if (bad_to_decode.contains(pair.index)) {
      throw Error("left " + std::to_string(pair.index) + ": is truncated");
    }
    BookPairOptions options;
    options.width_px = narrow.contains(pair.index) ? 29 : 37;
    options.height_px = 23;
    options.seed = static_cast<std::uint64_t>(pair.index - (repeat.contains(pair.index) ? 1 : 0));
    BookPair made = make_book_pair(options);
    pair.left = std::move(made.left);
    pair.right = std::move(made.right);
    if (uneven.contains(pair.index)) {
      pair.left.pixels = Image<std::uint8_t>(7, 23);
    }
  }
  void skip_to(int index) override { next_ = index; }
  [[nodiscard]] int pair_count() const override { return count_; }
  [[nodiscard]] std::string describe(int index) const override {
    return "left " + std::to_string(index) + ", right " + std::to_string(index);
  }
  [[nodiscard]] std::vector<std::string> remarks() const override { return {}; }
  [[nodiscard]] std::optional<FrameRate> frame_rate() const override { return {}; }
  [[nodiscard]] Sound sound() const override { return {}; }
  [[nodiscard]] std::vector<std::filesystem::path> files() const override { return {}; }
  [[nodiscard]] std::vector<std::string> identities() const override { return {"made up"}; }

 private:
  int count_;
  int next_ = 0;
};

}  // namespace vantage
