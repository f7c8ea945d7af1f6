#include "python/core/python_presenter.h"
#include "study/run/settings_hash.h"

#include <pybind11/stl.h>

namespace bindings {
namespace {

using study::Block;
using study::Script;
using study::Stimulus;

py::dict stimulus_dict(Script const& s, Block const* block, Stimulus const& stimulus)
{
    py::dict levels, settings;
    for (std::size_t f = 0; f < stimulus.levels.size(); ++f)
        if (int const level = stimulus.levels[f]; level >= 0)
            levels[py::str(s.factors[f].name)] = s.factors[f].levels[std::size_t(level)].name;
    study::Patch const patch = study::settings_of(s, block ? *block : Block{}, stimulus);
    for (auto const& [key, value] : patch) settings[py::str(key)] = value;
    py::dict d;
    d["levels"] = levels;
    d["settings"] = settings;
    d["camera"] = block ? block->camera : s.defaults.camera;
    d["level"] = stimulus.level;
    d["settings_sha256"] = study::settings_hash(patch);
    return d;
}

/// Names of the allowed answers; empty if any number or order is allowed.
py::list answers_of(Block const& block)
{
    py::list answers;
    for (std::string_view const name : study::facts(block.task).answers)
        answers.append(py::str(std::string(name)));
    if (block.may_tie) answers.append("neither");
    return answers;
}

py::dict timing_dict(study::TrialTiming const& t)
{
    py::dict d;
    d["warmup_frames"] = t.warmup_frames;
    d["isi_ms"] = t.isi_ms;
    d["iti_ms"] = t.iti_ms;
    d["stimulus_ms"] = t.stimulus_ms;
    d["timeout_ms"] = t.timeout_ms;
    d["feedback_ms"] = t.feedback_ms;
    return d;
}

} // namespace

py::dict to_dict(study::TrialRequest const& r)
{
    Script const& s = *r.script;
    py::dict d, stimuli;
    d["step"] = r.step_index;
    d["attempt"] = r.attempt;
    for (std::size_t k = 0; k < r.stimuli.size(); ++k)
        stimuli[py::str(std::string(1, char('a' + k)))] = stimulus_dict(s, r.block, r.stimuli[k]);
    if (r.reference) stimuli["r"] = stimulus_dict(s, r.block, *r.reference);
    d["stimuli"] = stimuli;
    d["order"] = r.step->trial.order;
    d["level"] = r.level;
    d["trials_done"] = r.trials_done;
    d["trials_planned"] = r.trials_planned;
    d["phase"] = std::string(study::name_of(r.step->trial.phase));
    d["answer"] = r.step->trial.answer;
    if (r.block != nullptr) {
        Block const& b = *r.block;
        bool const is_practice = r.step->trial.phase == study::Phase::practice;
        d["block"] = b.name;
        d["task"] = std::string(study::facts(b.task).name);
        d["prompt"] = b.prompt;
        d["answers"] = answers_of(b);
        d["is_sequential"] = b.is_sequential;
        d["has_feedback"] = is_practice ? b.practice.has_feedback : b.has_feedback;
        d["timing"] = timing_dict(b.timing);
        d["scale"] = py::make_tuple(b.scale.low, b.scale.high, b.scale.step);
        py::dict labels;
        for (auto const& [value, text] : b.scale.labels) labels[py::float_(value)] = text;
        d["labels"] = labels;
        d["modulus"] = b.magnitude.modulus;
        d["setting"] = b.compare ? b.compare->vary : std::string();
        py::list cues;
        for (study::Cue const& c : b.cues) {
            constexpr char const* kMoments[] = {"fixation", "first_stimulus", "each_stimulus"};
            study::Sound const& sound = s.sounds[std::size_t(c.sound)];
            py::dict cue;
            cue["sound"] = sound.name;
            cue["at"] = kMoments[std::size_t(c.at)];
            cue["offset_ms"] = c.offset_ms;
            cue["file"] = sound.file;
            cue["tone_hz"] = sound.file.empty() ? sound.tone_hz : 0;
            cue["duration_ms"] = sound.file.empty() ? sound.duration_ms : 0;
            cue["level_db"] = sound.level_db;
            cues.append(cue);
        }
        d["cues"] = cues;
        d["range"] = b.compare ? py::make_tuple(b.compare->low, b.compare->high) : py::make_tuple(0.0, 0.0);
    }
    return d;
}

} // namespace bindings
