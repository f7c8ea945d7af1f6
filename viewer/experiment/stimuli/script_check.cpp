#include "viewer/experiment/stimuli/script_check.h"

#include "study/script/setting_place.h"
#include "viewer/experiment/stimuli/study_stimuli.h"

#include <algorithm>

namespace viewer {

CheckedScript check_script(ScriptToCheck& read, SceneAccess const& scenes, ScriptCheckOptions const& o)
{
    constexpr int kMostPlans = 2000;
    LoadedScript const& loaded = read.loaded;
    study::Script const& s = loaded.script;
    study::Mistakes& m = read.mistakes;
    CheckedScript checked;
    if (!read.is_whole) return checked;
    std::set<std::pair<std::string, std::string>> wrong;
    if (!o.any_settings) wrong = find_wrong_settings(s, loaded.text, loaded.folder, m);
    StimulusCollection stimuli(s, wrong);
    ArStimulusCheck ar(loaded);
    study::find_plan_mistakes(s, std::min(s.participants.count, kMostPlans), m, [&](study::Plan const& plan) {
        ++checked.plans;
        if (!o.any_settings) {
            m.attempt([&] { ar.add(plan); });
            stimuli.add(plan, m);
        }
        if (checked.plans == 1 || plan.duration_us > checked.longest.duration_us) checked.longest = plan;
    });
    if (o.any_settings) return checked;
    ar.find_wrong(m);
    checked.ar_stimuli = ar.count();
    StimulusCheckOptions options = o.stimuli;
    options.place_of = [&](std::string const& key, std::string const& value) {
        return study::place_of_setting(loaded.text, key, value);
    };
    checked.stimuli = find_wrong_stimuli(stimuli.list(), scenes, options, m);
    return checked;
}

} // namespace viewer
