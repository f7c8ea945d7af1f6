"""Puts the passes of `lightwell ar run --passes` together again, with numpy alone.

    python3 passes_numpy.py PASSES/000012.exr OUT.png     (PNG of 8 or 16 bits, as the frame was; .npy of linear frames)

composite = objects.rgb + (1 - objects.a) background + added + noise, in linear light; then the camera's response.
Without `noise` the virtual objects are free of the camera's noise (--no-noise). To grade, change the parts first: scale
`added`, or multiply `background` by `shadow` and add `indirect` in place of `added`.
"""

import struct
import sys
import zlib
from pathlib import Path

import numpy as np

PREFIX = "lightwell:"


def read_exr(file):
    """Returns (layers, attributes): name -> height x width x channels, float32; name -> text.

    Reads what `ar run --passes` writes: scan lines, half or float, ZIP, several parts. No other files.
    """
    data = Path(file).read_bytes()
    magic, version = struct.unpack_from("<II", data)
    if magic != 20000630 or not version & 0x1000:
        raise ValueError(f"{file} is no multi-part EXR: read it with OpenEXR")
    at, headers = 8, []
    while data[at] != 0:
        header = {}
        while data[at] != 0:
            end = data.index(b"\0", at)
            name, at = data[at:end].decode(), end + 1
            end = data.index(b"\0", at)
            (size,) = struct.unpack_from("<I", data, end + 1)
            header[name] = data[end + 5 : end + 5 + size]
            at = end + 5 + size
        headers.append(header)
        at += 1
    at += 1
    layers, parts = {}, []
    for header in headers:
        x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
        channels, c = [], 0
        while header["channels"][c] != 0:
            end = header["channels"].index(b"\0", c)
            (kind,) = struct.unpack_from("<I", header["channels"], end + 1)
            channels.append((header["channels"][c:end].decode(), np.dtype("<f2" if kind == 1 else "<f4")))
            c = end + 17
        if header["compression"] != b"\3":
            raise ValueError(f"{file} is not compressed by ZIP: read it with OpenEXR")
        (chunks,) = struct.unpack("<I", header["chunkCount"])
        planes = {name: np.empty((y1 - y0 + 1, x1 - x0 + 1), np.float32) for name, _ in channels}
        parts.append((y0, channels, planes, np.frombuffer(data, "<u8", chunks, at)))
        at += 8 * chunks
    for header, (y0, channels, planes, offsets) in zip(headers, parts):
        for offset in offsets:
            _, y, size = struct.unpack_from("<iiI", data, int(offset))
            read_rows(data[int(offset) + 12 : int(offset) + 12 + size], y - y0, channels, planes)
        name = header["name"].decode()
        order = [f"{prefix}{c}" for c in "RGBAXYV" for prefix in (f"{name}.", "") if f"{prefix}{c}" in planes]
        layers[name] = np.stack([planes[c] for c in order], -1)
    text = {k[len(PREFIX) :]: v.decode() for k, v in headers[0].items() if k.startswith(PREFIX)}
    return layers, text


def read_rows(packed, first, channels, planes):
    """Undoes ZIP of up to 16 rows: deflate, differences, even and odd bytes apart."""
    height, width = next(iter(planes.values())).shape
    rows = min(16, height - first)
    size = rows * width * sum(kind.itemsize for _, kind in channels)
    if len(packed) < size:
        deltas = np.frombuffer(zlib.decompress(packed), np.uint8).astype(np.int64)
        deltas[1:] -= 128
        halves = (np.cumsum(deltas) & 255).astype(np.uint8)
        values = np.empty(size, np.uint8)
        values[0::2], values[1::2] = halves[: (size + 1) // 2], halves[(size + 1) // 2 :]
        packed = values.tobytes()
    at = 0
    for y in range(first, first + rows):
        for name, kind in channels:
            planes[name][y] = np.frombuffer(packed, kind, width, at)
            at += width * kind.itemsize


def composite(layers, with_noise=True):
    """Returns the composite in linear light, height x width x 3."""
    objects = layers["objects"]
    light = objects[..., :3] + (1 - objects[..., 3:]) * layers["background"] + layers["added"]
    return light + layers["noise"] if with_noise else light


def encoded(light, text):
    """Returns the camera's codes of linear light: uint8, uint16, or the light itself for linear frames."""
    if text["bits"] == "float":
        return light
    most = 255 if text["bits"] == "8" else 65535
    height, width, _ = light.shape
    unit = light @ np.array(text["unit_of_radiance"].split(), float).reshape(3, 3).T
    y, x = np.mgrid[:height, :width]
    r2 = 4 * ((x + 0.5 - width / 2) ** 2 + (y + 0.5 - height / 2) ** 2) / (width**2 + height**2)
    a, b, c = map(float, text["vignetting"].split())
    unit *= (1 + r2 * (a + r2 * (b + r2 * c)))[..., None]
    if text["response"] == "sRGB":
        unit = unit.clip(0, 1)
        code = np.where(unit <= 0.0031308, 12.92 * unit, 1.055 * unit ** (1 / 2.4) - 0.055)
    else:  # the curve's bytes are points of a line
        curves = np.array(text["response"].split(), float).reshape(3, 256)
        code = np.stack([np.interp(unit[..., i], curves[i], np.arange(256) / 255) for i in range(3)], -1)
    return np.rint(most * code).astype(np.uint8 if most == 255 else np.uint16)


def write_png(file, codes):
    """Writes uint8 or uint16, height x width x 3."""
    height, width, _ = codes.shape
    rows = codes.astype(">u2" if codes.dtype == np.uint16 else np.uint8).reshape(height, -1)
    rows = np.concatenate([np.zeros((height, 1), np.uint8), rows.view(np.uint8).reshape(height, -1)], 1)

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    size = struct.pack(">IIBBBBB", width, height, 8 * codes.dtype.itemsize, 2, 0, 0, 0)
    body = chunk(b"IHDR", size) + chunk(b"IDAT", zlib.compress(rows.tobytes())) + chunk(b"IEND", b"")
    Path(file).write_bytes(b"\x89PNG\r\n\x1a\n" + body)


def main(arguments):
    names = [a for a in arguments if not a.startswith("--")]
    if len(names) != 2 or not set(arguments) - set(names) <= {"--no-noise"}:
        print(__doc__, file=sys.stderr)
        return 2
    layers, text = read_exr(names[0])
    codes = encoded(composite(layers, "--no-noise" not in arguments), text)
    if codes.dtype.kind == "f":
        np.save(names[1], codes)
    else:
        write_png(names[1], codes)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
