// The targets without libFuzzer: on inputs that once were finds, or show what a format has
// (regressions/TARGET), on these cut at many places, and changed at random. Faster than fuzzing and
// always the same; scripts/fuzz finds what this does not.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <random>
#include <set>

#include "tests/fuzz/target.h"
#include "tests/test_paths.h"
#include "tests/test_sample.h"

namespace vantage::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The inputs of a target, in order.
std::vector<fs::path> inputs_of(const Target& target) {
  const fs::path folder = fs::path(test_paths::required("VANTAGE_FUZZ_INPUTS")) / target.name;
  std::vector<fs::path> files;
  if (fs::is_directory(folder)) {
    files.assign(fs::directory_iterator(folder), {});
  }
  std::ranges::sort(files);
  return files;
}

class Replay : public testing::TestWithParam<std::string> {
 protected:
  /// False where the target found something, which fails the test.
  bool take(const std::vector<std::uint8_t>& bytes, const std::string& what) const {
    try {
      run(target_, bytes);
      return true;
    } catch (const std::exception& error) {
      ADD_FAILURE() << what << ": " << error.what() << " (" << sample_name() << ")";
      return false;
    }
  }
  /// Bytes that are changed, left out, or repeated; every second time near the front, since headers
  /// decide most.
  [[nodiscard]] std::vector<std::uint8_t> mutated(std::vector<std::uint8_t> bytes, int number) {
    for (unsigned change = 0; change <= random_() % 3; ++change) {
      const std::size_t range =
          number % 2 == 0 ? bytes.size() : std::min<std::size_t>(bytes.size(), 64);
      if (range == 0) {
        break;
      }
      const auto at = bytes.begin() + static_cast<std::ptrdiff_t>(random_() % range);
      const auto end = at + std::min<std::ptrdiff_t>(bytes.end() - at, 1 + random_() % 8);
      switch (random_() % 8) {
        case 0:
          bytes.erase(at, end);
          break;
        case 1: {
          const std::vector<std::uint8_t> repeated(at, end);
          bytes.insert(at, repeated.begin(), repeated.end());
          break;
        }
        case 2:
          *at = 0;
          break;
        case 3:
          *at = 255;
          break;
        default:
          *at = static_cast<std::uint8_t>(random_());
          break;
      }
    }
    return bytes;
  }

  const Target& target_ = *find_target(GetParam());
  std::mt19937 random_{6 + sample_seed()};
};

TEST_P(Replay, AnyBytesAreAnErrorOrTaken) {
  const std::vector<fs::path> inputs = inputs_of(target_);
  ASSERT_FALSE(inputs.empty()) << "no inputs in tests/fuzz/regressions/" << target_.name;
  // A film is opened by FFmpeg, and settings are hundreds of objects: these take their time.
  const bool is_slow =
      std::set<std::string>{"video", "stream", "arguments", "keywords", "settings_toml"}.contains(
          GetParam());
  const int changes = (is_slow ? 5 : 30) * (runs_everything() ? 20 : 1);
  for (const fs::path& input : inputs) {
    const std::string name = input.filename();
    const std::vector<std::uint8_t> whole = bytes_of(input);
    bool is_sound = take(whole, name);
    const std::size_t step = std::max<std::size_t>(1, whole.size() / (is_slow ? 5 : 25));
    for (std::size_t size = 0; is_sound && size < whole.size();
         size += size < 16 && !is_slow ? 1 : step) {
      is_sound = take({whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)},
                      name + " cut at " + std::to_string(size));
    }
    for (int i = 0; is_sound && i < changes; ++i) {
      is_sound = take(mutated(whole, i), name + " change " + std::to_string(i));
    }
  }
}

std::vector<std::string> names() {
  std::set<std::string> sorted;
  for (const Target& target : targets()) {
    sorted.emplace(target.name);
  }
  return {sorted.begin(), sorted.end()};
}

INSTANTIATE_TEST_SUITE_P(Targets, Replay, testing::ValuesIn(names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vantage::fuzz
