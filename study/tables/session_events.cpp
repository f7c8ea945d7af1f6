#include "study/tables/events.h"

#include <fmt/format.h>
#include <map>

namespace study {
namespace {

std::string calibration_text(CalibrationDone const& c)
{
    std::string const nominal = c.nominal_hz > 0 ? fmt::format("{:.3f} Hz", c.nominal_hz) : "unknown";
    return fmt::format("{}, {} frames, nominal {}, period {:.4f} ms, SD {:.4f} ms, {}",
                       c.passed ? "passed" : "failed", c.frames, nominal, c.period_mean_ms, c.period_sd_ms,
                       c.onset_method) +
           (c.reason.empty() ? "" : ": " + c.reason);
}

/// HED 8.3.0. Calibrations have none: without an onset, those of all parts would be one event.
std::vector<std::pair<std::string, std::string>> hed_of_session_events()
{
    return {{"start", "Experiment-structure, Label/session-start"},
            {"instructions", "Experiment-structure, Instructional"},
            {"rest", "Experiment-structure, Label/rest"},
            {"free_walk", "Experiment-structure, Label/free-walk"},
            {"questionnaire", "Experiment-structure, Questionnaire"},
            {"end", "Experiment-structure, Label/session-end"},
            {"note", "Experiment-control, Label/note"},
            {"pause", "Experiment-control, Pause"},
            {"resume", "Experiment-control, Label/resume"},
            {"skip", "Experiment-control, Label/skip"},
            {"abort", "Experiment-control, Label/abort"},
            {"warning", "Experiment-control, Warning"},
            {"display", "Experiment-control, Label/display"},
            {"display_lost", "Experiment-control, Label/display-lost"},
            {"clock_changed", "Experiment-control, Label/clock-changed"}};
}

void add(Table& table, double onset_s, double end_s, std::string const& type, std::string const& step,
         std::string const& text)
{
    table.rows.push_back({seconds_cell(onset_s), seconds_cell(end_s - onset_s), cell(type), step, cell(text)});
}

} // namespace

std::vector<AnsweredQuestionnaire> answered_questionnaires(Script const& script, RecordedSession const& session)
{
    std::vector<AnsweredQuestionnaire> out;
    std::map<int, int> times;
    for (TimedEntry const& timed : timed_entries(session)) {
        auto const* done = std::get_if<QuestionnaireDone>(timed.entry);
        if (done == nullptr) continue;
        auto const& steps = session.plan.steps;
        bool const is_planned = done->step >= 0 && done->step < int(steps.size());
        PlanStep const* const step = is_planned ? &steps[std::size_t(done->step)] : nullptr;
        int which = step ? step->questionnaire : -1;
        if (step && which < 0 && step->block >= 0) which = script.blocks[std::size_t(step->block)].questionnaire;
        auto const refuse = [&](std::string const& problem) {
            return ScriptError("journal of " + session.plan.participant_id, {}, problem,
                               "'" + script.file + "' gives another plan",
                               "use the script and the plan with which the session was recorded");
        };
        if (which < 0) throw refuse(fmt::format("step {} is no questionnaire", done->step + 1));
        Questionnaire const& q = script.questionnaires[std::size_t(which)];
        std::size_t const texts = has_text_items(q) ? q.items.size() : 0;
        if (done->texts.size() != texts)
            throw refuse(
                fmt::format("{} texts for the {} items of {}", done->texts.size(), q.items.size(), q.name));
        try {
            out.push_back({&q, step, done, ++times[which], timed.offset_s, score(q, done->answers)});
        } catch (std::invalid_argument const& e) {
            throw refuse(fmt::format("the answers to {} do not fit: {}", q.name, e.what()));
        }
    }
    return out;
}

std::string AnsweredQuestionnaire::level(Script const& script, std::size_t factor) const
{
    int const at =
        step->kind == PlanStepKind::trial ? step->trial.stimuli.front().levels[factor] : step->levels[factor];
    return at < 0 ? "" : script.factors[factor].levels[std::size_t(at)].name;
}

std::string AnsweredQuestionnaire::condition(Script const& script) const
{
    std::string all;
    for (std::size_t f = 0; f < script.factors.size(); ++f)
        if (std::string const name = level(script, f); !name.empty()) all += (all.empty() ? "" : ", ") + name;
    return all;
}

Table questionnaires_table(Script const& script, RecordedSession const& session)
{
    Table table{{{"start", "When the questionnaire was shown, since the beginning of the session", "s"},
                 {"time_taken", "Time taken to answer", "s"},
                 {"questionnaire", "Its name"},
                 {"time_point", "Number of the occasion in this session, from 1"}}};
    for (std::string const& name : factor_columns(script))
        table.columns.push_back({name, "Level of the factor at that time; n/a if none was fixed"});
    std::vector<Column> const more{
        {"kind", "Kind of row", "", {{"item", "an answer"}, {"score", "a score computed from answers"}}},
        {"item", "Item, or the name of the score"},
        {"raw", "Answer as given"},
        {"reversed", "Whether the item is reverse-scored"},
        {"scored", "Answer as scored, or the score"},
        {"text",
         "Answer as typed, of an item that asks for a text; in tab-separated files its line ends are blanks"}};
    table.columns.insert(table.columns.end(), more.begin(), more.end());
    for (AnsweredQuestionnaire const& a : answered_questionnaires(script, session)) {
        std::vector<std::string> head{seconds_cell(a.done->start_s + a.offset_s),
                                      seconds_cell(a.done->end_s - a.done->start_s), cell(a.questionnaire->name),
                                      cell(a.time_point)};
        for (std::size_t f = 0; f < script.factors.size(); ++f) head.push_back(cell(a.level(script, f)));
        auto const row = [&](std::vector<std::string> const& tail) {
            table.rows.push_back(head);
            table.rows.back().insert(table.rows.back().end(), tail.begin(), tail.end());
        };
        for (std::size_t i = 0; i < a.questionnaire->items.size(); ++i) {
            QuestionnaireItem const& item = a.questionnaire->items[i];
            auto const& s = a.scores.items[i];
            bool const is_text = item.type == ItemType::text;
            row({"item", cell(item.id), s ? cell(s->raw) : cell(""), is_text ? cell("") : cell(item.is_reversed),
                 s ? cell(s->scored) : cell(""), is_text ? cell(a.done->texts[i]) : cell("")});
        }
        for (SubscaleScore const& s : a.scores.subscales)
            row({"score", cell(s.subscale), cell(""), cell(""), cell(s.value), cell("")});
    }
    return table;
}

Table session_events_table(RecordedSession const& session)
{
    Table table{{{"onset", "Start, since the beginning of the session", "s"},
                 {"duration", "Duration", "s"},
                 {"trial_type",
                  "Kind of event: start, calibration, instructions, rest, free_walk, questionnaire, "
                  "end, or the kind of a note (note, pause, skip, abort, warning, ...)",
                  "",
                  {},
                  "",
                  hed_of_session_events()},
                 {"step", "Step of the plan, from 1"},
                 {"text", "Details"}}};
    for (TimedEntry const& timed : timed_entries(session)) {
        JournalEntry const& entry = *timed.entry;
        double const t = timed.offset_s;
        if (auto const* e = std::get_if<SessionStarted>(&entry))
            add(table, e->clock_s + t, e->clock_s + t, "start", cell(""),
                fmt::format("part {}, {}, gap {:.1f} s", e->part, e->utc, e->gap_s));
        else if (auto const* c = std::get_if<CalibrationDone>(&entry))
            table.rows.push_back({cell(""), cell(""), "calibration", cell(""), cell(calibration_text(*c))});
        else if (auto const* s = std::get_if<StepDone>(&entry)) {
            bool const is_known = s->step >= 0 && s->step < int(session.plan.steps.size());
            PlanStep const* const step = is_known ? &session.plan.steps[std::size_t(s->step)] : nullptr;
            add(table, s->start_s + t, s->end_s + t, step ? std::string(name_of(step->kind)) : "step",
                cell(s->step + 1), s->reason);
        } else if (auto const* q = std::get_if<QuestionnaireDone>(&entry))
            add(table, q->start_s + t, q->end_s + t, "questionnaire", cell(q->step + 1), "");
        else if (auto const* n = std::get_if<NoteTaken>(&entry))
            add(table, n->time_s + t, n->time_s + t, n->kind, cell(""), n->text);
        else if (auto const* end = std::get_if<SessionEnded>(&entry))
            add(table, end->time_s + t, end->time_s + t, "end", cell(""),
                (end->is_complete ? "complete, " : "not complete, ") + end->utc +
                    (end->reason.empty() ? "" : ", " + end->reason));
    }
    return table;
}

} // namespace study
