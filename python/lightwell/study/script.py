"""Scripts, their plans, and sessions of them."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Mapping

from .. import _core
from ._steps import Steps
from .presenter import Presenter
from .records import table_of_text

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Outcome:
    """Result of a session.

    Attributes:
        participant_id: for example "P001".
        folder: folder of its records; empty if nothing is recorded because the participant did not consent.
        is_complete, reason: True if every step of the plan is done; otherwise why not.
        trials, bad_trials, steps: numbers in this part of the session, since it was started or resumed.
        plan_remark: how the recorded plan of a resumed session differs from the one that this version makes; empty if
            it does not.
    """

    participant_id: str
    folder: Path
    is_complete: bool
    reason: str
    trials: int
    bad_trials: int
    steps: int
    plan_remark: str


class Script:
    """An experiment script of schema study/1 (docs/study.md), read and checked.

    Raises:
        ScriptError: the script is invalid; the error has file, line and column.
        InputError: the file does not exist.
    """

    def __init__(self, file: str | os.PathLike[str]) -> None:
        self.file = Path(file)
        self._core = _core.Script(os.fspath(file))

    def __repr__(self) -> str:
        return f"<lightwell.study.Script {self.id!r}: {self.participants} participants>"

    @property
    def id(self) -> str:
        return self._core.id

    @property
    def title(self) -> str:
        return self._core.title

    @property
    def seed(self) -> int:
        return self._core.seed

    @property
    def participants(self) -> int:
        """Number of participants; they are numbered from 1."""
        return self._core.participants

    @property
    def factors(self) -> dict[str, list[str]]:
        """Factor name -> names of its levels."""
        return dict(self._core.factors)

    @property
    def blocks(self) -> dict[str, str]:
        """Block name -> its task."""
        return dict(self._core.blocks)

    @property
    def doubts(self) -> list[str]:
        """Warnings about valid but unusual parts of the script, one line each."""
        return self._core.doubts()

    def text(self) -> str:
        """Returns a readable summary of the script."""
        return self._core.text()

    def participant_id(self, participant: int) -> str:
        """Returns the participant's id, such as "P001".

        Raises:
            ScriptError: the participant's plan is impossible.
        """
        return self._core.participant_id(participant)

    def plan_tsv(self, participant: int) -> str:
        """Returns the plan as text, the table plan.tsv of a session: a line of column names, then one per step."""
        return self._core.plan_tsv(participant)

    def plan_seconds(self, participant: int) -> float:
        """Returns the expected duration of the session in seconds."""
        return self._core.plan_seconds(participant)

    def plan(self, participant: int) -> pandas.DataFrame:
        """Returns every step of a participant's session in order. Needs pandas.

        Raises:
            ScriptError: the plan is impossible.
            InputError: there is no such participant.
        """
        return table_of_text(self.plan_tsv(participant))

    def run(
        self,
        participant: int,
        presenter: Presenter,
        *,
        dir: str | os.PathLike[str] = "",
        session: int = 1,
        resume: bool = False,
        about: Mapping[str, str] | None = None,
    ) -> Outcome:
        """Runs the session of one participant. The journal is on the disk after each step.

        Args:
            participant: number of the participant, from 1.
            presenter: shows the trials.
            dir: folder of the data set; "" = the script's ``record.dir``.
            session: number of the session, 1 to 99.
            resume: continue an interrupted session with its remaining steps in the same order; start it if it
                does not exist.
            about: facts to record, in addition to `Presenter.about`.

        Raises:
            ScriptError: the session exists already, another process runs it, it was recorded with another script,
                the display fails the test that the script requires, or the disk failed. Existing records are
                never overwritten.
            BaseException: an exception of the presenter, raised again after the session was ended properly.
        """
        outcome = self._core.run(
            participant,
            Steps(presenter),
            os.fspath(dir) or self._core.record_dir,
            session,
            resume,
            [(str(k), str(v)) for k, v in (about or {}).items()],
        )
        return _outcome(outcome)

    def simulate(
        self,
        participants: Iterable[int] | None = None,
        *,
        dir: str | os.PathLike[str],
        observer: str | os.PathLike[str] = "",
        seed: int | None = None,
        session: int = 1,
        resume: bool = False,
        gap_s: float = 0.0,
    ) -> list[Outcome]:
        """Runs sessions with model observers on a simulated clock, without waiting.

        Args:
            participants: numbers of the participants; None = all.
            dir: folder of the data set; the observers' true parameters go to its sourcedata/simulation/truth.json.
            observer: file that describes the model observers (YAML, docs/study.md); "" = the default observers.
            seed: seed of observers and answers; None = that of the script.
            session, resume: as for `run`.
            gap_s: with resume: simulated seconds between the interruption and resuming.

        Raises:
            ScriptError: as for `run`.
        """
        chosen = range(1, self.participants + 1) if participants is None else participants
        return [
            _outcome(self._core.simulate(p, os.fspath(dir), os.fspath(observer), seed, session, resume, gap_s))
            for p in chosen
        ]


def example(name: str) -> str:
    """Returns the text of an example script: "visibility2026", "pairs", "staircase" or "rating"."""
    return _core.study_example(name)


def _outcome(d: dict[str, Any]) -> Outcome:
    return Outcome(**{**d, "folder": Path(d["folder"])})
