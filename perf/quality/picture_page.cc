#include "perf/quality/picture_page.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>

#include "engine/io/files/atomic_file.h"
#include "engine/io/images/photograph_io.h"
#include "engine/io/images/preview.h"
#include "engine/synthesis/view_synthesizer.h"

namespace vantage::perf {
namespace {

namespace fs = std::filesystem;

constexpr std::array kViewPositions = {-0.5, 0.5, 1.5};
constexpr float kLargestErrorShown_px = 4;

constexpr const char* kHead = R"(<!doctype html><meta charset="utf-8"><title>Maps and views</title>
<style>body{font:14px sans-serif;background:#222;color:#ddd}img{display:block;width:19vw}
td,th{padding:2px;text-align:left;vertical-align:top}</style>
<p>Errors: blue 0, red )";

/// The table of one scene.
class SceneTable {
 public:
  SceneTable(std::string scene, const PicturePage& page) : scene_(std::move(scene)), page_(page) {}

  void begin_row(const std::string& name) {
    html_ += fmt::format("<tr><th colspan=5>{}<tr>", name);
    row_ = name;
    pictures_.clear();
  }
  void add(const std::string& what, const Photograph& picture) {
    std::string file = fmt::format("{}-{}-{}.png", scene_, row_, what);
    for (char& letter : file) {
      letter = letter == ' ' || letter == ',' ? '_' : letter;
    }
    write_photograph(page_.folder / file, picture);
    html_ += cell(file);
    pictures_.push_back(std::move(file));
  }
  /// The same pictures of the page before, where it has them.
  void end_row() {
    if (!page_.before || pictures_.empty() || !fs::exists(*page_.before / pictures_.front())) {
      return;
    }
    const fs::path from = fs::proximate(*page_.before, page_.folder);
    html_ += fmt::format("<tr><th colspan=5>{}, before<tr>", row_);
    for (const std::string& file : pictures_) {
      html_ += cell((from / file).generic_string());
    }
  }
  [[nodiscard]] std::string html() const {
    return fmt::format("<h2>{}</h2><table>{}</table>\n", scene_, html_);
  }

 private:
  static std::string cell(const std::string& file) {
    return fmt::format("<td><a href=\"{0}\"><img loading=lazy src=\"{0}\"></a>", file);
  }

  std::string scene_;
  const PicturePage& page_;
  std::string row_;
  std::vector<std::string> pictures_;
  std::string html_;
};

Photograph picture_of(Image<std::uint8_t> pixels) {
  Photograph picture;
  picture.pixels = std::move(pixels);
  return picture;
}

/// NaN where the truth is unknown; the largest error where the map is.
DisparityMap errors_of(const DisparityMap& map, const DisparityMap& truth) {
  DisparityMap errors(map.width(), map.height());
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      const float error = std::abs(map.at(x, y) - truth.at(x, y));
      const bool is_missing = std::isnan(map.at(x, y)) && !std::isnan(truth.at(x, y));
      errors.at(x, y) = is_missing ? kLargestErrorShown_px : error;
    }
  }
  return errors;
}

std::string table_of(const TrueScene& scene, const std::vector<MapContender>& contenders,
                     const fs::path& data, const PicturePage& page, Execution& execution) {
  const LoadedScene loaded = load_scene(scene, data);
  const PreviewRange range = choose_preview_range(loaded.truth.view());
  const auto colours = [&](const DisparityMap& map) {
    return picture_of(colour_preview(map.view(), range.min_px, range.max_px));
  };
  SceneTable table(scene.name, page);
  table.begin_row("truth");
  table.add("map", colours(loaded.truth));
  table.add("left", loaded.pair.left);
  table.add("right", loaded.pair.right);
  const ViewSynthesizer synthesizer({}, execution);
  SynthesizedView view;
  for (const MapContender& contender : contenders) {
    const std::unique_ptr<MapMaker> maker = contender.prepare(loaded.pair, execution);
    maker->match(TimedMaps::kBoth);
    const DisparityMaps& maps = maker->maps();
    table.begin_row(contender.name);
    table.add("map", colours(maps.left.disparity_px));
    table.add("errors",
              picture_of(colour_preview(errors_of(maps.left.disparity_px, loaded.truth).view(), 0,
                                        kLargestErrorShown_px)));
    for (const double view_x : kViewPositions) {
      synthesizer.synthesize({loaded.pair.left, loaded.pair.right, maps.left.disparity_px.view(),
                              maps.right.disparity_px.view()},
                             view_x, view);
      table.add(fmt::format("{:g}", view_x), view.image);
    }
    table.end_row();
  }
  return table.html();
}

}  // namespace

void write_picture_page(const std::vector<MapContender>& contenders,
                        const std::vector<const TrueScene*>& scenes, const fs::path& data,
                        const PicturePage& page, Execution& execution) {
  fs::create_directories(page.folder);
  std::string html =
      fmt::format("{}{} px and more. Columns: map, errors, views at XS = -0.5, 0.5, 1.5.</p>\n",
                  kHead, kLargestErrorShown_px);
  for (const TrueScene* scene : scenes) {
    fmt::print(stderr, "pictures of {}\n", scene->name);
    html += table_of(*scene, contenders, data, page, execution);
  }
  write_text_file(page.folder / "index.html", html);
}

}  // namespace vantage::perf
