"""Records of sessions as the tables of ``lightwell study export``."""

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
            "tables need pandas (it is not installed in this Python) pip install pandas, or use plain text: "
            "Script.plan_tsv(), study.read_journal()"
        ) from error
    return pandas


def table_of_text(tsv: str) -> pandas.DataFrame:
    """Parses a table of the program: tab-separated, n/a = missing; words such as "none" stay strings."""
    pd = pandas_module()
    table: pandas.DataFrame = pd.read_csv(io.StringIO(tsv), sep="\t", na_values=[NOTHING], keep_default_na=False)
    return table


def read_journal(file: str | os.PathLike[str]) -> list[dict[str, Any]]:
    """Reads the entries of a journal.jsonl in order, each with "kind" and the fields of that kind.

    An incomplete last line, which a killed process may leave, is skipped.

    Raises:
        ScriptError: lines are missing or were changed.
    """
    entries, _ = _core.read_journal(os.fspath(file))
    return entries


@dataclass(frozen=True)
class Records:
    """All sessions of a data set, finished or not. ``table.attrs["columns"]`` describes each column with its unit.

    Attributes:
        trials: one row per trial that ran to its end, with every factor; `analysis` states whether it counts.
        stimuli: one row per stimulus shown in these trials.
        questionnaires: one row per item, then one per score.
        session_events: starts, calibrations, instructions, rests, walks, notes, ends.
        participants: one row per participant.
    """

    trials: pandas.DataFrame
    stimuli: pandas.DataFrame
    questionnaires: pandas.DataFrame
    session_events: pandas.DataFrame
    participants: pandas.DataFrame

    @property
    def happenings(self) -> pandas.DataFrame:
        """The former name of `session_events`."""
        return self.session_events


def read_records(dir: str | os.PathLike[str], script: str | os.PathLike[str] = "") -> Records:
    """Reads every journal of a data set. Needs pandas.

    Args:
        dir: folder of the data set, as passed to `Script.run` and `Script.simulate`.
        script: the script that it was recorded with; "" = the one in DIR/code, where `rebuild` copies it.

    Raises:
        ScriptError: there is no session or no script, or a journal is damaged or belongs to another script.
        InputError: a file cannot be read.
    """
    pandas_module()
    tables = {}
    for name, (text, columns) in _core.export_tables(os.fspath(dir), os.fspath(script)).items():
        tables[name] = table_of_text(text)
        tables[name].attrs["columns"] = columns
    return Records(**tables)


def rebuild(dir: str | os.PathLike[str], script: str | os.PathLike[str] = "") -> int:
    """Rewrites the BIDS tables of a data set and copies the script to DIR/code (``lightwell study rebuild``).

    Returns:
        Number of files written.

    Raises:
        ScriptError: as for `read_records`.
    """
    return _core.rebuild_tables(os.fspath(dir), os.fspath(script))
