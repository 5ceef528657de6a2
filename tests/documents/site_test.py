#!/usr/bin/env python3
"""Builds the documentation site with a small gallery; its links must lead somewhere.

usage: site_test.py VANTAGE REFERENCE_DIR    skips (77) without mkdocs, doxygen or Debian's OpenCV

Symbols of the library without a comment fail, too: scripts/lib/Doxyfile makes warnings errors.
"""
import pathlib
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WIDTH_PX = "160"

modules = ["/usr/bin/python3", "-c", "import mkdocs, cv2, numpy"]
if not shutil.which("doxygen") or subprocess.run(modules, stderr=subprocess.DEVNULL).returncode != 0:
    print("no mkdocs, doxygen, python3-opencv or python3-numpy")
    sys.exit(77)
program, reference = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
sys.exit(subprocess.run([ROOT / "scripts/lib/build_site.sh", program, reference, WIDTH_PX],
                        cwd=ROOT).returncode)
