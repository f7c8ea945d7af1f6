"""Scenes and pictures."""

import _thread
import shutil
import subprocess
import threading
import time

import numpy as np
import pytest

import lightwell

SIZE = (48, 32)


def test_a_scene_is_loaded_with_its_triangles_cameras_bounds_and_lights(cornell):
    assert cornell.triangles.dtype == np.uint32 and cornell.triangles.shape[1] == 3
    assert cornell.positions.dtype == np.float32 and cornell.positions.shape[1] == 3
    assert cornell.triangles.max() < len(cornell.positions)
    low, high = cornell.bounds
    positions = cornell.positions + np.asarray(cornell.origin)
    np.testing.assert_allclose(low, positions.min(axis=0), atol=1e-6)
    np.testing.assert_allclose(high, positions.max(axis=0), atol=1e-6)
    assert cornell.emitting_triangles > 0 and cornell.lights == []
    assert [c.name for c in cornell.cameras] and cornell.camera() == cornell.cameras[0]


def test_the_arrays_of_a_world_are_its_own_memory_and_read_only(cornell):
    assert np.shares_memory(cornell.positions, cornell.positions)
    with pytest.raises(ValueError):
        cornell.positions[0] = 0


def test_arrays_outlive_what_they_came_from():
    world = lightwell.load("cornell")
    positions = world.positions
    expected = positions.copy()
    color = world.render(size=SIZE, paths=1, bounces=1).color
    again = color.copy()
    del world
    np.testing.assert_array_equal(positions, expected)
    np.testing.assert_array_equal(color, again)


@pytest.mark.parametrize("method", ["paths", "slhb", "reference"])
def test_pictures_equal_those_of_the_program_bit_for_bit(program, cornell, tmp_path, method):
    out = tmp_path / "a.exr"
    options = ["--method", method, "--size", "48x32", "--paths", "4", "--bounces", "3", "--seed", "5"]
    subprocess.run(
        [program, "render", "cornell", *options, "--out", out, "--quiet"], check=True, capture_output=True
    )
    theirs = lightwell.read_picture(out)
    ours = cornell.render(method, size=SIZE, paths=4, bounces=3, seed=5)
    assert set(theirs) == set(ours.layers)
    for name, layer in theirs.items():
        np.testing.assert_array_equal(ours.layers[name], layer, err_msg=name)
        assert ours.layers[name].dtype == np.float32
    assert ours.paths == 4 and ours.end == "paths" and ours.seconds > 0


def test_bytes_equal_those_of_the_program(program, cornell, tmp_path):
    png, exr = tmp_path / "a.png", tmp_path / "a.exr"
    command = [program, "render", "cornell", "--size", "48x32", "--paths", "1", "--exposure", "1", "--quiet"]
    subprocess.run([*command, "--png", png, "--out", exr], check=True, capture_output=True)
    ours = lightwell.tone_map(lightwell.read_picture(exr), exposure_ev=1)
    assert ours.dtype == np.uint8 and ours.shape == (32, 48, 3)
    copy = tmp_path / "b.png"
    lightwell.write_png(copy, ours)
    np.testing.assert_array_equal(lightwell.read_picture(copy)["color"], lightwell.read_picture(png)["color"])


def test_layers_have_the_shapes_that_the_documentation_says(cornell):
    picture = cornell.render(size=SIZE, paths=2, bounces=2)
    for name in ("color", "L0", "L1", "L2", "albedo", "normal", "position", "variance"):
        assert picture.layers[name].shape == (32, 48, 3), name
    assert picture.layers["depth"].shape == (32, 48)
    total = picture.layers["L0"] + picture.layers["L1"] + picture.layers["L2"]
    np.testing.assert_allclose(picture.color, total, rtol=1e-5, atol=1e-6)
    assert picture.color.flags.writeable


