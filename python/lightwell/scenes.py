"""Scenes, cameras, and pictures of them by every light-transport method of the program."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any, Callable, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Camera
from .errors import InputError
from .pictures import Floats, tone_map

CameraLike = Union[str, Camera, None]
Point = Sequence[float]


@dataclass(frozen=True)
class Light:
    """A punctual light; surfaces that emit are `World.emitting_triangles`, the sky is `World.has_environment`.

    Attributes:
        type: "point", "spot" or "directional".
        position: m, in the world; of no meaning where it is directional.
        direction: unit, the way the light travels; of no meaning where it is a point.
        intensity: red, green, blue: W/sr, or of a directional light W/m2 across the beam.
        cos_inner, cos_outer: of a spot: full inside the inner cone, nothing outside the outer one.
        range_m: where it ends; 0 = nowhere.
    """

    type: str
    position: tuple[float, float, float]
    direction: tuple[float, float, float]
    intensity: tuple[float, float, float]
    cos_inner: float
    cos_outer: float
    range_m: float


@dataclass
class Rendered:
    """A picture and how it came about.

    Attributes:
        layers: name -> array, float32, height x width x 3, or height x width of "depth" and "alpha":
            "color" (linear Rec. 709 radiance, W/(m2 sr)) = "L0" (emitted) + "L1" (direct) + "L2" (indirect light),
            "albedo", "normal", "depth" (m), "position" (m), "variance" (of the mean, per channel); "alpha" where
            the background is transparent. The memory is the renderer's own, not a copy, and may be written to.
        seconds: for building structures and tracing paths.
        paths: per pixel.
        relmse: its own estimate of the relative error, from the variance; 0 = not known.
        end: why it ended: "paths", "budget", "error_target".
        options: what the method chose for itself, as options of the command line.
        losses: what was skipped, clamped or missing -> how often.
        stages_s: seconds by stage.
        note: what is to be said about it; "" = nothing.
    """

    layers: dict[str, Floats]
    seconds: float
    paths: int
    relmse: float
    end: str
    options: str
    losses: dict[str, int] = field(default_factory=dict)
    stages_s: dict[str, float] = field(default_factory=dict)
    note: str = ""

    @property
    def color(self) -> Floats:
        """height x width x 3, linear Rec. 709 radiance, W/(m2 sr)."""
        return self.layers["color"]

    @property
    def variance(self) -> Floats:
        """height x width x 3: of the mean that "color" is."""
        return self.layers["variance"]

    def uint8(self, exposure_ev: float = 0.0, curve: str = "srgb") -> NDArray[np.uint8]:
        """height x width x 3 for a display, see `tone_map`."""
        return tone_map(self.color, exposure_ev=exposure_ev, curve=curve)


class World:
    """A scene at one moment. Made by `load`; it never changes.

    Rendering it from several threads of Python at once is allowed.
    """

    def __init__(self, core: _core.World) -> None:
        self._core = core

    def __repr__(self) -> str:
        return f"<lightwell.World {self.name!r}: {len(self.triangles)} triangles>"

    @property
    def name(self) -> str:
        """The file or built-in name that was loaded."""
        return self._core.name

    @property
    def positions(self) -> Floats:
        """vertices x 3, m, relative to `origin`; read-only, not a copy."""
        return self._core.positions

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """triangles x 3 indices into `positions`; read-only, not a copy."""
        return self._core.triangles

    @property
    def origin(self) -> tuple[float, float, float]:
        """m, in the world: where `positions` has its zero. (0, 0, 0) but for scenes far from it."""
        return tuple(self._core.origin)  # type: ignore[return-value]

    @property
    def bounds(self) -> NDArray[np.float64]:
        """2 x 3: the lowest and the highest corner, m, in the world; zeros where there is nothing."""
        return np.asarray(self._core.bounds)

    @property
    def cameras(self) -> list[Camera]:
        """Those that the scene has."""
        return self._core.cameras

    def camera(self, name: str = "") -> Camera:
        """The named camera; "" = the scene's first, or where it has none, one that sees all of it.

        Raises:
            InputError: there is none of that name; the message lists the others.
        """
        return self._core.camera(name)

    @property
    def lights(self) -> list[Light]:
        """Punctual ones."""
        vectors = ("position", "direction", "intensity")
        return [Light(**{**light, **{k: tuple(light[k]) for k in vectors}}) for light in self._core.lights]

    @property
    def emitting_triangles(self) -> int:
        """How many triangles are lamps."""
        return self._core.emitting_triangles

    @property
    def has_environment(self) -> bool:
        """Whether there is a sky."""
        return self._core.has_environment

    @property
    def losses(self) -> dict[str, int]:
        """What was skipped, clamped or missing when it was loaded -> how often."""
        return self._core.losses

    def render(
        self,
        method: str = "slhb",
        *,
        camera: CameraLike = None,
        size: tuple[int, int] = (512, 512),
        paths: int | None = None,
        budget_s: float | None = None,
        until_relmse: float | None = None,
        bounces: int = 64,
        seed: int = 0,
        filter: str = "box",
        denoise: str = "none",
        threads: int = 0,
        progress: Callable[[float, int, float], object] | None = None,
        **options: Any,
    ) -> Rendered:
        """Renders a picture, the same bits as ``lightwell render`` with the same options.

        Other threads of Python run meanwhile. Ctrl-C stops it at its next pass and raises KeyboardInterrupt.

        Args:
            method: one of `methods()`.
            camera: one of the scene's by name, or a `Camera`; None = `World.camera()`.
            size: (width, height), pixels.
            paths: per pixel, at most; None = 64, or no limit where there is a budget or an error target.
            budget_s: seconds for structures and paths.
            until_relmse: ends when the estimated relative error is below.
            bounces: indirect ones; 0 = emitted and direct light only.
            seed: another seed, another noise.
            filter: of pixels: "box" or "tent".
            denoise: "none", "atrous", "discontinuity", "wide", "oidn" or "oidn-high" (Open Image Denoise, where it
                is installed); "variance" stays that of the unfiltered picture.
            threads: 0 = all. The picture does not depend on it.
            progress: called a few times a second with the share that is done (0..1), paths per pixel, and the
                estimated relative error. What it raises ends the render.
            **options: of the method, by the names of the command line's options (``lightwell render --help``)
                with _ for -: ``axes=8``, ``schedule="stored"``, ``packed=True``, ``light_paths=64``, ...

        Raises:
            InputError: the method, the camera or a value is wrong.
            KeyboardInterrupt: on Ctrl-C.
        """
        width, height = _size(size)
        keywords = {
            "width": width,
            "height": height,
            "paths": paths,
            "budget_s": budget_s,
            "until_relmse": until_relmse,
            "bounces": bounces,
            "seed": seed,
            "threads": threads,
            "filter": filter,
        }
        eye = camera if isinstance(camera, Camera) else self.camera(camera or "")
        result = _core.render(self._core, method, eye, keywords, options, denoise, progress)
        result["stages_s"] = dict(result["stages_s"])
        return Rendered(**result)


def _size(size: tuple[int, int]) -> tuple[int, int]:
    try:
        width, height = size
    except (TypeError, ValueError):
        raise InputError(f"size = {size!r} (it is two numbers) give (width, height)") from None
    return width, height


def load(
    scene: str | os.PathLike[str],
    *,
    time_s: float | None = None,
    environment: str | os.PathLike[str] = "",
    environment_rotate_deg: float = 0.0,
    environment_scale: float = 1.0,
    background: str = "",
) -> World:
    """Reads a scene. One without any light gets a white sky; such decisions are said on stderr.

    Args:
        scene: a glTF, YAML, OBJ, PLY, FBX, ... file, a folder of OBJ or PLY frames, or the name of a scene that
        the program makes: "atrium", "cornell", "mirror", "avatar".
        time_s: moment of its animation, s; None = at rest.
        environment: an HDR or EXR file, a map of the sky in place of the scene's.
        environment_rotate_deg: about +Y, counter-clockwise from above.
        environment_scale: factor on its radiance.
        background: what cameras see past all surfaces: "map", "transparent" or "R,G,B" (radiance); "" = as the
        scene says.

    Raises:
        InputError: it is no scene, or a value is wrong.
    """
    core = _core.load(
        os.fspath(scene), time_s, os.fspath(environment), environment_rotate_deg, environment_scale, background
    )
    return World(core)


def methods() -> dict[str, str]:
    """All light-transport methods with what they do."""
    return _core.methods()
