#!/usr/bin/env bash
# usage: arm64_root.sh FOLDER
# Unpacks the arm64 packages that Vantage is built from, with all that they need, in FOLDER: what
# cmake/aarch64.cmake compiles against and qemu-aarch64 runs with. Nothing outside FOLDER changes.
# Up to date, it asks no server. Exits 3 where the archive of Debian has no arm64 packages for it.
set -euo pipefail

here=$(dirname "${BASH_SOURCE[0]}")
# shellcheck source=scripts/lib/packages.sh
source "$here/packages.sh"
root=$(realpath -m "$1")

wanted=()
for package in "${BUILD_PACKAGES[@]}"; do
  [[ $package != *-dev ]] || wanted+=("$package")
done
if [[ $(cat "$root/packages" 2>/dev/null) == "${wanted[*]}" ]]; then
  exit 0
fi

rm -rf "$root"
apt=$root/apt
database=$root/var/lib/dpkg  # dpkg-query and dpkg-shlibdeps read it
mkdir -p "$apt/state/lists/partial" "$apt/cache/archives/partial" "$database/info" "$database/updates"
touch "$apt/status"
echo 1 >"$database/info/format"
cat >"$apt/apt.conf" <<TEXT
APT { Architecture "arm64"; Architectures "arm64"; Install-Recommends "false"; Sandbox::User ""; };
Dir { State "$apt/state"; State::status "$apt/status"; Cache "$apt/cache"; };
TEXT
export APT_CONFIG=$apt/apt.conf
if ! apt-get -q update >"$apt/log" 2>&1 ||
   ! apt-get -q -y --download-only install "${wanted[@]}" >>"$apt/log" 2>&1; then
  tail -3 "$apt/log" >&2
  exit 3
fi

for file in "$apt"/cache/archives/*.deb; do
  package=$(dpkg-deb -f "$file" Package)
  instance=$package
  [[ $(dpkg-deb -f "$file" Multi-Arch) != same ]] || instance=$package:arm64
  info=$database/info/$instance
  # As if the libraries were installed where they lie.
  dpkg-deb --fsys-tarfile "$file" | tar -xvC "$root" |
    sed "s|^\.|$root|; s|/\$||" >"$info.list"
  dpkg-deb -e "$file" "$apt/control"
  for kind in shlibs symbols; do
    [[ ! -f $apt/control/$kind ]] || cp "$apt/control/$kind" "$info.$kind"
  done
  sed "/^Package:/a Status: install ok installed" "$apt/control/control" >>"$database/status"
  echo >>"$database/status"
  rm -r "$apt/control"
done
rm -r "$apt" "${root:?}"/{bin,etc,sbin}
# Absolute links would leave the folder.
find "$root" -type l -lname '/*' -printf '%p\t%l\n' | while IFS=$'\t' read -r link target; do
  ln -sfnr "$root$target" "$link"
done
# Installing would have chosen these among several packages.
for library in blas/libblas lapack/liblapack; do
  ln -s "$library.so.3" "$root/usr/lib/aarch64-linux-gnu/"
done
echo "${wanted[*]}" >"$root/packages"