def test_cameras_are_chosen_by_name_place_and_matrix(cornell):
    by_name = cornell.render(size=SIZE, paths=1, bounces=0, camera=cornell.cameras[0].name)
    default = cornell.render(size=SIZE, paths=1, bounces=0)
    np.testing.assert_array_equal(by_name.color, default.color)
    eye = lightwell.Camera.look_at((0.3, 0.3, -0.4), (0.3, 0.2, 0.3), fov_deg=60)
    other = lightwell.Camera()
    other.world_from_camera = eye.world_from_camera
    other.fov_deg = 60
    np.testing.assert_allclose(other.position, (0.3, 0.3, -0.4))
    a, b = (cornell.render(size=SIZE, paths=1, bounces=0, camera=c).color for c in (eye, other))
    np.testing.assert_array_equal(a, b)
    assert not np.array_equal(a, default.color)


def test_a_budget_ends_a_render(cornell):
    picture = cornell.render(size=SIZE, budget_s=0.2)
    assert picture.end == "budget" and picture.paths > 1


@pytest.mark.parametrize(
    "call, part",
    [
        (lambda w: w.render("radiosity2"), "radiosity2"),
        (lambda w: w.render(size=(0, 4)), "width"),
        (lambda w: w.render(size=4), "size"),
        (lambda w: w.render(size=SIZE, paths=0), "paths"),
        (lambda w: w.render(size=SIZE, camera="nobody"), "nobody"),
        (lambda w: w.render(size=SIZE, bounces=-1), "bounces"),
        (lambda w: w.render(size=SIZE, filter="gauss"), "gauss"),
        (lambda w: w.render(size=SIZE, denoise="nlm"), "nlm"),
        (lambda w: w.render("reference", size=SIZE, axes=3), "--axes"),
        (lambda w: w.render(size=SIZE, axis=3), "axis"),
        (lambda w: w.render("slhb", size=SIZE, axes="many"), "axes"),
        (lambda w: w.render("slhb", size=SIZE, axes=1000), "axes"),
        (lambda w: w.render("slhb", size=SIZE, packed=3), "packed"),
        (lambda w: w.render("slhb", size=SIZE, schedule="stored", axes=3), "--axes"),
        (lambda w: w.render(size=SIZE, budget_s=float("nan")), "budget_s"),
        (lambda w: w.render(size=SIZE, resume=True), "state"),
        (lambda w: w.render(size=SIZE, state="no/such/folder/a.state"), "no/such/folder"),
        (lambda w: setattr(lightwell.Camera(), "world_from_camera", np.zeros((4, 4))), "world_from_camera"),
        (lambda w: lightwell.Camera.look_at((0, 0, 0), (0, 0, 0)), "camera"),
        (lambda w: lightwell.load("no such scene"), "no such scene"),
        (lambda w: lightwell.compare(np.zeros((4, 4, 3)), np.zeros((5, 7, 3))), "size"),
        (lambda w: lightwell.compare(np.zeros((4, 4, 3), np.uint8), np.zeros((4, 4, 3))), "no radiance"),
        (lambda w: lightwell.write_png("never.png", np.zeros((4, 4, 3))), "tone_map"),
        (lambda w: lightwell.compare(np.zeros((4, 4)), np.zeros((4, 4, 3)), ["what"]), "what"),
        (lambda w: lightwell.tone_map(np.zeros((0, 4, 3))), "no picture"),
    ],
)
def test_what_is_wrong_is_said_with_why_and_what_to_do(cornell, call, part):
    with pytest.raises(lightwell.InputError) as raised:
        call(cornell)
    error = raised.value
    assert isinstance(error, ValueError) and part in str(error)
    assert error.problem and error.why and error.suggestion, str(error)


def test_other_threads_run_while_a_picture_is_rendered(cornell):
    ticks = []
    done = threading.Event()

    def count():
        while not done.is_set():
            ticks.append(time.monotonic())
            time.sleep(0.005)

    thread = threading.Thread(target=count)
    thread.start()
    picture = cornell.render("reference", size=SIZE, budget_s=0.5)
    done.set()
    thread.join()
    assert picture.seconds >= 0.4 and len(ticks) > 5


def test_ctrl_c_stops_a_render(cornell):
    threading.Timer(0.3, _thread.interrupt_main).start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        cornell.render("reference", size=SIZE, budget_s=60)
    assert time.monotonic() - start < 50


