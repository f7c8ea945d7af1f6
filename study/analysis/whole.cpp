#include "study/analysis/whole.h"

#include "gi/core/quantile.h"
#include "study/plan/transitions.h"
#include "study/stats/summary.h"
#include "study/tables/events.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Numbers of excluded trials, by reason.
void exclude_trials(ObserverTrials const& o, Analysis& a)
{
    std::map<std::pair<std::string, std::string>, int> counts;
    for (TrialRow const& row : o.rows) {
        std::string const reason = row.done->reason.empty() ? "" : ": " + row.done->reason;
        if (row.is_kept_though_invalid)
            ++counts[{"kept", "flagged" + reason + ", kept because the script sets on_bad_trial: keep"}];
        else if (row.status == TrialStatus::invalid || row.status == TrialStatus::superseded)
            ++counts[{"left out", std::string(name_of(row.status)) + reason}];
        else if (row.status == TrialStatus::unanswered)
            ++counts[{"left out", "no answer" + reason}];
    }
    for (auto const& [key, n] : counts) a.exclusions.push_back({o.participant, key.first, key.second, n});
}

std::string level_name(Script const& s, std::size_t factor, int level)
{
    return s.factors[factor].name + "=" + s.factors[factor].levels[std::size_t(level)].name;
}

} // namespace

void summarise(RecordedSession const& session, SessionStarted const& start, std::vector<TrialRow> const& rows,
               Analysis& a)
{
    auto it = std::find_if(a.observers.begin(), a.observers.end(),
                           [&](ObserverSummary const& o) { return o.participant == start.participant_id; });
    if (it == a.observers.end()) {
        it = a.observers.insert(it, ObserverSummary{});
        it->participant = start.participant_id;
    }
    ++it->sessions;
    it->is_complete = it->is_complete && is_complete(session);
    it->is_simulated = it->is_simulated || start.is_simulated;
    for (TrialRow const& row : rows) {
        it->counted += row.status == TrialStatus::counted;
        it->practice += row.status == TrialStatus::practice;
        it->invalid += row.status == TrialStatus::invalid;
        it->superseded += row.status == TrialStatus::superseded;
        it->unanswered += row.status == TrialStatus::unanswered;
        if (row.status == TrialStatus::catch_trial) {
            ++it->catches;
            bool const is_right = row.done->is_correct.value_or(row.done->response == row.step->trial.answer);
            it->catches_right += is_right;
        }
        if (row.status != TrialStatus::counted || session.detail == TrialDetail::wins) continue;
        if (row.done->response == "first") ++it->choices, ++it->chose_first;
        if (row.done->response == "second") ++it->choices;
    }
}

void finish_summary(ObserverTrials const& observer, AnalysisSettings const& settings, ObserverSummary& s,
                    Analysis& a)
{
    s.is_excluded =
        std::find(settings.exclude.begin(), settings.exclude.end(), s.participant) != settings.exclude.end();
    std::vector<double> reactions;
    for (TrialRow const& row : observer.rows)
        if (row.status == TrialStatus::counted && row.done->reaction_ms)
            reactions.push_back(*row.done->reaction_ms);
    s.reaction_median_ms = gi::quantile(reactions, 0.5);
    if (s.choices > 0) s.bias_p = binomial_test(s.chose_first, s.choices);
    if (s.is_excluded) {
        a.exclusions.push_back({s.participant, "left out", "excluded on request", int(observer.rows.size())});
        return;
    }
    exclude_trials(observer, a);
    if (!s.is_complete)
        a.exclusions.push_back({s.participant, "kept", "the session is not complete", int(observer.rows.size())});
    // Guessing gives half of the catch trials; nobody is excluded for this without a request.
    if (s.catches > 0 && wilson(s.catches_right, s.catches).high < 0.9)
        a.exclusions.push_back({s.participant, "look at",
                                fmt::format("{} of {} catch trials right", s.catches_right, s.catches),
                                s.counted});
}

