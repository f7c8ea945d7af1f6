#include "viewer/experiment/stimuli/stimulus_check.h"

#include "gi/core/error.h"
#include "gi/core/step.h"
#include "study/script/condition.h"
#include "study/script/written_settings.h"
#include "viewer/experiment/stimuli/stimulus_place.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr glm::ivec2 kTiny_px{16, 16};

/// Loads each scene once, although edits can only be undone by setting the scene again.
class OneScene {
public:
    explicit OneScene(LoadScene load) : load_(std::move(load)) {}

    std::shared_ptr<gi::Scene const> get(std::string const& name, gi::Report& report)
    {
        if (name != name_) {
            scene_.reset();
            scene_ = load_(name, report);
            name_ = name;
            ++loaded_;
        }
        return scene_;
    }
    std::size_t loaded() const { return loaded_; }

private:
    LoadScene load_;
    std::string name_;
    std::shared_ptr<gi::Scene const> scene_;
    std::size_t loaded_ = 0;
};

bool is_finite(gi::Picture const& picture)
{
    gi::Layer const* const color = picture.find("color");
    return color == nullptr || std::ranges::all_of(color->data, [](float v) { return std::isfinite(v); });
}

/// One path per pixel at scene time 0.
void render_tiny(RenderSession& session, StimulusSettings const& s, gi::Camera const& camera,
                 gi::StopRequest const& stop)
{
    FrameCommand command;
    command.paths = 1;
    StimulusView view;
    view.size_px = kTiny_px;
    command.views = stimulus_views(place_of(session.world(), camera), s, view, 0);
    SessionFrame const frame = session.render(command, stop);
    if (stop.requested()) throw gi::Interrupted();
    for (ViewPicture const& v : frame.views)
        if (!is_finite(v.picture))
            throw gi::InputError("a picture of it has values that are not finite", "a setting is too extreme",
                                 "change its settings");
}

/// Adds what is wrong with stimuli, each problem once at its place.
class Teller {
public:
    Teller(StimulusCheckOptions const& options, study::Mistakes& m) : options_(options), m_(m) {}

    /// @param key  the setting that is wrong; empty = the whole stimulus
    void tell(PlannedStimulus const& stimulus, std::string const& key, gi::InputError const& e)
    {
        if (!e.where().file.empty()) return m_.add(e); // within a scene file
        gi::TextLocation where = stimulus.place;
        for (auto const& [written, value] : stimulus.patch)
            if (options_.place_of && (written == key || written == "gi." + key))
                if (study::Place const p = options_.place_of(written, value); p.line > 0)
                    where = {where.file, p.line, p.column};
        if (!told_.emplace(where.line, where.column, e.what()).second) return;
        m_.add(gi::InputError(where, stimulus.what + ": " + e.problem(), e.why(), e.suggestion()));
    }

private:
    StimulusCheckOptions const& options_;
    study::Mistakes& m_;
    std::set<std::tuple<int, int, std::string>> told_;
};

/// Checks each size, place and luminance alone, so that all wrong ones are reported at their lines.
void check_measures(PlannedStimulus const& stimulus, ShownOn shown_on, Teller& teller)
{
    shown_on.has_own_views |= stimulus.settings.view == StimulusViewer::headset;
    bool is_told = false;
    for (auto const& [written, value] : stimulus.patch) {
        std::string const key = written.starts_with("gi.") ? written.substr(3) : written;
        if (!is_physical_setting(key)) continue;
        try {
            check_physical(key, value, shown_on);
        } catch (gi::InputError const& e) {
            teller.tell(stimulus, key, e);
            is_told = true;
        }
    }
    if (is_told || !stimulus.settings.physical.place) return;
    try {
        check_physical(stimulus.settings.physical, shown_on.model);
    } catch (gi::InputError const& e) {
        teller.tell(stimulus, "place", e);
    }
}

