"""What passes between a session and a presenter: trials, answers, questionnaires, as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Stimulus:
    """What is shown.

    Attributes:
        levels: factor -> level.
        settings: of the renderer, key -> value as the script writes it; `FrameRenderer.show` takes them.
        camera: of the scene, or "path:NAME"; "" = the scene's first.
        level: of the setting that a procedure varies (it is in `settings` too); None = nothing is varied.
        settings_sha256: for `StimulusShown`.
    """

    levels: dict[str, str]
    settings: dict[str, str]
    camera: str
    level: float | None
    settings_sha256: str


@dataclass(frozen=True)
class Timing:
    """How a trial runs; ms. None: `stimulus_ms` until the answer, `timeout_ms` waits."""

    warmup_frames: int = 0
    isi_ms: float = 500
    iti_ms: float = 500
    stimulus_ms: float | None = None
    timeout_ms: float | None = None
    feedback_ms: float = 500


@dataclass(frozen=True)
class Trial:
    """A trial with everything decided; also the place of a walk, whose `order` is "".

    Attributes:
        step, attempt: of the plan, from 0; more than 1: a trial that was not valid comes again.
        stimuli: letter -> stimulus; "r" is a reference that is shown too.
        order: letters in the order of presentation, "ba"; "aab" shows a twice.
        level: of what is varied.
        trials_done, trials_planned: of the session.
        phase: "practice", "main" or "catch".
        answer: the right one; "" = there is none.
        block, task, prompt: of the script.
        answers: what `TrialDone.response` may be. Of rating, magnitude and adjustment it is "confirm" with a
        value; of ranking the letters, best first.
        is_sequential: one after another, else side by side.
        has_feedback: right or wrong is to be said after the answer.
        timing: how it runs.
        scale, labels: of rating: lowest, highest, step; texts of values.
        modulus: of magnitude: the number of the standard; 0 = free.
        setting, range: what is varied, from lowest to highest; "" = nothing.
    """

    step: int
    attempt: int
    stimuli: dict[str, Stimulus]
    order: str
    level: float | None
    trials_done: int
    trials_planned: int
    phase: str
    answer: str
    block: str = ""
    task: str = ""
    prompt: str = ""
    answers: list[str] = field(default_factory=list)
    is_sequential: bool = False
    has_feedback: bool = False
    timing: Timing = Timing()
    scale: tuple[float, float, float] = (1, 7, 1)
    labels: dict[float, str] = field(default_factory=dict)
    modulus: float = 0
    setting: str = ""
    range: tuple[float, float] = (0, 0)

    @property
    def presented(self) -> list[Stimulus]:
        """The stimuli in the order in which they are shown, without the reference."""
        return [self.stimuli[letter] for letter in self.order]


@dataclass
class StimulusShown:
    """One stimulus as it was shown. Times are of `Presenter.now`, s.

    Attributes:
        letter: of `Trial.stimuli`.
        onset_s, duration_s: when it was first seen, and for how long.
        onset_method: how the onset was timed, in a word of yours: "swap_finish", "psychopy_flip", ...
        onset_uncertainty_ms: the onset lies within +- so much, as far as software can tell.
        frames_planned, frames_shown, frames_dropped: of the display; more dropped than the script allows make the
            trial invalid.
        render_ms_mean, render_ms_p99: of the frames rendered for it.
        settings_sha256: `Stimulus.settings_sha256`.
    """

    letter: str
    onset_s: float
    duration_s: float = 0.0
    onset_method: str = ""
    onset_uncertainty_ms: float = 0.0
    frames_planned: int = 0
    frames_shown: int = 0
    frames_dropped: int = 0
    render_ms_mean: float = 0.0
    render_ms_p99: float = 0.0
    settings_sha256: str = ""


@dataclass
class TrialDone:
    """A trial that was carried through. Whether it was right, and whether it is valid, the session finds itself.

    Attributes:
        response: one of `Trial.answers`; of ranking letters, best first, "bac"; "" = none came (a timeout).
        value: of rating, magnitude, adjustment.
        response_s: time of the answer, s, of `Presenter.now`.
        reaction_ms: from the onset of the last stimulus.
        response_uncertainty_ms: of `reaction_ms`, onset included.
        device: that answered: "key:left".
        shown: in the order of presentation.
        is_valid, reason: False with why, where you know that it is not: "lost_focus". "skipped" and "aborted" are
            for the wishes of that name.
    """

    response: str = ""
    value: float | None = None
    response_s: float | None = None
    reaction_ms: float | None = None
    response_uncertainty_ms: float = 0.0
    device: str = ""
    shown: list[StimulusShown] = field(default_factory=list)
    is_valid: bool = True
    reason: str = ""


@dataclass
class Calibration:
    """The display as it was measured; a script with ``vsync: required`` refuses one that has not passed.

    Attributes:
        passed, reason: whether it keeps time, and why not.
        frames: that were timed.
        nominal_hz: that the display tells; 0 = it does not.
        period_mean_ms, period_sd_ms: of its refreshes.
        onset_method: as of `StimulusShown`.
    """

    passed: bool = False
    reason: str = ""
    frames: int = 0
    nominal_hz: float = 0.0
    period_mean_ms: float = 0.0
    period_sd_ms: float = 0.0
    onset_method: str = ""


@dataclass(frozen=True)
class QuestionnaireItem:
    """A question with its scale; `labels` are those of both ends, or of every step."""

    id: str
    text: str
    low: float
    high: float
    step: float
    labels: list[str]


@dataclass(frozen=True)
class Questionnaire:
    name: str
    title: str
    instructions: str
    items: list[QuestionnaireItem]


@dataclass
class Note:
    """Something that happened, `time_s` of `Presenter.now`."""

    text: str
    time_s: float
    kind: str = "note"
