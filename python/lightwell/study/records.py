"""Records of sessions as tables, those of ``lightwell study export``."""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .. import _core

if TYPE_CHECKING:
    import pandas

NOTHING = "n/a"


def pandas_module() -> Any:
    try:
        import pandas
    except ImportError as error:
        raise ImportError(
            "tables need pandas (it is not installed in this Python) pip install pandas, or read texts: "
            "Script.plan_tsv(), study.read_journal()"
        ) from error
    return pandas


def table_of_text(tsv: str) -> pandas.DataFrame:
    """A table of the program: tabs between, n/a where there is nothing; words such as "none" stay words."""
    pd = pandas_module()
    table: pandas.DataFrame = pd.read_csv(io.StringIO(tsv), sep="\t", na_values=[NOTHING], keep_default_na=False)
    return table


def read_journal(file: str | os.PathLike[str]) -> list[dict[str, Any]]:
    """The entries of a journal.jsonl in order: "kind" and the fields that the program keeps. A last line that is
    not whole, as a killed process may leave it, is left out.

    Raises:
        ScriptError: lines are missing or were changed.
    """
    entries, _ = _core.read_journal(os.fspath(file))
    return entries


@dataclass(frozen=True)
class Records:
    """All sessions of a data set, finished or not. ``table.attrs["columns"]`` says what each column is, with its
    unit.

    Attributes:
        trials: a row per trial that was carried through, with every factor; `analysis` says whether it counts.
        stimuli: a row per stimulus that was shown in them.
        questionnaires: a row per item, then one per score.
        happenings: starts, calibrations, instructions, rests, walks, notes, ends.
        participants: a row each.
    """

    trials: pandas.DataFrame
    stimuli: pandas.DataFrame
    questionnaires: pandas.DataFrame
    happenings: pandas.DataFrame
    participants: pandas.DataFrame


def read_records(dir: str | os.PathLike[str], script: str | os.PathLike[str] = "") -> Records:
    """Reads every journal of a data set. Needs pandas.

    Args:
        dir: of the data set: what `Script.run` and `Script.simulate` were given.
        script: with which it was recorded; "" = the one in DIR/code, where `rebuild` keeps it.

    Raises:
        ScriptError: there is no session or no script, or a journal is broken or of another script.
    """
    pandas_module()
    tables = {}
    for name, (text, columns) in _core.export_tables(os.fspath(dir), os.fspath(script)).items():
        tables[name] = table_of_text(text)
        tables[name].attrs["columns"] = columns
    return Records(**tables)


def rebuild(dir: str | os.PathLike[str], script: str | os.PathLike[str] = "") -> int:
    """Writes the BIDS tables of a data set anew, and keeps the script in DIR/code: ``lightwell study rebuild``.

    Returns:
        How many files were written.

    Raises:
        ScriptError: as of `read_records`.
    """
    return _core.rebuild_tables(os.fspath(dir), os.fspath(script))
