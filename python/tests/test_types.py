"""Annotations: the package and its examples under strict rules, and the stub against what was compiled."""

import ast
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

import lightwell
from lightwell import _core

PACKAGE = Path(lightwell.__file__).parent
EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def test_the_package_and_its_examples_have_types_that_hold(tmp_path):
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("mypy is not installed (scripts/setup --tests)")
    # One run, whose cache the build keeps, as numpy's types take long. Of examples alone modules may be missing.
    settings = tmp_path / "mypy.ini"
    settings.write_text("[mypy]\n[mypy-psychopy.*,matplotlib.*]\nignore_missing_imports = True\n")
    cache = os.path.join(os.environ["LIGHTWELL_BUILD"], "mypy") if "LIGHTWELL_BUILD" in os.environ else "/dev/null"
    command = [sys.executable, "-m", "mypy", "--strict", f"--cache-dir={cache}", f"--config-file={settings}"]
    files = [PACKAGE, EXAMPLES / "error_over_time.py", EXAMPLES / "psychopy_pairs.py"]
    done = subprocess.run([*command, *files], capture_output=True, text=True, cwd=PACKAGE.parent)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (PACKAGE / "py.typed").exists()


def test_the_stub_names_all_that_was_compiled_and_nothing_else():
    stub = ast.parse((PACKAGE / "_core.pyi").read_text())

    def names(body):
        for node in body:
            if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
                yield node.name
            elif isinstance(node, ast.AnnAssign):
                yield node.target.id

    def public(thing):
        return {n for n in vars(thing) if not n.startswith("_")}

    assert set(names(stub.body)) == public(_core) - {"Array"}
    for node in stub.body:
        if isinstance(node, ast.ClassDef):
            stubbed = {n for n in names(node.body) if not n.startswith("_")}
            assert stubbed == public(getattr(_core, node.name)), node.name


def test_everything_public_has_a_docstring():
    for name in lightwell.__all__:
        thing = getattr(lightwell, name)
        if callable(thing):
            assert thing.__doc__ and len(thing.__doc__) > 20, name
