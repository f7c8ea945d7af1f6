"""Installs the package into an empty folder, without any network, and runs its tests there: what CTest calls.

Exit code 77: skipped, as the tools are not there (scripts/setup --tests)."""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parents[1]
TOOLS = PACKAGE.parent / "build" / "python" / "bin" / "python"  # of scripts/setup --tests, perhaps after the build was configured


def main() -> int:
    missing = [name for name in ("pip", "numpy", "pandas", "pytest") if importlib.util.find_spec(name) is None]
    if missing and TOOLS.exists() and Path(sys.prefix) != TOOLS.parents[1]:
        os.execv(TOOLS, [str(TOOLS), *sys.argv])
    if missing:
        print(f"SKIPPED: {sys.executable} has no {', '.join(missing)}: run scripts/setup --tests")
        return 77
    with tempfile.TemporaryDirectory(prefix="lightwell-python-") as folder:
        pip = [sys.executable, "-m", "pip", "install", "-q", "--disable-pip-version-check"]
        subprocess.run([*pip, "--no-index", "--no-deps", "--target", folder, str(PACKAGE)], check=True)
        environment = {**os.environ, "PYTHONPATH": folder, "PYTHONDONTWRITEBYTECODE": "1"}
        memory = Path("/dev/shm")  # as cmake/suites.cmake.in
        if memory.is_dir() and shutil.disk_usage(memory).free >= 4 << 30:
            environment["TMPDIR"] = str(memory)
        pytest = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", str(PACKAGE)]
        return subprocess.run([*pytest, *sys.argv[1:], str(PACKAGE / "tests")], env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
