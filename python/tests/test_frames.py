"""Frames that follow each other."""

import numpy as np
import pytest

import lightwell
from lightwell import FrameRenderer, View, study


def made(n=3, threads=0, **settings):
    frames = FrameRenderer("cornell", size=(40, 24), threads=threads, bounces=2, **settings)
    return [frames.next(paths=1) for _ in range(n)]


def test_a_frame_is_there_as_radiance_and_as_bytes():
    frame = made(1, exposure=1.0)[0]
    assert frame.color.shape == (24, 40, 3) and frame.color.dtype == np.float32
    assert frame.uint8().shape == (24, 40, 3) and frame.uint8().dtype == np.uint8
    np.testing.assert_array_equal(frame.uint8(), lightwell.tone_map(frame.color, exposure_ev=1))
    assert not np.array_equal(frame.uint8(), lightwell.tone_map(frame.color))
    assert frame.paths == 1 and frame.seconds > 0
    signed = frame.signed()
    assert signed.min() >= -1 and signed.max() <= 1
    np.testing.assert_allclose((signed[-1] + 1) * 127.5, frame.uint8()[0], atol=1e-3)


def test_the_same_calls_give_the_same_pixels_on_any_number_of_threads():
    for a, b in zip(made(), made(threads=1)):
        np.testing.assert_array_equal(a.color, b.color)


def test_frames_at_rest_converge(cornell):
    reference = cornell.render("reference", size=(40, 24), paths=256, bounces=2).color
    frames = made(12)
    errors = [lightwell.compare(f.color, reference, ["relmse"])["relmse"] for f in (frames[0], frames[-1])]
    assert errors[1] < 0.5 * errors[0]
    assert frames[-1].still_frames > frames[0].still_frames


def test_settings_and_edits_change_the_next_frame():
    frames = FrameRenderer("cornell", size=(40, 24), bounces=2)
    before = frames.next(paths=1).color.copy()
    frames.set("bounces", 0)
    assert frames.get("bounces") == 0
    after = frames.next(paths=1)
    assert after.layer("L2").max() == 0 and after.color.mean() < before.mean()
    assert {"exposure", "bounces", "method"} <= {k["key"] for k in frames.keys()}
    for key, value in [
        ("no_such_key", 1),
        ("bounces", "many"),
        ("light.7.intensity", [1, 1, 1]),
        ("bounces", object()),
    ]:
        with pytest.raises(lightwell.InputError):
            frames.set(key, value)


def test_cameras_move_between_frames():
    frames = FrameRenderer("cornell", size=(40, 24), bounces=1)
    at_rest = frames.next(paths=1).color
    eye = frames.camera.copy()
    matrix = eye.world_from_camera.copy()
    matrix[0, 3] += 0.1
    eye.world_from_camera = matrix
    frames.camera = eye
    assert frames.camera.position[0] == pytest.approx(matrix[0, 3])
    moved = frames.next(paths=1)
    assert moved.still_frames <= 1 and not np.array_equal(at_rest, moved.color)


def test_several_views_are_rendered_together():
    frames = FrameRenderer("cornell", bounces=1)
    frames.views = {"left": View(size=(40, 24)), "right": View(size=(20, 16), partner="left")}
    frame = frames.next(paths=1)
    assert frame.layer("color", "left").shape == (24, 40, 3) and frame.layer("color", "right").shape == (16, 20, 3)
    frames.views = {"left": View(size=(40, 24), partner="nobody")}
    with pytest.raises(lightwell.InputError, match="nobody"):
        frames.next(paths=1)


def test_a_budget_chooses_the_paths():
    frames = FrameRenderer("cornell", size=(40, 24), bounces=1)
    paths = [frames.next(budget_s=0.1).paths for _ in range(6)]
    assert max(paths) > 1


def test_without_a_scene_it_says_so():
    with pytest.raises(lightwell.InputError, match="scene"):
        FrameRenderer().next()


def stimulus(**settings):
    return study.Stimulus(levels={}, settings=settings, camera="", level=None, settings_sha256="")


def test_a_stimulus_brings_its_scene_and_settings_and_leaves_none_behind():
    frames = FrameRenderer(size=(40, 24))
    frames.show(stimulus(scene="cornell", bounces="0"))
    assert frames.scene == "cornell" and frames.get("bounces") == 0
    frames.show(stimulus(scene="cornell"))
    assert frames.get("bounces") == 64
    with pytest.raises(lightwell.InputError, match="no_such"):
        frames.show(stimulus(scene="cornell", no_such="1"))


def test_the_path_of_a_stimulus_moves_the_camera():
    frames = FrameRenderer(size=(40, 24))
    orbit = study.Stimulus({}, {"scene": "cornell"}, "path:orbit", None, "")
    frames.show(orbit)
    frames.along_path(0.0, 4.0)
    start = frames.camera.position
    frames.along_path(1.0, 4.0)
    assert frames.camera.position != start
    frames.along_path(4.0, 4.0)
    assert frames.camera.position == pytest.approx(start)
