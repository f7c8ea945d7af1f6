"""Sequences of frames for display loops: stimuli, animations, head-tracked views."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Camera
from .errors import InputError
from .pictures import Floats, tone_map
from .scenes import CameraLike, _size

if TYPE_CHECKING:
    from .study import Stimulus


@dataclass(frozen=True)
class View:
    """A camera and a picture size, such as an eye or a wall. A frame has one picture per view.

    Attributes:
        camera: name of a camera of the scene, or a `Camera`; None = the scene's first.
        size: (width, height), pixels.
        partner: name of an earlier view that sees nearly the same, such as the other eye; this view reuses its
            light. "" = none.
    """

    camera: CameraLike = None
    size: tuple[int, int] = (512, 512)
    partner: str = ""


@dataclass
class Frame:
    """A frame rendered by `FrameRenderer.next`.

    Attributes:
        views: view name -> layer name -> array, as in `Rendered.layers`; not copies.
        paths: paths per pixel.
        still_frames: number of frames since anything moved or changed, including this one; up to `reuse` of them
            are averaged.
        seconds: time that rendering took.
        stages_s: seconds of each stage.
        options: options that the method chose itself.
    """

    views: dict[str, dict[str, Floats]]
    paths: int
    still_frames: int
    seconds: float
    stages_s: dict[str, float]
    options: str
    _tone: dict[str, Any] = field(default_factory=dict, repr=False)

    def layer(self, name: str = "color", view: str = "") -> Floats:
        """Returns a layer of one view, height x width x channels; view "" = the first."""
        return self.views[view or next(iter(self.views))][name]

    @property
    def color(self) -> Floats:
        """The first view, height x width x 3: linear Rec. 709 radiance, W/(m2 sr)."""
        return self.layer()

    def uint8(self, view: str = "") -> NDArray[np.uint8]:
        """Returns height x width x 3 bytes for a display; uses the frame's settings `exposure` and `tone`."""
        return tone_map(self.layer("color", view), **self._tone)

    def signed(self, view: str = "") -> Floats:
        """Returns an array for PsychoPy's ``ImageStim``: height x width x 3 in -1 to 1, *bottom* row first."""
        return np.ascontiguousarray(self.uint8(view)[::-1].astype(np.float32) / 127.5 - 1.0)


