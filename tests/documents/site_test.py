#!/usr/bin/env python3
"""Builds the documentation site with a small gallery; its links must lead somewhere.

usage: site_test.py VANTAGE REFERENCE_DIR    skips (77) without mkdocs or Debian's OpenCV
"""
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
WIDTH_PX = "160"

modules = ["/usr/bin/python3", "-c", "import mkdocs, cv2, numpy"]
if subprocess.run(modules, stderr=subprocess.DEVNULL).returncode != 0:
    print("no mkdocs, python3-opencv or python3-numpy")
    sys.exit(77)
program, reference = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
sys.exit(subprocess.run([ROOT / "scripts/lib/build_site.sh", program, reference, WIDTH_PX],
                        cwd=ROOT).returncode)
