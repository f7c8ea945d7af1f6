#pragma once
// Small scripts, noiseless observer models and tolerances for tests of simulated answers.

#include "study/observers/answer.h"
#include "study/observers/simulate.h"
#include "study/run/progress.h"
#include "study/run/trial.h"
#include "study/script/script_file.h"
#include "tests/viewer/run_program.h"

namespace study::test {

using viewer::test::file_text;
using viewer::test::TemporaryFolder;

inline Script parse(std::string const& body)
{
    return parse_script(
        "schema: study/1\nid: t\nseed: 5\nparticipants: {count: 24}\ntiming: {vsync: record}\n" + body, "t.yaml");
}

/// Block `b` of this text; factors q with levels good, bad, worst and s with one level.
inline Script with_block(std::string const& block)
{
    return parse("factors: {q: {good: {x: 1}, bad: {x: 2}, worst: {x: 3}}}\nreference: {q: good}\nsequence: "
                 "[b]\nblocks:\n  b: {" +
                 block + "}\n");
}

/// No noise but that of percepts, no bias, no lapses, everybody the same.
inline ObserverModel plain_model(Script const& s, double bad = -1, double worst = -2)
{
    ObserverModel m = usual_observers(s);
    m.between_sd = m.lapse = m.side_bias = m.rating_sd = m.dropped = 0;
    for (VariedModel& v : m.varied) v.between_sd = 0;
    if (!m.quality.empty() && !m.quality[0].empty()) m.quality[0] = {0, bad, worst};
    return m;
}

/// Shares of answers to each trial of the first participant's plan that `wanted` picks, each asked n times.
struct Shares {
    int n = 0;
    std::map<std::string, int> count;
    double operator()(std::string const& answer) const
    {
        auto const found = count.find(answer);
        return found == count.end() ? 0 : double(found->second) / n;
    }
};
inline Shares ask(Script const& s, ObserverModel const& model, int n,
                  std::function<bool(Trial const&)> const& wanted, std::optional<double> level = {})
{
    Observer const o = draw_observer(model, 1, 1);
    Plan const plan = make_plan(s, 1);
    Progress const progress(s, plan);
    Shares shares;
    for (std::size_t i = 0; i < plan.steps.size(); ++i) {
        PlanStep const& step = plan.steps[i];
        if (step.kind != PlanStepKind::trial || !wanted(step.trial)) continue;
        TrialRequest r = request_of(s, plan, progress, {int(i), 1, false, level ? level : step.trial.level});
        for (int k = 0; k < n; ++k) {
            Random random = o.random(i * 1000000 + std::uint64_t(k));
            std::string const response = answer(o, r, random).response;
            ++shares.count[response == step.trial.answer ? "right" : response];
            ++shares.n;
        }
    }
    return shares;
}

/// The tolerance of a share of n: 4.5 standard deviations.
inline double near(double p, int n) { return 4.5 * std::sqrt(std::max(p * (1 - p), 1e-3) / n); }

} // namespace study::test
