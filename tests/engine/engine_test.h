#pragma once

// What nearly every test of the engine uses: the standard library, the matchers of gmock and
// helpers for images and files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <ostream>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/error.h"
#include "engine/execution.h"
#include "engine/image/disparity_maps.h"
#include "engine/image/photograph.h"
#include "tests/engine/positions_of.h"
#include "tests/temporary_folder.h"

namespace vantage {

using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;
using testing::UnorderedElementsAre;

/// Images of all pixels: suites of TYPED_TEST.
using PixelTypes = testing::Types<std::uint8_t, std::uint16_t, float>;

inline namespace test {

/// Two threads, for tests that are not about executions.
inline Execution& execution() {
  static Execution two_threads({.threads = 2});
  return two_threads;
}

/// A pixel without disparity.
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

inline std::vector<std::uint8_t> bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void put_bytes(const std::filesystem::path& path, const std::vector<std::uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

inline void put_text(const std::filesystem::path& path, const std::string& text) {
  put_bytes(path, {text.begin(), text.end()});
}

/// What() of the Error that `action` throws, "" when it throws none.
template <typename Action>
std::string error_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Noise over the whole range of T, 0..1 for float.
template <typename T>
Photograph noise(int width, int height, int channels, unsigned seed = 1) {
  std::mt19937 generator(seed);
  Image<T> image(width, height, channels);
  for (const auto [i, y] : positions_of(width * channels, height)) {
    if constexpr (std::is_same_v<T, float>) {
      image.row(y)[i] = static_cast<float>(generator() >> 8) / static_cast<float>(1 << 24);
    } else {
      image.row(y)[i] = static_cast<T>(generator());
    }
  }
  return {std::move(image)};
}

inline bool same(const Photograph& a, const Photograph& b) {
  return a.pixels.index() == b.pixels.index() && a.width() == b.width() &&
         a.height() == b.height() && a.channels() == b.channels() &&
         std::visit(
             [&]<typename T>(const Image<T>& image) {
               const auto& other = std::get<Image<T>>(b.pixels);
               for (int y = 0; y < image.height(); ++y) {
                 if (!std::equal(image.row(y), image.row(y) + image.width() * image.channels(),
                                 other.row(y))) {
                   return false;
                 }
               }
               return true;
             },
             a.pixels);
}

/// Whether both hold the same bits, unknown pixels included.
template <typename T>
bool identical(const Image<T>& a, const Image<T>& b) {
  if (a.width() != b.width() || a.height() != b.height()) {
    return false;
  }
  for (int y = 0; y < a.height(); ++y) {
    if (std::memcmp(a.row(y), b.row(y), sizeof(T) * static_cast<std::size_t>(a.width())) != 0) {
      return false;
    }
  }
  return true;
}

/// The same of the maps of both images and their confidences.
inline bool identical(const DisparityMaps& a, const DisparityMaps& b) {
  return identical(a.left.disparity_px, b.left.disparity_px) &&
         identical(a.right.disparity_px, b.right.disparity_px) &&
         identical(a.left.disparity_y_px, b.left.disparity_y_px) &&
         identical(a.right.disparity_y_px, b.right.disparity_y_px) &&
         identical(a.left.confidence, b.left.confidence) &&
         identical(a.right.confidence, b.right.confidence);
}

}  // namespace test

}  // namespace vantage
