// What the page takes beside the C interface (engine/library/vantage_c.h): an example, the map in
// colours, and the page of 'vantage view'. They belong to one worker of the page, and one thread.
//
// Pictures are kept here until the next call that begins with them, as browser_picture() gives
// them: the browser has encoders for them.
#include <fmt/format.h>

#include <cstdint>
#include <exception>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apps/pages/view_page.h"
#include "engine/generation/layered_scene.h"
#include "engine/io/images/preview.h"
#include "engine/library/handles.h"

namespace {

using Pixels = vantage::Image<std::uint8_t>;

std::vector<Pixels> kept;
std::string text;  // of the last call

/// The place of a picture in a text, which the page puts base64 of a PNG file there.
std::string keep(const std::string& /*file_name*/, Pixels pixels) {
  kept.push_back(std::move(pixels));
  return fmt::format("@picture {}@", kept.size() - 1);
}

/// Whether `body` returned; what it threw becomes the text.
template <typename Body>
bool succeeds(const Body& body) {
  kept.clear();
  text.clear();
  try {
    body();
    return true;
  } catch (const std::exception& error) {
    text = error.what();
    return false;
  }
}

}  // namespace

extern "C" {

/// Why the last function returned NULL or 0.
const char* browser_error() { return text.c_str(); }

/// RGBA of a picture; `size`: its width and height in pixels.
const std::uint8_t* browser_picture(int index, int* size) {
  static std::vector<std::uint8_t> rgba;
  const Pixels& picture = kept[static_cast<std::size_t>(index)];
  size[0] = picture.width();
  size[1] = picture.height();
  rgba.clear();
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      for (int c = 0; c < 3; ++c) {
        rgba.push_back(picture.at(x, y, picture.channels() == 1 ? 0 : c));
      }
      rgba.push_back(255);
    }
  }
  return rgba.data();
}

/// Picture 0 and 1 become the left and the right image of an artificial scene.
int browser_example(int width, int height) {
  return succeeds([&] {
    vantage::Execution execution({.threads = 1});
    const vantage::LayeredScene scene(
        {.width_px = width, .height_px = height, .samples_per_side = 1}, execution);
    for (const double x : {0.0, 1.0}) {
      keep("", std::get<Pixels>(scene.render({x, 0}, 0).image.pixels));
    }
  });
}

/// Picture 0 becomes the left map in colours; `range`: their smallest and largest disparity.
int browser_colours(const vantage_pair* pair, float* range) {
  return succeeds([&] {
    const auto map = pair->pair.maps.left.disparity_px.view();
    const vantage::PreviewRange shown = vantage::choose_preview_range(map);
    range[0] = shown.min_px;
    range[1] = shown.max_px;
    keep("", vantage::colour_preview(map, shown.min_px, shown.max_px));
  });
}

/// The page of a pair, with "@picture N@" where base64 of a PNG file of picture N belongs.
const char* browser_view_page(const vantage_pair* pair, const char* names) {
  return succeeds([&] {
    vantage::apps::ViewPage page({.synthesis = pair->synthesis}, "", keep);
    const std::string script = page.add_frame(0, pair->pair, *pair->execution);
    text = page.html(names, {}, script);
  })
             ? text.c_str()
             : nullptr;
}
}
