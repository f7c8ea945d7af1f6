#include "gi/core/error.h"
#include "gi/core/file.h"
#include "study/observers/simulate.h"
#include "study/plan/doubts.h"
#include "study/plan/plan.h"
#include "viewer/base/report_json.h"
#include "viewer/base/version.h"
#include "viewer/cli/commands.h"
#include "viewer/study/comparisons.h"
#include "viewer/study/setting_lookup.h"
#include "viewer/study/study_outcome.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <optional>

namespace viewer {
namespace {

struct SimulateOptions {
    std::string script, participants, out, observer;
    std::optional<std::uint64_t> seed;
    int session = 1;
    double gap_min = 0;
    bool resume = false, each = false, json = false, any_settings = false;
};

study::ObserverModel observers(SimulateOptions const& o, study::Script const& s)
{
    if (o.observer.empty()) return study::usual_observers(s);
    auto const bytes = gi::read_bytes(o.observer, std::size_t(1) << 20);
    return study::read_observers({bytes.begin(), bytes.end()}, o.observer, s);
}

/// Prints one line per entry once it is on disk.
void print_kept(std::string const& id, study::JournalEntry const& entry)
{
    if (auto const* const trial = std::get_if<study::TrialDone>(&entry))
        fmt::print("{} step {} attempt {}{}{}\n", id, trial->step + 1, trial->attempt,
                   trial->response.empty() ? "" : ": ", trial->response);
    else if (auto const* const step = std::get_if<study::StepDone>(&entry))
        fmt::print("{} step {}\n", id, step->step + 1);
    else if (auto const* const items = std::get_if<study::QuestionnaireDone>(&entry))
        fmt::print("{} step {}\n", id, items->step + 1);
    std::fflush(stdout);
}

int run_simulate(SimulateOptions const& o)
{
    LoadedScript const loaded = load_looked_up(o.script, o.any_settings);
    study::Script const& s = loaded.script;
    std::vector<int> const participants = parse_participants(o.participants, s.participants.count);
    study::ObserverModel const model = observers(o, s);
    std::uint64_t const seed = o.seed.value_or(s.seed);

    study::SessionSettings settings;
    settings.dir = o.out.empty() ? "simulated-" + s.id : o.out;
    settings.script_folder = loaded.folder;
    settings.script_text = loaded.text;
    settings.session = o.session;
    settings.start = o.resume ? study::SessionStart::go_on : study::SessionStart::begin;
    settings.version = version_number();
    settings.git_hash = git_hash();
    if (!o.resume)
        for (int const p : participants) check_is_new(participant_id(s, p), settings);
    study::keep_truth(settings.dir, study::truth_text(s, model, seed));

    auto sessions = nlohmann::ordered_json::array();
    bool are_complete = true;
    for (int const p : participants) {
        std::string const id = participant_id(s, p);
        if (o.each) settings.on_kept = [&](study::JournalEntry const& entry) { print_kept(id, entry); };
        study::SessionOutcome const outcome =
            study::simulate_session(s, p, study::draw_observer(model, seed, p), settings, o.gap_min * 60);
        are_complete = are_complete && outcome.is_complete;
        if (o.json)
            sessions.push_back(session_json(id, outcome));
        else
            print_session(id, outcome);
    }
    keep_tables(settings.dir, o.script);
    auto doubts = study::find_idle_procedures(s);
    if (!o.any_settings)
        for (std::string& doubt : find_comparisons(s, make_plan(s, participants.front())).doubts)
            doubts.push_back(std::move(doubt));
    if (!o.json) print_doubts(doubts);
    if (o.json)
        std::fputs(to_text({{"id", s.id},
                            {"seed", seed},
                            {"truth", study::truth_file(settings.dir).string()},
                            {"sessions", sessions},
                            {"doubts", doubts}})
                       .c_str(),
                   stdout);
    return are_complete ? 0 : 1;
}

} // namespace

void add_study_simulate(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<SimulateOptions>();
    CLI::App* const simulate = study.add_subcommand(
        "simulate", "Simulate sessions with model observers: to try a script, for power analysis, for tests.");
    simulate->add_option("SCRIPT", o->script, "experiment (YAML, schema study/2)")->required();
    simulate->add_option("--participants", o->participants, "3, 1..24 or 1,4,7..9 (default: all of the script)");
    simulate->add_option("-o,--out,--dir", o->out, "folder of the data set (default: simulated-ID)");
    simulate->add_option("--observer", o->observer, "model of the observers (YAML, docs/study/analysis.md)");
    simulate->add_option("--seed", o->seed, "seed of the observers and their answers (default: the script's)");
    simulate->add_option("--session", o->session, "number of the session")
        ->check(CLI::Range(1, 99))
        ->capture_default_str();
    CLI::Option* const resume =
        simulate->add_flag("--resume", o->resume, "continue interrupted sessions and start missing ones");
    simulate->add_option("--gap-min", o->gap_min, "with --resume: minutes since the session was interrupted")
        ->check(CLI::Range(-1e6, 1e6))
        ->needs(resume)
        ->capture_default_str();
    simulate->add_flag("--each", o->each, "print a line for each step once it is on disk");
    simulate->add_flag("--any-settings", o->any_settings, "do not look settings up (as for study check)");
    simulate->add_flag("--json", o->json, "print JSON");
    simulate->callback([o, &exit_code] { exit_code = run_simulate(*o); });
    simulate->footer(R"(Prepared by:
  lightwell study example staircase --out staircase.yaml
Examples:
  lightwell study simulate staircase.yaml --participants 1..3 --out stairs
  lightwell study simulate staircase.yaml --participants 4 --seed 7 --out others --each

Exit codes: 0 all sessions are complete, 1 not all are, 2 the input or the call is wrong, or the disk failed.)");
}

} // namespace viewer
