"use strict";

// Charts as SVG. The style sheet gives classes their colours, for light and dark.

const TEXT_SIZE = 11;  // as in the style sheet

const textWidth = (() => {
  const context = document.createElement("canvas").getContext("2d");
  context.font = `${TEXT_SIZE}px ${getComputedStyle(document.body).fontFamily}`;
  return (text) => context.measureText(text).width;
})();

function linearTicks(low, high) {
  const power = 10 ** Math.floor(Math.log10((high - low) / 6));
  const enough = (high - low) * 0.999999;
  const step = power * [1, 2, 5, 10].find((factor) => 6 * factor * power >= enough);
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + 1e-9 * step; ++i) {
    ticks.push(i * step);
  }
  return ticks;
}

function logarithmicTicks(low, high) {
  const decades = Math.log10(high / low);
  const decadeStep = Math.max(1, Math.ceil(decades / 6));
  const ticks = [];
  for (let exponent = Math.floor(Math.log10(low)); 10 ** exponent <= high; ++exponent) {
    for (const factor of decades <= 2 ? [1, 2, 5] : [1]) {
      if (factor > 1 || exponent % decadeStep === 0) {
        ticks.push(factor * 10 ** exponent);
      }
    }
  }
  return ticks.filter((value) => value >= low * 0.999999 && value <= high * 1.000001);
}

/// From values to places along an axis, 0 to 1; not finite for values that it cannot show.
function makeAxis(title, low, high, {isLogarithmic = false, ticks = null} = {}) {
  const scaled = isLogarithmic ? Math.log10 : (value) => value;
  const length = scaled(high) - scaled(low);
  const canShow = length > 0 && Number.isFinite(length);
  const place = (value) => (scaled(value) - scaled(low)) / length;
  ticks ??= !canShow ? [] : isLogarithmic ? logarithmicTicks(low, high) : linearTicks(low, high);
  return {title, place, ticks: ticks.map((value) => (
    {place: place(value), label: String(Number(value.toPrecision(6)))}))};
}

class Chart {
  /// `description` is for those who cannot see it.
  constructor(width, height, description) {
    this.area = {left: 50, top: 24, right: width - 14, bottom: height - 40};
    this.svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.svg.setAttribute("style", `max-width:${width}px`);
    this.svg.setAttribute("role", "img");
    this.svg.setAttribute("aria-label", description);
  }

  /// Adds a shape, unless a number of it is not finite. `hint` shows when a pointer rests on it.
  add(name, classes, numbers, {hint = "", text = ""} = {}) {
    if (!Object.values(numbers).flat(2).every(Number.isFinite)) {
      return;
    }
    const shape = document.createElementNS(this.svg.namespaceURI, name);
    shape.setAttribute("class", classes);
    for (const [key, value] of Object.entries(numbers)) {
      shape.setAttribute(key, [value].flat(2).map((number) => number.toFixed(2)).join(" "));
    }
    if (hint) {
      const title = document.createElementNS(this.svg.namespaceURI, "title");
      title.append(hint);
      shape.append(title);
    }
    shape.append(text);
    this.svg.append(shape);
  }

  line(points, classes) {
    this.add("polyline", classes, {points});
  }

  disc([x, y], radius, classes, hint) {
    this.add("circle", classes, {cx: x, cy: y, r: radius}, {hint});
  }

  text([x, y], text, classes = "") {
    this.add("text", classes, {x, y}, {text});
  }

  /// Grid lines, ticks with labels, and titles.
  drawAxes(xAxis, yAxis) {
    const {left, right, top, bottom} = this.area;
    this.xAxis = xAxis;
    this.yAxis = yAxis;
    let labelEnd = -Infinity;
    for (const tick of xAxis.ticks) {
      const x = left + tick.place * (right - left);
      this.line([[x, top], [x, bottom]], "grid");
      const half = textWidth(tick.label) / 2;
      if (x - half > labelEnd) {  // labels that would overlap are left out
        this.text([x, bottom + 6 + TEXT_SIZE], tick.label, "tick middle");
        labelEnd = x + half + 2;
      }
    }
    for (const tick of yAxis.ticks) {
      const y = bottom - tick.place * (bottom - top);
      this.line([[left, y], [right, y]], "grid");
      this.text([left - 6, y + 0.35 * TEXT_SIZE], tick.label, "tick end");
    }
    this.line([[left, top], [left, bottom], [right, bottom]], "axis");
    // Beside the axis it would have to be turned; above it reads as well.
    this.text([4, top - 10], yAxis.title);
    this.text([right, bottom + 12 + 2 * TEXT_SIZE], xAxis.title, "end");
  }

  /// Where values of both axes are.
  point(x, y) {
    const {left, right, top, bottom} = this.area;
    return [left + this.xAxis.place(x) * (right - left),
            bottom - this.yAxis.place(y) * (bottom - top)];
  }
}

