#pragma once
// Sessions whose trials are given one by one, without a planner.

#include "study/analysis/analysis.h"
#include "study/script/script_file.h"
#include "tests/study_tables/recorded.h"

#include <gtest/gtest.h>

namespace study::test {

/// Yes or no at levels 1 to 100.
inline Script yes_no_script(std::string const& harder, std::string const& procedure)
{
    return parse_script(R"(schema: study/1
id: s
seed: 1
participants: {count: 1}
factors: {scene: [hall]}
reference: {scene: hall}
defaults: {stimulus_ms: 2000}
sequence: [find]
blocks:
  find:
    task: yes_no
    cross: [scene]
    compare: {vary: points, scale: log10, range: [1, 100], harder: )" +
                            harder + "}\n    procedure: " + procedure + "\n",
                        "s.yaml");
}

class MadeSession {
public:
    MadeSession(Script const& script, std::string const& participant_id) : script_(script)
    {
        session_.plan.participant_id = participant_id;
        session_.record.entries.emplace_back(started(script, session_.plan));
    }

    /// A trial of a block whose stimuli have these levels, shown in the order of their letters.
    TrialDone& add(int block, std::vector<std::vector<int>> const& stimuli, std::string const& response,
                   std::optional<double> value = {})
    {
        PlanStep step;
        step.block = block;
        step.number = int(session_.plan.steps.size()) + 1;
        for (std::size_t i = 0; i < stimuli.size(); ++i) {
            step.trial.stimuli.push_back({stimuli[i], false, {}});
            step.trial.order += char('a' + i);
        }
        session_.plan.steps.push_back(step);
        int const index = int(session_.plan.steps.size()) - 1;
        TrialDone done = unanswered(step, index, 100 + 10 * index);
        done.response = response;
        done.value = value;
        session_.record.entries.emplace_back(std::move(done));
        return std::get<TrialDone>(session_.record.entries.back());
    }
    /// A trial of yes_no_script().
    void add_yes_no(double level, bool says_yes, bool is_noise)
    {
        TrialDone& t = add(0, {{0}, {0}}, says_yes ? "yes" : "no");
        t.level = level;
        t.is_correct = says_yes != is_noise;
        last_step().trial.procedure = 0;
        last_step().trial.is_noise = is_noise;
    }
    PlanStep& last_step() { return session_.plan.steps.back(); }

    RecordedSession finished()
    {
        session_.record.entries.emplace_back(SessionEnded{9999, "2026-11-22T09:00:00.000Z", true, ""});
        return session_;
    }

private:
    Script const& script_;
    RecordedSession session_;
};

inline double fact(ScaleResult const& scale, std::string const& name)
{
    for (NamedValue const& f : scale.facts)
        if (f.name == name) return f.value;
    ADD_FAILURE() << "no " << name;
    return 0;
}

} // namespace study::test
