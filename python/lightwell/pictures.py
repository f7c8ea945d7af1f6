"""Pictures: comparison, display, files. Arrays have the top row first, the left pixel first, and channels last."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING, Mapping, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .errors import InputError

if TYPE_CHECKING:
    from .scenes import Rendered

Floats = NDArray[np.float32]
Layers = Mapping[str, Floats]
PictureLike = Union[Floats, Layers, "Rendered"]


def layers_of(picture: PictureLike) -> dict[str, Floats]:
    """Returns layers by name as contiguous float32 arrays. Arrays that are so already are not copied.

    A bare array becomes the layer "color".

    Raises:
        InputError: a layer holds integers of 8 or 16 bits, which are display-encoded.
    """
    layers = getattr(picture, "layers", picture)
    if not isinstance(layers, Mapping):
        layers = {"color": layers}
    for name, data in layers.items():
        if np.asarray(data).dtype.kind in "ui" and np.asarray(data).dtype.itemsize <= 2:
            raise InputError(
                f"layer '{name}' holds {np.asarray(data).dtype} (display-encoded bytes are no radiance) "
                "write them with write_png and read them with read_picture, which decodes them"
            )
    return {name: np.ascontiguousarray(data, np.float32) for name, data in layers.items()}


def compare(
    image: PictureLike, reference: PictureLike, metrics: Sequence[str] = (), *, layer: str = "color"
) -> dict[str, float]:
    """Measures the difference between a picture and a reference, as ``lightwell compare`` does.

    Args:
        image, reference: height x width x 3 of linear radiance, or layers by name, or a result of
            `World.render`. If their sizes differ by a whole factor, the larger one is averaged down. The metric
            "ztest" needs the layer "variance" of both.
        metrics: names from `metrics()`, such as "relmse", "flip"; () = the program's default metrics.
        layer: the layer to compare.

    Returns:
        Values by metric name; some metrics have several values ("bias.r"). Values that are not finite in one of
        the two are left out; that, and what speaks against the comparison, is warned of.

    Raises:
        InputError: there is no such metric or layer, or the sizes do not fit.
    """
    values, notes = _core.compare(layers_of(image), layers_of(reference), list(metrics), layer)
    for note in notes:
        warnings.warn(note, stacklevel=2)
    return values


def metrics() -> dict[str, str]:
    """Returns the metrics of `compare`: name -> description."""
    return _core.metrics()


def flip_map(image: Floats, reference: Floats, *, hdr: bool = True, pixels_per_degree: float = 67.02064) -> Floats:
    """Returns FLIP per pixel: the difference that an observer sees when two pictures alternate.

    Args:
        image, reference: height x width x 3, linear Rec. 709; with ``hdr=False`` the display shows values in 0..1.
        hdr: True = the largest error over exposures (Andersson et al. 2021), False = Andersson et al. 2020.
        pixels_per_degree: pixels per degree of visual angle; the default is that of the papers.

    Returns:
        height x width, 0 (no difference) to 1.
    """
    return _core.flip_map(
        np.ascontiguousarray(image, np.float32),
        np.ascontiguousarray(reference, np.float32),
        hdr,
        pixels_per_degree,
    )


def tone_map(color: PictureLike, *, exposure_ev: float = 0.0, curve: str = "srgb") -> NDArray[np.uint8]:
    """Converts linear radiance to display bytes, as ``lightwell render --png`` writes them.

    Args:
        color: height x width x 3 float32, linear Rec. 709 radiance, W/(m2 sr); or a result of `World.render`.
        exposure_ev: exposure in stops; radiance is multiplied by 2 to this power.
        curve: "srgb" clips at 1, "filmic" compresses highlights.

    Returns:
        height x width x 3, sRGB-encoded.
    """
    layers = layers_of(color)
    if "color" not in layers:
        raise InputError("there is no layer 'color' (it is what is shown) give an array, or layers with 'color'")
    return _core.tone_map(layers["color"], exposure_ev, curve)


def read_picture(file: str | os.PathLike[str]) -> dict[str, Floats]:
    """Reads the layers of an OpenEXR, HDR, PNG or JPEG file by name, linear; 8 and 16 bits are sRGB-decoded.

    Warns of what was cut, chosen or converted: of OpenEXR files the display window is the picture.
    """
    return _core.read_picture(os.fspath(file))


def write_exr(file: str | os.PathLike[str], picture: PictureLike, *, half: bool = False) -> None:
    """Writes all layers to an OpenEXR file, atomically: on failure no partial file is left.

    Args:
        half: write 16-bit floats.
    """
    _core.write_exr(os.fspath(file), layers_of(picture), half)


def write_png(file: str | os.PathLike[str], pixels: NDArray[np.uint8]) -> None:
    """Writes height x width x 3 (or 4, with alpha) sRGB-encoded bytes, atomically: no partial file is left.

    Raises:
        InputError: the pixels are no bytes.
    """
    if np.asarray(pixels).dtype != np.uint8:
        raise InputError(
            f"pixels of {np.asarray(pixels).dtype} (a PNG holds display-encoded bytes) "
            "give tone_map(picture), or an array of uint8"
        )
    _core.write_png(os.fspath(file), np.ascontiguousarray(pixels, np.uint8))
