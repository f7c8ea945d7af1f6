"""Frames that follow each other, for loops that show them: stimuli, animations, head-tracked views."""

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
    """One picture of each frame: an eye, a wall.

    Attributes:
        camera: one of the scene's by name, or a `Camera`; None = the scene's first.
        size: (width, height), pixels.
        partner: name of an earlier view that sees nearly the same, as the other eye does: light found for it is
            reused; "" = none.
    """

    camera: CameraLike = None
    size: tuple[int, int] = (512, 512)
    partner: str = ""


@dataclass
class Frame:
    """What `FrameRenderer.next` made.

    Attributes:
        views: name -> layer -> array, as `Rendered.layers`; not copies.
        paths: per pixel.
        still_frames: since anything moved or changed, this one counted: so many were averaged, up to `reuse`.
        seconds: that it took.
        stages_s: of these, by stage.
        options: what the method chose for itself.
    """

    views: dict[str, dict[str, Floats]]
    paths: int
    still_frames: int
    seconds: float
    stages_s: dict[str, float]
    options: str
    _tone: dict[str, Any] = field(default_factory=dict, repr=False)

    def layer(self, name: str = "color", view: str = "") -> Floats:
        """height x width x channels of one view; "" = the first."""
        return self.views[view or next(iter(self.views))][name]

    @property
    def color(self) -> Floats:
        """height x width x 3 of the first view: linear Rec. 709 radiance, W/(m2 sr)."""
        return self.layer()

    def uint8(self, view: str = "") -> NDArray[np.uint8]:
        """height x width x 3 for a display, with the settings `exposure` and `tone` that it was rendered with."""
        return tone_map(self.layer("color", view), **self._tone)

    def signed(self, view: str = "") -> Floats:
        """As PsychoPy's ``ImageStim`` takes arrays: height x width x 3 from -1 to 1, the *bottom* row first."""
        return np.ascontiguousarray(self.uint8(view)[::-1].astype(np.float32) / 127.5 - 1.0)


class FrameRenderer:
    """Renders a frame whenever it is asked for one, reusing the light of those before.

    The same settings, cameras, paths and times in the same order give the same pixels, on any number of threads.
    Calls from several threads wait for each other. For experiments give ``paths``; with ``budget_s`` the number
    of paths follows the machine's speed.

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
            scene: a file or a built-in name as of `load`; "" = none yet (``set("scene", ...)``, or `show`).
            size: (width, height) of the view, pixels.
            camera: from where.
            threads: 0 = all.
            **settings: as of `set`: ``method="slhb"``, ``bounces=3``, ``reuse=16``, ...

        Raises:
            InputError: the scene or a setting is wrong.
        """
        self._core = _core.Frames(threads)
        self.views: dict[str, View] = {"": View(camera, _size(size))}
        """The pictures of each frame by name, in order; may be replaced between frames."""
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
        """Sets what the viewer can set: a key of `keys()`, "scene", or an edit of the scene:

        ``object.NODE.position`` (m), ``object.NODE.rotation`` (x, y, z, w), ``object.NODE.scale``,
        ``light.N.intensity``, ``light.N.position``, ``material.NAME.base_color``, ``.roughness``, ``.metallic``,
        ``.emission``, ``environment.rotation`` (radians), ``environment.scale``.

        Raises:
            InputError: there is no such key, or the value cannot be; nothing has changed then.
        """
        self._core.set(key, value)

    def get(self, key: str) -> Any:
        """The value of a key of `keys()`, or of "scene"."""
        return self._core.get(key)

    @staticmethod
    def keys() -> list[dict[str, Any]]:
        """Every setting: key, type, what it is (with its unit), words that it may be, low and high of numbers."""
        return _core.setting_keys()

    @property
    def camera(self) -> Camera:
        """Of the first view."""
        return self._eye(next(iter(self.views.values())).camera)

    @camera.setter
    def camera(self, camera: Camera) -> None:
        self.look_from(camera)

    def look_from(self, camera: CameraLike) -> None:
        """Sets the camera of the first view: a `Camera`, one of the scene's by name, or None (its first)."""
        name, view = next(iter(self.views.items()))
        self.views[name] = View(camera, view.size, view.partner)

    @property
    def losses(self) -> dict[str, int]:
        """What was skipped, clamped or missing so far -> how often."""
        return self._core.losses

    def show(self, stimulus: Stimulus) -> None:
        """Takes scene, settings and camera of a stimulus of an experiment (`study.Trial.stimuli`), all others as
        they are by default; the next frame is the first of it.

        Raises:
            InputError: the renderer does not know a key or a value.
        """
        wanted = _core.StimulusSettings(list(stimulus.settings.items()), stimulus.camera)
        self._core.take(wanted)
        self._path = wanted
        self.look_from(wanted.camera)

    def along_path(self, seconds: float, duration_s: float) -> None:
        """Puts the camera where the path of the stimulus (``camera: path:orbit``) has it, so long after its onset.

        Args:
            seconds: since the onset.
            duration_s: that one round takes.
        """
        if self._path is not None and self._path.moves:
            width, height = next(iter(self.views.values())).size
            self.camera = self._core.camera_at(self._path, width, height, seconds, duration_s)

    def next(self, *, paths: int | None = None, budget_s: float = 0.05, time_s: float = 0.0) -> Frame:
        """Renders the next frame. Other threads of Python run meanwhile; Ctrl-C raises KeyboardInterrupt.

        Args:
            paths: per pixel; None = what is expected to fit into `budget_s`.
            budget_s: s that the frame should take; it is aimed at, not kept.
            time_s: time of the scene's animations, s.

        Raises:
            InputError: there is no scene, no such camera, or a size cannot be.
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
            raise InputError(f"there is no view {view.partner!r} (a view is its partner's) choose one of: {names}")
        return names.index(view.partner)