/// Returns whether a picture was rendered.
bool check_one(RenderSession& session, PlannedStimulus const& stimulus, SceneAccess const& scenes,
               StimulusCheckOptions const& o, gi::StopRequest const& stop, Teller& teller)
{
    StimulusSettings const& s = stimulus.settings;
    std::string key = "camera";
    try {
        gi::Camera const camera = scenes.camera(session.world(), s.camera);
        for (Change const& c : s.edits) {
            key = c.key;
            session.apply(c);
        }
        key.clear();
        if (!o.renders) return false;
        for (Change const& c : differences(session.settings(), s.settings)) session.apply(c);
        render_tiny(session, s, camera, stop);
        return true;
    } catch (gi::InputError const& e) {
        teller.tell(stimulus, key, e);
        return false;
    }
}

/// The stimulus, with the lowest and highest of all levels that are chosen at the trial.
std::vector<study::Stimulus> at_ends(study::Block const& block, study::Stimulus const& stimulus)
{
    std::vector<study::Stimulus> all{stimulus};
    bool const is_open = stimulus.is_varied && !stimulus.level && !block.procedures.empty();
    if (is_open) {
        auto const [low, high] = presented_ends(block);
        all = {stimulus, stimulus};
        all[0].level = low;
        all[1].level = high;
    }
    if (!block.compare || block.compare->also.empty()) return all;
    std::size_t const count = all.size();
    for (std::size_t i = 0; i < count; ++i) {
        all.push_back(all[i]); // besides the usual levels of further settings, which practice has
        all.push_back(all[i]);
        for (study::FurtherSetting const& f : block.compare->also) {
            all[all.size() - 2].also.push_back(f.low);
            all.back().also.push_back(f.high);
        }
    }
    return all;
}

} // namespace

void StimulusCollection::add(int index, study::Stimulus const& stimulus, study::Mistakes& m)
{
    if (std::ranges::any_of(stimulus.levels, [](int level) { return level < 0; })) return; // reported
    if (!seen_.emplace(index, stimulus.levels, stimulus.is_varied, stimulus.level, stimulus.also).second) return;
    study::Block const block = index >= 0 ? script_.blocks[std::size_t(index)] : plain_block(script_);
    study::Patch patch = settings_of(script_, block, stimulus);
    auto const is_wrong = [&](std::pair<std::string, std::string> const& setting) {
        return wrong_.contains(setting) || wrong_.contains({setting.first, ""});
    };
    for (auto const& setting : patch)
        if (is_ar_key(setting.first) || (is_wrong(setting) && setting.first.ends_with("scene"))) return;
    std::erase_if(patch, is_wrong); // the others are checked nevertheless
    std::string const camera = wrong_.contains({"camera", block.camera}) ? "" : block.camera;
    PlannedStimulus planned;
    planned.what = fmt::format("block {}, {}", block.name, stimulus_label(script_, block, stimulus));
    planned.where = script_.file + ": " + planned.what;
    planned.place = {script_.file, block.place.line, block.place.column};
    planned.patch = patch;
    if (std::ranges::none_of(patch, [](auto const& one) { return one.first == "camera"; }))
        planned.patch.emplace_back("camera", camera);
    try {
        planned.settings = stimulus_settings(patch, camera, std::filesystem::path(script_.file).parent_path(),
                                             made_for(script_));
    } catch (gi::InputError const& e) {
        return m.add(gi::InputError(planned.place, planned.what + ": " + e.problem(), e.why(), e.suggestion()));
    }
    auto const refuse = [&](std::string const& what, std::string const& why, std::string const& suggestion) {
        m.add(gi::InputError(planned.place, fmt::format("block {}: {}", block.name, what), why, suggestion));
    };
    if (block.stimuli == study::Stimuli::prepared && planned.settings.view == StimulusViewer::headset)
        refuse("stimuli: prepared with view: openxr", "pictures in a headset follow the head",
               "write stimuli: live");
    if (block.stimuli == study::Stimuli::prepared && planned.settings.settings.draw_surfaces)
        refuse("stimuli: prepared with frames: shown", "surfaces are drawn for poses that nobody knows ahead",
               "write stimuli: live, or frames: exact");
    std::set<std::string> luminances;
    for (auto const& [key, unused] : patch)
        if (study::plain_key(key).ends_with("luminance")) luminances.insert(study::plain_key(key));
    if (luminances.size() > 1)
        refuse(fmt::format("{} and {} of one stimulus", *luminances.begin(), *std::next(luminances.begin())),
               "a picture has one scale of luminance", "keep one of them");
    std::string const digits = planned.settings.sha256;
    all_.emplace(digits, std::move(planned));
}

