"use strict";

// Quantities as people read them: three significant digits, "–" for what is unknown (null).

const UNKNOWN = "–";
const SPACE = "\u00A0";  // at which no line ends
const PREFIXES = [["T", 1e12], ["G", 1e9], ["M", 1e6], ["k", 1e3],
                  ["", 1], ["m", 1e-3], ["µ", 1e-6], ["n", 1e-9]];

function prefixFor(value) {
  const size = Math.abs(value);
  return size === 0 ? ["", 1]
    : PREFIXES.find(([, factor]) => size >= 0.9995 * factor) ?? PREFIXES.at(-1);
}

function numberText(value) {
  if (!Number.isFinite(value)) {
    return UNKNOWN;
  }
  const size = Math.abs(value);
  if (size > 0 && (size >= 1e6 || size < 1e-4)) {
    return value.toExponential(2);
  }
  const digits = size > 0 ? 2 - Math.floor(Math.log10(size * 1.0005)) : 0;
  return value.toFixed(Math.min(Math.max(digits, 0), 6));
}

/// With an SI prefix before `unit`: "1.24 ms".
function quantityText(value, unit) {
  const [prefix, factor] = prefixFor(value);
  return Number.isFinite(value) ? numberText(value / factor) + SPACE + prefix + unit : UNKNOWN;
}

/// The median, followed by the range where the shown digits differ: "1.92 (1.88–1.95)".
function rangeText(sample, factor = 1) {
  const [median, least, most] =
    [sample.median, sample.least, sample.most].map((value) => numberText(value / factor));
  return least === median && most === median ? median : `${median}${SPACE}(${least}–${most})`;
}

/// The same with an SI prefix before `unit`.
function sampleText(sample, unit) {
  const [prefix, factor] = prefixFor(sample.median);
  return Number.isFinite(sample.median)
    ? rangeText(sample, factor) + SPACE + prefix + unit : UNKNOWN;
}

/// Of a share, 1 being all: "43 %", "4.3 %", "0.43 %".
function percentText(share) {
  if (!Number.isFinite(share)) {
    return UNKNOWN;
  }
  const percent = 100 * share;
  const size = Math.abs(percent);
  return percent.toFixed(size >= 9.95 || size === 0 ? 0 : size >= 0.995 ? 1 : 2) + SPACE + "%";
}

function countText(count) {
  return count !== null && Math.abs(count) < 1e6 ? count.toFixed(0) : quantityText(count, "");
}

/// What is 0 where it is unknown.
const knownText = (value) => value > 0 ? numberText(value) : UNKNOWN;
const plural = (count, noun) => `${count} ${noun}${count === 1 ? "" : "s"}`;
const shareOf = (part, all) => all > 0 ? part / all : 0;

// Elements. Children are elements or texts; a text is never read as markup.

function element(name, attributes = {}, ...children) {
  const result = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    result.setAttribute(key, value);
  }
  result.append(...children.flat());
  return result;
}

const paragraph = (text) => element("p", {}, text);
const note = (text) => element("p", {class: "note"}, text);
const section = (title, ...children) =>
  element("section", {}, element("h2", {}, title), ...children);
const sentences = (texts) =>
  element("ul", {class: "findings"}, texts.map((text) => element("li", {}, text)));
/// Beside each other where there is room.
const sideBySide = (...columns) =>
  element("div", {class: "pair"},
          columns.map((children) => element("div", {class: "column"}, children)));
const legendKey = (classes, name) =>
  element("span", {class: "key"}, element("span", {class: `field ${classes}`}), name);
const legend = (...keys) => element("p", {class: "legend"}, ...keys);

/// A bar that fills `share` (0 to 1) of its width, with the percentage beside it.
function bar(share) {
  const percent = Number.isFinite(share) ? 100 * Math.min(Math.max(share, 0), 1) : 0;
  return element("span", {},
                 element("span", {class: "bar"},
                         element("span", {style: `width:${percent.toFixed(1)}%`})),
                 percentText(share));
}

/// The title of a column that does not hold numbers, which are aligned to the right.
const words = (title) => ({title, isWords: true});

/// Columns are titles or words(); the first cell of a row names it.
function table(columns, rows, caption = "") {
  const cell = (i, name, attributes, content) =>
    element(name, columns[i].isWords ? attributes : {...attributes, class: "number"}, content);
  const head = columns.map((column, i) => cell(i, "th", {scope: "col"}, column.title ?? column));
  const body = rows.map((row) => element("tr", {}, row.map(
    (content, i) => i > 0 ? cell(i, "td", {}, content)
      : cell(i, "th", {scope: "row"}, content))));
  return element("table", {}, caption ? element("caption", {}, caption) : [],
                 element("thead", {}, element("tr", {}, head)), element("tbody", {}, body));
}
