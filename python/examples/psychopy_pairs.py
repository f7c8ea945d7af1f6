"""An experiment shown by PsychoPy: two renderings side by side, rendered live, answered by arrow keys.

    pip install psychopy        # GPL-3; not part of Lightwell, needed only by main()
    python psychopy_pairs.py --participant 1
    python psychopy_pairs.py --participant 1 --resume

PsychoPy opens the window, draws, and reads keys; Lightwell renders the stimuli and runs the session: trial order,
crash-safe journal, and records. Frames that take longer than a display refresh to render are counted as dropped.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from lightwell import FrameRenderer, study

SCRIPT = """\
schema: study/2
id: psychopypairs
seed: 12
participants: {count: 20}
timing: {vsync: record, max_dropped_frames: 100000}
factors:
  scene: [cornell]
  bounces: [0, 1, 3]
reference: {bounces: 3}
defaults: {settings: {method: paths, exposure: 0}, warmup_frames: 2, stimulus_ms: 2000, timeout_ms: 10000}
sequence: [{instructions: "Which room looks more real? Left or right arrow. Space goes on."}, real]
blocks:
  real:
    task: pair
    prompt: "Which one looks more real?"
    cross: [scene]
    pairs: {factor: bounces}
    repeats: 2
"""


class PsychoPyPresenter(study.Presenter):
    """Shows trials of the task pair in a PsychoPy window.

    Args:
        win: psychopy.visual.Window with units "pix".
        visual, event, core: the modules of PsychoPy; passed as arguments so that tests can replace them.
        size: size of each picture, (width, height), pixels.
        hz: refresh rate of the display.
    """

    keys = {"left": "first", "right": "second"}

    def __init__(self, win: Any, visual: Any, event: Any, core: Any, size: tuple[int, int], hz: float) -> None:
        self.win, self.visual, self.event, self.core, self.hz = win, visual, event, core, hz
        self.renderers = [FrameRenderer(size=size) for _ in range(2)]
        self.images = [
            visual.ImageStim(win, units="pix", size=size, pos=(x * (size[0] / 2 + 10), 0)) for x in (-1, 1)
        ]
        self.text = visual.TextStim(win, units="pix", pos=(0, -size[1] / 2 - 40), height=24, wrapWidth=2 * size[0])

    def now(self) -> float:
        return float(self.core.getTime())  # the clock of flips and time stamps of keys

    def about(self) -> dict[str, str]:
        return {"toolkit": "PsychoPy", "display_hz": f"{self.hz:g}"}

    def instruct(self, markdown: str, step: int) -> None:
        self.text.text = markdown
        self.text.draw()
        self.win.flip()
        self._wait_for(["space"])

    def show(self, trial: study.Trial) -> study.TrialDone:
        timing = trial.timing
        self.win.flip()  # empty, between trials
        self.core.wait(timing.iti_ms / 1000)
        for renderer, stimulus in zip(self.renderers, trial.presented):
            renderer.show(stimulus)
            for _ in range(timing.warmup_frames):
                renderer.next(paths=1)
        self.text.text = trial.prompt
        self.event.clearEvents()
        onset_s, flips_s, render_s, answer = self._show_stimuli(timing)
        shown_s = flips_s[-1] - onset_s
        self.text.draw()
        self.win.flip()
        while answer is None and not self._is_late(onset_s, timing):
            answer = self._answer()
        return self._done(trial, onset_s, shown_s, flips_s, render_s, answer)

    def _show_stimuli(
        self, timing: study.Timing
    ) -> tuple[float, list[float], list[float], tuple[str, float] | None]:
        """Shows both pictures, refined with every refresh, for stimulus_ms or until the answer."""
        flips_s: list[float] = []
        render_s: list[float] = []
        answer = None
        while True:
            for renderer, image in zip(self.renderers, self.images):
                frame = renderer.next(paths=1)
                image.image = frame.signed()
                image.draw()
                render_s.append(frame.seconds)
            self.text.draw()
            self.win.flip()
            flips_s.append(self.now())
            answer = answer or self._answer()
            if timing.stimulus_ms is None:
                over = answer is not None or self._is_late(flips_s[0], timing)
            else:
                over = flips_s[-1] - flips_s[0] >= timing.stimulus_ms / 1000
            if over:
                return flips_s[0], flips_s, render_s, answer

    def _done(
        self,
        trial: study.Trial,
        onset_s: float,
        shown_s: float,
        flips_s: list[float],
        render_s: list[float],
        answer: tuple[str, float] | None,
    ) -> study.TrialDone:
        period_s = 1 / self.hz
        dropped = sum(max(0, round((b - a) / period_s) - 1) for a, b in zip(flips_s, flips_s[1:]))
        shown = [
            study.StimulusShown(
                letter=letter,
                onset_s=onset_s,
                duration_s=shown_s,
                onset_method="psychopy_flip",
                onset_uncertainty_ms=1000 * period_s,
                frames_planned=len(flips_s) + dropped,
                frames_shown=len(flips_s),
                frames_dropped=dropped,
                render_ms_mean=1000 * sum(render_s) / len(render_s),
                render_ms_p99=1000 * float(np.quantile(render_s, 0.99)),
                settings_sha256=trial.stimuli[letter].settings_sha256,
            )
            for letter in trial.order
        ]
        if answer is None:
            return study.TrialDone(shown=shown)  # no answer: the session records a timeout
        key, time_s = answer
        return study.TrialDone(
            response=self.keys[key],
            response_s=time_s,
            reaction_ms=1000 * (time_s - onset_s),
            response_uncertainty_ms=1000 * period_s,
            device=f"key:{key}",
            shown=shown,
        )

    def _is_late(self, onset_s: float, timing: study.Timing) -> bool:
        return timing.timeout_ms is not None and self.now() - onset_s > timing.timeout_ms / 1000

    def _answer(self) -> tuple[str, float] | None:
        """Returns the first answer among the keys pressed since the last call, with its time."""
        for key in self.event.getKeys(keyList=[*self.keys, "escape"]):
            if key == "escape":
                raise KeyboardInterrupt  # ends the session properly; --resume continues it
            return key, self.now()
        return None

    def _wait_for(self, keys: list[str]) -> None:
        if "escape" in self.event.waitKeys(keyList=[*keys, "escape"]):
            raise KeyboardInterrupt


def main() -> None:
    from psychopy import core, event, visual

    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--participant", type=int, required=True)
    parser.add_argument("--dir", default="data")
    parser.add_argument("--resume", action="store_true")
    arguments = parser.parse_args()

    file = Path(arguments.dir) / "psychopypairs.yaml"
    file.parent.mkdir(parents=True, exist_ok=True)
    if not file.exists():
        file.write_text(SCRIPT)
    win = visual.Window(fullscr=True, units="pix", color=(-1, -1, -1))
    hz = win.getActualFrameRate() or 60.0
    presenter = PsychoPyPresenter(win, visual, event, core, (win.size[0] // 2 - 40, win.size[1] // 2), hz)
    try:
        outcome = study.Script(file).run(
            arguments.participant, presenter, dir=arguments.dir, resume=arguments.resume
        )
        print(f"{outcome.participant_id}: {outcome.trials} trials in {outcome.folder}")
    except KeyboardInterrupt:
        print("ended; continue with --resume")
    finally:
        win.close()


if __name__ == "__main__":
    main()
