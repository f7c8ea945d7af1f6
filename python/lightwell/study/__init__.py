"""Experiments: plans of scripts, sessions with people or model observers, and their records.

The program runs the session: trial order, adaptive procedures, journal and resuming. Python only shows trials
and returns the answers:

>>> class Keyboard(Presenter):
...     def instruct(self, markdown, step):
...         input(markdown)
...     def show(self, trial):
...         return TrialDone(response=input(f"{trial.prompt} {trial.answers} "))

>>> Script("pairs.yaml").run(1, Keyboard(), dir="data")  # doctest: +SKIP
"""

from .presenter import Presenter
from .records import Records, read_journal, read_records, rebuild
from .script import Outcome, Script, example
from .trial import (
    Calibration,
    Cue,
    Note,
    Questionnaire,
    QuestionnaireItem,
    SoundPlayed,
    Stimulus,
    StimulusShown,
    Timing,
    Trial,
    TrialDone,
)

__all__ = [
    "Calibration",
    "Cue",
    "Note",
    "Outcome",
    "Presenter",
    "Questionnaire",
    "QuestionnaireItem",
    "Records",
    "Script",
    "SoundPlayed",
    "Stimulus",
    "StimulusShown",
    "Timing",
    "Trial",
    "TrialDone",
    "example",
    "read_journal",
    "read_records",
    "rebuild",
]
