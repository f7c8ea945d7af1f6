"""Scenes, and pictures of them rendered by any light-transport method of the program."""

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
    """A punctual light. For emissive surfaces see `World.emitting_triangles`, for the sky `World.has_environment`.

    Attributes:
        type: "point", "spot" or "directional".
        position: in world coordinates, m; unused by directional lights.
        direction: unit vector in which the light travels; unused by point lights.
        intensity: red, green, blue: W/sr; for directional lights W/m2 perpendicular to the beam.
        cos_inner, cos_outer: cosines of a spot's cones: full intensity inside the inner, none outside the outer.
        range_m: distance at which the light ends; 0 = unlimited.
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
    """A rendered picture with statistics of its rendering.

    Attributes:
        layers: name -> array, float32, height x width x 3; "depth" and "alpha" are height x width.
            "color" (linear Rec. 709 radiance, W/(m2 sr)) = "L0" (emitted) + "L1" (direct) + "L2" (indirect light),
            "albedo", "normal", "depth" (m), "position" (m), "variance" (of the mean, per channel); "alpha" only if
            the background is transparent. The memory is the renderer's own, not a copy, and may be written to.
        seconds: time for building structures and tracing paths.
        paths: paths per pixel.
        relmse: relative mean squared error, estimated from the variance; 0 = unknown.
        end: why rendering ended: "paths", "budget", "error_target".
        options: options that the method chose itself, as on the command line.
        method: the method that rendered: of "auto", the one that it chose.
        why_method: why "auto" chose it; "" = it was asked for.
        resumable: the file `state` remains, for more paths with ``resume=True``.
        losses: counts of everything skipped, clamped or missing, by name.
        stages_s: seconds of each stage.
        note: a remark about the picture; "" = none.
    """

    layers: dict[str, Floats]
    seconds: float
    paths: int
    relmse: float
    end: str
    options: str
    method: str = ""
    why_method: str = ""
    resumable: bool = False
    losses: dict[str, int] = field(default_factory=dict)
    stages_s: dict[str, float] = field(default_factory=dict)
    note: str = ""

    @property
    def color(self) -> Floats:
        """height x width x 3, linear Rec. 709 radiance, W/(m2 sr)."""
        return self.layers["color"]

    @property
    def variance(self) -> Floats:
        """Variance of the mean stored in "color", height x width x 3."""
        return self.layers["variance"]

    def uint8(self, exposure_ev: float = 0.0, curve: str = "srgb") -> NDArray[np.uint8]:
        """Returns height x width x 3 bytes for a display, see `tone_map`."""
        return tone_map(self.color, exposure_ev=exposure_ev, curve=curve)


class World:
    """A scene at one moment, loaded by `load`; immutable.

    Several Python threads may render it at once.
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
        """Vertex positions, vertices x 3, m, relative to `origin`; read-only, not a copy."""
        return self._core.positions

    @property
    def triangles(self) -> NDArray[np.uint32]:
        """Indices into `positions`, triangles x 3; read-only, not a copy."""
        return self._core.triangles

    @property
    def origin(self) -> tuple[float, float, float]:
        """World position of the zero of `positions`, m; (0, 0, 0) unless the scene is far from the origin."""
        return tuple(self._core.origin)  # type: ignore[return-value]

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lowest and highest corner in world coordinates, 2 x 3, m; zeros if the scene is empty."""
        return np.asarray(self._core.bounds)

    @property
    def cameras(self) -> list[Camera]:
        """Cameras of the scene."""
        return self._core.cameras

    def camera(self, name: str = "") -> Camera:
        """Returns the named camera; "" = the scene's first, or, if it has none, one that frames the whole scene.

        Raises:
            InputError: no camera has this name; the message lists the names.
        """
        return self._core.camera(name)

    @property
    def lights(self) -> list[Light]:
        """Punctual lights of the scene."""
        vectors = ("position", "direction", "intensity")
        return [Light(**{**light, **{k: tuple(light[k]) for k in vectors}}) for light in self._core.lights]

    @property
    def emitting_triangles(self) -> int:
        """Number of emissive triangles."""
        return self._core.emitting_triangles

    @property
    def has_environment(self) -> bool:
        """True if the scene has a sky (environment map)."""
        return self._core.has_environment

    @property
    def losses(self) -> dict[str, int]:
        """Counts of everything skipped, clamped or missing while loading, by name."""
        return self._core.losses

    def render(
        self,
        method: str = "auto",
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
        state: str | os.PathLike[str] = "",
        resume: bool = False,
        checkpoint_s: float = 30.0,
        **options: Any,
    ) -> Rendered:
        """Renders a picture, bit-identical to ``lightwell render`` with the same options.

        Other Python threads run meanwhile. Ctrl-C stops rendering after the current pass, saves its state, if a file
        for it is given, and raises KeyboardInterrupt; the same call with ``resume=True`` then gives the picture of an
        uninterrupted one. ``lightwell render --resume`` continues such a state too, and this one continues its.

        Args:
            method: a name from `methods()`.
            camera: name of a camera of the scene, or a `Camera`; None = `World.camera()`.
            size: (width, height), pixels.
            paths: maximum of paths per pixel; None = 64, or no limit if a budget or an error target is given.
            budget_s: seconds for building structures and tracing paths.
            until_relmse: stop when the estimated relative mean squared error falls below this value.
            bounces: maximum number of bounces; 0 = emitted and direct light only.
            seed: random seed; another seed gives another noise.
            filter: pixel filter, "box" or "tent".
            denoise: "none", "atrous", "discontinuity", "wide", "oidn" or "oidn-high" (Open Image Denoise, if
                installed); the layer "variance" remains that of the unfiltered picture.
            threads: number of threads, 0 = all. The picture does not depend on it.
            progress: called a few times a second with the completed fraction (0..1), paths per pixel, and the
                estimated relative mean squared error. An exception that it raises ends the render, as Ctrl-C does.
            state: file for the state of the unfinished picture, 92 bytes a pixel; deleted when the picture is
                complete. "" = none is kept.
            resume: continue from the file `state`, which is left by interrupted and killed renders and by those
                that a budget or an error target ended with ``resume=True``. Without the file, start afresh.
            checkpoint_s: seconds after which the state is saved again, for a crash; 0 = only when interrupted.
            **options: options of the method, named as on the command line (``lightwell render --help``) with
                _ for -: ``axes=8``, ``schedule="stored"``, ``packed=True``, ``light_paths=64``, ...

        Raises:
            InputError: the method, the camera or a value is invalid; `state` belongs to another render, or to an
                unfinished one that is not to be resumed.
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
            "state": os.fspath(state),
            "resume": resume,
            "checkpoint_s": checkpoint_s,
        }
        eye = camera if isinstance(camera, Camera) else self.camera(camera or "")
        result = _core.render(self._core, method, eye, keywords, options, denoise, progress)
        result["stages_s"] = dict(result["stages_s"])
        return Rendered(**result)


