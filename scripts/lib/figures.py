#!/usr/bin/env python3
"""Figures that several pages quote: docs/figures.toml has each once, and the sentences that quote it.

usage: figures.py [--write]    prints quotes that do not have its values, exits 1 if there are any;
                               --write puts the values into them
"""
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
FIGURES = "docs/figures.toml"
PLACEHOLDER = re.compile(r"\{(\w+)(?::([^}]*))?\}")
ANY_NUMBER = r"[\d.,]+(?: of \d+)?"
GAP = r'(?:\s|"|\\n)+'  # between words: also the end of a line of text in a source


def text_of(value, form):
    return f"{float(value):{form}}" if form else value


def pattern(quote, values, has_values):
    """A regular expression of the quote, with its values or with any numbers in their places."""
    words = []
    for word in quote.split():
        parts, end = [], 0
        for match in PLACEHOLDER.finditer(word):
            value = text_of(values[match.group(1)], match.group(2))
            parts += [re.escape(word[end:match.start()]),
                      re.escape(value) if has_values else f"({ANY_NUMBER})"]
            end = match.end()
        words.append("".join(parts) + re.escape(word[end:]).replace("…", ".*?"))
    return re.compile(GAP.join(words))


def files_of(root, place):
    if place != "help":
        return [root / place]
    return sorted(file for folder in ("apps", "engine") for file in (root / folder).rglob("*.cc"))


def quotes(root):
    """File, quote, values, and whether the file says it, of each quote; no file if none has it."""
    figures = tomllib.loads((root / FIGURES).read_text(encoding="utf-8"))
    values = figures["values"]
    for place, texts in figures["quotes"].items():
        files = [(file, file.read_text(encoding="utf-8")) for file in files_of(root, place)]
        for quote in texts:
            form = pattern(quote, values, has_values=False)
            file, text = next((pair for pair in files if form.search(pair[1])), (None, ""))
            is_true = pattern(quote, values, has_values=True).search(text) is not None
            yield place, file, quote, values, is_true


def violations(root):
    if not (root / FIGURES).is_file():
        return
    for place, _, quote, values, is_true in quotes(root):
        if not is_true:
            wanted = PLACEHOLDER.sub(lambda m: text_of(values[m.group(1)], m.group(2)), quote)
            yield f"{place}: does not say '{wanted}', as {FIGURES} does"


def write(root):
    for place, file, quote, values, is_true in quotes(root):
        if file is None:
            sys.exit(f"figures: {place} has no sentence '{quote}'")
        if is_true:
            continue
        text = file.read_text(encoding="utf-8")
        found = pattern(quote, values, has_values=False).search(text)
        wanted = [text_of(values[name], form) for name, form in PLACEHOLDER.findall(quote)]
        for number in range(len(wanted), 0, -1):
            text = text[:found.start(number)] + wanted[number - 1] + text[found.end(number):]
        file.write_text(text, encoding="utf-8")


def main():
    if sys.argv[1:] == ["--write"]:
        write(ROOT)
    elif sys.argv[1:]:
        sys.exit(__doc__)
    found = list(violations(ROOT))
    print("\n".join(found + [f"figures: {len(found)} violations"]))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
