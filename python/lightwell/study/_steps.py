"""Adapter between the program and a presenter: converts plain dicts to the dataclasses of trial.py and back."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any, Mapping

from ..errors import InputError
from .presenter import Presenter
from .trial import Calibration, Cue, Questionnaire, QuestionnaireItem, Stimulus, StimulusShown, Timing, Trial, TrialDone


def _trial(d: dict[str, Any]) -> Trial:
    stimuli = {letter: Stimulus(**s) for letter, s in d["stimuli"].items()}
    cues = [Cue(**cue) for cue in d.get("cues", [])]
    return Trial(**{**d, "stimuli": stimuli, "timing": Timing(**d.get("timing", {})), "cues": cues})


def _plain(given: Any, kind: type) -> dict[str, Any]:
    if isinstance(given, kind):
        plain: dict[str, Any] = asdict(given)  # type: ignore[call-overload]
        return plain
    if isinstance(given, Mapping):
        return {k: [_plain(s, StimulusShown) for s in v] if k == "shown" else v for k, v in given.items()}
    raise InputError(
        f"a presenter returned {given!r} (it must be a {kind.__name__} or a dict with its fields) return one"
    )


def _check_answer(trial: Trial, done: Mapping[str, Any]) -> None:
    """Raises InputError unless the answer is one that the task allows."""
    response, value = done.get("response", ""), done.get("value")
    if response == "":
        return
    if trial.task == "ranking":
        fits, known = sorted(response) == sorted(set(trial.order)), "the letters " + trial.order + ", best first"
    elif trial.task in ("rating", "magnitude", "adjustment"):
        fits, known = response == "confirm" and value is not None, "confirm, with a value"
    else:
        fits, known = response in trial.answers, ", ".join(trial.answers)
    if not fits:
        raise InputError(
            f"the answer {response!r}, value {value!r} (the task {trial.task} does not allow it) return {known}"
        )
    low, high, _ = trial.scale
    if trial.task == "rating" and not low <= float(value) <= high:  # type: ignore[arg-type]
        raise InputError(f"the rating {value!r} (the scale is {low:g} to {high:g}) choose a value in this range")


def _check_item(asked: Questionnaire, item: QuestionnaireItem, answer: Any) -> None:
    """Raises InputError unless the item allows the answer."""
    name = f"{asked.name}.{item.id}"
    if answer is None or (item.type == "text" and answer == ""):
        if item.is_required:
            raise InputError(f"no answer to {name} (it is required) return one")
    elif item.type == "text":
        if not isinstance(answer, str):
            raise InputError(f"the answer {answer!r} to {name} (it is a text) return a str")
        if len(answer) > item.max_chars:
            raise InputError(f"{len(answer)} characters for {name} (at most {item.max_chars}) shorten it")
    elif not item.low <= answer <= item.high:
        raise InputError(
            f"the answer {answer!r} to {name} (it is {item.low:g} to {item.high:g}) choose a value in this range"
        )


class Steps:
    """The object that the program calls (python/core/python_presenter.cpp); forwards to a Presenter."""

    def __init__(self, presenter: Presenter) -> None:
        self._presenter = presenter

    def now(self) -> float:
        return self._presenter.now()

    def about(self) -> list[tuple[str, str]]:
        return [(str(k), str(v)) for k, v in self._presenter.about().items()]

    def calibrate(self, timing: dict[str, Any]) -> dict[str, Any]:
        return _plain(self._presenter.calibrate(timing), Calibration)

    def ask_consent(self, markdown: str) -> bool:
        return bool(self._presenter.ask_consent(markdown))

    def ask_participant(self, questions: list[Any]) -> list[tuple[str, str]]:
        return [(str(k), str(v)) for k, v in self._presenter.ask_participant(questions).items()]

    def instruct(self, markdown: str, step: int) -> dict[str, Any]:
        return self._timed(lambda: self._presenter.instruct(markdown, step))

    def rest(self, prompt: str, least_s: float, step: int) -> dict[str, Any]:
        return self._timed(lambda: self._presenter.rest(prompt, least_s, step))

    def walk(self, where: dict[str, Any], prompt: str, seconds: float) -> dict[str, Any]:
        return self._timed(lambda: self._presenter.walk(_trial(where), prompt, seconds))

    def ask(self, questionnaire: dict[str, Any], step: int) -> dict[str, Any]:
        items = [QuestionnaireItem(**item) for item in questionnaire["items"]]
        asked = Questionnaire(**{**questionnaire, "items": items})
        start_s = self._presenter.now()
        answers = list(self._presenter.ask(asked, step))
        if len(answers) != len(items):
            raise InputError(
                f"{len(answers)} answers to the questionnaire {asked.name} (it has {len(items)} items) "
                "return one per item, None if not answered"
            )
        numbers: list[float | None] = []
        texts: list[str] = []
        for item, answer in zip(items, answers):
            _check_item(asked, item, answer)
            is_text = item.type == "text"
            numbers.append(None if is_text or answer is None else float(answer))
            texts.append(answer if isinstance(answer, str) else "")
        done = {"start_s": start_s, "end_s": self._presenter.now(), "answers": numbers}
        return {**done, "texts": texts} if any(item.type == "text" for item in items) else done

    def show(self, trial: dict[str, Any]) -> dict[str, Any]:
        shown = _trial(trial)
        done = _plain(self._presenter.show(shown), TrialDone)
        _check_answer(shown, done)
        return done

    def wish(self) -> str:
        return self._presenter.wish()

    def notes(self) -> list[dict[str, Any]]:
        return [{"time_s": n.time_s, "note_kind": n.kind, "text": n.text} for n in self._presenter.notes()]

    def _timed(self, step: Any) -> dict[str, Any]:
        start_s = self._presenter.now()
        step()
        return {"start_s": start_s, "end_s": self._presenter.now()}
