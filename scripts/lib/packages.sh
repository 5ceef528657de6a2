# shellcheck shell=bash
# Shell functions to be sourced: the Debian packages that Vantage is built from.

# What building, testing and the demo need. An installed package is never touched.
# shellcheck disable=SC2034  # used by whoever sources this
readonly BUILD_PACKAGES=(
  g++ cmake ninja-build pkg-config ccache mold
  libtbb-dev libopencv-dev libeigen3-dev libhwy-dev libhwloc-dev
  libavformat-dev libavcodec-dev libavfilter-dev libavutil-dev libswscale-dev libswresample-dev
  libdeflate-dev libjpeg-dev libpng-dev libtiff-dev libcurl4-openssl-dev
  libcli11-dev libtomlplusplus-dev nlohmann-json3-dev libfmt-dev
  libgtest-dev libgmock-dev libbenchmark-dev
  python3 python3-dev python3-numpy python3-opencv python3-pytest pybind11-dev
)

# What building for aarch64, and running the result, needs beside that (cmake/aarch64.cmake).
# shellcheck disable=SC2034
readonly ARM64_PACKAGES=(g++-aarch64-linux-gnu qemu-user)

# What scripts/fuzz needs beside that: clang with libFuzzer, and its OpenMP.
# shellcheck disable=SC2034
readonly FUZZ_PACKAGES=(clang libclang-rt-14-dev libomp-dev)

# What some tests need beside that; without these they are skipped.
# shellcheck disable=SC2034
readonly PYTHON_PACKAGES=(mypy python3-jedi python3-nbclient python3-ipykernel python3-distributed)
# shellcheck disable=SC2034
readonly NEIGHBOUR_PACKAGES=(  # programs and libraries that docs/NEIGHBOURS.md is about
  gstreamer1.0-tools gstreamer1.0-plugins-base gstreamer1.0-plugins-good
  openimageio-tools python3-openimageio python3-xarray
)
# shellcheck disable=SC2034
readonly WHEEL_PACKAGES=(patchelf python3-build python3-setuptools python3-venv python3-wheel)
# shellcheck disable=SC2034
readonly TEST_PACKAGES=(
  slurmctld slurmd slurm-client munge gridengine-master gridengine-exec gridengine-client
  python3-yaml python3-botocore xvfb xdotool "${WHEEL_PACKAGES[@]}" "${PYTHON_PACKAGES[@]}"
  "${NEIGHBOUR_PACKAGES[@]}"
)
# shellcheck disable=SC2034
readonly BROWSER_PACKAGES=(chromium)

# What the page that matches in the browser is built with.
# shellcheck disable=SC2034
readonly WASM_PACKAGES=(emscripten)

# What scripts/package needs beside BUILD_PACKAGES.
# shellcheck disable=SC2034
readonly PACKAGING_PACKAGES=(dpkg-dev file "${WHEEL_PACKAGES[@]}")

# What the documentation site is built with.
# shellcheck disable=SC2034
readonly SITE_PACKAGES=(mkdocs mkdocs-material doxygen python3-opencv python3-numpy)

can_be_root() {
  [[ $(id -u) -eq 0 ]] || command -v sudo >/dev/null
}

as_root() {
  if [[ $(id -u) -eq 0 ]]; then
    "$@"
  else
    sudo "$@"
  fi
}

package_is_installed() {
  [[ $(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# install_packages PACKAGE...: installs those that are missing; asks no server when none is.
install_packages() {
  local missing=() package
  if ! command -v dpkg-query >/dev/null; then
    echo "error: no dpkg-query here; Vantage's scripts expect Debian 12 (packages: $*)" >&2
    return 1
  fi
  for package in "$@"; do
    package_is_installed "$package" || missing+=("$package")
  done
  if [[ ${#missing[@]} -eq 0 ]]; then
    return 0
  fi
  if ! can_be_root; then
    echo "error: missing packages and neither root nor sudo to install them: ${missing[*]}" >&2
    return 1
  fi
  echo "== installing ${#missing[@]} missing packages: ${missing[*]}"
  as_root apt-get update -q
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -q -y --no-install-recommends "${missing[@]}"
}
