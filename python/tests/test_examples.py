"""The examples as they are shipped, with a stand-in for PsychoPy's window."""

import ast
import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from lightwell import study

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def test_the_notebook_runs_as_a_script_and_its_errors_fall(tmp_path):
    options = ["--size", "48x36", "--budgets", "0.05,0.4", "--reference-s", "1", "--out", tmp_path / "e"]
    command = [sys.executable, EXAMPLES / "error_over_time.py", *options]
    printed = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    lines = [line.split() for line in printed.splitlines() if " relMSE " in line and " paths " in line]
    errors = [float(words[-1]) for words in lines if words[0] in ("reference", "paths")]
    assert len(errors) == 4 and errors[1] < errors[0] and errors[3] < errors[2], printed
    assert (tmp_path / "e_reference.png").exists()


class Stand:
    """What the example uses of psychopy.visual, .event and .core, on a clock that each flip moves on."""

    hz = 60.0

    def __init__(self, keys):
        self.time_s, self.flips, self.drawn, self.pictures, self.keys = 0.0, 0, [], [], keys

    def flip(self):
        self.flips += 1
        self.time_s += 1 / self.hz
        self.drawn.clear()

    def ImageStim(self, win, units, size, pos):
        return _Drawn(self, "image", size)

    def TextStim(self, win, **_):
        return _Drawn(self, "text", None)

    def getTime(self):
        self.time_s += 1e-4
        return self.time_s

    def wait(self, seconds):
        self.time_s += seconds

    def clearEvents(self):
        self.since = self.flips

    def getKeys(self, keyList):
        return [k for k in (self.keys(self.flips - self.since),) if k in keyList]

    def waitKeys(self, keyList):
        return keyList[:1]


class _Drawn:
    def __init__(self, stand, kind, size):
        self.stand, self.kind, self.size, self.image, self.text = stand, kind, size, None, ""

    def draw(self):
        self.stand.drawn.append(self.kind)
        if self.kind == "image":
            assert self.image.shape == (self.size[1], self.size[0], 3) and self.image.dtype == np.float32
            assert -1 <= self.image.min() and self.image.max() <= 1
            self.stand.pictures.append(self.image.copy())


@pytest.fixture(scope="module")
def example():
    spec = importlib.util.spec_from_file_location("psychopy_pairs", EXAMPLES / "psychopy_pairs.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def script(example, tmp_path):
    file = tmp_path / "pairs.yaml"
    file.write_text(
        example.SCRIPT.replace("stimulus_ms: 2000, timeout_ms: 10000", "stimulus_ms: 100, timeout_ms: 1000")
    )
    return study.Script(file)


def presenter(example, stand):
    return example.PsychoPyPresenter(stand, stand, stand, stand, (40, 30), stand.hz)


def test_the_psychopy_example_imports_psychopy_in_main_alone():
    tree = ast.parse((EXAMPLES / "psychopy_pairs.py").read_text())
    for node in ast.walk(tree):
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            names = [node.module] if isinstance(node, ast.ImportFrom) else [a.name for a in node.names]
            in_main = any(
                node in ast.walk(f) for f in tree.body if isinstance(f, ast.FunctionDef) and f.name == "main"
            )
            assert in_main or not any(n.startswith("psychopy") for n in names)


def test_the_psychopy_example_shows_what_lightwell_renders_and_keeps_the_answers(example, script, tmp_path):
    stand = Stand(lambda flips: "left" if flips == 8 else None)  # after the stimuli, which take 6 or 7 flips
    outcome = script.run(1, presenter(example, stand), dir=tmp_path / "data")
    assert outcome.is_complete and outcome.trials == 6
    records = study.read_records(tmp_path / "data", script.file)
    trials = records.trials
    assert trials["response"].eq("first").all() and trials["device"].eq("key:left").all()
    assert len(records.stimuli) == 12
    assert any(np.ptp(picture) > 0.1 for picture in stand.pictures)


def test_in_the_psychopy_example_no_answer_is_a_timeout_and_escape_can_be_resumed(example, script, tmp_path):
    def keys(flips):
        return "escape" if stand.flips > 60 else None

    stand = Stand(keys)
    with pytest.raises(KeyboardInterrupt):
        script.run(2, presenter(example, stand), dir=tmp_path / "data")
    stand = Stand(lambda flips: "right" if flips == 8 else None)
    assert script.run(2, presenter(example, stand), dir=tmp_path / "data", resume=True).is_complete
    entries = study.read_journal(tmp_path / "data/sub-P002/ses-01/beh/journal.jsonl")
    trials = [e for e in entries if e["kind"] == "trial_done"]
    assert trials[0]["reason"] == "timeout" and not trials[0]["is_valid"]
    assert trials[-1]["response"] == "second" and trials[-1]["is_valid"]
