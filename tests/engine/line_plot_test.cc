#include "engine/plot/line_plot.h"

#include "engine/plot/heat_map.h"
#include "engine/plot/picture_sheet.h"
#include "tests/engine/engine_test.h"
#include "tests/well_formed_xml.h"

namespace vantage::line_plot_test {

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

constexpr const char* kCurve = "<polyline fill=\"none\" stroke=\"#0072b2\" stroke-width=\"1.6\"";

/// The points of all elements of a drawing that begin with `tag`.
std::vector<std::vector<DrawingPoint>> points_of(const Drawing& drawing, const std::string& tag) {
  const std::string svg = drawing.svg();
  std::vector<std::vector<DrawingPoint>> all;
  for (std::size_t at = svg.find(tag); at != std::string::npos; at = svg.find(tag, at + 1)) {
    const std::size_t begin = svg.find("points=\"", at) + 8;
    std::istringstream text(svg.substr(begin, svg.find('"', begin) - begin));
    std::vector<DrawingPoint>& points = all.emplace_back();
    char comma = 0;
    for (DrawingPoint point; text >> point.x >> comma >> point.y;) {
      points.push_back(point);
    }
  }
  return all;
}

TEST(LinePlot, SmallMultiplesAreWellFormedSvg) {
  const std::vector<LinePlot> plots = {noise_plot("a < b & \"c\""), noise_plot("B"),
                                       noise_plot("\xff\x01")};
  const std::string svg = draw_line_plots("All <of> them", plots, 2).svg();
  const XmlOutline outline = read_xml(svg);
  EXPECT_EQ(outline.error, "");
  EXPECT_EQ(outline.elements.front(), "svg");
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; &quot;c&quot;"));
  EXPECT_THAT(svg, HasSubstr(">1/4</text>"));
  // Eight values in each panel but the one that is missing, and two in the legend.
  EXPECT_EQ(outline.count("circle"), 3 * 7 + 2);
}

TEST(LinePlot, TheLegendNamesEachCurveOnceInOneColour) {
  const std::string svg = draw_line_plots("t", {noise_plot("a"), noise_plot("b")}, 2).svg();
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
  EXPECT_EQ(points_of(draw_line_plots("", {plot}, 1), kCurve).size(), 2U);
}

TEST(LinePlot, GrowingValuesGoUp) {
  const Drawing drawing = draw_line_plots(
      "", {{.title = "", .x_axis = {}, .y_axis = {}, .series = {{"s", {0, 1}, {10, 20}}}}}, 1);
  const auto curves = points_of(drawing, kCurve);
  ASSERT_EQ(curves.size(), 1U);
  EXPECT_LT(curves[0][0].x, curves[0][1].x);
  EXPECT_GT(curves[0][0].y, curves[0][1].y);
}

TEST(LinePlot, EverythingIsOnThePage) {
  const Drawing drawing = draw_line_plots("t", {noise_plot("a"), noise_plot("b")}, 1);
  const auto strokes = points_of(drawing, "<polyline");
  EXPECT_GT(strokes.size(), 20U);
  for (const auto& stroke : strokes) {
    for (const DrawingPoint& point : stroke) {
      EXPECT_TRUE(point.x >= 0 && point.x <= drawing.width && point.y >= 0 &&
                  point.y <= drawing.height);
    }
  }
}

TEST(LinePlot, RefusesUnequalNumbersOfValues) {
  LinePlot plot = noise_plot("bad");
  plot.series = {{"bad", {0, 1}, {1}}};
  EXPECT_THAT(error_of([&] { draw_line_plots("", {plot}, 1); }),
              HasSubstr("curve 'bad' has 2 x and 1 y"));
}

TEST(LinePlot, NoValuesAtAllStillMakeAChart) {
  LinePlot plot = noise_plot("empty");
  plot.series = {{"nothing", {}, {}}, {"unknown", {0}, {kNaN}}};
  EXPECT_EQ(read_xml(draw_line_plots("", {plot}, 1).svg()).error, "");
  EXPECT_EQ(read_xml(draw_line_plots("", {}, 3).svg()).error, "");
}

TEST(HeatMap, ShowsItsExtremesAndTheMarkedPoint) {
  HeatMap map{.title = "surface",
              .x_title = "dx",
              .y_title = "dy",
              .x_first = -2,
              .y_first = 1,
              .values = Image<float>(5, 3)};
  for (const auto [x, y] : positions_of(5, 3)) {
    map.values.at(x, y) = static_cast<float>(x - y);
  }
  map.marked = {2, 1};
  std::vector<HeatMap> maps;
  maps.push_back(std::move(map));
  const Drawing drawing = draw_heat_maps("title", maps, 2);
  const XmlOutline outline = read_xml(drawing.svg());
  EXPECT_EQ(outline.error, "");
  EXPECT_EQ(outline.count("image"), 2);  // the map and its scale
  // Four arms of a cross around the marked point, the largest value: above right of the centre.
  const auto arms = points_of(drawing, "<polyline fill=\"none\" stroke=\"#ffffff\"");
  ASSERT_EQ(arms.size(), 4U);
  EXPECT_GT(arms[0][0].x, 62 + 320 * 0.8);
  EXPECT_LT(arms[0][0].y, 30 + 40 + 192 / 2);
}

TEST(HeatMap, ConstantAndUnknownValues) {
  for (const float value : {0.0F, 7.0F, std::numeric_limits<float>::quiet_NaN()}) {
    std::vector<HeatMap> maps(1);
    maps[0].values = Image<float>(1, 1);
    maps[0].values.at(0, 0) = value;
    EXPECT_EQ(read_xml(draw_heat_maps("", maps, 1).svg()).error, "");
  }
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
  const std::string svg = drawing.svg();
  std::vector<double> tops;
  for (std::size_t at = svg.find("<image"); at != std::string::npos;
       at = svg.find("<image", at + 1)) {
    double x = 0;
    double y = 0;
    double width = 0;
    double height = 0;
    ASSERT_EQ(
        std::sscanf(svg.c_str() + at, "<image x=\"%lf\" y=\"%lf\" width=\"%lf\" height=\"%lf\"", &x,
                    &y, &width, &height),
        4);
    EXPECT_EQ(height, 50);
    EXPECT_LE(y + height, drawing.height);
    tops.push_back(y);
  }
  ASSERT_EQ(tops.size(), 3U);
  EXPECT_EQ(tops[0], tops[1]);
  EXPECT_GE(tops[2], tops[0] + 50);
  EXPECT_GT(read_xml(svg).count("text"), 4);
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

}  // namespace vantage::line_plot_test
