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
    """What a session came to.

    Attributes:
        participant_id: "P001".
        folder: of its records; empty where nothing is kept, as the participant did not agree.
        is_complete, reason: every step of the plan is done; why not.
        trials, bad_trials, steps: of this part.
    """

    participant_id: str
    folder: Path
    is_complete: bool
    reason: str
    trials: int
    bad_trials: int
    steps: int


class Script:
    """An experiment of schema study/1 (docs/study.md), read and checked.

    Raises:
        ScriptError: it cannot be; with file, line and column.
        InputError: there is no such file.
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
        """How many; they are numbered from 1."""
        return self._core.participants

    @property
    def factors(self) -> dict[str, list[str]]:
        """Factor -> its levels."""
        return dict(self._core.factors)

    @property
    def blocks(self) -> dict[str, str]:
        """Block -> its task."""
        return dict(self._core.blocks)

    @property
    def doubts(self) -> list[str]:
        """What may be meant but seldom is, a line each."""
        return self._core.doubts()

    def text(self) -> str:
        """What it holds, for people."""
        return self._core.text()

    def participant_id(self, participant: int) -> str:
        """ "P001"; also of a participant whose plan cannot be, which raises ScriptError."""
        return self._core.participant_id(participant)

    def plan_tsv(self, participant: int) -> str:
        """The plan as the table plan.tsv that a session keeps: a line of names, then one per step."""
        return self._core.plan_tsv(participant)

    def plan_seconds(self, participant: int) -> float:
        """How long it is expected to take."""
        return self._core.plan_seconds(participant)

    def plan(self, participant: int) -> pandas.DataFrame:
        """Every step that will happen to a participant, in its order. Needs pandas.

        Raises:
            ScriptError: the plan cannot be. InputError: there is no such participant.
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
        """Takes one participant through the plan. After each step its journal is on the disk.

        Args:
            participant: from 1.
            presenter: shows the trials.
            dir: of the data set; "" = the script's ``record.dir``.
            session: 1 to 99.
            resume: goes on with the same remaining order where the session was cut off; begins it where there is
            none. about: what is worth keeping, beside `Presenter.about`.

        Raises:
            ScriptError: the session is there already, another process runs it, its script is another, the display
                fails the test that the script requires, the disk failed. What is there is never overwritten.
            BaseException: what the presenter raised, after the session was ended in order.
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
        """The same with model observers, in a moment.

        Args:
            participants: None = all.
            dir: of the data set; what is true of the observers is in its sourcedata/simulation/truth.json.
            observer: who answers (YAML, docs/study.md); "" = what is usual.
            seed: of observers and answers; None = that of the script.
            session, resume: as of `run`.
            gap_s: with resume: since the session was cut off.

        Raises:
            ScriptError: as of `run`.
        """
        chosen = range(1, self.participants + 1) if participants is None else participants
        return [
            _outcome(self._core.simulate(p, os.fspath(dir), os.fspath(observer), seed, session, resume, gap_s))
            for p in chosen
        ]


def example(name: str) -> str:
    """The text of a shipped script: "visibility2026", "pairs", "staircase", "rating"."""
    return _core.study_example(name)


def _outcome(d: dict[str, Any]) -> Outcome:
    return Outcome(**{**d, "folder": Path(d["folder"])})
