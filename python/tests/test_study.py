"""Plans, sessions and records."""

import itertools
import subprocess
import sys

import pytest

import lightwell
from lightwell import study

PAIRS = """\
schema: study/2
id: twopairs
seed: 7
participants: {count: 2}
timing: {vsync: record, on_bad_trial: repeat_at_end}
factors:
  scene: [cornell]
  bounces: [0, 1, 3]
reference: {bounces: 3}
defaults: {settings: {method: paths}, stimulus_ms: 100, iti_ms: 0}
sequence: [{instructions: "Which is brighter?"}, similarity, {questionnaire: thoughts}]
blocks:
  similarity:
    task: pair
    prompt: "Which?"
    cross: [scene]
    pairs: {factor: bounces}
    repeats: 2
questionnaires:
  thoughts: {items: [{id: sure, text: "I was sure."}, {id: hard, text: "It was hard."}]}
"""


class Clockwork(study.Presenter):
    """Answers by itself, on a clock of its own."""

    def __init__(self, fail_at=None, response=None):
        self.time_s, self.seen, self.texts, self.fail_at, self.response = 0.0, [], [], fail_at, response

    def now(self):
        self.time_s += 0.01
        return self.time_s

    def about(self):
        return {"display": "none"}

    def instruct(self, markdown, step):
        self.texts.append(markdown)

    def ask(self, questionnaire, step):
        assert [i.id for i in questionnaire.items] == ["sure", "hard"]
        return [3, None]

    def show(self, trial):
        if self.fail_at is not None and len(self.seen) == self.fail_at:
            raise KeyboardInterrupt
        self.seen.append(trial)
        onsets = [self.now() for _ in trial.order]
        shown = [
            study.StimulusShown(letter, onset, 0.1, "test", settings_sha256=trial.stimuli[letter].settings_sha256)
            for letter, onset in zip(trial.order, onsets)
        ]
        bounces = [int(s.levels["bounces"]) for s in trial.presented]
        response = self.response or ("first" if bounces[0] > bounces[1] else "second")
        return study.TrialDone(
            response, response_s=onsets[-1] + 0.5, reaction_ms=500.0, device="test", shown=shown
        )


@pytest.fixture
def script(tmp_path):
    file = tmp_path / "twopairs.yaml"
    file.write_text(PAIRS)
    return study.Script(file)


def test_a_script_says_what_it_holds(script):
    assert (script.id, script.seed, script.participants) == ("twopairs", 7, 2)
    assert script.factors == {"scene": ["cornell"], "bounces": ["0", "1", "3"]}
    assert script.blocks == {"similarity": "pair"}
    assert "similarity" in script.text() and script.plan_seconds(1) > 0


def test_a_plan_is_that_of_the_program(program, script, tmp_path):
    out = tmp_path / "plan.tsv"
    command = [program, "study", "plan", script.file, "--participant", "2", "--out", out]
    subprocess.run(command, check=True, capture_output=True)
    assert script.plan_tsv(2) == out.read_text()
    plan = script.plan(2)
    assert list(plan["step"]) == list(range(1, len(plan) + 1))
    assert (plan["kind"] == "trial").sum() == 6
    assert plan.loc[plan["kind"] == "trial", "task"].eq("pair").all()


def test_errors_of_scripts_have_their_place(tmp_path):
    file = tmp_path / "bad.yaml"
    file.write_text(PAIRS.replace("repeats: 2", "repeatz: 2"))
    with pytest.raises(lightwell.ScriptError) as raised:
        study.Script(file)
    error = raised.value
    assert isinstance(error, lightwell.InputError) and "repeatz" in error.problem
    assert (error.file, error.line) == (str(file), 18) and error.column > 0 and error.why and error.suggestion
    with pytest.raises(lightwell.InputError):
        study.Script(tmp_path / "none.yaml")
    with pytest.raises(lightwell.InputError, match="staircase"):
        study.example("none")


def test_a_session_runs_and_its_records_are_tables(script, tmp_path):
    presenter = Clockwork()
    outcome = script.run(1, presenter, dir=tmp_path / "data", about={"room": "B1"})
    assert outcome.is_complete and (outcome.participant_id, outcome.trials) == ("P001", 6)
    assert presenter.texts == ["Which is brighter?"]
    trial = presenter.seen[0]
    assert (trial.block, trial.task, trial.prompt) == ("similarity", "pair", "Which?")
    assert trial.answers == ["first", "second"] and trial.timing.stimulus_ms == 100
    assert trial.presented[0].settings["method"] == "paths"
    records = study.read_records(tmp_path / "data", script.file)
    trials = records.trials
    assert len(trials) == 6 and trials["valid"].all() and (trials["analysis"] == "counted").all()
    assert (trials["response_time"] == 0.5).all() and (trials["scene"] == "cornell").all()
    assert "[s]" in trials.attrs["columns"]["response_time"]
    plan = script.plan(1)
    assert list(trials["cond_a"]) == list(plan.loc[plan["kind"] == "trial", "cond_a"])
    assert len(records.stimuli) == 12 and (records.stimuli["onset_method"] == "test").all()
    answers = records.questionnaires.set_index("item")["raw"]
    assert answers["sure"] == 3 and answers.isna()["hard"]
    assert list(records.participants["complete"]) == [True]
    started = study.read_journal(outcome.folder / "journal.jsonl")[0]
    assert started["about"].pop("program").startswith("lightwell ")
    assert started["about"] == {"room": "B1", "display": "none"}


