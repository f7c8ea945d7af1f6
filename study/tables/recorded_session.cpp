#include "study/tables/recorded_session.h"

#include "gi/core/text.h"
#include "study/journal/moments.h"
#include "study/run/pair_run.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

ScriptError broken(Script const& script, RecordedSession const& session, std::string const& problem)
{
    return {fmt::format("journal of {}", session.plan.participant_id),
            {},
            problem,
            fmt::format("'{}' gives another plan", script.file),
            "use the script and the plan with which the session was recorded"};
}

TrialStatus standing_of(Script const& script, TrialRow const& row, int attempts)
{
    if (row.step->trial.phase == Phase::practice) return TrialStatus::practice;
    if (row.done->attempt < attempts) return TrialStatus::superseded;
    bool const is_answered = !row.done->response.empty() || row.done->value;
    if (!is_answered) return row.done->is_valid ? TrialStatus::unanswered : TrialStatus::invalid;
    bool const is_mistimed = row.done->reason == kAnticipation || row.done->reason == kTooSlow;
    if (!row.done->is_valid && (is_mistimed || script.timing.on_bad_trial != BadTrial::keep))
        return TrialStatus::invalid;
    return row.step->trial.phase == Phase::catches ? TrialStatus::catch_trial : TrialStatus::counted;
}

} // namespace

void fill_chosen(Script const& script, RecordedSession& session)
{
    for (JournalEntry const& entry : session.record.entries) {
        auto const* const done = std::get_if<TrialDone>(&entry);
        if (done == nullptr || done->chosen.empty()) continue;
        if (done->step < 0 || done->step >= int(session.plan.steps.size())) continue; // reported by trial_rows
        PlanStep& step = session.plan.steps[std::size_t(done->step)];
        if (!step.trial.is_open_pair) continue;
        Block const& block = script.blocks[std::size_t(step.block)];
        auto const pair = pair_of_text(script, block, done->chosen);
        if (!pair) throw broken(script, session, fmt::format("'{}' is no pair", done->chosen));
        step.trial.stimuli[0].levels[std::size_t(block.pairs->factor)] = pair->first;
        step.trial.stimuli[1].levels[std::size_t(block.pairs->factor)] = pair->second;
        step.trial.is_open_pair = false;
    }
}

SessionStarted const& start_of(Script const& script, RecordedSession const& session)
{
    auto const& entries = session.record.entries;
    auto const* start = entries.empty() ? nullptr : std::get_if<SessionStarted>(&entries.front());
    if (start == nullptr) throw broken(script, session, "the journal does not begin with the start of a session");
    if (start->experiment != script.id)
        throw broken(script, session, fmt::format("it is of the experiment '{}'", start->experiment));
    if (start->participant_id != session.plan.participant_id)
        throw broken(script, session, fmt::format("it is of the participant '{}'", start->participant_id));
    return *start;
}

std::string recorded_fact(SessionStarted const& start, std::string_view key)
{
    for (auto const& [name, value] : start.about)
        if (name == key) return value;
    return {};
}

std::optional<std::pair<double, double>> recorded_pair(SessionStarted const& start, std::string_view key)
{
    std::string const text = recorded_fact(start, key);
    auto const x = text.find(" x ");
    if (x == std::string::npos) return {};
    auto const a = gi::parse_finite(text.substr(0, x)), b = gi::parse_finite(text.substr(x + 3));
    return a && b && *a > 0 && *b > 0 ? std::optional(std::pair(*a, *b)) : std::nullopt;
}

bool is_complete(RecordedSession const& session)
{
    auto const& entries = session.record.entries;
    return std::any_of(entries.begin(), entries.end(), [](JournalEntry const& e) {
        auto const* end = std::get_if<SessionEnded>(&e);
        return end != nullptr && end->is_complete;
    });
}

std::vector<TimedEntry> timed_entries(RecordedSession const& session)
{
    std::vector<TimedEntry> out;
    double offset_s = 0, last_s = 0; // last_s: since the session's beginning
    int part = 1;
    for (JournalEntry const& entry : session.record.entries) {
        if (auto const* start = std::get_if<SessionStarted>(&entry)) {
            part = start->part;
            offset_s = (out.empty() ? 0 : last_s + std::max(0.0, start->gap_s)) - start->clock_s;
        }
        if (auto const moment = last_moment(entry)) last_s = std::max(last_s, *moment + offset_s);
        out.push_back({&entry, part, offset_s});
    }
    return out;
}

std::string_view name_of(TrialStatus status)
{
    switch (status) {
    case TrialStatus::counted:
        return "counted";
    case TrialStatus::practice:
        return "practice";
    case TrialStatus::catch_trial:
        return "catch";
    case TrialStatus::superseded:
        return "repeated later";
    case TrialStatus::invalid:
        return "invalid";
    case TrialStatus::unanswered:
        break;
    }
    return "no answer";
}

std::vector<TrialRow> trial_rows(Script const& script, RecordedSession const& session)
{
    SessionStarted const& start = start_of(script, session);
    std::map<int, int> attempts;
    for (JournalEntry const& entry : session.record.entries)
        if (auto const* done = std::get_if<TrialDone>(&entry))
            attempts[done->step] = std::max(attempts[done->step], done->attempt);
    std::vector<TrialRow> rows;
    for (TimedEntry const& timed : timed_entries(session)) {
        auto const* done = std::get_if<TrialDone>(timed.entry);
        if (done == nullptr) continue;
        if (done->step < 0 || done->step >= int(session.plan.steps.size()) ||
            session.plan.steps[std::size_t(done->step)].kind != PlanStepKind::trial)
            throw broken(script, session, fmt::format("step {} is no trial", done->step + 1));
        PlanStep const& step = session.plan.steps[std::size_t(done->step)];
        TrialRow row{&step,         &script.blocks[std::size_t(step.block)],
                     done,          start.session,
                     timed.part,    timed.offset_s,
                     TrialStatus{}, false};
        row.status = standing_of(script, row, attempts[done->step]);
        row.is_kept_though_invalid = row.status == TrialStatus::counted && !done->is_valid;
        rows.push_back(row);
    }
    return rows;
}

Stimulus const* stimulus_of(Trial const& trial, char letter)
{
    if (letter == 'r') return trial.reference ? &*trial.reference : nullptr;
    auto const i = std::size_t(letter - 'a');
    return letter >= 'a' && i < trial.stimuli.size() ? &trial.stimuli[i] : nullptr;
}

std::string compared_label(Script const& script, Block const& block, Trial const& trial)
{
    std::string label = stimulus_label(script, block, trial.stimuli.front());
    if (block.pairs && trial.stimuli.size() > 1) label += " vs " + stimulus_label(script, block, trial.stimuli[1]);
    return label;
}

int shared_level(Block const& block, Trial const& trial, int factor)
{
    if (trial.stimuli.empty() || compared_factor(block) == factor) return -1;
    return trial.stimuli.front().levels[std::size_t(factor)];
}

std::optional<char> chosen_letter(TrialRow const& row)
{
    constexpr std::string_view kPlaces[] = {"first", "second", "third"};
    std::string order = row.step->trial.order;
    std::erase(order, 'r');
    for (std::size_t i = 0; i < std::size(kPlaces); ++i)
        if (row.done->response == kPlaces[i] && i < order.size()) return order[i];
    return std::nullopt;
}

} // namespace study