def test_progress_is_told_and_what_it_raises_ends_the_render(cornell):
    seen = []

    def progress(fraction, paths, relmse):
        seen.append((fraction, paths))
        if len(seen) == 3:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        cornell.render("reference", size=SIZE, budget_s=60, progress=progress)
    assert len(seen) == 3 and seen[0][1] <= seen[2][1]


def test_a_stopped_render_continues_bit_for_bit(cornell, tmp_path):
    state = tmp_path / "a.state"

    def stop(fraction, paths, relmse):
        raise RuntimeError("enough")

    call = {"size": (320, 240), "bounces": 2, "state": state}
    with pytest.raises(RuntimeError, match="enough"):
        cornell.render("reference", paths=1_000_000, progress=stop, **call)
    assert state.exists()
    with pytest.raises(lightwell.InputError, match="unfinished.*resume=True"):
        cornell.render("reference", paths=2, **call)
    ours = cornell.render("reference", paths=1, resume=True, **call)
    assert not state.exists() and not ours.resumable and ours.note == ""
    whole = cornell.render("reference", size=(320, 240), bounces=2, paths=ours.paths)
    for name, layer in whole.layers.items():
        np.testing.assert_array_equal(ours.layers[name], layer, err_msg=name)


def test_a_state_that_could_not_be_written_is_warned_of(cornell, tmp_path):
    folder = tmp_path / "gone"
    folder.mkdir()

    def stop(*_):
        shutil.rmtree(folder, ignore_errors=True)
        raise RuntimeError("enough")

    call = dict(size=(320, 240), paths=1_000_000, state=folder / "a.state", progress=stop)
    with pytest.warns(RuntimeWarning, match="does not hold the interrupted render"):
        with pytest.raises(RuntimeError, match="enough"):
            cornell.render("reference", **call)


def test_the_program_continues_a_state_of_python(program, cornell, tmp_path):
    state, out = tmp_path / "a.state", tmp_path / "a.exr"
    first = cornell.render("reference", size=SIZE, until_relmse=1e6, denoise="atrous", state=state, resume=True)
    assert first.resumable and first.end == "error_target" and state.exists() and "afresh" in first.note
    options = ["--method", "reference", "--size", "48x32", "--paths", "32", "--state", state, "--resume"]
    subprocess.run([program, "render", "cornell", *options, "--out", out], check=True, capture_output=True)
    whole = cornell.render("reference", size=SIZE, paths=32)
    np.testing.assert_array_equal(lightwell.read_picture(out)["color"], whole.color)
    assert first.paths < whole.paths and not whole.resumable and not state.exists()


def test_the_method_is_said_that_auto_chose(cornell):
    by_plan = cornell.render(size=SIZE, paths=1)
    assert by_plan.method == "paths" and "exact rays" in by_plan.why_method
    asked = cornell.render("reference", size=SIZE, paths=1)
    assert asked.method == "reference" and asked.why_method == ""


def test_pictures_are_compared_as_the_program_does(program, cornell, tmp_path):
    a, b = (cornell.render(size=SIZE, paths=p, bounces=2, seed=p) for p in (1, 16))
    values = lightwell.compare(a, b, ["relmse", "flip", "ztest"])
    lightwell.write_exr(tmp_path / "a.exr", a)
    lightwell.write_exr(tmp_path / "b.exr", b.layers)
    command = [program, "compare", tmp_path / "a.exr", tmp_path / "b.exr", "--metrics", "relmse,flip,ztest"]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    for line in printed.splitlines():
        name, value = line.split()
        assert values[name] == pytest.approx(float(value), rel=1e-5)
    assert lightwell.compare(a, a, ["relmse"])["relmse"] == 0
    assert lightwell.flip_map(a.color, b.color).shape == (32, 48)
    assert lightwell.flip_map(a.color, a.color).max() == 0


def test_methods_take_their_own_options(cornell):
    picture = cornell.render("slhb", size=SIZE, paths=1, schedule="stored", hit_buffer=32)
    assert "stored" in picture.options and "32" in picture.options


def test_every_method_and_metric_has_a_line():
    assert {"auto", "paths", "slhb", "reference"} <= set(lightwell.methods())
    assert {"relmse", "flip"} <= set(lightwell.metrics())
    assert all(lightwell.methods().values())