def test_tables_are_those_that_the_program_exports(program, script, tmp_path):
    import pandas

    script.simulate(dir=tmp_path / "sim")
    assert study.rebuild(tmp_path / "sim", script.file) > 4
    command = [program, "study", "export", tmp_path / "sim", "--out", tmp_path / "out"]
    subprocess.run(command, check=True, capture_output=True)
    (csv,) = (tmp_path / "out").glob("**/*description-trials_data.csv")
    theirs = pandas.read_csv(csv)
    ours = study.read_records(tmp_path / "sim").trials  # the script is kept in code/
    assert list(theirs.columns) == list(ours.columns) and len(theirs) == len(ours)
    assert list(theirs["response_time"]) == list(ours["response_time"])


def test_a_session_that_was_cut_off_goes_on_with_the_same_order(script, tmp_path):
    whole = Clockwork()
    script.run(2, whole, dir=tmp_path / "whole")
    first, second = Clockwork(fail_at=2), Clockwork()
    with pytest.raises(KeyboardInterrupt):
        script.run(2, first, dir=tmp_path / "cut")
    with pytest.raises(lightwell.ScriptError, match="already"):
        script.run(2, Clockwork(), dir=tmp_path / "cut")
    outcome = script.run(2, second, dir=tmp_path / "cut", resume=True)
    assert outcome.is_complete and len(first.seen) == 2
    assert [t.step for t in first.seen + second.seen] == [t.step for t in whole.seen]
    entries = study.read_journal(outcome.folder / "journal.jsonl")
    ends = [(e["is_complete"], e["reason"]) for e in entries if e["kind"] == "session_ended"]
    assert [e["part"] for e in entries if e["kind"] == "session_started"] == [1, 2]
    assert len(ends) == 2 and ends[1] == (True, "") and not ends[0][0] and "KeyboardInterrupt" in ends[0][1]
    assert list(study.read_records(tmp_path / "cut", script.file).trials["part"]) == [1, 1, 2, 2, 2, 2]


