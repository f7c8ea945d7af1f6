#include "study/display/model_file.h"
#include "study/plan/counterbalance.h"
#include "study/plan/doubts.h"
#include "study/plan/plan_text.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/experiment/stimuli/study_stimuli.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct CheckOptions {
    std::string script, display_model;
    bool json = false;
};

int run_check(CheckOptions const& o)
{
    constexpr int kMostPlans = 2000;
    LoadedScript const loaded = load_script(o.script);
    study::Script const& s = loaded.script;
    int const plans = std::min(s.participants.count, kMostPlans);
    ArStimulusCheck ar(loaded);
    study::Plan longest = study::make_plan(s, 1);
    ar.add(longest);
    for (int p = 2; p <= plans; ++p) {
        study::Plan plan = study::make_plan(s, p);
        ar.add(plan);
        if (plan.duration_us > longest.duration_us) longest = std::move(plan);
    }
    ar.check();
    std::optional<study::DisplayModel> model;
    if (!o.display_model.empty()) {
        model = study::load_display_model(o.display_model);
        check_physical_of(stimuli_of(s, longest), &*model, false);
    }
    auto doubts = study::find_doubts(s);
    for (std::string& doubt : study::find_doubts(s, longest)) doubts.push_back(std::move(doubt));
    if (o.json) {
        nlohmann::ordered_json j{{"id", s.id},
                                 {"participants", s.participants.count},
                                 {"plans_made", plans},
                                 {"full_cycle", study::full_cycle(s)},
                                 {"ar_stimuli", ar.count()},
                                 {"longest_s", double(longest.duration_us) * 1e-6},
                                 {"doubts", doubts}};
        if (model)
            for (auto const& [key, value] : study::display_model_facts(*model)) j["display_model"][key] = value;
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    std::fputs(study::script_text(s, longest).c_str(), stdout);
    if (ar.count() > 0) fmt::print("{} stimuli from AR sessions\n", ar.count());
    fmt::print("{} plans made, the longest is expected to take {}\n", plans,
               study::clock_text(longest.duration_us));
    if (model) fmt::print("{}", study::display_model_summary(*model));
    print_doubts(doubts);
    return 0;
}

} // namespace

void add_study_check(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<CheckOptions>();
    CLI::App* const c = study.add_subcommand("check", about("study check"));
    c->add_option("SCRIPT", o->script, "experiment (YAML, schema study/1)")->required();
    c->add_option("--display-model", o->display_model,
                  "display model (study calibrate): checks sizes and luminances, prints pixels per degree");
    c->add_flag("--json", o->json, "print JSON");
    c->callback([o, &exit_code] { exit_code = run_check(*o); });
}

} // namespace viewer
