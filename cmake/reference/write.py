#!/usr/bin/env python3
"""Writes what is made from the option table of a vantage program.

usage: write.py PROGRAM DIR

DIR/man       manual pages (compressed roff), one per command
DIR/bash      completion for bash
DIR/zsh       completion for zsh
DIR/markdown  reference pages for the documentation site
"""
import gzip
import pathlib
import sys

from completion import bash_completion, zsh_completion
from manual_pages import manual_pages
from program import read_program
from reference_pages import reference_pages


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    description = read_program(program)
    pages = {f"{name}.gz": gzip.compress(text.encode(), mtime=0)
             for name, text in manual_pages(description).items()}
    texts = {"bash": {"vantage": bash_completion(description)},
             "zsh": {"_vantage": zsh_completion(description)},
             "markdown": reference_pages(description)}
    folders = {"man": pages, **{folder: {name: text.encode() for name, text in files.items()}
                                for folder, files in texts.items()}}
    for name, files in folders.items():
        (folder / name).mkdir(parents=True, exist_ok=True)
        for stale in set(entry.name for entry in (folder / name).iterdir()) - set(files):
            (folder / name / stale).unlink()
        for file_name, contents in files.items():
            (folder / name / file_name).write_bytes(contents)


if __name__ == "__main__":
    main()
