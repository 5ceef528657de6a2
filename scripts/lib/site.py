#!/usr/bin/env python3
"""Prepares and checks the documentation site.

usage: site.py stage REFERENCE_DIR GALLERY_DIR SOURCE_DIR    Markdown for mkdocs
       site.py check SITE_DIR                                links of the built pages

`stage` copies the documents under the site's names with their links adapted; a link to what is not
on the site, such as a source file, becomes plain text. The commands' reference pages come from
REFERENCE_DIR (cmake/reference), the page of the Python module from beside it, the gallery from
GALLERY_DIR.
"""
import html.parser
import os
import pathlib
import re
import shutil
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
PAGES = {"README.md": "about.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md",
         "perf/README.md": "benchmarks.md"}
# Pages that are made for the site, as documents link to them → on the site.
MADE_PAGES = {"docs/gallery.md": "gallery.md", "docs/commands/index.md": "commands/index.md",
              "docs/python-reference.md": "python-reference.md", "docs/cpp/index.html": "cpp/index.html"}
# The page that matches in the browser, of preset wasm. A site without it has no links to it.
BROWSER_PAGE = ROOT / "build/wasm/vantage.html"
if BROWSER_PAGE.is_file():
    MADE_PAGES["docs/match.html"] = "match.html"
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s]+)\)")


def site_names():
    """Path in the repository → path on the site, for all pages and pictures."""
    names = dict(PAGES)
    for page in ROOT.glob("docs/*.md"):
        names[f"docs/{page.name}"] = page.name.lower()
    for picture in ROOT.glob("docs/pictures/*"):
        names[f"docs/pictures/{picture.name}"] = f"pictures/{picture.name}"
    return names


def adapted(text, source, names):
    """`text` of the file `source` with its relative links as they are on the site."""
    targets = {**names, **MADE_PAGES}

    def adapt(match):
        is_picture, label, target = match.groups()
        if urllib.parse.urlparse(target).scheme or target.startswith("#"):
            return match.group(0)
        path, _, anchor = target.partition("#")
        linked = os.path.normpath(os.path.join(os.path.dirname(source), path))
        if linked not in targets:
            return label
        relative = os.path.relpath(targets[linked], os.path.dirname(names[source]) or ".")
        return f"{is_picture}[{label}]({relative}{'#' + anchor if anchor else ''})"
    return LINK.sub(adapt, text)


def stage(reference, gallery, out):
    shutil.rmtree(out, ignore_errors=True)
    names = site_names()
    for source, name in names.items():
        file = out / name
        file.parent.mkdir(parents=True, exist_ok=True)
        if name.endswith(".md"):
            file.write_text(adapted((ROOT / source).read_text(), source, names))
        else:
            shutil.copy(ROOT / source, file)
    shutil.copytree(reference, out / "commands")
    shutil.copy(reference.parent / "python.md", out / "python-reference.md")
    shutil.copytree(gallery, out, dirs_exist_ok=True)
    if BROWSER_PAGE.is_file():
        shutil.copy(BROWSER_PAGE, out / "match.html")
    else:
        print("site: without the page that matches in the browser, which preset wasm builds")


class Page(html.parser.HTMLParser):
    """The link targets and the anchors of a page."""

    def __init__(self, text):
        super().__init__()
        self.targets, self.anchors = [], {""}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.targets.append(value)
            elif name in ("id", "name") and value:
                self.anchors.add(value)


def check(site):
    pages = {file: Page(file.read_text()) for file in site.rglob("*.html")}
    problems = []
    for file, page in pages.items():
        for target in page.targets:
            parts = urllib.parse.urlparse(target)
            if parts.scheme or parts.netloc:
                continue
            linked = (site / parts.path.lstrip("/") if parts.path.startswith("/") else
                      (file.parent / urllib.parse.unquote(parts.path)).resolve())
            linked = file if not parts.path else linked
            if linked.is_dir():
                linked = linked / "index.html"
            if not linked.exists():
                problems.append(f"{file.relative_to(site)}: '{target}' leads nowhere")
            elif linked in pages and urllib.parse.unquote(parts.fragment) not in pages[linked].anchors:
                problems.append(f"{file.relative_to(site)}: '{target}': no such heading")
    for problem in sorted(set(problems)):
        print(problem)
    print(f"site: {len(pages)} pages, {len(set(problems))} broken links")
    return 1 if problems or not pages else 0


def main():
    if len(sys.argv) == 5 and sys.argv[1] == "stage":
        stage(*(pathlib.Path(argument) for argument in sys.argv[2:]))
    elif len(sys.argv) == 3 and sys.argv[1] == "check":
        sys.exit(check(pathlib.Path(sys.argv[2]).resolve()))
    else:
        sys.exit(__doc__)


if __name__ == "__main__":
    main()
