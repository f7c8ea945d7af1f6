"""The program whose results the module's are held to: LIGHTWELL_PROGRAM, else build/release/lightwell."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def program() -> str:
    path = os.environ.get("LIGHTWELL_PROGRAM") or str(ROOT / "build" / "release" / "lightwell")
    if not os.access(path, os.X_OK) or not os.access(path + "-render", os.X_OK):
        pytest.skip(f"{path} is not there: set LIGHTWELL_PROGRAM")
    return path


@pytest.fixture(scope="session")
def cornell():
    import lightwell

    return lightwell.load("cornell")