def _size(size: tuple[int, int]) -> tuple[int, int]:
    try:
        width, height = size
    except (TypeError, ValueError):
        raise InputError(f"size = {size!r} (a size is two numbers) give (width, height)") from None
    return width, height


def load(
    scene: str | os.PathLike[str],
    *,
    time_s: float | None = None,
    environment: str | os.PathLike[str] = "",
    environment_rotate_deg: float = 0.0,
    environment_scale: float = 1.0,
    background: str = "",
    light: str = "studio",
) -> World:
    """Loads a scene. A scene without any light gets lamps of a studio; a note on stderr reports such decisions.

    Args:
        scene: a glTF, YAML, OBJ, PLY, FBX, ... file, a folder of OBJ or PLY frames, or the name of a built-in
            scene: "atrium", "cornell", "mirror", "ring", "avatar".
        time_s: time in the scene's animation, s; None = at rest.
        environment: an HDR or EXR file, an environment map that replaces the scene's.
        environment_rotate_deg: rotation of the environment map about +Y, counter-clockwise seen from above.
        environment_scale: factor on the radiance of the environment map.
        background: what cameras see where there is no surface: "map", "transparent" or "R,G,B" (radiance);
            "" = as the scene specifies.
        light: what a scene without light gets: "studio" (lamps before a grey background, also where nothing but
            textures glow), "white" (a sky of radiance 1) or "none".

    Raises:
        InputError: the scene cannot be read, or a value is invalid.
    """
    core = _core.load(
        os.fspath(scene), time_s, os.fspath(environment), environment_rotate_deg, environment_scale, background, light
    )
    return World(core)


def methods() -> dict[str, str]:
    """Returns the light-transport methods: name -> description."""
    return _core.methods()
