"""How setuptools builds the module: by CMake. Everything else stands in pyproject.toml."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE_DIR = pathlib.Path(__file__).resolve().parent


def project_version():
    text = (SOURCE_DIR / "CMakeLists.txt").read_text()
    return re.search(r"project\(Vantage VERSION ([0-9.]+)", text)[1]


class CMakeBuild(build_ext):
    """Builds the target vantage_python.

    VANTAGE_BUILD_DIR names a CMake build to take it from; without it, everything is compiled anew.
    """

    def build_extension(self, ext):
        existing = os.environ.get("VANTAGE_BUILD_DIR")
        build_dir = pathlib.Path(existing or self.build_temp).resolve()
        if not existing:
            build_dir.mkdir(parents=True, exist_ok=True)
            subprocess.run(
                ["cmake", "-S", str(SOURCE_DIR), "-B", str(build_dir), "-G", "Ninja",
                 "-DCMAKE_BUILD_TYPE=Release", "-DVANTAGE_BATCH_SOURCES=ON",
                 "-DVANTAGE_BUILD_PROGRAM=OFF", "-DVANTAGE_BUILD_TESTS=OFF",
                 "-DVANTAGE_BUILD_PERF=OFF", f"-DPython_EXECUTABLE={sys.executable}"], check=True)
        subprocess.run(["cmake", "--build", str(build_dir), "--target", "vantage_python"],
                       check=True)
        target = pathlib.Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        built = build_dir / "python/vantage"
        for file in (built / target.name, *built.glob("*.pyi"), built / "_option_texts.py"):
            shutil.copy2(file, target.parent / file.name)


# setuptools writes beside the other builds, not into the sources.
PIP_DIR = SOURCE_DIR / "build/pip"
PIP_DIR.mkdir(parents=True, exist_ok=True)

setup(version=project_version(), ext_modules=[Extension("vantage._vantage", sources=[])],
      cmdclass={"build_ext": CMakeBuild},
      options={"build": {"build_base": str(PIP_DIR)}, "egg_info": {"egg_base": str(PIP_DIR)}})
