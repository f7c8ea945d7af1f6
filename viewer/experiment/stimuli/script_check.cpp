#include "viewer/experiment/stimuli/script_check.h"

#include "study/script/setting_place.h"
#include "viewer/experiment/answer_keys.h"
#include "viewer/experiment/sound/sound_files.h"
#include "viewer/experiment/stimuli/idle_settings.h"
#include "viewer/experiment/stimuli/study_stimuli.h"

#include <algorithm>

namespace viewer {

void find_wrong_gaze(study::Script const& script, bool is_measured, study::DisplayModel const* model,
                     study::Mistakes& m)
{
    for (study::Block const& block : script.blocks) {
        if (!block.gaze.any()) continue;
        gi::TextLocation const place{script.file, block.place.line, block.place.column};
        std::string const what = "block " + block.name + ": gaze";
        if (!is_measured)
            m.add(gi::InputError(place, what, "nothing measures it", "give --gaze, or write record: {gaze: lsl}"));
        else if (model == nullptr || !model->screen || !(model->screen->distance_cm > 0))
            m.add(gi::InputError(place, what, "degrees need the screen's size and distance",
                                 "name a display model that has them with --display-model"));
    }
}

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
    if (!o.any_settings) find_wrong_devices(s, m);
    if (o.stimuli.shown_on) find_wrong_gaze(s, true, o.stimuli.shown_on->model, m);
    ArStimulusCheck ar(loaded, o.stimuli.shown_on);
    study::find_plan_mistakes(s, std::min(s.participants.count, kMostPlans), m, [&](study::Plan const& plan) {
        ++checked.plans;
        if (!o.any_settings) {
            m.attempt([&] { ar.add(plan); });
            stimuli.add(plan, m);
        }
        if (checked.plans == 1 || plan.duration_us > checked.longest.duration_us) checked.longest = plan;
    });
    find_wrong_sounds(s, loaded.folder, m);
    if (o.any_settings) return checked;
    checked.needs_display_model = stimuli.need_display_model();
    ar.find_wrong(m);
    checked.ar_stimuli = ar.count();
    StimulusCheckOptions options = o.stimuli;
    options.place_of = [&](std::string const& key, std::string const& value) {
        return study::place_of_setting(loaded.text, key, value);
    };
    checked.idle_settings = find_idle_settings(s, stimuli.list());
    checked.stimuli = find_wrong_stimuli(stimuli.list(), scenes, options, m);
    return checked;
}

} // namespace viewer
