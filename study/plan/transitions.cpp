#include "study/plan/transitions.h"

#include <algorithm>
#include <functional>
#include <map>

namespace study {
namespace {

/// Index into names, or -1.
using Read = std::function<int(Trial const&)>;

Transitions count(std::vector<Trial const*> const& trials, Transitions t, Read const& read)
{
    std::size_t const n = t.names.size();
    t.counts.assign(n * n, 0);
    std::vector<double> by_name(n);
    double neighbours = 0, switches = 0, all = 0;
    int before = -1;
    for (Trial const* const trial : trials) {
        int const now = read(*trial);
        if (now >= 0) {
            ++by_name[std::size_t(now)];
            ++all;
        }
        if (before >= 0 && now >= 0) {
            ++t.counts[std::size_t(before) * n + std::size_t(now)];
            ++neighbours;
            switches += before != now;
        }
        before = now;
    }
    t.switched = neighbours > 0 ? switches / neighbours : 0;
    double same = 0;
    for (double const k : by_name) same += k * (k - 1);
    t.by_chance = all > 1 ? 1 - same / (all * (all - 1)) : 0;
    return t;
}

void add_pass(Script const& s, int block, int pass, std::vector<Trial const*> const& trials,
              std::vector<Transitions>& out)
{
    Block const& b = s.blocks[std::size_t(block)];
    auto const add = [&](std::string const& subject, std::vector<std::string> names, Read const& read) {
        Transitions t = count(trials, {block, pass, subject, std::move(names), {}, 0, 0}, read);
        if (t.by_chance > 0) out.push_back(std::move(t)); // otherwise it is the same in all trials
    };
    for (std::size_t f = 0; f < s.factors.size(); ++f) {
        if ((b.pairs && b.pairs->factor == int(f)) || b.rank == int(f)) continue;
        std::vector<std::string> names;
        for (FactorLevel const& l : s.factors[f].levels) names.push_back(l.name);
        add(s.factors[f].name, names, [f](Trial const& t) { return t.stimuli[0].levels[f]; });
    }
    std::vector<std::string> answers, procedures;
    for (auto const a : facts(b.task).answers) answers.emplace_back(a);
    add("answer", answers, [&](Trial const& t) {
        auto const at = std::find(answers.begin(), answers.end(), t.answer);
        return at == answers.end() ? -1 : int(at - answers.begin());
    });
    for (Procedure const& p : b.procedures) procedures.push_back(p.name);
    add("procedure", procedures, [](Trial const& t) { return t.procedure; });
}

} // namespace

std::vector<Transitions> find_transitions(Script const& script, Plan const& plan)
{
    std::map<std::pair<int, int>, std::vector<Trial const*>> passes;
    for (PlanStep const& step : plan.steps)
        if (step.kind == PlanStepKind::trial && step.trial.phase != Phase::practice)
            passes[{step.block, step.pass}].push_back(&step.trial);
    std::vector<Transitions> out;
    for (auto const& [key, trials] : passes) add_pass(script, key.first, key.second, trials, out);
    return out;
}

} // namespace study