void analyze_questionnaires(Script const& script, std::vector<RecordedSession const*> const& sessions,
                            AnalysisSettings const& settings, Analysis& a)
{
    using Key = std::tuple<std::size_t, std::size_t, std::string>; // questionnaire, score, when
    std::map<Key, std::vector<double>> values;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<std::map<int, double>>> by_time;
    for (RecordedSession const* session : sessions)
        for (AnsweredQuestionnaire const& q : answered_questionnaires(script, *session)) {
            auto const which = std::size_t(q.questionnaire - script.questionnaires.data());
            for (std::size_t k = 0; k < q.scores.subscales.size(); ++k) {
                auto const& value = q.scores.subscales[k].value;
                auto& people = by_time[{which, k}];
                if (q.time_point == 1 || people.empty()) people.emplace_back();
                if (!value) continue;
                values[{which, k, fmt::format("time {}", q.time_point)}].push_back(*value);
                for (std::size_t f = 0; f < script.factors.size(); ++f)
                    if (q.step->kind != PlanStepKind::trial && q.step->levels[f] >= 0)
                        values[{which, k, level_name(script, f, q.step->levels[f])}].push_back(*value);
                people.back()[q.time_point] = *value;
            }
        }
    for (auto const& [key, list] : values) {
        auto const& [which, k, when] = key;
        Questionnaire const& q = script.questionnaires[which];
        a.questionnaires.push_back(
            {q.name, q.subscales[k].name, when, mean_of(list, settings.confidence), standard_deviation(list)});
        if (a.questionnaires.back().mean.is_constant)
            a.effect_notes.push_back({q.name, q.subscales[k].name,
                                      fmt::format("no variation between participants, {}: no interval", when)});
    }
    for (auto const& [key, people] : by_time) {
        int last = 1;
        for (auto const& times : people) last = std::max(last, times.empty() ? 1 : times.rbegin()->first);
        for (int t = 2; t <= last; ++t) {
            std::vector<double> changes;
            double size = 0;
            for (auto const& times : people)
                if (times.count(1) && times.count(t)) {
                    changes.push_back(times.at(t) - times.at(1));
                    size = std::max({size, std::abs(times.at(t)), std::abs(times.at(1))});
                }
            Questionnaire const& q = script.questionnaires[key.first];
            a.changes.push_back({q.name, q.subscales[key.second].name, 1, t,
                                 mean_of(changes, settings.confidence, size), mean_p(changes, size)});
            if (a.changes.back().change.is_constant)
                a.effect_notes.push_back(
                    {q.name, q.subscales[key.second].name,
                     fmt::format("no variation between participants in the change from time 1 "
                                 "to {}: no interval and no test",
                                 t)});
        }
    }
}

void analyze_timing(Script const& script, std::vector<ObserverTrials> const& observers,
                    std::vector<RecordedSession const*> const& sessions, Analysis& a)
{
    TimingResult& t = a.timing;
    for (RecordedSession const* session : sessions) {
        std::string const& id = start_of(script, *session).participant_id;
        for (TimedEntry const& timed : timed_entries(*session))
            if (auto const* c = std::get_if<CalibrationDone>(timed.entry))
                t.calibrations.push_back({id, timed.part, *c});
    }
    for (ObserverTrials const& o : observers)
        for (TrialRow const& row : o.rows) {
            t.bookkeeping_ms.push_back(row.done->bookkeeping_ms);
            for (StimulusShown const& s : row.done->shown) {
                ++t.onset_methods[s.onset_method];
                t.uncertainty_ms.push_back(s.onset_uncertainty_ms);
                if (s.render_ms_mean > 0) t.frame_ms.push_back(s.render_ms_mean);
                t.frames_planned += s.frames_planned;
                t.frames_shown += s.frames_shown;
                t.frames_dropped += s.frames_dropped;
                ++t.stimuli;
                t.stimuli_with_drops += s.frames_dropped > 0;
            }
        }
    for (std::size_t b = 0; b < script.blocks.size(); ++b) {
        ReactionResult r;
        r.block = script.blocks[b].name;
        for (ObserverTrials const& o : counted(observers, int(b)))
            for (TrialRow const& row : o.rows)
                if (row.done->reaction_ms) r.ms.push_back(*row.done->reaction_ms);
        if (!r.ms.empty()) t.reactions.push_back(std::move(r));
    }
}

void analyze_transitions(Script const& script, std::vector<RecordedSession const*> const& sessions, Analysis& a)
{
    std::map<std::string, std::size_t> at;
    std::vector<int> parts;
    for (RecordedSession const* session : sessions) {
        if (session->detail != TrialDetail::trials) continue;
        for (Transitions const& t : find_transitions(script, session->plan)) {
            std::string const& block = script.blocks[std::size_t(t.block)].name;
            std::string key = block + "\n" + t.subject;
            for (std::string const& name : t.names) key += "\n" + name;
            auto const [it, is_new] = at.emplace(key, a.transitions.size());
            if (is_new) {
                a.transitions.push_back({block, t.subject, t.names, std::vector<int>(t.counts.size(), 0)});
                parts.push_back(0);
            }
            TransitionResult& sum = a.transitions[it->second];
            for (std::size_t i = 0; i < t.counts.size(); ++i) sum.counts[i] += t.counts[i];
            sum.switched += t.switched;
            sum.by_chance += t.by_chance;
            ++parts[it->second];
        }
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
        a.transitions[i].switched /= parts[i];
        a.transitions[i].by_chance /= parts[i];
    }
}

} // namespace study
