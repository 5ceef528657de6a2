"""docs/ARCHITECTURE.md names the libraries that the program links: usage libraries_test.py PROGRAM"""

import re
import subprocess
import sys
from pathlib import Path

# Of the compiler and the C library.
SYSTEM = {"libstdc++", "libgcc_s", "libm", "libc", "ld-linux-x86-64"}


def main():
    page = Path(__file__).parent.parent / "docs/ARCHITECTURE.md"
    table = page.read_text(encoding="utf-8").split("<!-- libraries -->")[1].split("<!-- end")[0]
    first_column = "\n".join(line.split("|")[1] for line in table.strip().splitlines()[2:])
    told = set(re.findall(r"lib\w+", first_column))
    dynamic = subprocess.run(["readelf", "-d", sys.argv[1]], capture_output=True, text=True,
                             check=True).stdout
    linked = set(re.findall(r"\(NEEDED\).*\[(.+?)\.so", dynamic)) - SYSTEM
    if told == linked:
        return 0
    print(f"{page.name} lacks {sorted(linked - told)}, and {sys.argv[1]} does not link "
          f"{sorted(told - linked)}")
    return 1


if __name__ == "__main__":
    sys.exit(main())
