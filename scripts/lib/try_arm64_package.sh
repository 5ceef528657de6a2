#!/usr/bin/env bash
# usage: try_arm64_package.sh DIR
# Unpacks the program of the arm64 packages in DIR, and has it match a pair by qemu-aarch64.
set -euo pipefail

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
dpkg-deb -x "$1"/vantage_*_arm64.deb "$folder"
emulated() {
  qemu-aarch64 -L build/arm64-root "$folder/usr/bin/vantage" "$@" --quiet
}
emulated generate scene -o "$folder/scene" --width 131 --height 97
emulated match "$folder"/scene/{left,right}.png -o "$folder/map.pfm" --preview "$folder/map.png"
test -s "$folder/map.pfm" -a -s "$folder/map.png"
echo "== the program of the package makes a first map"
