"""Which compiled module is imported: that of the best level that runs here, or of the one that is asked for."""

import pytest

from lightwell import _level

FEATURES = {"second": _level._SECOND, "third": _level._THIRD | {"avx512f"}, "fourth": _level._FOURTH}


@pytest.fixture
def package(tmp_path, monkeypatch):
    monkeypatch.delenv("LIGHTWELL_LEVEL", raising=False)
    for level in ("x86-64-v3", "x86-64-v4"):
        (tmp_path / level).mkdir()
    return tmp_path


@pytest.mark.parametrize("processor, wanted", [("second", None), ("third", "x86-64-v3"), ("fourth", "x86-64-v4")])
def test_the_best_level_that_runs_here(package, monkeypatch, processor, wanted):
    monkeypatch.setattr(_level, "_features", lambda: FEATURES[processor])
    assert _level.folders(str(package)) == ([str(package / wanted)] if wanted else [])


def test_processors_below_all_levels(package, monkeypatch):
    monkeypatch.setattr(_level, "_features", lambda: {"sse2"})
    with pytest.raises(ImportError, match="x86-64-v2 or higher"):
        _level.folders(str(package))


def test_the_level_that_is_asked_for(package, monkeypatch):
    monkeypatch.setattr(_level, "_features", lambda: FEATURES["fourth"])
    monkeypatch.setenv("LIGHTWELL_LEVEL", "x86-64-v3")
    assert _level.folders(str(package)) == [str(package / "x86-64-v3")]
    _level.check("x86-64-v3")
    with pytest.raises(ImportError, match="no module for it"):
        _level.check("x86-64-v2")
    monkeypatch.setenv("LIGHTWELL_LEVEL", "x86-64-v2")
    assert _level.folders(str(package)) == []
    _level.check("x86-64-v2")


@pytest.mark.parametrize("level, why", [("v3", "no such level"), ("x86-64-v4", "a lower level")])
def test_levels_that_cannot_be(package, monkeypatch, level, why):
    monkeypatch.setattr(_level, "_features", lambda: FEATURES["third"])
    monkeypatch.setenv("LIGHTWELL_LEVEL", level)
    with pytest.raises(ImportError, match=why):
        _level.folders(str(package))


def test_the_processor_is_read_as_the_program_reads_it():
    import lightwell

    assert lightwell.level == "x86-64" or _level.LEVELS[lightwell.level] <= _level._features()
