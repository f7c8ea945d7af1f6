"""Builds the wheel of the package (PEP 517): CMake builds lightwell/_core in the project's build tree.

If the build tree exists, only the module is compiled. Environment variables:
    LIGHTWELL_BUILD   build tree; default: build/release of this checkout, configured if missing
    LIGHTWELL_JOBS    number of parallel compile jobs
"""

from __future__ import annotations

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import zipfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
ROOT = PACKAGE.parent


def _run(*command: str) -> None:
    print("+", *command, file=sys.stderr)
    subprocess.run(command, cwd=ROOT, check=True, stdout=sys.stderr)


def cached(build: Path, name: str) -> str:
    cache = build / "CMakeCache.txt"
    found = re.search(rf"^{name}:[A-Z]+=(.*)$", cache.read_text(), re.M) if cache.exists() else None
    return found.group(1) if found else ""


def _is_for_this_python(build: Path) -> bool:
    """True if the build tree builds the module for the minor version of the installing interpreter."""
    python = cached(build, "Python_EXECUTABLE")
    if not os.path.exists(python):
        return False
    ask = "import sysconfig; print(sysconfig.get_config_var('EXT_SUFFIX'))"
    suffix = subprocess.run([python, "-c", ask], capture_output=True, text=True).stdout.strip()
    return suffix == sysconfig.get_config_var("EXT_SUFFIX")


def _build_module() -> Path:
    build = Path(os.environ.get("LIGHTWELL_BUILD") or ROOT / "build" / "release").resolve()
    if not (build / "build.ninja").exists() or not _is_for_this_python(build):
        _run("cmake", "--preset", "release", "-B", str(build), f"-DLIGHTWELL_PYTHON={sys.executable}")
    jobs = os.environ.get("LIGHTWELL_JOBS")
    _run("cmake", "--build", str(build), "--target", "lightwell_python", *(["-j", jobs] if jobs else []))
    module = build / "python" / ("_core" + sysconfig.get_config_var("EXT_SUFFIX"))
    if not module.exists():
        raise SystemExit(
            f"lightwell: {module} was not built (needs python3-dev and pybind11-dev) run scripts/setup"
        )
    return module


def _metadata() -> str:
    version = re.search(r"project\(lightwell VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    text = (
        f"Metadata-Version: 2.1\nName: lightwell\nVersion: {version}\n"
        "Summary: Globally lit pictures as numpy arrays, live frames for stimuli, and experiments\n"
        "Requires-Python: >=3.9\nRequires-Dist: numpy>=1.20\n"
        "Provides-Extra: study\nRequires-Dist: pandas; extra == 'study'\n"
        "Provides-Extra: plots\nRequires-Dist: matplotlib; extra == 'plots'\n"
        "Provides-Extra: oidn\nRequires-Dist: pyoidn==2.5.1; extra == 'oidn'\n"
        "Description-Content-Type: text/markdown\n\n"
    )
    return text + (PACKAGE / "README.md").read_text()


def write_wheel(folder: str, content: dict[str, bytes]) -> str:
    """Its name. "{data}" and "{info}" in names of files stand for the folders with these endings (PEP 427)."""
    metadata = _metadata()
    version = re.search(r"^Version: (\S+)$", metadata, re.M).group(1)
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    tag = f"{python}-{python}-{re.sub(r'[-.]', '_', sysconfig.get_platform())}"
    info = f"lightwell-{version}.dist-info"
    folders = {"info": info, "data": f"lightwell-{version}.data"}
    files = {name.format(**folders): data for name, data in content.items()}
    files[f"{info}/METADATA"] = metadata.encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: lightwell\nRoot-Is-Purelib: false\nTag: {tag}\n".encode()
    )
    record = []
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record.append(f"{name},sha256={digest},{len(data)}\n")
    files[f"{info}/RECORD"] = ("".join(record) + f"{info}/RECORD,,\n").encode()
    wheel = f"lightwell-{version}-{tag}.whl"
    with zipfile.ZipFile(Path(folder) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            item = zipfile.ZipInfo(name)
            runs = data.startswith((b"\x7fELF", b"#!"))
            item.external_attr = (0o100755 if runs else 0o100644) << 16
            item.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(item, data)
    return wheel


def sources() -> dict[str, bytes]:
    """The package's files that are not compiled."""
    found = sorted(p for p in (PACKAGE / "lightwell").rglob("*") if p.suffix in {".py", ".pyi", ".typed"})
    return {p.relative_to(PACKAGE).as_posix(): p.read_bytes() for p in found}


def build_wheel(wheel_directory: str, config_settings=None, metadata_directory=None) -> str:
    module = _build_module()
    return write_wheel(wheel_directory, {**sources(), f"lightwell/{module.name}": module.read_bytes()})


def build_sdist(sdist_directory: str, config_settings=None) -> str:
    raise SystemExit(
        "lightwell: there is no source distribution of the module alone (it is built with the program) "
        "run pip install ./python in a checkout"
    )
