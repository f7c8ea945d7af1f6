"""Which of the system's packages a build consists of: for the list of them (scripts/sbom), and for their notices in the wheel."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path


def printed(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def compiled_in(build: Path) -> set[str]:
    """Those whose headers the compiler read, as it wrote down."""
    lines = printed("ninja", "-C", str(build), "-t", "deps").splitlines()
    return _owners({line.strip() for line in lines if line.startswith("    /usr/")})


def linked(programs: list[Path]) -> set[str]:
    """Those of whose shared libraries programs and modules need."""
    return _owners(set(re.findall(r"=> (/\S+)", printed("ldd", *map(str, programs)))))


def notice(package: str) -> str:
    """What Debian says of its authors and licences; empty if that is missing."""
    file = Path("/usr/share/doc") / package.split(":")[0] / "copyright"
    return file.read_text(errors="replace") if file.exists() else ""


def _owners(files: set[str]) -> set[str]:
    names = set()
    asked = sorted({f for file in files for f in (file, str(Path(file).resolve()))})  # /lib is a link to /usr/lib
    for first in range(0, len(asked), 500):
        for line in printed("dpkg-query", "-S", *asked[first : first + 500]).splitlines():
            names.update(name.strip() for name in line.rsplit(": ", 1)[0].split(","))
    return {name for name in names if not name.startswith("diversion by")}
