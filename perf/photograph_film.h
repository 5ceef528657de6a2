#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>

#include "engine/execution.h"
#include "engine/generation/layered_scene.h"
#include "engine/io/video/video_io.h"

namespace vantage::perf {

/// A pair that films are made of.
struct FilmedPair {
  std::string name;
  std::array<cv::Mat, 2> images;  ///< left, right; 8-bit, three channels, RGB
};

inline FilmedPair read_pair(const std::filesystem::path& left, const std::filesystem::path& right) {
  FilmedPair pair{.name = left.parent_path().filename().string(), .images = {}};
  const std::array<std::filesystem::path, 2> files = {left, right};
  for (std::size_t side = 0; side < 2; ++side) {
    cv::Mat& image = pair.images[side];
    image = cv::imread(files[side].string(), cv::IMREAD_COLOR);
    cv::cvtColor(image, image, cv::COLOR_BGR2RGB);
  }
  return pair;
}

/// A generated scene of the size, disparities and noise of a Middlebury pair at quarter size, whose
/// steps take as long as those of such a photograph.
inline FilmedPair generated_pair() {
  LayeredSceneOptions options;
  options.width_px = 741;
  options.height_px = 497;
  options.far_disparity_px = 9;
  options.near_disparity_px = 62;
  options.noise_sigma = 3;
  Execution execution({});
  const LayeredScene scene(options, execution);
  FilmedPair pair{.name = "a generated scene", .images = {}};
  for (std::size_t side = 0; side < 2; ++side) {
    const Photograph rendered = scene.render({static_cast<double>(side), 0}, 0).image;
    const auto& image = std::get<Image<std::uint8_t>>(rendered.pixels);
    cv::Mat(image.height(), image.width(), CV_8UC3, const_cast<std::uint8_t*>(image.row(0)),
            image.view().stride())
        .copyTo(pair.images[side]);
  }
  return pair;
}

/// The film of a camera that pans over a pair: a window of 640 pixels moves by 2 pixels a frame,
/// forth and back; each eye is enlarged to `size` by cubic resampling, and both lie side by side,
/// in H.264 at factor 20.
inline void write_film(const FilmedPair& pair, cv::Size size, int frames,
                       const std::filesystem::path& file) {
  constexpr int kStep = 2;
  const cv::Size all = pair.images[0].size();
  const int width = std::min(all.width, 640);
  const int height = std::min(all.height, width * size.height / size.width);
  const int path = std::max(1, all.width - width - 1);
  VideoWriter writer(file, 2 * size.width, size.height, {.crf = 20});
  Photograph both{Image<std::uint8_t>(2 * size.width, size.height, 3)};
  auto& packed = std::get<Image<std::uint8_t>>(both.pixels);
  cv::Mat target(packed.height(), packed.width(), CV_8UC3, packed.row(0), packed.view().stride());
  for (int frame = 0; frame < frames; ++frame) {
    const int step = kStep * frame % (2 * path);
    const cv::Rect window(std::min(step, 2 * path - step), (all.height - height) / 2, width,
                          height);
    for (int side = 0; side < 2; ++side) {
      cv::Mat eye = target(cv::Rect(side * size.width, 0, size.width, size.height));
      cv::resize(pair.images[static_cast<std::size_t>(side)](window), eye, size, 0, 0,
                 cv::INTER_CUBIC);
    }
    writer.write(both);
  }
  writer.finish();
}

}  // namespace vantage::perf
