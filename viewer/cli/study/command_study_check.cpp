#include "study/display/model_file.h"
#include "study/plan/counterbalance.h"
#include "study/plan/doubts.h"
#include "study/plan/plan_text.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/command_table.h"
#include "viewer/experiment/stimuli/script_check.h"
#include "viewer/experiment/stimuli/study_scenes.h"
#include "viewer/study/comparisons.h"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

namespace viewer {
namespace {

struct CheckOptions {
    std::string script, display_model;
    int threads = 0;
    bool no_render = false, any_settings = false, json = false;
};

CheckedScript check(CheckOptions const& o, ScriptToCheck& read, std::optional<study::DisplayModel> const& model)
{
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    gi::ProgressBar bar("check " + read.loaded.script.id);
    ScriptCheckOptions options;
    options.any_settings = o.any_settings;
    options.stimuli.renders = !o.no_render;
    options.stimuli.threads = o.threads;
    options.stimuli.stop = &stop;
    if (model) options.stimuli.shown_on = ShownOn{&*model};
    options.stimuli.progress = [&](double share, std::string const& what) { bar.update(share, what); };
    return check_script(read, study_scenes(), options);
}

/// Why this machine cannot make a folder; empty = it can, or has it.
std::string why_not_a_folder(std::string const& folder)
{
    std::error_code none;
    std::filesystem::path existing = std::filesystem::absolute(folder, none);
    while (!std::filesystem::exists(existing, none) && existing.has_relative_path())
        existing = existing.parent_path();
    if (!std::filesystem::is_directory(existing, none)) return fmt::format("'{}' is a file", existing.string());
    if (access(existing.c_str(), W_OK) != 0) return fmt::format("'{}' cannot be written", existing.string());
    return {};
}

int tell(CheckOptions const& o, study::Mistakes const& mistakes)
{
    auto const all = mistakes.in_order();
    if (o.json) {
        nlohmann::ordered_json j{{"mistakes", nlohmann::ordered_json::array()}};
        for (study::ScriptError const& e : all)
            j["mistakes"].push_back({{"file", e.where().file},
                                     {"line", e.where().line},
                                     {"column", e.where().column},
                                     {"problem", e.problem()},
                                     {"why", e.why()},
                                     {"suggestion", e.suggestion()}});
        std::fputs(to_text(j).c_str(), stdout);
    }
    for (study::ScriptError const& e : all) std::fputs(fmt::format("lightwell: {}\n", e.what()).c_str(), stderr);
    if (all.size() > 1) std::fputs(fmt::format("{} mistakes\n", all.size()).c_str(), stderr);
    return 2;
}

int run_check(CheckOptions const& o)
{
    ScriptToCheck read = load_script_to_check(o.script);
    study::Script const& s = read.loaded.script;
    std::optional<study::DisplayModel> model;
    if (!o.display_model.empty()) model = study::load_display_model(o.display_model);
    CheckedScript const checked = check(o, read, model);
    if (!read.mistakes.empty()) return tell(o, read.mistakes);
    Comparisons const comparisons = find_comparisons(s, checked.longest);
    auto doubts = study::find_doubts(s);
    for (auto const* const list : {&comparisons.doubts, &checked.idle_settings})
        doubts.insert(doubts.end(), list->begin(), list->end());
    for (std::string& doubt : study::find_doubts(s, checked.longest)) doubts.push_back(std::move(doubt));
    if (checked.needs_display_model && !model)
        doubts.emplace_back("stimuli have sizes, places or luminances in physical units: study run needs "
                            "--display-model, with which check finds what the display cannot show");
    if (std::string const why = why_not_a_folder(s.record.dir); !why.empty())
        doubts.push_back(fmt::format("record.dir '{}' cannot be made here: {}; study run needs another --out",
                                     s.record.dir, why));
    if (o.json) {
        nlohmann::ordered_json j{{"id", s.id},
                                 {"participants", s.participants.count},
                                 {"plans_made", checked.plans},
                                 {"full_cycle", study::full_cycle(s)},
                                 {"scenes", checked.stimuli.scenes},
                                 {"stimuli", checked.stimuli.stimuli},
                                 {"stimuli_rendered", checked.stimuli.rendered},
                                 {"ar_stimuli", checked.ar_stimuli},
                                 {"longest_s", double(checked.longest.duration_us) * 1e-6},
                                 {"comparisons", comparisons.texts},
                                 {"doubts", doubts}};
        if (model)
            for (auto const& [key, value] : study::display_model_facts(*model)) j["display_model"][key] = value;
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    std::fputs(study::script_text(s, checked.longest).c_str(), stdout);
    for (std::string const& text : comparisons.texts) fmt::print("{}\n", text);
    if (checked.ar_stimuli > 0) fmt::print("{} stimuli from AR sessions\n", checked.ar_stimuli);
    if (!o.any_settings)
        fmt::print("{} stimuli in {} scenes set up, {} rendered\n", checked.stimuli.stimuli,
                   checked.stimuli.scenes, checked.stimuli.rendered);
    fmt::print("{} plans made, the longest is expected to take {}\n", checked.plans,
               study::clock_text(checked.longest.duration_us));
    if (model) fmt::print("{}", study::display_model_summary(*model));
    print_doubts(doubts);
    return 0;
}

} // namespace

void add_study_check(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<CheckOptions>();
    CLI::App* const c = study.add_subcommand("check", about("study check"));
    c->add_option("SCRIPT", o->script, "experiment (YAML, schema study/2)")->required();
    c->add_option("--display-model", o->display_model,
                  "display model (study calibrate): checks sizes and luminances, prints pixels per degree");
    c->add_flag("--no-render", o->no_render, "load and set up the stimuli, but render no tiny picture of each");
    c->add_flag("--any-settings", o->any_settings,
                "do not look settings up: the script is for a presenter of its own (Python)");
    c->add_option("--threads", o->threads, "render threads, 0 = all")
        ->check(CLI::Range(0, 1024))
        ->transform(as_many_threads_as_there_are())
        ->capture_default_str();
    c->add_flag("--json", o->json, "print JSON");
    c->callback([o, &exit_code] {
        try {
            exit_code = run_check(*o);
        } catch (gi::Interrupted const&) {
            std::fputs("lightwell: interrupted before everything was checked\n", stderr);
            exit_code = interrupted_code();
        }
    });
    c->footer(R"(Example:
  lightwell study check visibility2026.yaml

All mistakes are told at once, one line each: file:line:column: problem (why) suggestion. Settings are looked up
(lightwell info --settings lists them), each scene is loaded, and a picture of 16 x 16 pixels of each stimulus is
rendered, without a window. Exit codes: 0 no mistake, 2 mistakes.)");
}

} // namespace viewer
