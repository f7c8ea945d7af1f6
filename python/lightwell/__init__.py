"""Lightwell for Python: globally lit pictures as numpy arrays, live frames for stimuli, and experiments.

>>> import lightwell
>>> world = lightwell.load("cornell")
>>> picture = world.render("paths", size=(64, 64), paths=16)
>>> picture.color.shape, picture.color.dtype
((64, 64, 3), dtype('float32'))

Coordinate frames are right-handed, +Y up, in metres; pictures are linear Rec. 709 radiance, W/(m2 sr), top row
first. Invalid input raises `InputError`, whose message names the problem, why it is one, and a remedy.
"""

from . import _level

__path__ = [*_level.folders(__path__[0]), *__path__]

from . import study
from ._core import Camera, embree_version, git_hash, level, version
from .errors import InputError, ScriptError
from .frames import Frame, FrameRenderer, View
from .pictures import compare, flip_map, metrics, read_picture, tone_map, write_exr, write_png
from .scenes import Light, Rendered, World, load, methods

_level.check(level)
__version__ = version

__all__ = [
    "Camera",
    "Frame",
    "FrameRenderer",
    "InputError",
    "Light",
    "Rendered",
    "ScriptError",
    "View",
    "World",
    "compare",
    "embree_version",
    "flip_map",
    "git_hash",
    "level",
    "load",
    "methods",
    "metrics",
    "read_picture",
    "study",
    "tone_map",
    "version",
    "write_exr",
    "write_png",
]
