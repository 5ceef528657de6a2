#!/usr/bin/env bash
# usage: try_packages.sh DIR
# Installs the wheel and the packages of DIR on a new, minimal Debian 12 in a temporary folder, and
# uses them.
set -euo pipefail

packages=$1
root=$(mktemp -d)
leave() {
  umount "$root/proc" "$root/sys" 2>/dev/null || true
  rm -rf --one-file-system "$root"
}
trap leave EXIT

echo "== a minimal Debian 12 in $root"
debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 || {
  tail -5 "$root.log" >&2
  exit 1
}
rm -f "$root.log"
cp -r /etc/apt/apt.conf.d "$root/etc/apt/" 2>/dev/null || true  # a proxy, where there is one
cp /etc/resolv.conf "$root/etc/resolv.conf" 2>/dev/null || true
mount -t proc proc "$root/proc"
mount -t sysfs -o ro sysfs "$root/sys"
mkdir "$root/packages"
cp "$packages"/*.deb "$packages"/*.whl "$root/packages/"

inside() {
  chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive bash -ec "$1"
}

# apt_inside ARGUMENT...: apt-get, silent unless it fails.
apt_inside() {
  inside "apt-get -q -y --no-install-recommends $*" >"$root/apt.log" 2>&1 || {
    tail -20 "$root/apt.log" >&2
    exit 1
  }
}

# Documents are left out of minimal systems; these are to be seen.
echo 'path-include=/usr/share/man/*' >"$root/etc/dpkg/dpkg.cfg.d/manual"
# use_module NAME [PYTHON]
use_module() {
  inside "cd /tmp && ${2-python3} -c '
import numpy, vantage
left = numpy.random.default_rng(1).integers(0, 255, (90, 120), dtype=numpy.uint8)
result = vantage.Matcher(disparities=(0, 15)).compute(left, left)
assert result.disparity.shape == left.shape'"
  echo "== $1: the module works"
}

apt_inside update
apt_inside install python3-venv python3-numpy
inside 'python3 -m venv --system-site-packages /tmp/environment &&
  /tmp/environment/bin/pip install -q --no-index /packages/*.whl'
use_module 'a wheel beside NumPy alone' /tmp/environment/bin/python
start=$SECONDS
apt_inside install '/packages/vantage_*.deb'
echo "== vantage is installed ($((SECONDS - start)) s)"
start=$SECONDS
inside 'cd /tmp && vantage generate scene -o scene --quiet &&
  vantage match scene/left.png scene/right.png -o map.pfm --preview map.png --quiet &&
  test -s map.pfm -a -s map.png'
echo "== a first map ($((SECONDS - start)) s)"
inside 'vantage --version --verbose && vantage run --help >/dev/null'
inside 'zcat /usr/share/man/man1/vantage-match.1.gz | grep -q "disparity map"'
inside 'source /usr/share/bash-completion/completions/vantage; COMP_WORDS=(vantage ma); COMP_CWORD=1
  _vantage; test "${COMPREPLY[*]}" = match'
echo "== manual and completion are there"

if compgen -G "$packages/python3-vantage_*.deb" >/dev/null; then
  apt_inside install '/packages/python3-vantage_*.deb'
  use_module 'python3 of the package'
fi

apt_inside install '/packages/libvantage0_*.deb' '/packages/libvantage-dev_*.deb' g++ cmake make
mkdir "$root/consumer"
cp tests/consumer/CMakeLists.txt tests/consumer/main.cc "$root/consumer/"
inside 'cmake -S /consumer -B /tmp/consumer >/dev/null && cmake --build /tmp/consumer >/dev/null &&
  /tmp/consumer/consumer >/dev/null'
echo "== a C++ program builds with libvantage-dev and runs"

apt_inside remove vantage libvantage-dev libvantage0
inside '! command -v vantage'
echo "== all is removed again"
