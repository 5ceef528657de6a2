#include "engine/profile_page/page_style.h"

namespace vantage {

std::string_view page_style() {
  // Colours of parts: Okabe and Ito's, which most colour-blind people can tell apart.
  return R"css(
:root {
  color-scheme: light dark;
  --ground: #ffffff; --panel: #f6f7f9; --ink: #1d2126; --soft: #5a636e; --rule: #dfe3e8;
  --grid: #e8ebef; --accent: #0072b2; --waiting: #e6e8ec; --second: #d55e00;
}
@media (prefers-color-scheme: dark) {
  :root {
    --ground: #14171a; --panel: #1c2024; --ink: #e2e5e9; --soft: #98a1ab; --rule: #30363d;
    --grid: #272c32; --accent: #56b4e9; --waiting: #2c3238; --second: #e69f00;
  }
}
@media print {
  :root {
    --ground: #ffffff; --panel: #f6f7f9; --ink: #000000; --soft: #444444; --rule: #cccccc;
    --grid: #e8ebef; --accent: #0072b2; --waiting: #e6e8ec; --second: #d55e00;
  }
  * { print-color-adjust: exact; -webkit-print-color-adjust: exact; }
  tr, svg, dl { break-inside: avoid; }
  h2 { break-after: avoid; }
}
* { box-sizing: border-box; }
body {
  max-width: 1168px; margin: 0 auto; padding: 28px 24px 60px;
  background: var(--ground); color: var(--ink);
  font: 14px/1.5 system-ui, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif;
  font-variant-numeric: tabular-nums;
}
h1 { margin: 2px 0 10px; font-size: 20px; line-height: 1.35; overflow-wrap: anywhere; }
h1 code { font-family: ui-monospace, "SF Mono", Menlo, Consolas, "DejaVu Sans Mono", monospace; }
h2 { margin: 38px 0 10px; font-size: 16px; }
p { margin: 8px 0; max-width: 92ch; }
.kind { margin: 0; color: var(--soft); }
.note { color: var(--soft); font-size: 13px; }
dl { margin: 0; }
dd { margin: 0; }
.facts { display: flex; flex-wrap: wrap; gap: 4px 28px; color: var(--soft); }
.facts div { display: flex; gap: 6px; }
.facts dd { color: var(--ink); }
.figures {
  display: grid; grid-template-columns: repeat(auto-fit, minmax(138px, 1fr)); gap: 12px;
  margin: 22px 0 0;
}
.figures div { padding: 10px 14px 12px; background: var(--panel); border-radius: 8px; }
.figures dt { color: var(--soft); font-size: 13px; }
.figures dd { font-size: 21px; font-weight: 600; line-height: 1.3; }
.figures dd.detail { color: var(--soft); font-size: 12px; font-weight: 400; line-height: 1.4; }
.findings { margin: 8px 0; padding-left: 20px; max-width: 92ch; }
.findings li { margin: 4px 0; }
.pair { display: flex; flex-wrap: wrap; gap: 0 48px; align-items: flex-start; }
.column { flex: 1 1 400px; min-width: 0; }
table { width: 100%; margin: 10px 0; border-collapse: collapse; }
caption { padding: 14px 0 4px; text-align: left; font-weight: 600; }
th, td {
  padding: 4px 18px 4px 0; border-bottom: 1px solid var(--rule);
  text-align: left; vertical-align: baseline;
}
thead th { color: var(--soft); font-size: 12px; font-weight: 500; vertical-align: bottom; }
tbody th { font-weight: 500; overflow-wrap: anywhere; }
th:last-child, td:last-child { padding-right: 0; }
.number { text-align: right; }
td { white-space: nowrap; }
.bar {
  display: inline-block; width: 110px; height: 9px; margin-right: 8px;
  background: var(--waiting); border-radius: 2px; overflow: hidden;
}
.bar span { display: block; height: 100%; background: var(--accent); }
.beside { white-space: nowrap; }
.legend { display: flex; flex-wrap: wrap; gap: 2px 18px; max-width: none; font-size: 13px; }
.key { display: inline-flex; align-items: baseline; gap: 6px; overflow-wrap: anywhere; }
.field { flex: none; width: 11px; height: 11px; border-radius: 2px; }
svg { display: block; width: 100%; height: auto; margin: 8px 0; }
svg text { font-size: 11px; fill: var(--ink); }
svg .middle { text-anchor: middle; }
svg .end { text-anchor: end; }
svg .tick { fill: var(--soft); }
svg .inside {
  fill: #ffffff; stroke: #00000080; stroke-width: 2px; paint-order: stroke; pointer-events: none;
}
svg polyline { fill: none; }
svg .grid { stroke: var(--grid); }
svg .axis { stroke: var(--soft); }
svg .roof { stroke: var(--soft); stroke-width: 1.6; }
svg .roof-name { fill: var(--soft); font-style: italic; }
svg .label { paint-order: stroke; stroke: var(--ground); stroke-width: 3px; }
svg .leader { stroke: var(--soft); stroke-width: 0.7; }
svg .disc { fill-opacity: 0.75; stroke: var(--ground); }
svg .arithmetic { fill: var(--second); }
svg .bandwidth { fill: var(--accent); }
svg .ideal { stroke: var(--soft); stroke-dasharray: 4 4; }
svg .fitted { stroke: var(--second); stroke-width: 1.6; }
svg .range { stroke: var(--accent); stroke-width: 1.4; }
.measured { fill: var(--accent); background: var(--accent); }
.ideal-field { background: var(--soft); }
.fitted-field { background: var(--second); }
.odd { fill-opacity: 0.68; }
.wait { fill: var(--waiting); background: var(--waiting); }
.part-0 { fill: #0072b2; background: #0072b2; }
.part-1 { fill: #d55e00; background: #d55e00; }
.part-2 { fill: #009e73; background: #009e73; }
.part-3 { fill: #cc79a7; background: #cc79a7; }
.part-4 { fill: #e69f00; background: #e69f00; }
.part-5 { fill: #56b4e9; background: #56b4e9; }
.part-6 { fill: #8c6d4f; background: #8c6d4f; }
.part-more { fill: #8a8f96; background: #8a8f96; }
)css";
}

}  // namespace vantage
