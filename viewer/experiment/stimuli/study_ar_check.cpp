#include "gi/core/error.h"
#include "study/script/condition.h"
#include "study/script/setting_place.h"
#include "viewer/experiment/stimuli/ar_pictures.h"
#include "viewer/experiment/stimuli/study_stimuli.h"

#include <algorithm>
#include <regex>

namespace viewer {
namespace {

bool is_ar(study::Patch const& patch)
{
    return std::any_of(patch.begin(), patch.end(), [](auto const& one) { return is_ar_setting(one.first); });
}

/// "file:12:3: ..."
bool has_place(std::string const& message)
{
    static std::regex const place("^[^ ]+:[0-9]+:[0-9]+: .*");
    return std::regex_match(message, place);
}

/// A message without a position concerns a setting: adds the setting's position in the script.
[[noreturn]] void throw_at(LoadedScript const& loaded, std::string const& key, std::string const& value,
                           std::string const& message)
{
    study::Place const place = study::place_of_setting(loaded.text, key, value);
    throw gi::InputError(gi::TextLocation{loaded.script.file, place.line, place.column}, message, "", "");
}

} // namespace

void ArStimulusCheck::add(study::Block const& block, study::Stimulus const& stimulus)
{
    if (std::any_of(stimulus.levels.begin(), stimulus.levels.end(), [](int l) { return l < 0; })) return; // known
    study::Patch patch = settings_of(loaded_.script, block, stimulus);
    if (is_ar(patch)) patches_.emplace(std::move(patch), block.camera);
}

void ArStimulusCheck::add(study::Plan const& plan)
{
    study::Script const& s = loaded_.script;
    for (study::PlanStep const& step : plan.steps) {
        bool const walks = step.kind == study::PlanStepKind::free_walk;
        if (step.kind != study::PlanStepKind::trial && !walks) continue;
        study::Block const block = step.block >= 0 ? s.blocks[std::size_t(step.block)] : plain_block(s);
        std::vector<study::Stimulus> stimuli;
        if (!walks) stimuli = possible_stimuli(block, step.trial);
        if (walks) {
            if (std::ranges::any_of(step.levels, [](int l) { return l < 0; })) continue; // reported
            stimuli = {study::Stimulus{step.levels, false, {}}};
            study::Patch const patch = settings_of(s, block, stimuli[0]);
            for (auto const& [key, value] : patch)
                if (is_ar_setting(key))
                    throw_at(loaded_, key, value,
                             "a free walk through an AR session (its frames have the camera's viewpoint) give "
                             "it a scene");
        }
        for (study::Stimulus& stimulus : stimuli) {
            bool const is_open = stimulus.is_varied && !stimulus.level && block.compare;
            if (!is_open) {
                add(block, stimulus);
                continue;
            }
            for (double const level : {block.compare->low, block.compare->high}) {
                stimulus.level = level;
                add(block, stimulus);
            }
        }
    }
}

void ArStimulusCheck::find_wrong(study::Mistakes& m) const
{
    for (auto const& [patch, camera] : patches_) m.attempt([&, p = patch, c = camera] { check_one(p, c); });
}

void ArStimulusCheck::check() const
{
    for (auto const& [patch, camera] : patches_) check_one(patch, camera);
}

void ArStimulusCheck::check_one(study::Patch const& patch, std::string const& camera) const
{
    auto const at_setting = [&](std::string const& key, auto const& e) {
        for (auto const& [k, value] : patch)
            if (k == key) throw_at(loaded_, key, value, e.what());
        throw_at(loaded_, key, "", e.what());
    };
    if (shown_on_)
        for (auto const& [key, value] : patch)
            if (is_physical_setting(key)) try {
                    check_physical(key, value, *shown_on_);
                } catch (gi::InputError const& e) {
                    at_setting(key, e);
                }
    try {
        StimulusSettings const s = stimulus_settings(patch, camera, loaded_.folder);
        check_ar_pictures(*s.ar);
    } catch (ArSettingError const& e) {
        at_setting(e.key, e);
    } catch (gi::InputError const& e) {
        if (has_place(e.what())) throw;
        at_setting("ar", e);
    }
}

} // namespace viewer
