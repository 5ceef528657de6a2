#include "engine/profile_page/timeline_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "engine/plot/axis.h"
#include "engine/profile_page/quantity_text.h"
#include "engine/profile_page/svg_picture.h"

namespace vantage {
namespace {

constexpr double kTimelineWidth = 1120;
constexpr double kTimelineNameWidth = 90;
constexpr std::size_t kLongestName = 15;  // letters that fit into it

struct TimeUnit {
  double per_second = 1;
  std::string name;
};

TimeUnit unit_for(double seconds) {
  return seconds >= 2      ? TimeUnit{1, "s"}
         : seconds >= 2e-3 ? TimeUnit{1e3, "ms"}
                           : TimeUnit{1e6, "µs"};
}

std::string shortened(const std::string& name) {
  return name.size() <= kLongestName ? name : name.substr(0, kLongestName - 2) + "..";
}

void draw_span(const TimelineSpan& span, const Axis& axis, const ChartArea& row,
               const PartColours& colours, SvgPicture& picture) {
  const double begin = row.corner.x + std::clamp(axis.place(span.begin_s), 0.0, 1.0) * row.width;
  const double end = row.corner.x + std::clamp(axis.place(span.end_s), 0.0, 1.0) * row.width;
  std::string classes = span.is_wait ? "wait" : colours.class_of(span.name);
  if (!span.is_wait && span.frame % 2 == 1) {
    classes += " odd";
  }
  const std::string frame = span.frame >= 0 ? fmt::format(", frame {}", span.frame) : "";
  const double duration_s = span.end_s - span.begin_s;
  picture.box({begin, row.corner.y}, std::max(end - begin, 0.2), row.height, classes,
              fmt::format("{}{}: {} from {}", span.name, frame, quantity_text(duration_s, "s"),
                          quantity_text(span.begin_s, "s")));
  const std::string number = std::to_string(span.frame);
  if (span.frame >= 0 && !span.is_wait && end - begin > text_width(number, kTextSize) + 4) {
    picture.text({(begin + end) / 2, row.corner.y + row.height / 2 + 0.35 * kTextSize}, number,
                 "inside middle");
  }
}

}  // namespace

std::string timeline_chart(const Profile& profile, const PartColours& colours) {
  std::vector<const TimelineRow*> rows;
  for (const bool is_in_pool : {true, false}) {
    for (const TimelineRow& row : profile.timeline) {
      if (row.is_in_pool == is_in_pool) {
        rows.push_back(&row);
      }
    }
  }
  double end_s = profile.timeline_s;
  for (const TimelineRow* row : rows) {
    end_s = row->spans.empty() ? end_s : std::max(end_s, row->spans.back().end_s);
  }
  const double row_height = rows.size() <= 8 ? 24 : 18;
  const ChartArea area = {{kTimelineNameWidth, 4},
                          kTimelineWidth - kTimelineNameWidth - kAxesRight,
                          row_height * static_cast<double>(rows.size())};
  const TimeUnit unit = unit_for(end_s);
  const Axis labels({.title = "time, " + unit.name}, 0, end_s * unit.per_second, false);
  const Axis axis({}, 0, end_s, false);

  SvgPicture picture(kTimelineWidth, area.corner.y + area.height + kAxesBottom,
                     fmt::format("What {} threads did during {}", rows.size(),
                                 quantity_text(profile.timeline_s, "s")));
  draw_axes(area, labels, Axis({.title = "", .scale = AxisScale::kCategories}, 0, 1, false),
            picture);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double top = area.corner.y + row_height * static_cast<double>(i);
    picture.text({kTimelineNameWidth - 6, top + row_height / 2 + 0.35 * kTextSize},
                 shortened(rows[i]->thread), "end");
    const ChartArea lane = {{area.corner.x, top + 2}, area.width, row_height - 4};
    for (const TimelineSpan& span : rows[i]->spans) {
      draw_span(span, axis, lane, colours, picture);
    }
  }
  return picture.markup();
}

}  // namespace vantage
