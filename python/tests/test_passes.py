"""The passes of `lightwell ar run` add up to its composites, by the recipe for numpy."""

import importlib.util
import struct
import subprocess
import zlib
from pathlib import Path

import numpy as np
import pytest

RECIPE = Path(__file__).resolve().parents[2] / "scripts" / "recipes" / "passes_numpy.py"
specification = importlib.util.spec_from_file_location("passes_numpy", RECIPE)
passes = importlib.util.module_from_spec(specification)
specification.loader.exec_module(passes)


def read_png(file):
    """RGB of 8 or 16 bits, not interlaced."""
    data = Path(file).read_bytes()
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        body = data[at + 8 : at + 8 + length]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack_from(">IIBB", body)
            assert colour == 2
        packed += body if kind == b"IDAT" else b""
        at += 12 + length
    step = 3 * bits // 8
    raw = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * step)
    above = np.zeros(width * step, np.uint8)
    rows = []
    for line in raw:
        row = line[1:].copy()
        if line[0] == 1:
            row = (np.cumsum(row.reshape(-1, step).astype(np.int64), 0) & 255).astype(np.uint8).reshape(-1)
        elif line[0] == 2:
            row = row + above
        elif line[0] >= 3:
            row = unfiltered(line[0], row, above, step)
        rows.append(row)
        above = row
    pixels = np.array(rows)
    return pixels.view(">u2" if bits == 16 else np.uint8).reshape(height, width, 3).astype(int), bits


def unfiltered(kind, row, above, step):
    out = row.astype(int)
    for i in range(len(row)):
        left = out[i - step] if i >= step else 0
        up = int(above[i])
        corner = int(above[i - step]) if i >= step else 0
        p = left + up - corner
        nearest = min((abs(p - left), 0, left), (abs(p - up), 1, up), (abs(p - corner), 2, corner))[2]
        out[i] = (out[i] + ((left + up) // 2 if kind == 3 else nearest)) & 255
    return out.astype(np.uint8)


@pytest.fixture(scope="module")
def desk(program, tmp_path_factory):
    folder = tmp_path_factory.mktemp("passes")
    made = "ar synthesize desk --frames 2 --size 96x72 --paths 2 --no-truth"
    subprocess.run([program, *made.split()], cwd=folder, check=True, capture_output=True)
    return folder / "desk"


@pytest.mark.parametrize("noise", ["true", "false"])
@pytest.mark.parametrize("bits", ["16", "32"])
@pytest.mark.parametrize("blend", ["difference", "ratio"])
def test_passes_add_up(program, desk, noise, bits, blend):
    session = desk / "passes.yaml"
    session.write_text((desk / "session.yaml").read_text() + f"composite: {{noise: {noise}, blend: {blend}}}\n")
    run = f"ar run passes.yaml --fast --poses poses.csv --out out --passes passes --pass-bits {bits}"
    subprocess.run([program, *run.split()], cwd=desk, check=True, capture_output=True)
    for number in range(2):
        layers, text = passes.read_exr(desk / "passes" / f"{number:06}.exr")
        written, _ = read_png(desk / "out" / f"{number:06}.png")
        assert text["frame"] == str(number)
        assert np.abs(passes.encoded(passes.composite(layers), text).astype(int) - written).max() <= 1
        assert (layers["objects"][..., 3] > 0.5).any() and (layers["shadow"] < 0.9).any()
        assert (layers["added"] < -0.01).any()
        changed = (layers["objects"][..., 3] > 0) | (layers["added"] != 0).any(-1)
        plain = passes.encoded(passes.composite(layers, with_noise=False), text).astype(int)
        assert (np.abs(plain - written).max() <= 1) == (noise == "false")
        assert (plain[~changed] == written[~changed]).all()
        assert not layers["noise"][~changed].any()


def test_other_depths_add_up(program, desk):
    """Frames of 16 bits (rewritten from those of 8) come out with 16 bits."""
    frames = desk / "deep"
    frames.mkdir(exist_ok=True)
    for number in range(2):
        pixels, _ = read_png(desk / "frames" / f"{number:06}.png")
        passes.write_png(frames / f"{number:06}.png", (257 * pixels - (pixels > 128) * 100).astype(np.uint16))
    session = desk / "deep.yaml"
    session.write_text((desk / "session.yaml").read_text().replace("source: frames", "source: deep"))
    run = "ar run deep.yaml --fast --poses poses.csv --out deep_out --passes deep_passes --pass-bits 32"
    subprocess.run([program, *run.split()], cwd=desk, check=True, capture_output=True)
    layers, text = passes.read_exr(desk / "deep_passes" / "000001.exr")
    written, bits = read_png(desk / "deep_out" / "000001.png")
    camera, _ = read_png(frames / "000001.png")
    assert bits == 16 and text["bits"] == "16"
    assert np.abs(passes.encoded(passes.composite(layers), text).astype(int) - written).max() <= 4
    kept = (layers["objects"][..., 3] == 0) & (layers["added"] == 0).all(-1)
    assert kept.any() and (written[kept] == camera[kept]).all()
