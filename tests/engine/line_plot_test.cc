#include "engine/plot/line_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/error.h"
#include "engine/io/images/photograph_io.h"
#include "engine/plot/heat_map.h"
#include "engine/plot/picture_sheet.h"
#include "engine/plot/surface_plot.h"
#include "tests/engine/io_test_support.h"
#include "tests/well_formed_xml.h"

namespace vantage {
namespace line_plot_test {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> labels_of(const Axis& axis) {
  std::vector<std::string> labels;
  for (const Axis::Tick& tick : axis.ticks()) {
    labels.push_back(tick.label);
  }
  return labels;
}

TEST(Axis, TicksAreRound) {
  EXPECT_THAT(labels_of(Axis({}, 0, 10, false)), ElementsAre("0", "2", "4", "6", "8", "10"));
  EXPECT_THAT(labels_of(Axis({}, 0.3, 97, true)), ElementsAre("0", "20", "40", "60", "80", "100"));
  EXPECT_THAT(labels_of(Axis({}, -0.012, 0.008, true)),
              ElementsAre("-0.015", "-0.01", "-0.005", "0", "0.005", "0.01"));
  EXPECT_THAT(labels_of(Axis({}, -16, 16, false)), ElementsAre("-10", "0", "10"));
}

TEST(Axis, PlacesGoFromBeginToEnd) {
  const Axis linear({}, 2, 6, false);
  EXPECT_DOUBLE_EQ(linear.place(2), 0);
  EXPECT_DOUBLE_EQ(linear.place(3), 0.25);
  EXPECT_DOUBLE_EQ(linear.place(6), 1);
  const Axis downwards({.title = "", .downwards = true}, 2, 6, false);
  EXPECT_DOUBLE_EQ(downwards.place(3), 0.75);
  const Axis logarithmic({.title = "", .scale = AxisScale::kLogarithmic}, 1, 100, false);
  EXPECT_DOUBLE_EQ(logarithmic.place(10), 0.5);
  EXPECT_TRUE(std::isnan(logarithmic.place(0)));
  EXPECT_THAT(labels_of(logarithmic), ElementsAre("1", "2", "5", "10", "20", "50", "100"));
}

TEST(Axis, ManyDecadesHaveFewTicks) {
  const Axis axis({.title = "", .scale = AxisScale::kLogarithmic}, 1e-12, 1, true);
  EXPECT_GE(axis.ticks().size(), 3U);
  EXPECT_LE(axis.ticks().size(), 8U);
}

TEST(Axis, CategoriesAreAtEqualDistances) {
  const Axis axis(
      {.title = "", .scale = AxisScale::kCategories, .categories = {"0", "1/4", "1/2", "1", "2"}},
      0, 4, false);
  EXPECT_THAT(labels_of(axis), ElementsAre("0", "1/4", "1/2", "1", "2"));
  EXPECT_DOUBLE_EQ(axis.place(1), 0.25);
}

TEST(Axis, HasARangeWhateverTheValues) {
  for (const auto& [min, max] :
       {std::pair{0.0, 0.0},
        {5.0, 5.0},
        {-3.0, -3.0},
        {kNaN, kNaN},
        {7.0, 1.0},
        {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()}}) {
    for (const AxisScale scale : {AxisScale::kLinear, AxisScale::kLogarithmic}) {
      const Axis axis({.title = "", .scale = scale}, min, max, true);
      EXPECT_FALSE(axis.ticks().empty()) << min << ' ' << max;
      for (const Axis::Tick& tick : axis.ticks()) {
        EXPECT_TRUE(tick.place >= -1e-6 && tick.place <= 1 + 1e-6) << min << ' ' << max;
      }
    }
  }
}

LinePlot noise_plot(const std::string& title) {
  return {.title = title,
          .x_axis = {.title = "noise",
                     .scale = AxisScale::kCategories,
                     .categories = {"0", "1/4", "1/2", "1"}},
          .y_axis = {.title = "bad, %"},
          .y_from_zero = true,
          .series = {{"one", {0, 1, 2, 3}, {1, 2, 4, 8}}, {"two", {0, 1, 2, 3}, {3, kNaN, 5, 2}}}};
}

TEST(LinePlot, SmallMultiplesAreWellFormedSvg) {
  const std::vector<LinePlot> plots = {noise_plot("a < b & \"c\""), noise_plot("B"),
                                       noise_plot("\xff\x01")};
  const std::string svg = to_svg(draw_line_plots("All <of> them", plots, 2));
  const XmlOutline outline = read_xml(svg);
  EXPECT_EQ(outline.error, "");
  EXPECT_EQ(outline.elements.front(), "svg");
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
  EXPECT_THAT(svg, HasSubstr(">1/4</text>"));
  // Eight values in each panel but the one that is missing, and two in the legend.
  EXPECT_EQ(outline.count("circle"), 3 * 7 + 2);
}

TEST(LinePlot, TheLegendNamesEachCurveOnceInOneColour) {
  const std::string svg = to_svg(draw_line_plots("t", {noise_plot("a"), noise_plot("b")}, 2));
  std::size_t legends = 0;
  for (std::size_t at = svg.find(">one</text>"); at != std::string::npos;
       at = svg.find(">one</text>", at + 1)) {
    ++legends;
  }
  EXPECT_EQ(legends, 1U);
}

TEST(LinePlot, ACurveIsInterruptedWhereThereIsNoValue) {
  LinePlot plot = noise_plot("gap");
  plot.markers = false;
  plot.series = {{"gap", {0, 1, 2, 3, 4}, {1, 2, kNaN, 2, 1}}};
  const Drawing drawing = draw_line_plots("", {plot}, 1);
  int strokes = 0;
  for (const DrawingShape& shape : drawing.shapes) {
    const auto* stroke = std::get_if<StrokeShape>(&shape);
    strokes += stroke != nullptr && stroke->width == 1.6 ? 1 : 0;
  }
  EXPECT_EQ(strokes, 2);
}

TEST(LinePlot, GrowingValuesGoUp) {
  const Drawing drawing = draw_line_plots(
      "", {{.title = "", .x_axis = {}, .y_axis = {}, .series = {{"s", {0, 1}, {10, 20}}}}}, 1);
  for (const DrawingShape& shape : drawing.shapes) {
    if (const auto* stroke = std::get_if<StrokeShape>(&shape); stroke && stroke->width == 1.6) {
      EXPECT_LT(stroke->points[0].x, stroke->points[1].x);
      EXPECT_GT(stroke->points[0].y, stroke->points[1].y);
      return;
    }
  }
  FAIL() << "the curve is missing";
}

TEST(LinePlot, EverythingIsOnThePage) {
  const Drawing drawing = draw_line_plots("t", {noise_plot("a"), noise_plot("b")}, 1);
  for (const DrawingShape& shape : drawing.shapes) {
    if (const auto* stroke = std::get_if<StrokeShape>(&shape)) {
      for (const DrawingPoint& point : stroke->points) {
        EXPECT_TRUE(point.x >= 0 && point.x <= drawing.width && point.y >= 0 &&
                    point.y <= drawing.height);
      }
    }
  }
}

TEST(LinePlot, RefusesUnequalNumbersOfValues) {
  LinePlot plot = noise_plot("bad");
  plot.series = {{"bad", {0, 1}, {1}}};
  EXPECT_THAT(test::error_of([&] { draw_line_plots("", {plot}, 1); }),
              HasSubstr("curve 'bad' has 2 x and 1 y"));
}

TEST(LinePlot, NoValuesAtAllStillMakeAChart) {
  LinePlot plot = noise_plot("empty");
  plot.series = {{"nothing", {}, {}}, {"unknown", {0}, {kNaN}}};
  EXPECT_EQ(read_xml(to_svg(draw_line_plots("", {plot}, 1))).error, "");
  EXPECT_EQ(read_xml(to_svg(draw_line_plots("", {}, 3))).error, "");
}

TEST(Drawing, FilesOfBothKinds) {
  const TemporaryFolder folder;
  const Drawing drawing = draw_line_plots("t", {noise_plot("a")}, 1);
  write_drawing(folder / "plot.svg", drawing);
  write_drawing(folder / "plot.png", drawing);
  const auto bytes = test::bytes_of(folder / "plot.svg");
  EXPECT_EQ(read_xml({reinterpret_cast<const char*>(bytes.data()), bytes.size()}).error, "");
  const Photograph picture = read_photograph(folder / "plot.png");
  EXPECT_EQ(picture.width(), 2 * drawing.width);
  EXPECT_EQ(picture.height(), 2 * drawing.height);
  const auto& pixels = std::get<Image<std::uint8_t>>(picture.pixels);
  int coloured = 0;
  for (int y = 0; y < pixels.height(); ++y) {
    for (int x = 0; x < pixels.width(); ++x) {
      coloured += pixels.at(x, y, 0) != pixels.at(x, y, 2) ? 1 : 0;
    }
  }
  EXPECT_GT(coloured, 100);
  EXPECT_NE(test::error_of([&] { write_drawing(folder / "no/such.svg", drawing); }), "");
}

TEST(HeatMap, ShowsItsExtremesAndTheMarkedPoint) {
  HeatMap map{.title = "surface",
              .x_title = "dx",
              .y_title = "dy",
              .x_first = -2,
              .y_first = 1,
              .values = Image<float>(5, 3)};
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) {
      map.values.at(x, y) = static_cast<float>(x - y);
    }
  }
  map.marked = {2, 1};
  std::vector<HeatMap> maps;
  maps.push_back(std::move(map));
  const Drawing drawing = draw_heat_maps("title", maps, 2);
  const XmlOutline outline = read_xml(to_svg(drawing));
  EXPECT_EQ(outline.error, "");
  EXPECT_EQ(outline.count("image"), 2);  // the map and its scale
  // The largest value is red and in the upper right corner, the smallest blue and opposite.
  const auto& picture = std::get<PictureShape>(drawing.shapes[1]);
  EXPECT_GT(picture.rgb.at(4, 0, 0), picture.rgb.at(4, 0, 2));
  EXPECT_GT(picture.rgb.at(0, 2, 2), picture.rgb.at(0, 2, 1));
  const auto image = rasterize(drawing, 1);
  EXPECT_EQ(image.width(), drawing.width);
}

