#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/progress.h"
#include "gi/core/text.h"
#include "study/power/power_study.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/version.h"
#include "viewer/cli/commands.h"
#include "viewer/study/study_records.h"
#include "viewer/study/study_script.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <unistd.h>

namespace viewer {
namespace {

struct PowerOptions {
    std::string script, block, test, observer, out, participants = "12,24,36";
    std::vector<std::string> scaled;
    std::vector<int> repeats;
    study::PowerSettings settings;
    bool json = false;
};

int block_of(study::Script const& s, std::string const& name)
{
    std::string known;
    for (std::size_t b = 0; b < s.blocks.size(); ++b) {
        if (s.blocks[b].name == name) return int(b);
        known += (known.empty() ? "" : ", ") + s.blocks[b].name;
    }
    if (name.empty())
        throw gi::InputError("no --block", "power is that of a test of one block", "give one of " + known);
    throw gi::InputError(fmt::format("--block '{}'", name), "the script has no such block", "it has: " + known);
}

int factor_of(study::Script const& s, std::string const& name)
{
    std::string known;
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        if (s.factors[f].name == name) return int(f);
        known += (known.empty() ? "" : ", ") + s.factors[f].name;
    }
    throw gi::InputError(fmt::format("--effect-of '{}'", name), "the script has no such factor",
                         "it has: " + known);
}

study::ObserverModel observers(PowerOptions const& o, study::Script const& s)
{
    if (o.observer.empty()) return study::usual_observers(s);
    auto const bytes = gi::read_bytes(o.observer, std::size_t(1) << 20);
    return study::read_observers({bytes.begin(), bytes.end()}, o.observer, s);
}

int run_power(PowerOptions& o)
{
    study::Script const s = load_script(o.script).script;
    study::PowerSettings& p = o.settings;
    p.block = block_of(s, o.block.empty() && s.blocks.size() == 1 ? s.blocks[0].name : o.block);
    p.test = o.test;
    p.participants = parse_participants(o.participants, 2000);
    if (p.participants.front() < 2)
        throw gi::InputError("--participants 1", "tests are over participants", "use 3 or more");
    p.repeats = o.repeats;
    for (std::string const& name : o.scaled) p.scaled.push_back(factor_of(s, name));
    study::ObserverModel const model = observers(o, s);

    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    bool const is_shown = isatty(2) != 0;
    int shown = -1;
    study::PowerStudy const study = study_power(s, model, p, [&](double share) {
        int const percent = int(100 * share);
        if (is_shown && percent != shown) fmt::print(stderr, "\r{:3} % ", shown = percent);
        return !stop.requested();
    });
    if (is_shown) fmt::print(stderr, "\r       \r");
    if (!o.out.empty())
        write_files(o.out, {{"power.csv", study::csv_text(power_table(study, p), "NA")},
                            {"power.json", study::power_json(study, p)},
                            {"power.html", study::power_page(s, study, p, version_text())}});
    std::fputs((o.json ? power_json(study, p) : power_text(study, p)).c_str(), stdout);
    return study.is_complete ? 0 : interrupted_code();
}

} // namespace

void add_study_power(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<PowerOptions>();
    CLI::App* const power = study.add_subcommand(
        "power", "Power by simulation: how often the analysis finds an effect, by its size and the participants.");
    power->add_option("SCRIPT", o->script, "experiment (YAML, schema study/2)")->required();
    power
        ->add_option(
            "--test", o->test,
            "an effect as analyze names it (display:scene, or 'display x scene'), or two items (exact-none)")
        ->required();
    power->add_option("--block", o->block, "the block that is tested (needed if there are several)");
    power->add_option("--observer", o->observer, "model of the observers (YAML, docs/study/analysis.md)");
    power
        ->add_option("--effects", o->settings.effects,
                     "factors on the model's effects; 0: none, as a check of alpha")
        ->delimiter(',')
        ->check(CLI::Range(-100.0, 100.0));
    power->add_option("--effect-of", o->scaled, "only effects of these factors are multiplied (default: all)")
        ->delimiter(',');
    power->add_option("--participants", o->participants, "numbers of participants: 12,24,36 or 8..12")
        ->capture_default_str();
    power->add_option("--repeats", o->repeats, "repeats of the block (default: the script's)")
        ->delimiter(',')
        ->check(CLI::Range(1, 1000));
    power->add_option("--simulations", o->settings.simulations, "simulated experiments")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    power->add_option("--alpha", o->settings.alpha, "level of significance")
        ->check(CLI::Range(1e-6, 0.5))
        ->capture_default_str();
    power->add_option("--seed", o->settings.seed, "seed of observers and answers")->capture_default_str();
    power->add_flag("--recovery", o->settings.has_recovery,
                    "compare the estimates with those of an experiment 20 times as large");
    power->add_option("-o,--out", o->out, "folder for power.csv, power.json and power.html (with a figure)");
    power->add_flag("--json", o->json, "print JSON");
    power->callback([o, &exit_code] { exit_code = run_power(*o); });
    power->footer(R"(Prepared by:
  lightwell study example pairs --out pairs.yaml
Examples:
  lightwell study power pairs.yaml --block better --test none-wide --participants 6,12 --effects 0,1 --simulations 20

Ctrl-C ends it and keeps the simulations that are complete.)");
}

} // namespace viewer
