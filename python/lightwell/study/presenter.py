"""Base class for code that shows trials to a participant."""

from __future__ import annotations

import time
from typing import Any, Iterable, Mapping, Sequence

from .trial import Calibration, Note, Questionnaire, Trial, TrialDone


class Presenter:
    """Base class: shows trials to a participant and collects the answers. Override `show` and `instruct`, and the
    other methods if the script needs them.

    The session decides what is recorded, chosen and repeated; a presenter needs no state between calls. Methods
    return when the participant is done. Nothing is written to the disk during a call. An exception of a method,
    including KeyboardInterrupt, ends the session: completed steps are kept, the current trial is not, and
    `Script.run` raises the exception again. The session can be resumed later.
    """

    def show(self, trial: Trial) -> TrialDone | Mapping[str, Any]:
        """Runs one trial: pause of ``timing.iti_ms``, warm-up, stimuli, answer, feedback."""
        raise NotImplementedError("a Presenter shows trials: override show()")

    def instruct(self, markdown: str, step: int) -> None:
        """Shows instructions; returns when the participant has read them."""
        raise NotImplementedError("the script has instructions: override instruct()")

    def rest(self, prompt: str, least_s: float, step: int) -> None:
        """Shows a rest; returns when the participant continues, after `least_s` at the earliest.

        Args:
            step: index in the plan; -1 = an unplanned pause.
        """
        self.instruct(prompt, step)

    def walk(self, where: Trial, prompt: str, seconds: float) -> None:
        """Lets the participant walk freely in the scene ``where.stimuli["a"]`` for `seconds`."""
        raise NotImplementedError("the script has free walks: override walk()")

    def ask(self, questionnaire: Questionnaire, step: int) -> Sequence[float | str | None]:
        """Shows a questionnaire; returns one answer per item (texts as str), None = not answered."""
        raise NotImplementedError("the script has questionnaires: override ask()")

    def ask_consent(self, markdown: str) -> bool:
        """Asks for consent; returns True if the participant agrees. Otherwise nothing is recorded."""
        raise NotImplementedError("the script asks for consent: override ask_consent()")

    def ask_participant(self, questions: Sequence[str | Mapping[str, Any]]) -> Mapping[str, str]:
        """Asks questions about the participant; returns id -> answer.

        Args:
            questions: ids of plain ones; for typed ones mappings with id, text, type (text, number, choice) and min,
                max, whole or choices. Answers of another type are recorded with a warning.
        """
        raise NotImplementedError("the script asks about the participant: override ask_participant()")

    def calibrate(self, timing: Mapping[str, Any]) -> Calibration | Mapping[str, Any]:
        """Measures the display before the first trial of each part of a session.

        Args:
            timing: limits of the script: frames, max_sd_ms, max_deviation, expected_hz, vsync.
        """
        return Calibration(reason="this presenter does not measure its display")

    def now(self) -> float:
        """Returns seconds of a monotonic clock. All times of a session refer to this clock."""
        return time.monotonic()

    def about(self) -> Mapping[str, str]:
        """Returns facts to record about the device, such as driver and display."""
        return {}

    def wish(self) -> str:
        """Returns the experimenter's choice, called between steps: "go_on", "pause", "skip" or "abort"."""
        return "go_on"

    def notes(self) -> Iterable[Note]:
        """Returns the notes taken since the last call."""
        return ()