TEST(HeatMap, ConstantAndUnknownValues) {
  for (const float value : {0.0F, 7.0F, std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<HeatMap> maps(1);
    maps[0].values = Image<float>(1, 1);
    maps[0].values.at(0, 0) = value;
    EXPECT_EQ(read_xml(to_svg(draw_heat_maps("", maps, 1))).error, "");
  }
}

TEST(SurfacePlot, DrawsAMeshPerCellButWhereAValueIsUnknown) {
  SurfacePlot plot{
      .title = "s", .x_title = "x", .y_title = "y", .z_title = "z", .values = Image<float>(5, 4)};
  plot.values.fill(1);
  plot.values.at(1, 1) = 9;
  plot.values.at(4, 3) = std::numeric_limits<float>::quiet_NaN();
  const auto meshes_of = [&plot] {
    std::vector<SurfacePlot> plots;
    plots.push_back(std::move(plot));
    const Drawing drawing = draw_surface_plots("surfaces", plots, 2);
    plot = std::move(plots.front());
    std::vector<PolygonShape> meshes;
    for (const DrawingShape& shape : drawing.shapes) {
      if (const auto* mesh = std::get_if<PolygonShape>(&shape)) {
        meshes.push_back(*mesh);
        for (const DrawingPoint& corner : mesh->corners) {
          EXPECT_GE(corner.x, 0);
          EXPECT_LT(corner.x, drawing.width);
          EXPECT_GE(corner.y, 0);
          EXPECT_LT(corner.y, drawing.height);
        }
      }
    }
    EXPECT_EQ(read_xml(to_svg(drawing)).error, "");
    EXPECT_EQ(rasterize(drawing, 1).width(), drawing.width);
    return meshes;
  };
  const auto meshes = meshes_of();
  ASSERT_EQ(meshes.size(), 4U * 3 - 1);
  // Above the floor where the value is large: corner 2 of the first cell is (1, 1).
  EXPECT_LT(meshes[0].corners[2].y, meshes[0].corners[0].y);
  plot.max_meshes = 2;
  EXPECT_EQ(meshes_of().size(), 2U * 2 - 1);
}

TEST(PictureSheet, BreaksTitlesAndKeepsShapes) {
  std::vector<SheetPicture> pictures(3);
  for (SheetPicture& picture : pictures) {
    picture.pixels = Image<std::uint8_t>(4, 2);
    picture.pixels.fill(7);
  }
  pictures[0].title = "a title that is much too long for one line";
  pictures[1].title = "short";
  const Drawing drawing = draw_picture_sheet("sheet", pictures, 2, 100);
  std::vector<PictureShape> shapes;
  int lines = 0;
  for (const DrawingShape& shape : drawing.shapes) {
    if (const auto* picture = std::get_if<PictureShape>(&shape)) {
      EXPECT_EQ(picture->height, 50);
      EXPECT_EQ(picture->rgb.at(3, 1, 2), 7);
      EXPECT_LE(picture->corner.y + picture->height, drawing.height);
      shapes.push_back({picture->corner, picture->width, picture->height, {}});
    }
    lines += std::holds_alternative<TextShape>(shape) ? 1 : 0;
  }
  ASSERT_EQ(shapes.size(), 3U);
  EXPECT_EQ(shapes[0].corner.y, shapes[1].corner.y);
  EXPECT_GE(shapes[2].corner.y, shapes[0].corner.y + 50);
  EXPECT_GT(lines, 4);
}

TEST(PictureSheet, GreyLevelsRunFromMinToMax) {
  Image<float> values(4, 1);
  for (int x = 0; x < 4; ++x) {
    values.at(x, 0) = static_cast<float>(x);
  }
  values.at(3, 0) = std::numeric_limits<float>::infinity();
  const Image<std::uint8_t> picture = grey_picture(values.view(), 0, 2, {1, 2, 3});
  EXPECT_EQ(picture.at(0, 0), 0);
  EXPECT_EQ(picture.at(1, 0, 1), 128);
  EXPECT_EQ(picture.at(2, 0, 2), 255);
  EXPECT_EQ(picture.at(3, 0, 0), 1);
  EXPECT_EQ(picture.at(3, 0, 2), 3);
}

}  // namespace line_plot_test
}  // namespace vantage