def test_the_program_knows_a_session_that_python_began_as_a_persons(program, script, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        script.run(1, Clockwork(fail_at=3), dir=tmp_path / "data")
    journal = tmp_path / "data/sub-P001/ses-01/beh/journal.jsonl"
    before = journal.read_bytes()
    options = ["--participants", "1", "--out", tmp_path / "data", "--resume"]
    command = [program, "study", "simulate", script.file, *options]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and "this session is a person's" in done.stderr
    assert journal.read_bytes() == before


@pytest.mark.parametrize(
    "answer, part",
    [
        (study.TrialDone("third"), "third"),
        ({"response": "first", "colour": "red"}, "colour"),
        ({"response": "first", "reaction_ms": "slow"}, "reaction_ms"),
        (None, "None"),
        ({"response": "first", "shown": [{"letter": "a", "onset": 1}]}, "onset"),
    ],
)
def test_answers_that_cannot_be_are_refused_and_not_kept(script, tmp_path, answer, part):
    class Wrong(Clockwork):
        def show(self, trial):
            return answer

    with pytest.raises(lightwell.InputError, match=part):
        script.run(1, Wrong(), dir=tmp_path / "data")
    entries = study.read_journal(tmp_path / "data/sub-P001/ses-01/beh/journal.jsonl")
    assert not any(e["kind"] == "trial_done" for e in entries)


def test_a_display_that_was_not_measured_is_refused_where_the_script_requires_it(tmp_path):
    file = tmp_path / "strict.yaml"
    file.write_text(PAIRS.replace("vsync: record", "vsync: required"))
    with pytest.raises(lightwell.ScriptError, match="does not measure"):
        study.Script(file).run(1, Clockwork(), dir=tmp_path / "data")
    assert not (tmp_path / "data" / "sub-P001" / "ses-01" / "beh" / "journal.jsonl").exists()


def test_methods_that_a_script_needs_and_a_presenter_lacks_are_named(script, tmp_path):
    with pytest.raises(NotImplementedError, match="instruct"):
        script.run(1, study.Presenter(), dir=tmp_path / "data")


def test_wishes_and_notes_of_the_experimenter_are_kept(script, tmp_path):
    class Watched(Clockwork):
        wishes = itertools.chain(["go_on", "skip"], itertools.repeat("go_on"))

        def wish(self):
            return next(self.wishes)

        def notes(self):
            return [study.Note("coughs", self.now())] if len(self.seen) == 1 else []

    script.run(1, Watched(), dir=tmp_path / "data")
    records = study.read_records(tmp_path / "data", script.file)
    assert "skipped" in set(records.trials["reason"])
    assert records.session_events["text"].str.contains("coughs").any()
    assert records.happenings is records.session_events


def test_staircases_are_those_of_the_program(tmp_path):
    file = tmp_path / "staircase.yaml"
    file.write_text(study.example("staircase").replace("vsync: required", "vsync: record"))
    script = study.Script(file)
    outcome = script.simulate([1], dir=tmp_path / "sim")[0]
    assert outcome.is_complete
    simulated = [e for e in study.read_journal(outcome.folder / "journal.jsonl") if e["kind"] == "trial_done"]

    class Replay(Clockwork):
        """Answers as the model observer did; so levels have to be what it saw."""

        def ask(self, questionnaire, step):
            return [item.low for item in questionnaire.items]

        def ask_consent(self, markdown):
            return True

        def ask_participant(self, questions):
            return {q: "x" for q in questions}

        def walk(self, where, prompt, seconds):
            pass

        def show(self, trial):
            then = simulated[len(self.seen)]
            assert (trial.step, trial.attempt, trial.level) == (then["step"], then["attempt"], then["level"])
            self.seen.append(trial)
            return {k: then[k] for k in ("response", "value", "is_valid", "reason", "reaction_ms", "shown")}

    presenter = Replay()
    assert script.run(1, presenter, dir=tmp_path / "again").is_complete
    assert len(presenter.seen) == len(simulated) > 20


def test_simulated_records_of_several_participants_are_read_together(script, tmp_path):
    outcomes = script.simulate(dir=tmp_path / "sim", seed=3)
    assert [o.participant_id for o in outcomes] == ["P001", "P002"]
    records = study.read_records(tmp_path / "sim", script.file)
    assert records.trials["participant"].nunique() == 2
    assert records.trials["simulated"].all() and records.participants["complete"].all()
    with pytest.raises(lightwell.ScriptError, match="session"):
        study.read_records(tmp_path / "sim" / "sourcedata", script.file)


def test_without_pandas_the_module_works_and_says_what_tables_need(script):
    code = (
        "import sys; sys.modules['pandas'] = None\n"
        "from lightwell import study\n"
        f"script = study.Script({str(script.file)!r})\n"
        "assert script.plan_tsv(1)\n"
        "try: script.plan(1)\n"
        "except ImportError as e: print(e)\n"
    )
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "pip install pandas" in printed


def test_texts_and_sounds_reach_the_records(tmp_path):
    file = tmp_path / "sounds.yaml"
    file.write_text(study.example("sounds"))

    class Typist(Clockwork):
        text = 'Ça, "she" said,\nłódź'

        def ask(self, questionnaire, step):
            assert [i.type for i in questionnaire.items] == ["scale", "text", "text"]
            assert questionnaire.items[1].is_required and questionnaire.items[1].lines == 4
            return [5, self.text, None]

        def calibrate(self, timing):
            return study.Calibration(passed=True)

        def show(self, trial):
            self.seen.append(trial)
            onsets = [self.now() for _ in trial.order]
            shown = [study.StimulusShown(letter, onset, 0.1, "test") for letter, onset in zip(trial.order, onsets)]
            assert [(c.sound, c.at) for c in trial.cues] == [("ready", "first_stimulus"), ("beep", "each_stimulus")]
            sounds = [study.SoundPlayed("beep", s.letter, s.onset_s, onset_s=s.onset_s + 0.002) for s in shown]
            return study.TrialDone("first", response_s=onsets[-1] + 0.5, reaction_ms=500.0, shown=shown, sounds=sounds)

    assert study.Script(file).run(1, Typist(), dir=tmp_path / "data").is_complete
    entries = study.read_journal(next((tmp_path / "data").glob("sub-*/ses-01/beh/journal.jsonl")))
    done = next(e for e in entries if e["kind"] == "questionnaire_done")
    assert done["texts"] == ["", Typist.text, ""] and done["answers"] == [5, None, None]
    assert next(e for e in entries if e["kind"] == "trial_done")["sounds"][0]["sound"] == "beep"

    class Silent(Typist):
        text = ""

    with pytest.raises(Exception, match="it is required"):
        study.Script(file).run(2, Silent(), dir=tmp_path / "data")
