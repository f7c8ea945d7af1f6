"""What shows trials to somebody."""

from __future__ import annotations

import time
from typing import Any, Iterable, Mapping, Sequence

from .trial import Calibration, Note, Questionnaire, Trial, TrialDone


class Presenter:
    """What shows trials to somebody and takes the answers: to be subclassed. `instruct` and `show` have to be
    there, the others where a script needs them.

    Everything that is kept, chosen or repeated is decided by the session; a presenter needs no memory from one
    call to the next. Methods return when the participant is done. Nothing is written to a disk meanwhile. What a
    method raises, KeyboardInterrupt too, ends the session: what is done is kept, the trial under way is not, and
    `Script.run` raises it again. The session can be gone on with later.
    """

    def show(self, trial: Trial) -> TrialDone | Mapping[str, Any]:
        """Pause of ``timing.iti_ms``, warm-up, stimuli, answer, feedback."""
        raise NotImplementedError("a Presenter shows trials: override show()")

    def instruct(self, markdown: str, step: int) -> None:
        """Returns when the text was read."""
        raise NotImplementedError("the script has instructions: override instruct()")

    def rest(self, prompt: str, least_s: float, step: int) -> None:
        """Returns when the participant goes on, after `least_s` at the earliest. `step` -1: a pause."""
        self.instruct(prompt, step)

    def walk(self, where: Trial, prompt: str, seconds: float) -> None:
        """The participant goes about in ``where.stimuli["a"]``."""
        raise NotImplementedError("the script has free walks: override walk()")

    def ask(self, questionnaire: Questionnaire, step: int) -> Sequence[float | None]:
        """An answer per item; None = not answered."""
        raise NotImplementedError("the script has questionnaires: override ask()")

    def ask_consent(self, markdown: str) -> bool:
        """Whether the participant agrees; otherwise nothing is kept."""
        raise NotImplementedError("the script asks for consent: override ask_consent()")

    def ask_participant(self, questions: Sequence[str]) -> Mapping[str, str]:
        """Question -> answer."""
        raise NotImplementedError("the script asks about the participant: override ask_participant()")

    def calibrate(self, timing: Mapping[str, Any]) -> Calibration | Mapping[str, Any]:
        """Measures the display before the first trial of each part of a session.

        Args:
            timing: what the script says: frames, max_sd_ms, max_deviation, expected_hz, vsync.
        """
        return Calibration(reason="this presenter does not measure its display")

    def now(self) -> float:
        """Seconds of a clock that never goes back: that of all times."""
        return time.monotonic()

    def about(self) -> Mapping[str, str]:
        """What is worth keeping about device, driver, display."""
        return {}

    def wish(self) -> str:
        """The experimenter's, asked between steps: "go_on", "pause", "skip" or "abort"."""
        return "go_on"

    def notes(self) -> Iterable[Note]:
        """Since the last call."""
        return ()
