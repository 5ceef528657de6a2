#include "apps/pages/comfort_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/pages/embedded_files.h"
#include "apps/pages/page_template.h"
#include "engine/build_info.h"
#include "engine/io/files/encoded_text.h"
#include "engine/plot/line_plot.h"

namespace vantage::apps {
namespace {

/// More points of a curve would not be seen.
constexpr int kMaxPoints = 1200;

std::string verdict_html(ComfortVerdict verdict) {
  return fmt::format("<span class=\"verdict {0}\">{0}</span>", name_of(verdict));
}

std::string clock_text(double seconds) {
  const auto whole = static_cast<int>(seconds);
  return fmt::format("{}:{:02}:{:04.1f}", whole / 3600, whole / 60 % 60,
                     seconds - 60 * std::floor(seconds / 60));
}

std::string film_table(const ComfortSummary& film) {
  std::string html = "<table><tbody>\n";
  for (const ComfortFinding& finding : film.findings) {
    html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td></tr>\n", finding.name,
                        verdict_html(finding.verdict), escaped_markup(finding.text));
  }
  html += fmt::format("<tr><th>shift advised</th><td></td><td>{:+.1f} px ({:+.2f} %)</td></tr>\n",
                      film.shift_px, 100 * film.shift_px / film.width_px);
  return html + "</tbody></table>\n";
}

std::string shot_table(const ComfortPage& page) {
  std::string html =
      "<div class=\"scroll\"><table><thead><tr><th>start</th><th>frames</th><th></th>"
      "<th>crossed %</th><th>uncrossed %</th><th>shift px</th><th>why</th></tr></thead><tbody>\n";
  for (const ComfortSummary& shot : page.report.shots) {
    std::string why;
    for (const ComfortFinding& finding : shot.findings) {
      if (finding.verdict != ComfortVerdict::kSafe) {
        why += fmt::format("{}{}: {}", why.empty() ? "" : "<br>", finding.name,
                           escaped_markup(finding.text));
      }
    }
    html += fmt::format(
        "<tr><td>{}</td><td>{}–{}</td><td>{}</td><td>{:.2f}</td><td>{:.2f}</td><td>{:+.1f}</td>"
        "<td>{}</td></tr>\n",
        clock_text(page.seconds(shot.span.first_frame)), shot.span.first_frame,
        shot.span.end_frame - 1, verdict_html(shot.verdict), shot.crossed_percent,
        shot.uncrossed_percent, shot.shift_px, why);
  }
  return html + "</tbody></table></div>\n";
}

/// A curve over time; several frames to a point give the value that is farthest up or down.
class TimeCurve {
 public:
  TimeCurve(std::string name, bool keeps_largest)
      : series_{std::move(name), {}, {}}, keeps_largest_(keeps_largest) {}

  void add(int bin, double seconds, double value) {
    if (bin != bin_) {
      bin_ = bin;
      series_.x.push_back(seconds);
      series_.y.push_back(value);
    } else if (keeps_largest_ ? value > series_.y.back() : value < series_.y.back()) {
      series_.y.back() = value;
    }
  }
  [[nodiscard]] const PlotSeries& series() const { return series_; }