class FrameRenderer:
    """Renders one frame per call of `next`, reusing the light of earlier frames.

    The same settings, cameras, paths and times in the same order give the same pixels, on any number of threads.
    Calls from several threads wait for each other. For experiments give ``paths``: with ``budget_s`` the number
    of paths depends on the machine's speed.

    >>> frames = FrameRenderer("cornell", size=(64, 64), bounces=2)
    >>> frames.set("exposure", 1.0)
    >>> frames.next(paths=1).uint8().shape
    (64, 64, 3)
    """

    def __init__(
        self,
        scene: str | os.PathLike[str] = "",
        *,
        size: tuple[int, int] = (512, 512),
        camera: CameraLike = None,
        threads: int = 0,
        **settings: Any,
    ) -> None:
        """
        Args:
            scene: a file or a built-in name, as for `load`; "" = none yet: use ``set("scene", ...)`` or `show`.
            size: (width, height) of the view, pixels.
            camera: name of a camera of the scene, or a `Camera`; None = the scene's first.
            threads: number of threads; 0 = all.
            **settings: keys of `set`: ``method="paths"``, ``bounces=3``, ``reuse=16``, ...

        Raises:
            InputError: the scene or a setting is invalid.
        """
        self._core = _core.Frames(threads)
        self.views: dict[str, View] = {"": View(camera, _size(size))}
        """The views of each frame by name, in order; may be replaced between frames."""
        for key, value in settings.items():
            self.set(key, value)
        if scene:
            self.set("scene", os.fspath(scene))
        self._path: _core.StimulusSettings | None = None

    @property
    def scene(self) -> str:
        """The scene's name; "" = none."""
        return str(self._core.get("scene"))

    def set(self, key: str, value: Any) -> None:
        """Sets a setting of the viewer: a key of `keys()`, "scene", or an edit of the scene:

        ``object.NODE.position`` (m), ``object.NODE.rotation`` (x, y, z, w), ``object.NODE.scale``,
        ``light.N.intensity``, ``light.N.position``, ``material.NAME.base_color``, ``.roughness``, ``.metallic``,
        ``.emission``, ``environment.rotation`` (radians), ``environment.scale``.

        Raises:
            InputError: the key is unknown or the value is invalid; nothing has changed then.
        """
        self._core.set(key, value)

    def get(self, key: str) -> Any:
        """Returns the value of a key of `keys()`, or of "scene"."""
        return self._core.get(key)

    @staticmethod
    def keys() -> list[dict[str, Any]]:
        """Returns a dict per setting: key, type, what (meaning, unit), words (allowed values), low, high."""
        return _core.setting_keys()

    @property
    def camera(self) -> Camera:
        """The camera of the first view."""
        return self._eye(next(iter(self.views.values())).camera)

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self.look_from(camera)

    def look_from(self, camera: CameraLike) -> None:
        """Sets the camera of the first view: a `Camera`, a name of the scene, or None (the scene's first)."""
        name, view = next(iter(self.views.items()))
        self.views[name] = View(camera, view.size, view.partner)

    @property
    def losses(self) -> dict[str, int]:
        """Counts of everything skipped, clamped or missing so far, by name."""
        return self._core.losses

    def show(self, stimulus: Stimulus) -> None:
        """Applies scene, settings and camera of a stimulus of an experiment (`study.Trial.stimuli`).

        All other settings return to their defaults. The next frame is the first of the stimulus.

        Raises:
            InputError: the renderer does not know a key or a value.
        """
        wanted = _core.StimulusSettings(list(stimulus.settings.items()), stimulus.camera)
        self._core.take(wanted)
        self._path = wanted
        self.look_from(wanted.camera)

    def along_path(self, seconds: float, duration_s: float) -> None:
        """Moves the camera along the path of the stimulus (``camera: path:orbit``).

        Args:
            seconds: time since the onset of the stimulus.
            duration_s: time of one round.
        """
        if self._path is not None and self._path.moves:
            width, height = next(iter(self.views.values())).size
            self.camera = self._core.camera_at(self._path, width, height, seconds, duration_s)

    def next(self, *, paths: int | None = None, budget_s: float = 0.05, time_s: float = 0.0) -> Frame:
        """Renders the next frame. Other threads of Python run meanwhile; Ctrl-C raises KeyboardInterrupt.

        Args:
            paths: paths per pixel; None = as many as are expected to fit into `budget_s`.
            budget_s: target time of the frame, s; frames may take longer.
            time_s: time of the scene's animations, s.

        Raises:
            InputError: there is no scene or no such camera, or a size is invalid.
        """
        names = list(self.views)
        orders = []
        for view in self.views.values():
            partner = self._partner(view, names)
            orders.append(("", self._eye(view.camera), *_size(view.size), partner))
        made = self._core.next(orders, paths, budget_s, time_s)
        tone = {"exposure_ev": made["exposure_ev"], "curve": made["tone"]}
        return Frame(
            views=dict(zip(names, made["views"])),
            paths=made["paths"],
            still_frames=made["still_frames"],
            seconds=made["seconds"],
            stages_s=made["stages_s"],
            options=made["options"],
            _tone=tone,
        )

    def _eye(self, camera: CameraLike) -> Camera:
        return camera if isinstance(camera, Camera) else self._core.camera(camera or "")

    @staticmethod
    def _partner(view: View, names: list[str]) -> int:
        if view.partner == "":
            return -1
        if view.partner not in names:
            raise InputError(f"there is no view {view.partner!r} (a view's partner) choose one of: {names}")
        return names.index(view.partner)
