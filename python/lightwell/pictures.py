"""Pictures: comparison, display, files. All arrays are rows from the top, pixels from the left, channels last."""

from __future__ import annotations

import os
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
    """Layers by name, as the program reads them: float32 without gaps. What is so already is not copied.

    A bare array is the layer "color".
    """
    layers = getattr(picture, "layers", picture)
    if not isinstance(layers, Mapping):
        layers = {"color": layers}
    return {name: np.ascontiguousarray(data, np.float32) for name, data in layers.items()}


def compare(
    image: PictureLike, reference: PictureLike, metrics: Sequence[str] = (), *, layer: str = "color"
) -> dict[str, float]:
    """How far a picture is from a reference, as ``lightwell compare`` measures it.

    Args:
        image, reference: height x width x 3 of linear radiance, or layers by name, or what `World.render`
        returned. If their sizes differ by a whole factor the larger one is averaged down. The metric "ztest"
        needs the layer "variance" of both.
        metrics: names from `metrics()`, such as "relmse", "flip"; () = those that the program measures by default.
        layer: which one is compared.

    Returns:
        Value by name; some metrics have several values ("bias.r").

    Raises:
        InputError: there is no such metric or layer, or the sizes do not fit.
    """
    values, _ = _core.compare(layers_of(image), layers_of(reference), list(metrics), layer)
    return values


def metrics() -> dict[str, str]:
    """All metrics of `compare` with what they mean."""
    return _core.metrics()


def flip_map(image: Floats, reference: Floats, *, hdr: bool = True, pixels_per_degree: float = 67.02064) -> Floats:
    """FLIP of each pixel: the difference that an observer sees where two pictures alternate.

    Args:
        image, reference: height x width x 3, linear Rec. 709; with ``hdr=False`` values in 0..1 are what is shown.
        hdr: the largest error over exposures (Andersson et al. 2021), else Andersson et al. 2020.
        pixels_per_degree: of visual angle; the default is that of the papers.

    Returns:
        height x width, 0 (none) to 1.
    """
    return _core.flip_map(
        np.ascontiguousarray(image, np.float32),
        np.ascontiguousarray(reference, np.float32),
        hdr,
        pixels_per_degree,
    )


def tone_map(color: PictureLike, *, exposure_ev: float = 0.0, curve: str = "srgb") -> NDArray[np.uint8]:
    """From linear radiance to a display: bytes as ``lightwell render --png`` writes them.

    Args:
        color: height x width x 3 float32, linear Rec. 709 radiance, W/(m2 sr); or what `World.render` returned.
        exposure_ev: stops; radiance is multiplied by 2 to this power.
        curve: "srgb" clips at 1, "filmic" rolls bright light off.

    Returns:
        height x width x 3, sRGB-encoded.
    """
    layers = layers_of(color)
    if "color" not in layers:
        raise InputError("there is no layer 'color' (it is what is shown) give an array, or layers with 'color'")
    return _core.tone_map(layers["color"], exposure_ev, curve)


def read_picture(file: str | os.PathLike[str]) -> dict[str, Floats]:
    """Layers of an OpenEXR, HDR, PNG or JPEG file by name, linear; those of 8 and 16 bits are sRGB-decoded."""
    return _core.read_picture(os.fspath(file))


def write_exr(file: str | os.PathLike[str], picture: PictureLike, *, half: bool = False) -> None:
    """Writes all layers; the file appears whole or not at all."""
    _core.write_exr(os.fspath(file), layers_of(picture), half)


def write_png(file: str | os.PathLike[str], pixels: NDArray[np.uint8]) -> None:
    """Writes height x width x 3 (or 4, with alpha) sRGB-encoded bytes; the file appears whole or not at all."""
    _core.write_png(os.fspath(file), np.ascontiguousarray(pixels, np.uint8))
