#include "study/power/simulated_record.h"

#include "study/observers/model_presenter.h"
#include "study/run/trial.h"

namespace study {

RecordedSession simulated_record(Script const& script, Plan plan, Observer const& observer)
{
    RecordedSession session{std::move(plan), {}};
    ModelPresenter presenter(observer);
    Progress progress(script, session.plan);
    auto const keep = [&](JournalEntry entry) {
        progress.apply(entry);
        session.record.entries.push_back(std::move(entry));
    };
    SessionStarted start;
    start.experiment = script.id;
    start.participant_id = session.plan.participant_id;
    start.participant = session.plan.participant;
    start.is_simulated = true;
    keep(start);
    while (auto const due = progress.next()) {
        PlanStep const& step = session.plan.steps[std::size_t(due->step)];
        if (step.kind == PlanStepKind::questionnaire || due->is_questionnaire_of_trial) {
            int const which = due->is_questionnaire_of_trial ? script.blocks[std::size_t(step.block)].questionnaire
                                                             : step.questionnaire;
            Questionnaire const& asked = script.questionnaires[std::size_t(which)];
            keep(presenter.ask({&asked, due->step}));
        } else if (step.kind != PlanStepKind::trial ||
                   script.blocks[std::size_t(step.block)].task == Task::free_walk) {
            keep(StepDone{due->step, presenter.now(), presenter.now(), ""});
        } else {
            TrialDone done = presenter.show(request_of(script, session.plan, progress, *due));
            complete(script, session.plan, *due, done);
            keep(std::move(done));
        }
    }
    keep(SessionEnded{presenter.now(), "", true, ""});
    fill_chosen(script, session);
    return session;
}

} // namespace study