// Labels of discs.

const boxAround = ([x, y], radius) =>
  ({left: x - radius, top: y - radius, right: x + radius, bottom: y + radius});
const overlap = (a, b) =>
  Math.max(0, Math.min(a.right, b.right) - Math.max(a.left, b.left)) *
  Math.max(0, Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top));

/// The box for a text beside a disc, clear of the boxes in `taken` and within `area`; farther away
/// until there is room, and if there is none, where it covers least.
function placeLabel(text, [x, y], radius, taken, area) {
  // A browser may draw a text up to a pixel wider than its canvas measures it.
  const [width, height] = [textWidth(text) + 2, 1.25 * TEXT_SIZE];
  let best = null;
  let minCovered = Infinity;
  for (let ring = 0; ring < 14; ++ring) {
    const reach = radius + 3 + 7 * ring;
    for (let direction = 0; direction < 16; ++direction) {
      // To the right first, then up and down in turn.
      const angle = (direction % 2 === 0 ? -direction : direction + 1) * Math.PI / 16;
      const left = x + Math.cos(angle) * (reach + width / 2) - width / 2;
      const top = y + Math.sin(angle) * (reach + height / 2) - height / 2;
      const box = {left, top, right: left + width, bottom: top + height, isFar: ring > 1};
      const outside = width * height - overlap(box, area);
      const covered = taken.reduce((sum, other) => sum + overlap(box, other), outside);
      if (covered < minCovered - 1e-6) {
        best = box;
        minCovered = covered;
      }
      if (minCovered < 1e-6) {
        return best;
      }
    }
  }
  return best;
}

/// GFLOP/s against operations per byte of one thread. Lines are its roofs; a disc is a stage, its
/// area the time it takes. `stages`: those with a place on the roofline, at least one.
function rooflineChart(stages, roofs) {
  const bySeconds = [...stages].sort((a, b) => b.seconds.median - a.seconds.median);
  // Both corners of the roofs are always visible.
  const corners = [roofs.gflops / roofs.l2_gb_per_s, roofs.gflops / roofs.memory_gb_per_s];
  const xs = [...corners, ...stages.map((stage) => stage.roofline.operations_per_byte)];
  const ys = [roofs.gflops, ...stages.map((stage) => stage.gflops)];
  const [xLow, xHigh] = [Math.min(...xs) / 3, Math.max(...xs) * 2.5];
  const [yLow, yHigh] = [Math.min(...ys) / 3, Math.max(...ys) * 2];
  const chart = new Chart(536, 400, "Roofline: GFLOP/s of the stages against operations per byte");
  chart.drawAxes(makeAxis("operations per byte", xLow, xHigh, {isLogarithmic: true}),
                 makeAxis("GFLOP/s of one thread", yLow, yHigh, {isLogarithmic: true}));

  const labels = [];
  const taken = [];
  function drawRoof(from, to, named, name) {
    const [[x0, y0], [x1, y1]] = [chart.point(...from), chart.point(...to)];
    chart.line([[x0, y0], [x1, y1]], "roof");
    for (let i = 0; i <= 80; ++i) {  // labels keep clear of the line
      taken.push(boxAround([x0 + (x1 - x0) * i / 80, y0 + (y1 - y0) * i / 80], 1.5));
    }
    labels.push({text: name, centre: chart.point(...named), radius: 0,
                 classes: "roof-name middle"});
  }
  // From where it enters the chart to where arithmetic limits it, named beside its lower end.
  function drawBandwidth(rate, name) {
    const begin = Math.max(xLow, yLow / rate);
    const end = Math.min(xHigh, roofs.gflops / rate);
    if (begin < end) {
      const named = begin * (end / begin) ** 0.07;
      drawRoof([begin, begin * rate], [end, end * rate], [named, named * rate],
               `${name} ${numberText(rate)} GB/s`);
    }
  }
  drawBandwidth(roofs.memory_gb_per_s, "memory");
  drawBandwidth(roofs.l2_gb_per_s, "L2");
  drawRoof([Math.min(corners[0], xHigh), roofs.gflops], [xHigh, roofs.gflops],
           [xHigh, roofs.gflops], `arithmetic ${numberText(roofs.gflops)} GFLOP/s`);

  for (const stage of bySeconds) {
    const place = stage.roofline;
    const centre = chart.point(place.operations_per_byte, stage.gflops);
    const radius =
      Math.max(17 * Math.sqrt(stage.seconds.median / bySeconds[0].seconds.median), 3.5);
    chart.disc(centre, radius, place.roof === "arithmetic" ? "disc arithmetic" : "disc bandwidth",
               `${stage.name}: ${quantityText(stage.seconds.median, "s")} of a thread, ` +
               `${numberText(stage.gflops)} GFLOP/s, ${numberText(stage.gb_per_s)} GB/s, ` +
               `${numberText(place.operations_per_byte)} operations per byte, ` +
               `${percentText(place.roof_share)} of its roof (${place.roof})`);
    taken.push(boxAround(centre, radius));
    labels.push({text: stage.name, centre, radius, classes: "label middle"});
  }
  for (const {text, centre, radius, classes} of labels) {
    const box = placeLabel(text, centre, radius, taken, chart.area);
    if (!box) {  // its place is not finite
      continue;
    }
    taken.push(box);
    if (box.isFar && radius > 0) {
      const nearest = [Math.min(Math.max(centre[0], box.left), box.right),
                       Math.min(Math.max(centre[1], box.top), box.bottom)];
      chart.line([nearest, centre], "leader");
    }
    chart.text([(box.left + box.right) / 2, box.top + 0.95 * TEXT_SIZE], text, classes);
  }
  return chart.svg;
}