 private:
  PlotSeries series_;
  bool keeps_largest_;
  int bin_ = -1;
};

std::size_t place_of(double share) {
  return static_cast<std::size_t>(std::ranges::find(kComfortShares, share) -
                                  kComfortShares.begin());
}

std::string charts(const ComfortPage& page) {
  TimeCurve near("nearest (99 %)", true);
  TimeCurve median("median", true);
  TimeCurve far("farthest (1 %)", false);
  TimeCurve left("left border", true);
  TimeCurve right("right border", true);
  TimeCurve vertical("vertical error", true);
  TimeCurve colour("colour difference", true);
  const int first = page.frames.begin()->first;
  const int span = page.frames.rbegin()->first - first + 1;
  for (const auto& [number, frame] : page.frames) {
    const int bin = static_cast<int>(static_cast<long long>(number - first) *
                                     std::min(span, kMaxPoints) / span);
    const double seconds = page.seconds(number);
    const double to_percent = 100.0 / kComfortPerPixel / frame.width_px;
    near.add(bin, seconds, to_percent * frame.disparity[place_of(0.99)]);
    median.add(bin, seconds, to_percent * frame.disparity[place_of(0.5)]);
    far.add(bin, seconds, to_percent * frame.disparity[place_of(0.01)]);
    left.add(bin, seconds, 100.0 * frame.borders[0].rows / kComfortWhole);
    right.add(bin, seconds, 100.0 * frame.borders[1].rows / kComfortWhole);
    vertical.add(bin, seconds,
                 frame.vertical
                     ? 100.0 * frame.vertical->systematic / kComfortPerPixel / frame.height_px
                     : std::numeric_limits<double>::quiet_NaN());
    int difference = 0;
    for (const int channel : frame.colour) {
      difference = std::max(difference, std::abs(channel));
    }
    colour.add(bin, seconds, static_cast<double>(difference) / kComfortPerGreyLevel);
  }
  const bool markers = span <= 60;
  const auto plot = [&](const char* title, const char* unit, std::vector<PlotSeries> series) {
    return LinePlot{.title = title,
                    .x_axis = {.title = "seconds"},
                    .y_axis = {.title = unit},
                    .y_from_zero = true,
                    .markers = markers,
                    .series = std::move(series)};
  };
  return draw_line_plots(
             "",
             {plot("Disparity", "% of the width", {near.series(), median.series(), far.series()}),
              plot("Cut at the borders", "% of the rows", {left.series(), right.series()}),
              plot("Vertical error", "% of the height", {vertical.series()}),
              plot("Colour difference", "levels of 255", {colour.series()})},
             2)
      .svg();
}

std::string limit_table() {
  const ComfortLimits limits;
  std::string html =
      "<table><thead><tr><th></th><th>borderline above</th><th>unsafe above</th><th></th></tr>"
      "</thead><tbody>\n";
  const auto add = [&](const char* name, const ComfortLimit& limit, const char* unit) {
    html += fmt::format("<tr><th>{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n", name,
                        limit.borderline, limit.unsafe, unit);
  };
  add("crossed (in front of the screen)", limits.crossed, "% of the width");
  add("uncrossed (behind the screen)", limits.uncrossed, "% of the width");
  add("depth budget", limits.depth_budget, "% of the width");
  add("cut at a border", limits.border, "% of the rows");
  add("jump of the median at a cut", limits.jump, "% of the width");
  add("vertical error", limits.vertical, "% of the height");
  add("colour difference", limits.colour, "levels of 255");
  return html + "</tbody></table>\n";
}

}  // namespace

std::string make_comfort_page(const ComfortPage& page) {
  std::string sources;
  for (const std::string_view source : kComfortSources) {
    sources += fmt::format("<p class=\"soft\">{}</p>\n", escaped_markup(source));
  }
  const ComfortSummary& film = page.report.film;
  return filled_in(
      embedded_file("comfort_page/page.html"),
      {{"version", escaped_markup(build_info().version)},
       {"style", std::string(embedded_file("comfort_page/page.css"))},
       {"verdict", std::string(name_of(film.verdict))},
       {"input", escaped_markup(page.input)},
       {"amount",
        fmt::format("{} frames of {}x{} pixels in {} shot{}, {}{} frames per second; {:.0f} "
                    "% of the pixels were matched",
                    film.frames, film.width_px, film.height_px, page.report.shots.size(),
                    page.report.shots.size() == 1 ? "" : "s", page.times != nullptr ? "about " : "",
                    to_string(page.rate), film.matched_percent)},
       {"film", film_table(film)},
       {"charts", charts(page)},
       {"shots", shot_table(page)},
       {"limits", limit_table()},
       {"sources", sources}});
}

}  // namespace vantage::apps
