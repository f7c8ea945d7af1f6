"""Makes the wheel that travels, installs it into an empty environment, and renders with it there: what CTest calls.

Exit code 77: skipped, as the tools are not there (scripts/setup --tests)."""

import base64
import os
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TOOLS = ROOT / "build" / "python" / "bin" / "python"  # of scripts/setup --tests

# A red square as JPEG: read without OpenCV's codecs, which are not in the wheel.
JPEG = (
    "/9j/4AAQSkZJRgABAQAAAQABAAD/2wBDAAMCAgMCAgMDAwMEAwMEBQgFBQQEBQoHBwYIDAoMDAsKCwsNDhIQDQ4RDgsLEBYQERMUFRUVDA8XGB"
    "YUGBIUFRT/2wBDAQMEBAUEBQkFBQkUDQsNFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBQUFBT/wAARCAAI"
    "AAgDAREAAhEBAxEB/8QAFAABAAAAAAAAAAAAAAAAAAAACP/EABQQAQAAAAAAAAAAAAAAAAAAAAD/xAAVAQEBAAAAAAAAAAAAAAAAAAAHCf/EAB"
    "QRAQAAAAAAAAAAAAAAAAAAAAD/2gAMAwEAAhEDEQA/ADoDFU3/2Q=="
)

EXAMPLE = """
import lightwell

world = lightwell.load("atrium")
picture = world.render("paths", camera="gallery", size=(64, 40), paths=4, seed=1)
assert picture.color.shape == (40, 64, 3) and picture.color.mean() > 0
reference = world.render("reference", camera="gallery", size=(64, 40), budget_s=0.5)
assert lightwell.compare(picture, reference, ["relmse", "flip"])["flip"] < 1
lightwell.write_png("picture.png", picture.uint8(exposure_ev=1))
red, green, blue = lightwell.read_picture("red.jpg")["color"].mean(axis=(0, 1))
assert red > 0.9 and green < 0.1 and blue < 0.1, (red, green, blue)
frames = lightwell.FrameRenderer("atrium", camera="gallery", size=(64, 40), bounces=2, exposure=1)
assert frames.next(paths=1, time_s=0.1).uint8().shape == (40, 64, 3)
print(open("/proc/self/maps").read())
"""


def main(build: Path) -> int:
    if not TOOLS.exists() or subprocess.run([str(TOOLS), "-c", "import auditwheel, numpy"], capture_output=True).returncode != 0:
        print("SKIPPED: there is no auditwheel, or no numpy: run scripts/setup --tests")
        return 77
    with tempfile.TemporaryDirectory(prefix="lightwell-wheel-") as name:
        folder = Path(name)
        subprocess.run([str(TOOLS), str(ROOT / "python" / "portable_wheel.py"), name, str(build)], check=True)
        (wheel,) = folder.glob("*.whl")
        assert "manylinux" in wheel.name, wheel.name
        size_mb = wheel.stat().st_size / 1e6
        print(f"{wheel.name}: {size_mb:.1f} MB")
        assert size_mb <= 90, size_mb
        venv.create(folder / "empty", with_pip=True)
        python = folder / "empty" / "bin" / "python"
        (site,) = (folder / "empty" / "lib").glob("python*/site-packages")
        subprocess.run([str(python), "-m", "pip", "install", "-q", "--no-index", "--no-deps", str(wheel)], check=True)
        (numpy,) = (TOOLS.parents[1] / "lib").glob("python*/site-packages/numpy")
        (site / "numpy").symlink_to(numpy)  # without a network
        (site / "numpy.libs").symlink_to(numpy.parent / "numpy.libs")
        return tried(folder, python)


def tried(folder: Path, python: Path) -> int:
    environment = {key: text for key, text in os.environ.items() if not key.startswith(("LD_", "PYTHON", "LIGHTWELL"))}

    def run(*command: str) -> str:
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
        if done.returncode != 0:
            raise SystemExit(f"{command[:3]} ended with {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    (folder / "red.jpg").write_bytes(base64.b64decode(JPEG))
    mapped = {line.split()[-1] for line in run(str(python), "-c", EXAMPLE).splitlines() if ".so" in line}
    libraries = {file for file in mapped if "libopencv" in file or "libembree" in file}
    assert libraries and all("lightwell.libs" in file for file in libraries), libraries
    lightwell = str(python.parent / "lightwell")
    assert run(lightwell, "--version").startswith("lightwell "), "no version"
    run(lightwell, "render", "cornell", "--size", "32x32", "--paths", "4", "--out", "a.exr", "--quiet")
    assert "relmse" in run(lightwell, "compare", "a.exr", "a.exr")
    run(lightwell, "study", "example", "visibility2026", "--out", "study.yaml")
    run(lightwell, "study", "simulate", "study.yaml", "--participants", "1..2", "--out", "simulated")
    run(lightwell, "batch", "--help")
    # The ffmpeg of imageio-ffmpeg is taken, though no other is in the PATH.
    (site,) = python.parents[1].glob("lib/python*/site-packages")
    binaries = site / "imageio_ffmpeg" / "binaries"
    binaries.mkdir(parents=True)
    (binaries.parent / "__init__.py").touch()
    (binaries / "ffmpeg-linux-test").symlink_to(shutil.which("ffmpeg") or "")
    environment["PATH"] = str(folder)
    run(lightwell, "render", "cornell", "--frames", "0:2@8", "--size", "32x32", "--paths", "1", "--video", "v.mkv", "--quiet")
    assert (folder / "v.mkv").stat().st_size > 0
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(os.environ["LIGHTWELL_BUILD"])))
