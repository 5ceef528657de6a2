#!/usr/bin/python3
"""usage: repair_wheel.py WHEEL DIR

Writes a copy of WHEEL to DIR that needs nothing of the system but the C library: puts the shared
libraries of its module beside it, and states the C library it needs in its name. Prints its path.

What auditwheel does elsewhere (Debian 12 does not have it). Libraries get names of their own, so
that they do not meet those of the system or of another wheel in a process. Libraries that the engine
opens on first use (engine/late_library.h) keep theirs: only libtiff is small enough to come along.
The others, FFmpeg's, libcurl and OpenCV's for rare image formats, are used where the system has them.
"""
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# The C library and its loader: the only ones that a wheel may expect.
OF_THE_SYSTEM = re.compile(r"(ld-linux.*|lib(c|m|dl|rt|pthread|util|resolv))\.so\.\d+$")
OPENED_ON_FIRST_USE = {"libtiff.so.6"}  # of Debian 12


def output_of(*command):
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout


def needed_libraries(file):
    """The libraries of a file, all levels deep: {soname: path}."""
    found = {}
    for line in output_of("ldd", file).splitlines():
        match = re.match(r"\s*(\S+) => (.*?)( \(0x[0-9a-f]+\))?$", line)
        if match is None or OF_THE_SYSTEM.match(match[1]):
            continue
        if not match[2].startswith("/"):
            sys.exit(f"repair_wheel.py: {file} needs {match[1]}, which is not on this system")
        found[match[1]] = pathlib.Path(match[2])
    return found


def directly_needed(file):
    return output_of("patchelf", "--print-needed", file).split()


def own_name(soname, path):
    stem, suffix = soname.split(".so", 1)
    return f"{stem}-{hashlib.sha256(path.read_bytes()).hexdigest()[:8]}.so{suffix}"


def late_libraries():
    """Where the libraries of OPENED_ON_FIRST_USE are: {soname: path}."""
    found = {}
    for line in output_of("/sbin/ldconfig", "-p").splitlines():
        match = re.match(r"\s*(\S+) \(libc6[^)]*\) => (\S+)", line)
        if match is not None and match[1] in OPENED_ON_FIRST_USE:
            found.setdefault(match[1], pathlib.Path(match[2]))
    for soname in OPENED_ON_FIRST_USE - found.keys():
        sys.exit(f"repair_wheel.py: {soname} is not on this system")
    return found


def bundle(module, library_dir):
    """Copies what `module` needs to `library_dir`, under names that only this wheel has.

    Returns all files of the wheel that are loaded, and where the copied ones came from."""
    late = late_libraries()
    libraries = needed_libraries(module)
    for path in late.values():
        libraries.update(needed_libraries(path))
    names = {soname: own_name(soname, path) for soname, path in libraries.items()}
    names.update({soname: soname for soname in late})
    library_dir.mkdir()
    # Before the names change: strip would break the layout that patchelf makes.
    subprocess.run(["strip", "--strip-unneeded", module], check=True)
    copies = []
    for soname, path in {**libraries, **late}.items():
        copy = library_dir / names[soname]
        shutil.copyfile(path, copy)
        copies.append(copy)
        subprocess.run(["strip", "--strip-unneeded", copy], check=True)
        subprocess.run(["patchelf", "--set-soname", copy.name, copy], check=True)
    for file, run_path in [(module, f"$ORIGIN/../{library_dir.name}"),
                           *((copy, "$ORIGIN") for copy in copies)]:
        for soname in set(directly_needed(file)) & names.keys():
            subprocess.run(["patchelf", "--replace-needed", soname, names[soname], file], check=True)
        subprocess.run(["patchelf", "--force-rpath", "--set-rpath", run_path, file], check=True)
    return [module, *copies], [*libraries.values(), *late.values()]


def add_licences(libraries, target_dir):
    """Copies what Debian says about the copyright of each library, by package."""
    target_dir.mkdir(exist_ok=True)
    for path in libraries:
        file = path.resolve()
        owner = output_of("dpkg-query", "-S", f"*/{file.parent.name}/{file.name}")
        package = owner.split(":", 1)[0]
        shutil.copyfile(f"/usr/share/doc/{package}/copyright", target_dir / package)


def newest_c_library(files):
    """The newest version of the C library that the files ask for: (2, 36)."""
    versions = set()
    for file in files:
        versions.update((int(major), int(minor)) for major, minor in
                        re.findall(r"\bGLIBC_(\d+)\.(\d+)", output_of("readelf", "-V", file)))
    return max(versions)


def check_closed(files):
    """Every library that a file needs is in the wheel or the C library."""
    present = {file.name for file in files}
    for file in files:
        for name in directly_needed(file):
            if name not in present and not OF_THE_SYSTEM.match(name):
                sys.exit(f"repair_wheel.py: {file.name} still needs {name}")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n", maxsplit=1)[0])
    wheel, target_dir = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as scratch:
        output_of(sys.executable, "-m", "wheel", "unpack", "-d", scratch, wheel)
        [content] = pathlib.Path(scratch).iterdir()
        [module] = content.glob("vantage/_vantage.*.so")
        files, originals = bundle(module, content / "vantage.libs")
        check_closed(files)
        major, minor = newest_c_library(files)
        [description] = content.glob("*.dist-info/WHEEL")
        add_licences(originals, description.parent / "licenses")
        text = description.read_text()
        description.write_text(re.sub(r"(?m)^(Tag: .*)-linux_", rf"\1-manylinux_{major}_{minor}_",
                                      text))
        target_dir.mkdir(parents=True, exist_ok=True)
        packed = output_of(sys.executable, "-m", "wheel", "pack", "-d", target_dir, content)
    print(re.search(r"Repacking wheel as (.*?)\.\.\.", packed)[1])


if __name__ == "__main__":
    main()
