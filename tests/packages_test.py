#!/usr/bin/env python3
"""Makes the Debian packages of a build and looks into them.

usage: packages_test.py BUILD_DIR
"""
import io
import pathlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1))


def field(package, name):
    return subprocess.run(["dpkg-deb", "-f", package, name], check=True, capture_output=True,
                          text=True).stdout.strip()


def files(package):
    listing = subprocess.run(["dpkg-deb", "-c", package], check=True, capture_output=True,
                             text=True).stdout
    return {line.split()[5].lstrip(".") for line in listing.splitlines()}


class PackagesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp())
        subprocess.run(["cpack", "--config", BUILD / "CPackConfig.cmake", "-B", cls.folder],
                       check=True, stdout=subprocess.DEVNULL)
        cls.packages = {package.name.split("_")[0]: package for package in
                        cls.folder.glob("*.deb")}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_program_comes_with_manual_completion_and_copyright(self):
        found = files(self.packages["vantage"])
        for path in ("/usr/bin/vantage", "/usr/bin/vantage-asp", "/usr/share/man/man1/vantage-match.1.gz",
                     "/usr/share/bash-completion/completions/vantage",
                     "/usr/share/zsh/vendor-completions/_vantage",
                     "/usr/share/doc/vantage/copyright"):
            self.assertIn(path, found)
        self.assertFalse([path for path in found if path.endswith((".h", ".a"))])

    def test_program_depends_on_linked_and_late_libraries(self):
        depends = field(self.packages["vantage"], "Depends")
        # The first two are linked, the others opened at run time.
        for library in ("libtbb", "libopencv-core", "libopencv-imgcodecs", "libopencv-video",
                        "libavformat", "libavcodec"):
            self.assertIn(library, depends)

    def test_architecture_is_that_of_the_program(self):
        package = self.packages["vantage"]
        contents = subprocess.run(["dpkg-deb", "--fsys-tarfile", package], check=True,
                                  capture_output=True).stdout
        with tarfile.open(fileobj=io.BytesIO(contents)) as archive:
            header = archive.extractfile("./usr/bin/vantage").read(20)
        machine = int.from_bytes(header[18:20], "little")
        self.assertEqual(machine, {"amd64": 62, "arm64": 183}[field(package, "Architecture")])

    def test_library_has_headers_archives_and_the_cmake_package(self):
        found = files(self.packages["libvantage-dev"])
        self.assertIn("/usr/include/vantage/engine/vantage.h", found)
        self.assertIn("/usr/include/vantage/vantage_c.h", found)
        shared = files(self.packages["libvantage0"])
        self.assertTrue([path for path in shared if path.endswith("/libvantage.so.0")])
        for ending in ("libvantage_engine.a", "/VantageConfig.cmake", "/VantageTargets.cmake",
                       "/vantageConfig.cmake", "/vantage.pc", "/libvantage.so"):
            self.assertTrue([path for path in found if path.endswith(ending)], ending)
        self.assertNotIn("/usr/bin/vantage", found)

    def test_no_file_is_in_two_packages(self):
        seen = {}
        for name, package in self.packages.items():
            for path in files(package):
                if not path.endswith("/"):
                    self.assertNotIn(path, seen, name)
                    seen[path] = name


if __name__ == "__main__":
    if shutil.which("dpkg-deb") is None:
        print("no dpkg-deb")
        sys.exit(77)
    unittest.main()
