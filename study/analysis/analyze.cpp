#include "study/analysis/analysis.h"

#include "study/analysis/blocks.h"
#include "study/analysis/whole.h"
#include "study/journal/scene_facts.h"
#include "study/plan/doubts.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

bool is_excluded(AnalysisSettings const& settings, std::string const& participant)
{
    return std::find(settings.exclude.begin(), settings.exclude.end(), participant) != settings.exclude.end();
}

BlockResult analyze_block(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                          AnalysisSettings const& settings, std::vector<ObserverSummary>& summaries)
{
    Block const& b = script.blocks[std::size_t(block)];
    BlockResult result;
    result.name = b.name;
    result.task = study::facts(b.task).name;
    result.prompt = b.prompt;
    switch (b.task) {
    case Task::pair:
    case Task::pair_with_reference:
        analyze_pairs(script, observers, block, settings, result, summaries);
        break;
    case Task::rating:
    case Task::magnitude:
    case Task::adjustment:
        analyze_values(script, observers, block, settings, result);
        break;
    case Task::ranking:
        analyze_rankings(script, observers, block, settings, result);
        break;
    case Task::two_interval:
    case Task::same_different:
    case Task::abx:
    case Task::oddity:
    case Task::yes_no:
        analyze_detection(script, observers, block, settings, result);
        break;
    case Task::questionnaire:
    case Task::free_walk:
        break;
    }
    return result;
}

void add_cautions(Script const& script, std::vector<RecordedSession> const& sessions, Analysis& a)
{
    auto& c = a.cautions;
    if (a.simulated > 0)
        c.push_back(fmt::format("{} of {} sessions were answered by model observers, not by people", a.simulated,
                                a.sessions));
    if (a.complete < a.sessions)
        c.push_back(fmt::format("{} of {} sessions are not complete: their existing trials are analysed",
                                a.sessions - a.complete, a.sessions));
    for (std::string& idle : find_idle_procedures(script)) c.push_back(std::move(idle));
    std::vector<SessionStarted const*> parts;
    for (RecordedSession const& session : sessions)
        for (JournalEntry const& entry : session.record.entries)
            if (auto const* const start = std::get_if<SessionStarted>(&entry)) parts.push_back(start);
    for (std::string& changed : changed_scenes(parts)) c.push_back(std::move(changed));
    int const used = int(std::count_if(a.observers.begin(), a.observers.end(),
                                       [](ObserverSummary const& o) { return !o.is_excluded; }));
    if (used == 0) c.push_back("nobody is left to analyse");
    bool const are_people = std::none_of(sessions.begin(), sessions.end(),
                                         [](RecordedSession const& s) { return s.detail == TrialDetail::wins; });
    if (used == 1 && are_people) c.push_back("one observer: intervals, if any, apply to this person only");
    if (used > 1 && used < 8)
        c.push_back(fmt::format("{} observers: intervals over observers are rough with fewer than about 8", used));
    if (used < script.participants.count)
        c.push_back(fmt::format("{} observers of the {} planned: orders may not be balanced over them", used,
                                script.participants.count));
}

} // namespace

Analysis analyze(Script const& script, std::vector<RecordedSession> const& sessions,
                 AnalysisSettings const& settings)
{
    Analysis a;
    a.experiment = script.id;
    a.title = script.title.empty() ? script.id : script.title;
    a.settings = settings;
    a.settings.progress = {}; // the callback may refer to something that no longer exists
    a.planned = script.participants.count;
    std::vector<ObserverTrials> observers; // all of them
    std::vector<RecordedSession const*> used;
    for (RecordedSession const& session : sessions) {
        SessionStarted const& start = start_of(script, session);
        ++a.sessions;
        a.complete += is_complete(session);
        a.simulated += start.is_simulated;
        a.other_plans += session.plan_source == PlanSource::recorded;
        a.assumed_plans += session.plan_source == PlanSource::assumed;
        std::string const& id = start.participant_id;
        auto it = std::find_if(observers.begin(), observers.end(),
                               [&](ObserverTrials const& o) { return o.participant == id; });
        if (it == observers.end()) it = observers.insert(it, {id, {}, session.detail});
        auto rows = trial_rows(script, session);
        it->rows.insert(it->rows.end(), rows.begin(), rows.end());
        summarise(session, start, rows, a);
        if (!is_excluded(settings, id)) used.push_back(&session);
    }
    for (std::string const& id : settings.exclude)
        if (std::none_of(observers.begin(), observers.end(),
                         [&](ObserverTrials const& o) { return o.participant == id; }))
            throw ScriptError(script.file, {}, fmt::format("participant '{}' is to be excluded", id),
                              "there is no such participant in the records", "see participants.tsv");
    a.participants = int(observers.size());
    for (std::size_t o = 0; o < observers.size(); ++o) finish_summary(observers[o], settings, a.observers[o], a);

    std::vector<ObserverTrials> kept;
    std::vector<ObserverSummary> summaries;
    for (std::size_t o = 0; o < observers.size(); ++o)
        if (!a.observers[o].is_excluded) {
            kept.push_back(observers[o]);
            summaries.push_back(a.observers[o]);
        }
    for (std::size_t b = 0; b < script.blocks.size(); ++b)
        if (std::any_of(kept.begin(), kept.end(), [&](ObserverTrials const& o) {
                return std::any_of(o.rows.begin(), o.rows.end(),
                                   [&](TrialRow const& row) { return row.step->block == int(b); });
            }))
            a.blocks.push_back(analyze_block(script, kept, int(b), settings, summaries));
    for (ObserverSummary& o : a.observers)
        for (ObserverSummary const& s : summaries)
            if (s.participant == o.participant) o = s;

    analyze_questionnaires(script, used, settings, a);
    auto const groups = participant_factors(script, used);
    a.factors = factor_use(script, kept, groups);
    for (BlockResult const& result : a.blocks)
        for (std::size_t b = 0; b < script.blocks.size(); ++b)
            if (script.blocks[b].name == result.name)
                for (Measure const& m : measures_of(script, kept, int(b), result))
                    test_effects(m, groups, settings, a);
    for (Measure const& m : questionnaire_measures(script, used)) test_effects(m, groups, settings, a);
    analyze_timing(script, kept, used, a);
    analyze_transitions(script, used, a);
    add_cautions(script, sessions, a);
    return a;
}

Analysis analyze(Dataset const& records, AnalysisSettings const& settings)
{
    Analysis a = analyze(records.script, records.sessions, settings);
    a.cautions.insert(a.cautions.begin(), records.remarks.begin(), records.remarks.end());
    a.inputs = records.inputs;
    return a;
}

Analysis analyze_one_block(Script const& script, std::span<RecordedSession const> sessions, int block,
                           AnalysisSettings const& settings)
{
    Analysis a;
    a.experiment = script.id;
    a.settings = settings;
    std::vector<ObserverTrials> observers;
    std::vector<RecordedSession const*> used;
    std::vector<ObserverSummary> summaries;
    for (RecordedSession const& session : sessions) {
        observers.push_back({session.plan.participant_id, trial_rows(script, session)});
        summaries.emplace_back().participant = session.plan.participant_id;
        used.push_back(&session);
    }
    a.participants = a.sessions = a.complete = int(sessions.size());
    a.blocks.push_back(analyze_block(script, observers, block, settings, summaries));
    auto const groups = participant_factors(script, used);
    for (Measure const& m : measures_of(script, observers, block, a.blocks[0]))
        test_effects(m, groups, settings, a);
    return a;
}

} // namespace study
