#!/usr/bin/env bash
# usage: build_site.sh VANTAGE REFERENCE_DIR [WIDTH]    from the root of the sources
# Makes the gallery (of scenes WIDTH pixels wide) and the pages of the library, then the site in
# build/site, and checks its links.
set -euo pipefail

program=$1 reference=$2
python3=/usr/bin/python3  # Debian's, which has the modules
rm -rf build/site build/site-gallery
$python3 -B scripts/lib/gallery.py "$program" build/photographs build/site-gallery "${@:3}"
$python3 -B scripts/lib/site.py stage "$reference" build/site-gallery build/site-source
doxygen scripts/lib/Doxyfile
$python3 -m mkdocs build --quiet --strict
$python3 -B scripts/lib/site.py check build/site
