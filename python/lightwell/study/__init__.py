"""Experiments: plans of scripts, sessions with people or model observers, and their records.

A session is the program's own: its order, adaptive procedures, journal and resumption. Python only shows trials
and says what was answered:

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
    Note,
    Questionnaire,
    QuestionnaireItem,
    Stimulus,
    StimulusShown,
    Timing,
    Trial,
    TrialDone,
)

__all__ = [
    "Calibration",
    "Note",
    "Outcome",
    "Presenter",
    "Questionnaire",
    "QuestionnaireItem",
    "Records",
    "Script",
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