/// Speed-ups with ranges, ideal, and Amdahl's law where it was fitted; at least two.
function speedUpChart(speedUps, serialFraction) {
  const fewest = speedUps[0].threads;
  const most = speedUps.at(-1).threads;
  const highest = Math.max(most / fewest, ...speedUps.map((one) => one.ratio.most));
  const chart = new Chart(440, 320, "Speed-up against the number of threads");
  chart.drawAxes(makeAxis("threads", 0, most, {ticks: speedUps.map((one) => one.threads)}),
                 makeAxis(`times as fast as ${plural(fewest, "thread")}`, 0, highest * 1.04));
  chart.line([chart.point(fewest, 1), chart.point(most, most / fewest)], "ideal");
  if (serialFraction !== null) {
    const curve = Array.from({length: 61}, (_, i) => fewest + (most - fewest) * i / 60);
    chart.line(curve.map((threads) => chart.point(
      threads, 1 / (serialFraction + (1 - serialFraction) * fewest / threads))), "fitted");
  }
  for (const {threads, ratio} of speedUps) {
    const [x, low] = chart.point(threads, ratio.least);
    const [, high] = chart.point(threads, ratio.most);
    chart.line([[x - 4, low], [x + 4, low], [x, low], [x, high], [x - 4, high], [x + 4, high]],
               "range");
    chart.disc(chart.point(threads, ratio.median), 4, "measured",
               `${plural(threads, "thread")}: ${rangeText(ratio)}×`);
  }
  return chart.svg;
}

/// What every thread did when, those outside the pool below the others. Every other frame is
/// fainter; spans that have room name their frame. `classOf`: the colour of a part.
function timelineChart(timeline, wall_s, classOf) {
  const rows = [...timeline.filter((row) => row.is_in_pool),
                ...timeline.filter((row) => !row.is_in_pool)];
  const end = Math.max(wall_s, ...rows.map((row) => row.spans.at(-1)?.end_s ?? 0));
  const rowHeight = rows.length <= 8 ? 24 : 18;
  const [unit, perSecond] = end >= 2 ? ["s", 1] : end >= 2e-3 ? ["ms", 1e3] : ["µs", 1e6];
  const chart = new Chart(1120, rowHeight * rows.length + 44,
                          `What ${rows.length} threads did during ${quantityText(wall_s, "s")}`);
  Object.assign(chart.area, {left: 90, top: 4});
  chart.drawAxes(makeAxis(`time, ${unit}`, 0, end * perSecond), makeAxis("", 0, 1, {ticks: []}));
  const place = (seconds) => chart.point(Math.min(Math.max(seconds, 0), end) * perSecond, 0)[0];
  rows.forEach((row, i) => {
    const top = chart.area.top + rowHeight * i;
    const baseline = top + rowHeight / 2 + 0.35 * TEXT_SIZE;
    const name = row.thread.length > 15 ? row.thread.slice(0, 13) + "…" : row.thread;
    chart.text([chart.area.left - 6, baseline], name, "end");
    for (const span of row.spans) {
      const [begin, width] = [place(span.begin_s), place(span.end_s) - place(span.begin_s)];
      const hasFrame = span.frame >= 0;
      const classes = span.is_wait ? "wait"
        : classOf(span.name) + (hasFrame && span.frame % 2 === 1 ? " odd" : "");
      chart.add("rect", classes,
                {x: begin, y: top + 2, width: Math.max(width, 0.2), height: rowHeight - 4},
                {hint: `${span.name}${hasFrame ? `, frame ${span.frame}` : ""}: ` +
                       `${quantityText(span.end_s - span.begin_s, "s")} from ` +
                       quantityText(span.begin_s, "s")});
      if (hasFrame && !span.is_wait && width > textWidth(String(span.frame)) + 4) {
        chart.text([begin + width / 2, baseline], String(span.frame), "inside middle");
      }
    }
  });
  return chart.svg;
}
