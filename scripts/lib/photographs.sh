# shellcheck shell=bash
# Shell functions to be sourced: the real photographs of the demo.

# download_package NAME DIR: the .deb of a Debian package into DIR, not installed.
download_package() {
  local options=(-q)
  if [[ $(id -u) -eq 0 ]]; then
    options+=(-o APT::Sandbox::User=root)  # apt's own user may not write to DIR
  fi
  (cd "$2" && apt-get "${options[@]}" download "$1")
}

# fetch_photographs DIR: aloeL.jpg, aloeR.jpg and aloeGT.png, the truth, of opencv-doc into DIR.
# Fails, saying why, when they cannot be had; asks no server when they are there.
fetch_photographs() {
  local dir=$1 download
  if [[ -s $dir/aloeL.jpg && -s $dir/aloeR.jpg && -s $dir/aloeGT.png ]]; then
    return 0
  fi
  mkdir -p "$dir" || return 1
  rm -rf "$dir"/download.*  # of an interrupted run
  download=$(mktemp -d "$dir/download.XXXXXX") || return 1
  echo "== downloading the Debian package opencv-doc (96 MB) for its photographs"
  if ! download_package opencv-doc "$download" 2>"$download/errors"; then
    # A fresh machine has no package lists yet.
    if can_be_root; then
      as_root apt-get update -q || true
    fi
    download_package opencv-doc "$download" 2>"$download/errors" || true
  fi
  local packages=("$download"/*.deb)
  if [[ -f ${packages[0]} ]]; then
    # Unpacked beside the target and renamed, so that an interrupted run leaves no half file.
    dpkg-deb --fsys-tarfile "${packages[0]}" |
      tar -x -C "$download" --wildcards --strip-components=7 '*/examples/data/aloe*' || true
    gunzip -q "$download"/aloe*.gz 2>/dev/null || true
    mv "$download"/aloe* "$dir" 2>/dev/null || true
  else
    tail -n 1 "$download/errors" >&2
  fi
  rm -rf "$download"
  [[ -s $dir/aloeL.jpg && -s $dir/aloeR.jpg && -s $dir/aloeGT.png ]]
}
