#!/usr/bin/env python3
"""Makes a wheel of the Python module of a build and uses it in a virtual environment without Debian's
packages.

usage: wheel_test.py BUILD_DIR SOURCE_DIR PYTHON
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

BUILD, SOURCE, PYTHON = (pathlib.Path(argument).absolute() for argument in sys.argv[1:4])
del sys.argv[1:4]

MEGABYTE = 1_000_000
# Prints a checksum of a map, and what the process has mapped for the module beside NumPy's libraries.
PROGRAM = """
import numpy, zlib
def mapped():
    return {line.split()[-1] for line in open("/proc/self/maps") if ".so" in line}
before = mapped()
import vantage
left = numpy.random.default_rng(1).integers(0, 255, (47, 83), numpy.uint8)
right = numpy.roll(left, -5, axis=1)
found = vantage.Matcher(disparities=(0, 15), threads=2).compute(left, right).disparity
assert abs(numpy.median(found) - 5) < 0.1, found
vantage.write_image("left.png", left)
assert (vantage.read_image("left.png") == left).all()
assert (vantage.read_image("saved.tif") == left[::-1]).all()
print(zlib.crc32(numpy.ascontiguousarray(found).tobytes()))
print(*sorted(mapped() - before), sep="\\n")
"""
SAVE = """
import numpy, vantage
left = numpy.random.default_rng(1).integers(0, 255, (47, 83), numpy.uint8)
vantage.write_image("saved.tif", left[::-1])
"""
OF_THE_SYSTEM = re.compile(r".*/(ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv))\.so\.\d+$")


def has_module(name):
    return subprocess.run([PYTHON, "-c", f"import {name}"], capture_output=True).returncode == 0


def missing_tools():
    missing = [] if shutil.which("patchelf") else ["patchelf"]
    return missing + [f"python3-{name}" for name in ("build", "ensurepip", "wheel", "numpy")
                      if not has_module(name)]


def run(*command, **options):
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **options)
    assert done.returncode == 0, f"{command}\n{done.stdout}"
    return done.stdout


class WheelTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        cls.source = cls.folder / "source"  # setuptools writes into it
        ignored = shutil.ignore_patterns("build", ".git", "__pycache__", "*.egg-info")
        shutil.copytree(SOURCE, cls.source, ignore=ignored)
        run(PYTHON, "-m", "build", "--no-isolation", "--sdist", "--wheel", "-o",
            cls.folder / "made", cls.source, env={**os.environ, "VANTAGE_BUILD_DIR": BUILD})
        [made] = cls.folder.glob("made/*.whl")
        cls.wheel = pathlib.Path(run(PYTHON, SOURCE / "scripts/lib/repair_wheel.py", made,
                                     cls.folder / "repaired").strip())

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_source_distribution_has_all_that_is_compiled(self):
        [archive] = self.folder.glob("made/*.tar.gz")
        with tarfile.open(archive) as tar:
            present = {name.split("/", 1)[1] for name in tar.getnames() if "/" in name}
        for folder in ("cmake", "kernels", "scheduler", "engine", "python"):
            for file in (self.source / folder).rglob("*"):
                if file.is_file():
                    self.assertIn(str(file.relative_to(self.source)), present)

    def test_works_where_only_the_c_library_is(self):
        self.assertLess(self.wheel.stat().st_size, 20 * MEGABYTE)
        self.assertRegex(self.wheel.name, r"^vantage-[0-9.]+-cp3\d+-cp3\d+-manylinux_2_\d+_")
        environment = self.folder / "environment"
        run(PYTHON, "-m", "venv", environment)
        run(environment / "bin/pip", "install", "--no-index", "--no-deps", "-q", self.wheel)
        [packages] = environment.glob("lib/python3*/site-packages")
        typed = {file.name for file in (packages / "vantage").iterdir()}
        self.assertLessEqual({"__init__.pyi", "_vantage.pyi", "opencv.pyi", "py.typed"}, typed)
        numpy = run(PYTHON, "-c", "import numpy; print(numpy.__path__[0])").strip()
        (packages / "numpy").symlink_to(numpy)
        with_build = ["env", "-i", f"PYTHONPATH={BUILD / 'python'}", PYTHON, "-c"]
        run(*with_build, SAVE, cwd=self.folder)
        built, *_ = run(*with_build, PROGRAM, cwd=self.folder).split()
        crc, *libraries = run("env", "-i", environment / "bin/python", "-c", PROGRAM,
                              cwd=self.folder).split()
        foreign = [library for library in libraries
                   if not library.startswith(str(packages / "vantage"))
                   and not OF_THE_SYSTEM.match(library) and "lib-dynload" not in library]
        self.assertEqual(foreign, [])
        self.assertEqual(crc, built)


if __name__ == "__main__":
    if missing_tools():
        print("skipped: needs", *missing_tools())
        sys.exit(77)
    unittest.main()
