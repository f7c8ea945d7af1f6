#pragma once
// Sessions made by hand: a plan that is gone through, each trial answered as a function says.

#include "study/tables/recorded_session.h"

#include <functional>

namespace study::test {

/// Fills in the answer: response, value, is_correct, level, validity.
using Answering = std::function<void(PlanStep const&, TrialDone&)>;

inline StimulusShown shown(char letter, double onset_s, double duration_s = 2, double render_ms = 4)
{
    return {letter, onset_s, duration_s, "swap_finish", 8.4, 120, 120, 0, render_ms, 2 * render_ms, "abc"};
}

inline SessionStarted started(Script const& script, Plan const& plan)
{
    SessionStarted s;
    s.experiment = script.id;
    s.participant_id = plan.participant_id;
    s.participant = plan.participant;
    s.utc = "2026-11-22T08:00:00.000Z";
    s.clock_s = 100;
    s.version = "0.1.0";
    s.seed = script.seed;
    s.about = {{"gpu", "none"}};
    return s;
}

/// A trial of the plan as it would be recorded, not answered yet: stimuli one after the other, the answer half a
/// second after the last one.
inline TrialDone unanswered(PlanStep const& step, int index, double start_s)
{
    TrialDone done;
    done.step = index;
    done.level = step.trial.level;
    double t = start_s;
    if (step.trial.reference) done.shown.push_back(shown('r', t));
    for (char const letter : step.trial.order)
        if (letter != 'r') done.shown.push_back(shown(letter, t += 2.5));
    done.response_s = t + 0.5;
    done.reaction_ms = 500;
    done.device = "key:left";
    return done;
}

/// The whole plan of a participant. Questionnaires are answered with their lowest values, or a text.
inline RecordedSession record_session(Script const& script, int participant, Answering const& answer)
{
    RecordedSession session{make_plan(script, participant), {}};
    auto& entries = session.record.entries;
    entries.emplace_back(started(script, session.plan));
    entries.emplace_back(CalibrationDone{600, 60, 16.667, 0.02, "swap_finish", true, ""});
    double t = 101;
    for (std::size_t i = 0; i < session.plan.steps.size(); ++i, t += 10) {
        PlanStep const& step = session.plan.steps[i];
        if (step.kind == PlanStepKind::trial) {
            TrialDone done = unanswered(step, int(i), t);
            answer(step, done);
            entries.emplace_back(std::move(done));
        } else if (step.kind == PlanStepKind::questionnaire) {
            QuestionnaireDone q{int(i), t, t + 9, {}};
            Questionnaire const& asked = script.questionnaires[std::size_t(step.questionnaire)];
            if (has_text_items(asked)) q.texts.assign(asked.items.size(), "");
            for (std::size_t k = 0; k < asked.items.size(); ++k)
                if (asked.items[k].type == ItemType::text) {
                    q.answers.emplace_back();
                    q.texts[k] = "\"Ça\",\nshe said";
                } else {
                    q.answers.emplace_back(asked.items[k].low);
                }
            entries.emplace_back(std::move(q));
        } else
            entries.emplace_back(StepDone{int(i), t, t + 5, ""});
    }
    entries.emplace_back(SessionEnded{t, "2026-11-22T09:00:00.000Z", true, ""});
    return session;
}

} // namespace study::test