void StimulusCollection::add(study::Plan const& plan, study::Mistakes& m)
{
    for (study::PlanStep const& step : plan.steps) {
        bool const walks = step.kind == study::PlanStepKind::free_walk;
        if (step.kind != study::PlanStepKind::trial && !walks) continue;
        if (walks) add(-1, study::Stimulus{step.levels, false, {}}, m);
        if (walks) continue;
        study::Block const& block = script_.blocks[std::size_t(step.block)];
        for (study::Stimulus const& stimulus : possible_stimuli(block, step.trial))
            for (study::Stimulus const& end : at_ends(block, stimulus)) add(step.block, end, m);
    }
}

bool StimulusCollection::need_display_model() const
{
    return std::ranges::any_of(all_, [](auto const& one) {
        PhysicalStimulus const& s = one.second.settings.physical;
        return s.needs_screen() || s.needs_luminance();
    });
}

std::vector<PlannedStimulus> StimulusCollection::list() const
{
    std::vector<PlannedStimulus> list;
    for (auto const& [digits, s] : all_) list.push_back(s);
    return list;
}

StimulusCheckResult find_wrong_stimuli(std::vector<PlannedStimulus> stimuli, SceneAccess const& scenes,
                                       StimulusCheckOptions const& o, study::Mistakes& m)
{
    gi::StopRequest const never;
    gi::StopRequest const& stop = o.stop != nullptr ? *o.stop : never;
    std::erase_if(stimuli, [](PlannedStimulus const& s) { return s.settings.ar.has_value(); });
    std::stable_sort(stimuli.begin(), stimuli.end(),
                     [](auto const& a, auto const& b) { return a.settings.scene < b.settings.scene; });
    gi::StepListener const listener(
        [&](gi::Step const&) {
            if (stop.requested()) throw gi::Interrupted();
        },
        &stop);
    gi::Report report; // losses are reported when the scenes are shown
    OneScene scene(scenes.load);
    RenderSession session([&](std::string const& name, gi::Report& r) { return scene.get(name, r); }, o.threads,
                          report);
    StimulusCheckResult result;
    Teller teller(o, m);
    std::string failed;
    bool is_fresh = false;
    for (std::size_t i = 0; i < stimuli.size(); ++i) {
        PlannedStimulus const& stimulus = stimuli[i];
        StimulusSettings const& s = stimulus.settings;
        if (stop.requested()) throw gi::Interrupted();
        if (o.progress) o.progress(double(i) / double(stimuli.size()), stimulus.what);
        if (o.shown_on) check_measures(stimulus, *o.shown_on, teller);
        if (!failed.empty() && s.scene == failed) continue;
        ++result.stimuli;
        try {
            if (s.scene != session.scene_name() || !is_fresh) session.apply({"scene", s.scene});
        } catch (gi::InputError const& e) {
            failed = s.scene;
            teller.tell(stimulus, "scene", e);
            continue;
        }
        result.rendered += check_one(session, stimulus, scenes, o, stop, teller);
        is_fresh = s.edits.empty();
    }
    result.scenes = scene.loaded();
    return result;
}

} // namespace viewer
