#include "gi/core/error.h"
#include "gi/core/file.h"
#include "study/display/model_file.h"
#include "study/plan/counterbalance.h"
#include "study/plan/doubts.h"
#include "study/plan/plan_text.h"
#include "study/plan/transitions.h"
#include "study/script/examples.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/cli/program.h"
#include "viewer/study/setting_lookup.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct StudyOptions {
    std::string script, out, example, display_model;
    int participant = 1;
    bool json = false, any_settings = false;
};

nlohmann::ordered_json to_json(study::Script const& s, study::Plan const& plan)
{
    nlohmann::ordered_json j{{"id", s.id},
                             {"participant", plan.participant},
                             {"participant_id", plan.participant_id},
                             {"seed", s.seed},
                             {"expected_s", double(plan.duration_us) * 1e-6}};
    for (study::PlanStep const& step : plan.steps) {
        if (step.kind != study::PlanStepKind::trial || step.number != 1) continue;
        study::TrialCounts const n = count_trials(plan, step.block, step.pass);
        j["blocks"].push_back({{"name", s.blocks[std::size_t(step.block)].name},
                               {"pass", step.pass + 1},
                               {"practice", n.practice},
                               {"main", n.main},
                               {"catch", n.catches},
                               {"start_s", double(step.start_us) * 1e-6}});
    }
    for (study::Transitions const& t : study::find_transitions(s, plan))
        j["transitions"].push_back({{"block", s.blocks[std::size_t(t.block)].name},
                                    {"pass", t.pass + 1},
                                    {"subject", t.subject},
                                    {"names", t.names},
                                    {"counts", t.counts},
                                    {"switched", t.switched},
                                    {"by_chance", t.by_chance}});
    j["doubts"] = study::find_doubts(s, plan);
    return j;
}

int run_plan(StudyOptions const& o)
{
    check_outputs({o.out}, {o.script});
    study::Script const s = load_looked_up(o.script, o.any_settings).script;
    if (o.participant > s.participants.count)
        throw gi::InputError(fmt::format("participant {} of {}", o.participant, s.participants.count),
                             "the script has no more", "name a smaller number, or raise participants.count");
    study::Plan const plan = study::make_plan(s, o.participant);
    std::optional<study::DisplayModel> model;
    if (!o.display_model.empty()) model = study::load_display_model(o.display_model);
    if (!o.out.empty()) gi::write_text(o.out, study::plan_table(s, plan));
    if (o.json) {
        nlohmann::ordered_json j = to_json(s, plan);
        if (model)
            for (auto const& [key, value] : study::display_model_facts(*model)) j["display_model"][key] = value;
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    fmt::print("{}: participant {} of {} ({}), seed {}\n", s.id, plan.participant, s.participants.count,
               plan.participant_id, s.seed);
    std::fputs(study::order_text(s, plan).c_str(), stdout);
    std::fputs(study::statistics_text(s, plan).c_str(), stdout);
    fmt::print("expected duration {}\n", study::clock_text(plan.duration_us));
    if (model) fmt::print("{}", study::display_model_summary(*model));
    print_doubts(study::find_doubts(s, plan));
    return 0;
}

std::string names_of_examples()
{
    std::string names;
    for (study::StudyExample const& example : study::study_examples())
        names += (names.empty() ? "" : ", ") + std::string(example.name);
    return names;
}

int run_example(StudyOptions const& o)
{
    for (study::StudyExample const& example : study::study_examples()) {
        if (o.example != example.name) continue;
        check_outputs({o.out}, {});
        gi::write_text(o.out, example.text);
        fmt::print("{}\n", o.out);
        return 0;
    }
    throw gi::InputError("there is no example '" + o.example + "'", "no built-in experiment has this name",
                         "there are: " + names_of_examples());
}

} // namespace

void add_study(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<StudyOptions>();
    CLI::App* const study = app.add_subcommand("study", about("study"));
    study->require_subcommand(1);

    CLI::App* const plan = study->add_subcommand(
        "plan", "Print a participant's plan: order, counts, transitions, expected duration.");
    plan->add_option("SCRIPT", o->script, "experiment (YAML, schema study/2)")->required();
    plan->add_option("--participant", o->participant, "number, from 1")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    plan->add_option("-o,--out", o->out, "file for the plan as a table (TSV)");
    plan->add_option("--display-model", o->display_model,
                     "display model (study calibrate): prints pixels per degree and luminances");
    plan->add_flag("--json", o->json, "print JSON, without the steps");
    plan->add_flag("--any-settings", o->any_settings, "do not look settings up (as for study check)");
    plan->callback([o, &exit_code] { exit_code = run_plan(*o); });

    CLI::App* const example = study->add_subcommand("example", "Write one of the built-in example experiments.");
    example->add_option("NAME", o->example, names_of_examples())->required();
    example->add_option("-o,--out", o->out, "file to write")->required();
    example->callback([o, &exit_code] { exit_code = run_example(*o); });

    for (CommandRow const& c : commands()) // commands of the other program, for --help
        if (c.name.starts_with("study ")) add_elsewhere(*study, c);
    add_study_simulate(*study, exit_code);
    add_study_power(*study, exit_code);
    add_study_tables(*study, exit_code);
    add_study_analyze(*study, exit_code);
    add_study_photodiode(*study, exit_code);

    study->footer(R"(Examples:
  lightwell study example visibility2026 --out visibility2026.yaml
  lightwell study check visibility2026.yaml
  lightwell study plan visibility2026.yaml --participant 3 --out plan.tsv
  lightwell study simulate visibility2026.yaml --participants 1..2 --out sessions
  lightwell study report sessions --out report.html

A script and a participant always give the same plan, byte for byte. Doubtful choices, such as sessions of
more than 60 minutes, are reported on stderr. docs/study/reference.md describes every key of a script.)");
}

} // namespace viewer
