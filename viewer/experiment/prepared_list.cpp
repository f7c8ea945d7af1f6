#include "viewer/experiment/prepared_list.h"

#include "gi/core/error.h"
#include "study/run/adaptive_run.h"
#include "viewer/experiment/trial.h"

#include <algorithm>

namespace viewer {

namespace {

/// Levels that a procedure may choose.
std::vector<double> levels_of(study::Script const& script, study::Block const& block, study::Trial const& trial)
{
    std::vector<double> levels;
    if (block.compare && trial.procedure >= 0)
        levels = reachable_levels(block.procedures[std::size_t(trial.procedure)], *block.compare);
    if (levels.empty())
        throw gi::InputError(script.file + ": block " + block.name + ": stimuli: prepared",
                             "its levels are not known in advance", "write stimuli: live");
    return levels;
}

bool has_prepared(study::Script const& script)
{
    return std::any_of(script.blocks.begin(), script.blocks.end(),
                       [](study::Block const& b) { return b.stimuli == study::Stimuli::prepared; });
}

} // namespace

std::map<std::string, PreparedStimulus> prepared_list(study::Script const& script, glm::ivec2 screen_px,
                                                      float font_px, std::string const& version,
                                                      study::DisplayModel const* model)
{
    std::map<std::string, PreparedStimulus> list;
    if (!has_prepared(script)) return list;
    for (int participant = 1; participant <= script.participants.count; ++participant)
        list.merge(prepared_list(script, make_plan(script, participant), screen_px, font_px, version, model));
    return list;
}

std::map<std::string, PreparedStimulus> prepared_list(study::Script const& script, study::Plan const& plan,
                                                      glm::ivec2 screen_px, float font_px,
                                                      std::string const& version, study::DisplayModel const* model)
{
    std::map<std::string, PreparedStimulus> list;
    if (!has_prepared(script)) return list;
    auto const add = [&](study::Block const& block, study::Trial const& trial, study::Stimulus const& stimulus) {
        PreparedStimulus p;
        p.stimulus = stimulus_settings(script, block, stimulus);
        std::size_t const together =
            block.is_sequential ? 1 : trial.order.size() + (trial.reference.has_value() ? 1 : 0);
        p.view = view_of(block, p.stimulus, together, screen_px, font_px, model);
        p.where = script.file + ": block " + block.name + ", " + stimulus_label(script, block, stimulus);
        list.emplace(prepared_key(p, version), p);
    };
    for (study::PlanStep const& step : plan.steps) {
        if (step.kind != study::PlanStepKind::trial) continue;
        study::Block const& block = script.blocks[std::size_t(step.block)];
        if (block.stimuli != study::Stimuli::prepared) continue;
        if (block.task == study::Task::adjustment)
            throw gi::InputError(script.file + ": block " + block.name + ": stimuli: prepared",
                                 "adjusted stimuli are rendered while they are shown", "write stimuli: live");
        for (study::Stimulus s : possible_stimuli(block, step.trial)) {
            bool const has_levels = block.compare && !block.compare->vary.empty();
            if (!s.is_varied || s.level || !has_levels) {
                add(block, step.trial, s);
                continue;
            }
            for (double const level : levels_of(script, block, step.trial)) {
                s.level = level;
                add(block, step.trial, s);
            }
        }
    }
    return list;
}

} // namespace viewer
