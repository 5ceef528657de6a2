#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "engine/error.h"
#include "engine/image/photograph.h"
#include "tests/temporary_folder.h"

namespace vantage::test {

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
  for (int y = 0; y < height; ++y) {
    for (int i = 0; i < width * channels; ++i) {
      if constexpr (std::is_same_v<T, float>) {
        image.row(y)[i] = static_cast<float>(generator() >> 8) / static_cast<float>(1 << 24);
      } else {
        image.row(y)[i] = static_cast<T>(generator());
      }
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

}  // namespace vantage::test
