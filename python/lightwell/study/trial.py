"""Data exchanged between a session and a presenter: trials, answers, questionnaires."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True)
class Stimulus:
    """A stimulus to show.

    Attributes:
        levels: factor -> level.
        settings: renderer settings, key -> value as written in the script; `FrameRenderer.show` applies them.
        camera: name of a camera of the scene, or "path:NAME"; "" = the scene's first.
        level: value of the setting that a procedure varies (also in `settings`); None = nothing is varied.
        settings_sha256: hash of the settings, to be copied to `StimulusShown`.
    """

    levels: dict[str, str]
    settings: dict[str, str]
    camera: str
    level: float | None
    settings_sha256: str


@dataclass(frozen=True)
class Timing:
    """Timing of a trial, ms. `stimulus_ms` None = shown until the answer; `timeout_ms` None = no timeout."""

    warmup_frames: int = 0
    isi_ms: float = 500
    iti_ms: float = 500
    stimulus_ms: float | None = None
    timeout_ms: float | None = None
    feedback_ms: float = 500


@dataclass(frozen=True)
class Cue:
    """A sound of a trial: a tone (`tone_hz`, `duration_ms`) or a `file` beside the script.

    `at` is "fixation", "first_stimulus" or "each_stimulus"; `offset_ms` counts from that onset; `level_db` from full scale.
    """

    sound: str
    at: str
    offset_ms: float
    file: str
    tone_hz: float
    duration_ms: float
    level_db: float


@dataclass(frozen=True)
class Trial:
    """A fully specified trial; also used for the place of a walk, where `order` is "".

    Attributes:
        step: index in the plan, from 0.
        attempt: more than 1 = repetition of an invalid trial.
        stimuli: letter -> stimulus; "r" is a reference that is also shown.
        order: letters in order of presentation, for example "ba"; "aab" shows a twice.
        level: value of the varied setting; None = nothing is varied.
        trials_done, trials_planned: numbers of trials in the session.
        phase: "practice", "main" or "catch".
        answer: the correct answer; "" = there is none.
        block, task, prompt: block name, task and prompt of the script.
        answers: allowed values of `TrialDone.response`. For rating, magnitude and adjustment the response is
            "confirm" with a value, for ranking the letters, best first.
        is_sequential: True = stimuli are shown one after another, False = side by side.
        has_feedback: True = show after the answer whether it was correct.
        timing: timing of the trial.
        scale, labels: for rating: (lowest, highest, step), and texts by value.
        modulus: for magnitude: number assigned to the standard; 0 = free modulus.
        cues: sounds to be played; report them in `TrialDone.sounds`.
        setting, range: the varied setting and its (lowest, highest) value; "" = nothing is varied.
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
    cues: list[Cue] = field(default_factory=list)

    @property
    def presented(self) -> list[Stimulus]:
        """The stimuli in order of presentation, without the reference."""
        return [self.stimuli[letter] for letter in self.order]


@dataclass
class StimulusShown:
    """Presentation of one stimulus. Times are in seconds of `Presenter.now`.

    Attributes:
        letter: key in `Trial.stimuli`.
        onset_s, duration_s: onset and duration on the display.
        onset_method: how the onset was timed, a word of your choice: "swap_finish", "psychopy_flip", ...
        onset_uncertainty_ms: the onset is known to within +- this value, as far as software can measure it.
        frames_planned, frames_shown, frames_dropped: display frames; the trial is invalid if more are dropped than
            the script allows.
        render_ms_mean, render_ms_p99: mean and 99th percentile of the rendering time per frame.
        settings_sha256: copy of `Stimulus.settings_sha256`.
        mean_cd_m2, peak_cd_m2: luminance of the first picture on a calibrated display.
        clipped_pixels: of the first picture, pixels beyond the display's peak or below its black.
        width_deg, height_deg: its size as seen.
        left_px, top_px, width_px, height_px: rectangle of its picture, from the window's top left corner.
        frames_kind: "shown" if frames were drawn for newer poses than those of their light; "" = finished pictures alone.
        frames_drawn: of frames_shown, those that were drawn so.
        light_age_ms: at the onset, since the pose for which the light of the first frame was rendered.
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
    mean_cd_m2: float | None = None
    peak_cd_m2: float | None = None
    clipped_pixels: int | None = None
    width_deg: float | None = None
    height_deg: float | None = None
    left_px: int | None = None
    top_px: int | None = None
    width_px: int | None = None
    height_px: int | None = None
    frames_kind: str = ""
    frames_drawn: int | None = None
    light_age_ms: float | None = None


@dataclass
class SoundPlayed:
    """A sound that was due. Times are in seconds of `Presenter.now`.

    Attributes:
        sound: its name. at: "fixation", or the letters of the stimuli with which it was due.
        event_s, offset_ms: onset of those, and the wanted time from then to the sound.
        onset_s: when it began; None = it was not played, and `missing` says why.
        duration_s: duration. underruns: times that the device ran out of samples.
    """

    sound: str
    at: str
    event_s: float
    offset_ms: float = 0.0
    onset_s: float | None = None
    duration_s: float = 0.0
    underruns: int = 0
    missing: str = ""


@dataclass
class TrialDone:
    """Result of a trial. The session itself determines whether the answer is correct and the trial valid.

    Attributes:
        response: one of `Trial.answers`; for ranking letters, best first, such as "bac"; "" = no answer (timeout).
        value: the answer of rating, magnitude, adjustment.
        response_s: time of the answer, s of `Presenter.now`.
        reaction_ms: reaction time from the onset of the last stimulus.
        response_uncertainty_ms: uncertainty of `reaction_ms`, including that of the onset.
        device: input that gave the answer, such as "key:left".
        shown: presentations in order.
        is_valid, reason: set False with a reason if you know that the trial is invalid, for example "lost_focus".
            The reasons "skipped" and "aborted" are for `Presenter.wish` returning "skip" or "abort".
        gaze_samples, gaze_valid, gaze_dropped, gaze_fixating: samples of gaze while stimuli were visible; valid ones;
            missing ones; valid ones near the place of fixation.
        sounds: of the cues of the trial.
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
    gaze_samples: int | None = None
    gaze_valid: int | None = None
    gaze_dropped: int | None = None
    gaze_fixating: int | None = None
    sounds: list[SoundPlayed] = field(default_factory=list)


@dataclass
class Calibration:
    """Measured timing of the display; a script with ``vsync: required`` refuses a display that has not passed.

    Attributes:
        passed, reason: True if the timing is within the script's limits; otherwise why not.
        frames: number of timed frames.
        nominal_hz: refresh rate reported by the display; 0 = unknown.
        period_mean_ms, period_sd_ms: mean and standard deviation of the refresh period.
        onset_method: as in `StimulusShown`.
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
    """A question. Of type "scale", the answer is a value from `low` to `high`; `labels` are for both ends, or for every
    step. Of type "text", it is a text of at most `max_chars` characters, in a box of `lines` lines.
    """

    id: str
    text: str
    low: float
    high: float
    step: float
    labels: list[str]
    type: str = "scale"
    is_required: bool = False
    lines: int = 1
    max_chars: int = 1000


@dataclass(frozen=True)
class Questionnaire:
    name: str
    title: str
    instructions: str
    items: list[QuestionnaireItem]


@dataclass
class Note:
    """A note of the experimenter; `time_s` is a time of `Presenter.now`."""

    text: str
    time_s: float
    kind: str = "note"
