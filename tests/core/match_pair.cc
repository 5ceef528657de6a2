// usage: match_pair LEFT.ppm RIGHT.ppm MAP VIEW
// Matches two pictures by the core alone, as 'vantage match' does with --disparities 1:17, and
// makes the view between them. Exits 1 unless what needs OpenCV is refused.
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

#include "engine/error.h"
#include "engine/matching/pair_matcher.h"
#include "engine/synthesis/view_renderer.h"

namespace {

vantage::Photograph read_ppm(const char* path) {
  std::ifstream file(path, std::ios::binary);
  std::string kind;
  int width = 0;
  int height = 0;
  int largest = 0;
  file >> kind >> width >> height >> largest;
  file.get();
  vantage::Image<std::uint8_t> image(width, height, 3);
  for (int y = 0; y < height; ++y) {
    file.read(reinterpret_cast<char*>(image.row(y)), 3 * width);
  }
  return {std::move(image)};
}

template <typename T>
void write_rows(const vantage::Image<T>& image, const char* path) {
  std::ofstream file(path, std::ios::binary);
  for (int y = 0; y < image.height(); ++y) {
    file.write(reinterpret_cast<const char*>(image.row(y)),
               static_cast<std::streamsize>(sizeof(T)) * image.width() * image.channels());
  }
}

/// Whether `call` throws an error that names OpenCV.
template <typename Call>
bool is_refused(const Call& call) {
  try {
    call();
  } catch (const vantage::UsageError& error) {
    return std::string(error.what()).find("without OpenCV") != std::string::npos;
  }
  return false;
}

}  // namespace

int main(int, char** arguments) {
  vantage::PairWithMaps pair;
  pair.left = read_ppm(arguments[1]);
  pair.right = read_ppm(arguments[2]);
  vantage::MatchOptions options;
  options.disparities = {1, 17};
  vantage::Execution execution({.threads = 2});
  vantage::PairMatcher(options, execution).match(pair.left, pair.right, {}, pair.maps);
  vantage::RenderedView view;
  vantage::ViewRenderer(pair, {}, {}, execution).render(vantage::BaselinePosition{0.5, 0}, view);
  write_rows(pair.maps.left.disparity_px, arguments[3]);
  write_rows(std::get<vantage::Image<std::uint8_t>>(view.picture(false).pixels), arguments[4]);
  std::printf("executor %s\n", std::string(execution.executor().name()).c_str());

  options.disparities_y = vantage::DisparityRange{0, 0};
  options.disparities_y_auto = true;
  const bool refuses =
      is_refused([&] { vantage::with_found_ranges(options, pair.left, pair.right, execution); }) &&
      is_refused(
          [] { vantage::SynthesisOptions{.holes = vantage::HoleFilling::kInpaint}.validate(); });
  return refuses ? 0 : 1;
}
