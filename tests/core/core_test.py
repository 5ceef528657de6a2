"""The core alone gives the bytes of the program: usage core_test.py PROGRAM SOURCE_DIR FOLDER

Builds tests/core in FOLDER with the packages of the engine out of reach, without OpenMP, then with
it. That takes minutes, so only VANTAGE_TEST_ALL does it.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

WIDTH, HEIGHT = 331, 197
WITHOUT = ["OpenCV", "TBB", "TIFF", "nlohmann_json", "CLI11", "tomlplusplus", "GTest", "pybind11"]


def run(*command, **options):
    words = [str(word) for word in command]
    done = subprocess.run(words, capture_output=True, text=True, check=False, **options)
    if done.returncode != 0:
        sys.exit(f"{' '.join(words)}: exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout


def build(source, folder, has_openmp):
    # pkg-config finds Highway and nothing else.
    files = folder / "pkgconfig"
    files.mkdir(exist_ok=True)
    home = run("pkg-config", "--variable=pcfiledir", "libhwy").strip()
    shutil.copy(Path(home) / "libhwy.pc", files)
    out_of_reach = [f"-DCMAKE_DISABLE_FIND_PACKAGE_{package}=ON" for package in WITHOUT]
    run("cmake", "-S", source / "tests/core", "-B", folder / "build", "-G", "Ninja",
        f"-DVANTAGE_SOURCE={source}", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS_RELEASE=-O1",
        "-DVANTAGE_INSTRUCTION_SETS=SSE4", "-DVANTAGE_BATCH_SOURCES=ON", "-DVANTAGE_USE_CCACHE=ON",
        *out_of_reach, f"-DCMAKE_DISABLE_FIND_PACKAGE_OpenMP={'OFF' if has_openmp else 'ON'}",
        env={**os.environ, "PKG_CONFIG_LIBDIR": str(files), "PKG_CONFIG_PATH": ""})
    run("cmake", "--build", folder / "build")
    return folder / "build/match_pair"


def main():
    if "VANTAGE_TEST_ALL" not in os.environ:
        print("skipped: compiles for minutes; VANTAGE_TEST_ALL=1 runs it")
        return 77
    program, source, folder = sys.argv[1], Path(sys.argv[2]), Path(sys.argv[3])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    os.chdir(folder)
    run(program, "generate", "scene", "-o", "scene", "--width", WIDTH, "--height", HEIGHT,
        "--samples", "1", "--noise", "2")
    pair, given = ["left.ppm", "right.ppm"], ["--disparities", "1:17", "--quiet"]
    for position, file in enumerate(pair):
        run(program, "synth", "scene/left.png", "scene/right.png", *given, "-o", file, "--view",
            position)
    run(program, "match", *pair, *given, "-o", "map.pfm")
    run(program, "synth", *pair, *given, "-o", "view.ppm", "--view", "0.5")
    for executor in ["serial", "openmp"]:
        match_pair = build(source, folder, executor == "openmp")
        said = run(match_pair, *pair, "map", "view")
        linked = run("ldd", match_pair)
        foreign = [name for name in ["opencv", "libav", "tbb", "hwloc", "png", "jpeg", "deflate"]
                   if name in linked]
        if f"executor {executor}\n" not in said or foreign:
            sys.exit(f"core_test: {said}, expected {executor}; linked: {foreign}, expected none")
        rows = [Path("map").read_bytes()[4 * WIDTH * y:4 * WIDTH * (y + 1)] for y in range(HEIGHT)]
        for file, values in [("map.pfm", b"".join(reversed(rows))),
                             ("view.ppm", Path("view").read_bytes())]:
            if not values or not Path(file).read_bytes().endswith(values):
                sys.exit(f"core_test: {file} of the program differs from the core's")
    return 0


if __name__ == "__main__":
    sys.exit(main())
