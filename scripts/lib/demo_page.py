"""The demo's index.html: one page with relative links, no outside resources."""

import html

STYLE = """
:root { color-scheme: light dark;
  --ground: #f6f7f9; --card: #fff; --ink: #1b2230; --soft: #5b6575; --line: #dde2ea;
  --accent: #0b6bcb; }
@media (prefers-color-scheme: dark) { :root {
  --ground: #10141b; --card: #181e28; --ink: #e8ecf2; --soft: #9aa6b7; --line: #2b3442;
  --accent: #6cb6ff; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink);
  font: 16px/1.55 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1320px; margin: 0 auto; padding: 2.2rem 1.4rem 4rem; }
h1 { font-size: 2rem; margin: 0 0 .2rem; letter-spacing: -.01em; }
h2 { font-size: 1.3rem; margin: 2.6rem 0 .3rem; }
p { max-width: 95ch; margin: .3rem 0 1rem; }
.soft, figcaption, th { color: var(--soft); }
a { color: var(--accent); }
.grid { display: grid; gap: 1.1rem; grid-template-columns: repeat(2, minmax(0, 1fr)); }
.three { grid-template-columns: repeat(3, minmax(0, 1fr)); }
@media (max-width: 800px) { .grid, .three { grid-template-columns: minmax(0, 1fr); } }
figure, .card { margin: 0; background: var(--card); border: 1px solid var(--line);
  border-radius: 10px; overflow: hidden; }
figure img, figure video { display: block; width: 100%; height: auto; background: #000; }
figcaption { padding: .55rem .8rem .6rem; font-size: .9rem; }
figcaption b { color: var(--ink); font-weight: 600; }
.facts { display: flex; flex-wrap: wrap; gap: 1.1rem; margin: 1.4rem 0 0; }
.facts div { background: var(--card); border: 1px solid var(--line); border-radius: 10px;
  padding: .7rem 1.1rem; }
.facts b { display: block; font-size: 1.35rem; font-variant-numeric: tabular-nums; }
.facts span { color: var(--soft); font-size: .86rem; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; width: 100%; font-size: .92rem;
  font-variant-numeric: tabular-nums; }
th, td { text-align: right; padding: .42rem .8rem; border-bottom: 1px solid var(--line);
  white-space: nowrap; }
th { font-weight: 500; }
th:first-child, td:first-child { text-align: left; }
tr:last-child td { border-bottom: 0; }
td.wide { white-space: normal; text-align: left; min-width: 24rem; }
.legend { display: flex; align-items: center; gap: .6rem; font-size: .86rem; margin: .8rem 0; }
.bar { height: 12px; width: 220px; border-radius: 6px; }
.player { display: flex; align-items: center; gap: .9rem; margin: 1rem 0; }
.player input { flex: 1; accent-color: var(--accent); }
.player output { min-width: 8.5em; text-align: right; font-variant-numeric: tabular-nums; }
button { font: inherit; padding: .3rem 1.1rem; border-radius: 8px; border: 1px solid var(--line);
  background: var(--card); color: var(--ink); cursor: pointer; min-width: 5.5rem; }
pre { background: var(--card); border: 1px solid var(--line); border-radius: 10px;
  padding: .9rem 1.1rem; overflow-x: auto; font-size: .84rem; line-height: 1.6; }
"""

# Flips through the frames of a sequence; every picture has a pattern with {} for the number.
PLAYER = """
const pictures = [...document.querySelectorAll('[data-frames]')];
const position = document.getElementById('frame');
const shown = document.getElementById('shown');
const button = document.getElementById('play');
const count = Number(position.max) + 1;
const address = (picture, frame) =>
  picture.dataset.frames.replace('{}', String(frame).padStart(6, '0'));
const cache = pictures.map(picture => Array.from({length: count}, (_, frame) => {
  const image = new Image();
  image.src = address(picture, frame);
  return image;
}));
function show(frame) {
  position.value = frame;
  shown.textContent = `frame ${frame + 1} of ${count}`;
  pictures.forEach((picture, i) => { picture.src = cache[i][frame].src; });
}
let timer = 0;
let direction = 1;
function step() {
  const frame = Number(position.value);
  if (frame + direction < 0 || frame + direction >= count) direction = -direction;
  show(frame + direction);
}
function play(on) {
  clearInterval(timer);
  timer = on ? setInterval(step, 83) : 0;
  button.textContent = on ? 'Pause' : 'Play';
}
button.addEventListener('click', () => play(timer === 0));
position.addEventListener('input', () => { play(false); show(Number(position.value)); });
show(0);
play(!matchMedia('(prefers-reduced-motion: reduce)').matches);
"""


def figure(source, title, text, tag="img", attributes=""):
    """A picture or a movie with its caption; `text` may hold markup."""
    alt = f'alt="{html.escape(title)}"' if tag == "img" else ""
    link = f'<a href="{source}">' if tag == "img" else ""
    end = "</video>" if tag == "video" else "</a>"
    return (f'<figure>{link}<{tag} src="{source}" {alt} {attributes}>{end}'
            f"<figcaption><b>{html.escape(title)}</b> {text}</figcaption></figure>")


def frames(pattern, title, text):
    """A picture that the player changes; `pattern` has {} for the six-digit frame number."""
    first = pattern.replace("{}", "000000")
    return (f'<figure><img src="{first}" data-frames="{pattern}" alt="{html.escape(title)}">'
            f"<figcaption><b>{html.escape(title)}</b> {text}</figcaption></figure>")


def table(head, rows):
    """Rows of texts; the first column is left-aligned."""
    def cell(tag, text):
        wide = ' class="wide"' if ", " in text else ""
        return f"<{tag}{wide}>{html.escape(text)}</{tag}>"

    def line(tag, cells):
        return "<tr>" + "".join(cell(tag, text) for text in cells) + "</tr>"

    return ('<div class="card scroll"><table>' + line("th", head) +
            "".join(line("td", row) for row in rows) + "</table></div>")


def legend(palette, low, high, unknown):
    """A colour bar for indices 1..255 of a palette, from `low` to `high`."""
    stops = ", ".join(f"rgb({c[0]},{c[1]},{c[2]})" for c in palette[1::16])
    black = "rgb({},{},{})".format(*palette[0])
    return (f'<div class="legend"><span>{low}</span><span class="bar" '
            f'style="background:linear-gradient(90deg,{stops})"></span><span>{high}</span>'
            f'<span class="bar" style="width:14px;background:{black}"></span>'
            f"<span>{html.escape(unknown)}</span></div>")


def facts(pairs):
    return ('<div class="facts">' + "".join(
        f"<div><b>{html.escape(value)}</b><span>{html.escape(name)}</span></div>"
        for name, value in pairs) + "</div>")


def player(frame_count):
    return ('<div class="player"><button id="play">Play</button>'
            f'<input id="frame" type="range" min="0" max="{frame_count - 1}" value="0" '
            'aria-label="frame"><output id="shown"></output></div>'
            f"<script>{PLAYER}</script>")


def page(title, body):
    return ('<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
            '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
            f"<title>{html.escape(title)}</title>\n<style>{STYLE}</style>\n</head>\n"
            f"<body><main>\n{body}\n</main></body>\n</html>\n")
