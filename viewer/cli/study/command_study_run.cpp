#include "gi/core/error.h"
#include "gi/core/host_name.h"
#include "study/display/model_file.h"
#include "study/journal/journal_file.h"
#include "study/journal/journal_folders.h"
#include "study/journal/scene_facts.h"
#include "study/run/session.h"
#include "study/run/session_plan.h"
#include "study/script/setting_place.h"
#include "viewer/base/arguments.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/port_options.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/base/version.h"
#include "viewer/cli/command_table.h"
#include "viewer/displays/display_file.h"
#include "viewer/experiment/prepared_list.h"
#include "viewer/experiment/sound/sound_files.h"
#include "viewer/experiment/stimuli/prepared_files.h"
#include "viewer/experiment/stimuli/script_check.h"
#include "viewer/experiment/stimuli/stimulus_check.h"
#include "viewer/experiment/stimuli/study_scenes.h"
#include "viewer/experiment/stimuli/study_stimuli.h"
#include "viewer/experiment/trial_presenter.h"
#include "viewer/report/machine.h"
#include "viewer/study/scene_content.h"
#include "viewer/study/study_outcome.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <memory>
#include <unistd.h>

namespace viewer {
namespace {

struct RunOptions {
    std::string script, dir, size = "1280x720", fullscreen, remote, prepared, display, display_model, gaze;
    std::string audio = "default";
    double audio_latency_ms = 30;
    std::optional<int> remote_port;
    std::string remote_token;
    bool remote_open = false;
    int participant = 1, session = 1, threads = 0, marker_port = kMarkerPort;
    double font_px = 22;
    bool hmd = false, seated = false, resume = false, no_vsync = false, json = false;
};

/// Checks before the session that all settings are known, and that stimuli can be loaded, set up and seen from
/// their cameras. Pictures are not rendered: `study check` does.
/// @returns facts of the scenes' contents for the record
std::vector<std::pair<std::string, std::string>> check_stimuli(LoadedScript const& loaded, study::Plan const& plan,
                                                               SceneAccess scenes, ShownOn const& shown_on)
{
    std::map<std::string, std::string> contents;
    scenes.load = [&contents, load = scenes.load](std::string const& name, gi::Report& report) {
        auto scene = load(name, report);
        if (std::string digits = scene_sha256(*scene); !digits.empty())
            contents[study::scene_fact(name)] = std::move(digits);
        return scene;
    };
    study::Mistakes m;
    StimulusCollection stimuli(loaded.script, find_wrong_settings(loaded.script, loaded.text, loaded.folder, m));
    stimuli.add(plan, m);
    StimulusCheckOptions options;
    options.renders = false;
    options.shown_on = shown_on;
    options.place_of = [&](std::string const& key, std::string const& value) {
        return study::place_of_setting(loaded.text, key, value);
    };
    if (m.empty()) find_wrong_stimuli(stimuli.list(), scenes, options, m);
    throw_first(m);
    return {contents.begin(), contents.end()};
}

/// Warns of scenes whose files have changed since other sessions of the data set.
void warn_of_changed_scenes(std::filesystem::path const& dir, study::SessionStarted const& now)
{
    std::vector<study::SessionRecord> records;
    for (std::filesystem::path const& file : study::find_journals(dir).files) {
        try {
            records.push_back(study::read_journal(file).record);
        } catch (gi::InputError const&) { // analyses report it
        }
    }
    std::vector<study::SessionStarted const*> parts;
    for (study::SessionRecord const& record : records)
        for (study::JournalEntry const& entry : record.entries)
            if (auto const* const s = std::get_if<study::SessionStarted>(&entry)) parts.push_back(s);
    parts.push_back(&now);
    for (std::string const& changed : study::changed_scenes(parts))
        std::fputs(("lightwell: caution: " + changed + "\n").c_str(), stderr);
}

void check_prepared(study::Script const& script, study::Plan const& plan, glm::ivec2 screen_px,
                    RunOptions const& o, study::DisplayModel const* model)
{
    auto const list = prepared_list(script, plan, screen_px, float(o.font_px), program_text(), model);
    for (auto const& [key, wanted] : list) {
        std::filesystem::path const folder = std::filesystem::path(o.prepared) / key;
        if (!std::filesystem::exists(folder))
            throw gi::InputError(
                fmt::format("a stimulus of {} is not in '{}'", name_of(wanted.stimulus), o.prepared),
                fmt::format("nothing was prepared for it in a window of {} x {} px by this version", screen_px.x,
                            screen_px.y),
                "run lightwell study prepare with this script, --size and --font, and name its "
                "folder by --prepared");
        read_prepared(folder);
    }
}

/// Throws unless walls or a headset show one stimulus at a time, rendered live.
void check_one_at_a_time(study::Script const& script, study::Plan const& plan, bool in_headset, bool on_walls)
{
    for (study::PlanStep const& step : plan.steps) {
        if (step.kind != study::PlanStepKind::trial || step.trial.stimuli.empty()) continue;
        study::Block const& block = script.blocks[std::size_t(step.block)];
        bool headset = in_headset, is_ar = false;
        std::vector<study::Stimulus> stimuli = step.trial.stimuli;
        if (step.trial.reference) stimuli.push_back(*step.trial.reference);
        for (std::size_t i = 0; i < stimuli.size(); ++i) {
            StimulusSettings const settings = stimulus_settings(script, block, stimuli[i]);
            auto const view = settings.view;
            is_ar |= settings.ar.has_value();
            bool const is_in_it = view ? *view == StimulusViewer::headset : in_headset;
            if (i > 0 && is_in_it != headset)
                throw gi::InputError(fmt::format("{}: block {}", script.file, block.name),
                                     "stimuli of one trial have different displays (view)",
                                     "vary it between trials: per: FACTOR, or cross");
            headset = is_in_it;
        }
        if (is_ar && on_walls)
            throw gi::InputError(fmt::format("{}: block {} on walls", script.file, block.name),
                                 "its stimuli are a camera's pictures", "run it in a window, without --display");
        if (!headset && !on_walls) continue;
        bool const is_several =
            !block.is_sequential && step.trial.order.size() + (step.trial.reference ? 1 : 0) > 1;
        if (!is_several && block.stimuli == study::Stimuli::live) continue;
        throw gi::InputError(
            fmt::format("{}: block {} {}", script.file, block.name, headset ? "in a headset" : "on walls"),
            is_several ? "it shows several stimuli side by side" : "its stimuli are prepared pictures",
            is_several ? "write presentation: sequential" : "write stimuli: live");
    }
}

/// Throws unless rules of gaze can be met.
void check_gaze(study::Script const& script, RunOptions const& o, study::DisplayModel const* model)
{
    std::string const& gaze = o.gaze.empty() ? script.record.gaze : o.gaze;
    study::Mistakes m;
    find_wrong_gaze(script, gaze != "none" && !gaze.empty(), model, m);
    throw_first(m);
}

/// The device for the cues of the participant's blocks; null if there are none, or the session is without sound.
std::unique_ptr<AudioOutput> open_audio(study::Script const& script, study::Plan const& plan, RunOptions const& o,
                                        SoundBank const& sounds)
{
    bool const has_cues = std::any_of(plan.steps.begin(), plan.steps.end(), [&](study::PlanStep const& step) {
        return step.kind == study::PlanStepKind::trial && !script.blocks[std::size_t(step.block)].cues.empty();
    });
    if (!has_cues || o.audio == "none") return nullptr;
    return std::make_unique<AudioOutput>(o.audio, sounds.front()->rate_hz, o.audio_latency_ms);
}

int run(RunOptions const& o)
{
    LoadedScript const loaded = load_script(o.script);
    study::Script const& script = loaded.script;
    if (o.participant > script.participants.count)
        throw gi::InputError(fmt::format("participant {} of {}", o.participant, script.participants.count),
                             "the script has no more", "name a smaller number, or raise participants.count");
    gi::Report report;
    TrialOptions trials;
    trials.scenes = study_scenes();
    auto const [width, height] = parse_size(o.size);
    study::SessionSettings settings;
    settings.dir = o.dir.empty() ? script.record.dir : o.dir;
    settings.script_folder = loaded.folder;
    settings.script_text = loaded.text;
    settings.session = o.session;
    settings.start = o.resume ? study::SessionStart::go_on : study::SessionStart::begin;
    settings.version = version_number();
    settings.git_hash = git_hash();
    std::string const participant = participant_id(script, o.participant);
    if (!o.resume) check_is_new(participant, settings);
    study::Plan const plan = plan_to_run(script, o.participant, settings).plan;

    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    if (o.hmd && !o.display.empty())
        throw gi::InputError("--hmd with --display", "a session is shown in only one of them", "give one");
    if (!o.display_model.empty() && (o.hmd || !o.display.empty()))
        throw gi::InputError("--display-model with --hmd or --display", "it describes the monitor of a window",
                             "leave one out");
    if (!o.display_model.empty()) trials.screen.model = study::load_display_model(o.display_model);
    study::DisplayModel const* const model = trials.screen.model ? &*trials.screen.model : nullptr;
    ShownOn const shown_on{model, o.hmd || !o.display.empty()};
    ArStimulusCheck ar(loaded, shown_on);
    ar.add(plan);
    ar.check();
    auto const scenes = check_stimuli(loaded, plan, trials.scenes, shown_on);
    check_one_at_a_time(script, plan, o.hmd, !o.display.empty());
    check_gaze(script, o, model);
    trials.sounds = load_sounds(script, loaded.folder);
    auto const audio = open_audio(script, plan, o, trials.sounds);
    trials.audio = audio.get();
    if (!o.display.empty()) trials.screen.display = load_display(o.display, report);
    trials.view = o.hmd ? StimulusViewer::headset : StimulusViewer::window;
    std::string const& gaze = o.gaze.empty() ? script.record.gaze : o.gaze;
    if (gaze == "openxr" && !o.hmd)
        throw gi::InputError("gaze: openxr", "only headsets have it, and the session is in a window",
                             "add --hmd, or name another source by --gaze");
    if (gaze == "openxr") trials.headset.eye_tracking = HmdEyeTracking::on;
    trials.headset.space = o.seated ? HmdSpace::local : HmdSpace::stage;
    trials.screen.window.title = "Lightwell: " + script.id;
    trials.screen.window.size_px = {width, height};
    trials.screen.window.monitor = o.fullscreen;
    trials.screen.window.swap_interval = o.no_vsync ? 0 : 1;
    trials.screen.font_px = float(o.font_px);
    trials.threads = o.threads;
    trials.folder = study::session_folder(settings.dir, participant, o.session);
    trials.participant = participant;
    trials.stem = fmt::format("sub-{}_ses-{:02}", participant, o.session);
    trials.remote.socket = o.remote;
    trials.remote.port = o.remote_port;
    trials.remote.token = o.remote_token;
    trials.remote.open = o.remote_open;
    trials.marker_port = o.marker_port;
    trials.session = o.session;
    trials.gaze = o.gaze;
    trials.prepared = o.prepared;
    trials.version = program_text();
    trials.stop = &stop;
    trials.about = {{"host", gi::host_name()},
                    {"program", version_text()},
                    {"processor", to_text(this_machine())},
                    {"os", operating_system()}};
    trials.about.insert(trials.about.end(), scenes.begin(), scenes.end());
    study::SessionStarted now;
    now.participant_id = participant;
    now.session = o.session;
    now.about = trials.about;
    warn_of_changed_scenes(settings.dir, now);

    study::SessionOutcome outcome;
    {
        TrialPresenter presenter(script, trials, report);
        check_prepared(script, plan, presenter.screen_px(), o, model);
        outcome = study::run_session(script, o.participant, presenter, settings);
    }
    if (!outcome.folder.empty()) keep_tables(settings.dir, o.script);
    print_losses(report);
    if (o.json)
        std::fputs(to_text(session_json(participant, outcome)).c_str(), stdout);
    else
        print_session(participant, outcome);
    return outcome.is_complete ? 0 : 1;
}

} // namespace

void add_study_run(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<RunOptions>();
    CLI::App* const c = study.add_subcommand("run", about("study run"));
    c->add_option("SCRIPT", o->script, "experiment (YAML, schema study/2)")->required();
    c->add_option("--participant", o->participant, "number, from 1")->check(CLI::Range(1, 100000))->required();
    c->add_option("--session", o->session, "number of the session")
        ->check(CLI::Range(1, 99))
        ->capture_default_str();
    c->add_flag("--resume", o->resume, "continue an interrupted session: same order, nothing is repeated");
    c->add_option("-o,--out,--dir", o->dir, "folder of the data set (default: record.dir of the script)");
    c->add_option("--size", o->size, "window size, px")->capture_default_str();
    c->add_option("--fullscreen", o->fullscreen, "full screen on the monitor with this number or name");
    c->add_option("--display", o->display, "display file: walls instead of a window (docs/displays.md)");
    c->add_option("--display-model", o->display_model,
                  "display model of the monitor (study calibrate): degrees, cd/m2, linear light");
    c->add_option("--gaze", o->gaze,
                  "gaze instead of record.gaze: lsl, lsl:NAME, openxr (with --hmd), none, or a table to replay "
                  "(t_s,x_px,y_px,valid)");
    c->add_option("--audio", o->audio,
                  "sound device of cues, by a part of its name; none: without sound, which is recorded")
        ->capture_default_str();
    c->add_option("--audio-latency-ms", o->audio_latency_ms,
                  "its latency; sounds are started earlier by it, smaller ones risk underruns")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    c->add_flag("--hmd", o->hmd,
                "show stimuli in a headset (OpenXR, docs/hmd.md) unless their `view` is set otherwise");
    c->add_flag("--seated", o->seated, "with --hmd: space without a floor, as in lightwell view");
    c->add_option("--font", o->font_px, "height of text, px")->check(CLI::Range(8, 200))->capture_default_str();
    c->add_option("--prepared", o->prepared, "output folder of study prepare, for blocks with stimuli: prepared");
    c->add_option("--threads", o->threads, "render threads, 0 = all")
        ->check(CLI::Range(0, 1024))
        ->transform(as_many_threads_as_there_are())
        ->capture_default_str();
    c->add_option("--remote", o->remote, "Unix socket for the experimenter (study control, docs/remote.md)");
    c->add_option("--remote-port", o->remote_port, "port on 127.0.0.1 for the experimenter; 0 = any free port")
        ->check(CLI::Range(0, 65535));
    declare_port_options(*c, o->remote_token, o->remote_open);
    c->add_option("--marker-port", o->marker_port, "UDP port of 127.0.0.1 for markers")
        ->check(CLI::Range(1, 65535))
        ->capture_default_str();
    c->add_flag("--no-vsync", o->no_vsync, "do not wait for the display's refresh (only for testing)");
    c->add_flag("--json", o->json, "print JSON");
    c->callback([o, &exit_code] { exit_code = run(*o); });
    c->footer(R"(Example (needs a display):
  lightwell study run pairs.yaml --participant 1 --out data --fullscreen 0 --remote /tmp/session.sock

Pressing Escape twice ends the session; completed trials are kept, and --resume continues it.
Exit codes: 0 all steps are done, 1 not all steps are done, 2 the input or the call is wrong, the disk failed,
or the display does not keep time although the script requires it.)");
}

} // namespace viewer
