#include "study/analysis/measure.h"

#include "study/analysis/blocks.h"
#include "study/stats/dprime.h"
#include "study/stats/pair_scale.h"
#include "study/tables/events.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace study {
namespace {

std::vector<std::string> level_names(Factor const& f)
{
    std::vector<std::string> names;
    for (FactorLevel const& l : f.levels) names.push_back(l.name);
    return names;
}

/// The factors, not between participants, whose shared level varies between trials.
std::vector<int> varying_factors(Script const& script, std::vector<ObserverTrials> const& trials)
{
    std::vector<int> out;
    for (std::size_t f = 0; f < script.factors.size(); ++f) {
        bool const is_between = std::any_of(
            script.counterbalances.begin(), script.counterbalances.end(),
            [&](Counterbalance const& c) { return c.factor == int(f) && c.method == Balance::between; });
        std::set<int> levels;
        for (ObserverTrials const& o : trials)
            for (TrialRow const& row : o.rows) levels.insert(shared_level(*row.block, row.step->trial, int(f)));
        levels.erase(-1);
        if (!is_between && levels.size() > 1) out.push_back(int(f));
    }
    return out;
}

class Conditions {
public:
    Conditions(Script const& script, std::vector<ObserverTrials> const& trials)
        : script_(script), factors_(varying_factors(script, trials))
    {
    }
    std::vector<MeasureAxis> axes() const
    {
        std::vector<MeasureAxis> out;
        for (int const f : factors_)
            out.push_back({script_.factors[std::size_t(f)].name, level_names(script_.factors[std::size_t(f)])});
        return out;
    }
    std::vector<int> of(TrialRow const& row) const
    {
        std::vector<int> out;
        for (int const f : factors_) out.push_back(shared_level(*row.block, row.step->trial, f));
        return out;
    }

private:
    Script const& script_;
    std::vector<int> factors_;
};

/// Index of a name on an axis; adds it if it is new.
int place_on(MeasureAxis& axis, std::string const& name)
{
    auto const it = std::find(axis.levels.begin(), axis.levels.end(), name);
    if (it != axis.levels.end()) return int(it - axis.levels.begin());
    axis.levels.push_back(name);
    return int(axis.levels.size()) - 1;
}

Measure judgements(Block const& b, std::vector<ObserverTrials> const& trials, Conditions const& conditions)
{
    bool const is_log = b.task == Task::magnitude || (b.compare && b.compare->scale != Scale::linear);
    Measure m{b.name,
              b.task == Task::rating ? "rating"
              : is_log               ? "natural logarithm"
                                     : "level",
              conditions.axes(),
              {}};
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows)
            if (row.done->value && (!is_log || *row.done->value > 0))
                m.observations.push_back(
                    {o.participant, conditions.of(row), is_log ? std::log(*row.done->value) : *row.done->value});
    return m;
}

/// Items by the levels of a factor; each observer's values in each condition have the mean 0.
Measure relative_items(Script const& script, Block const& b, int factor, std::string const& name,
                       Conditions const& conditions)
{
    Measure m{b.name, name, conditions.axes(), {}};
    m.relative_to = int(m.axes.size());
    m.axes.push_back({script.factors[std::size_t(factor)].name, level_names(script.factors[std::size_t(factor)])});
    return m;
}

Measure jods(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
             Conditions const& conditions)
{
    Measure m = relative_items(script, b, b.pairs->factor, "JOD of each observer", conditions);
    std::vector<int> levels;
    for (auto const& [i, j] : b.pairs->pairs) levels.insert(levels.end(), {i, j});
    std::sort(levels.begin(), levels.end());
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    PairSettings settings;
    settings.regularisation = Regularisation::always; // the few choices of one person are often unanimous
    for (ObserverTrials const& o : trials) {
        std::map<std::vector<int>, std::vector<PairCount>> cells;
        for (TrialRow const& row : o.rows) {
            std::string order = row.step->trial.order;
            std::erase(order, 'r');
            if (order.size() != 2) continue;
            auto const item = [&](char letter) {
                Stimulus const* const s = stimulus_of(row.step->trial, letter);
                int const level = s ? s->levels[std::size_t(b.pairs->factor)] : -1;
                auto const it = std::find(levels.begin(), levels.end(), level);
                return it == levels.end() ? -1 : int(it - levels.begin());
            };
            PairCount p{item(order[0]), item(order[1])};
            std::string const& answer = row.done->response;
            if (p.first < 0 || p.second < 0) continue;
            (answer == "first" ? p.first_wins : answer == "second" ? p.second_wins : p.ties) = 1;
            cells[conditions.of(row)].push_back(p);
        }
        for (auto const& [cell, pairs] : cells) try {
                PairScale const fit = fit_pairs(without_order(pairs), int(levels.size()), settings);
                for (std::size_t i = 0; i < levels.size(); ++i) {
                    std::vector<int> at = cell;
                    at.push_back(levels[i]);
                    m.observations.push_back({o.participant, at, fit.score[i] * jod_per_unit(fit.model)});
                }
            } catch (
                std::invalid_argument const&) { // not connected: the observer lacks this cell, which is counted
            }
    }
    return m;
}

Measure ranks(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
              Conditions const& conditions)
{
    Measure m = relative_items(script, b, b.rank, "rank (larger = better)", conditions);
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows) {
            double place = double(row.done->response.size());
            for (char const letter : row.done->response) {
                Stimulus const* const s = stimulus_of(row.step->trial, letter);
                if (s == nullptr) break;
                std::vector<int> at = conditions.of(row);
                at.push_back(s->levels[std::size_t(b.rank)]);
                m.observations.push_back({o.participant, at, place--});
            }
        }
    return m;
}

struct AnswerCounts {
    double correct = 0, trials = 0, hits = 0, signals = 0, false_alarms = 0, noises = 0;
};

/// d' of tasks in which it may be negative, with the log-linear correction.
double signed_dprime(Task task, AnswerCounts const& t)
{
    if (task == Task::two_interval) return two_interval_dprime((t.correct + 0.5) / (t.trials + 1));
    return t.signals > 0 && t.noises > 0
               ? yes_no(t.hits, t.signals, t.false_alarms, t.noises, Correction::log_linear).dprime
               : kUnknown;
}

std::vector<Measure> detections(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
                                Conditions const& conditions, bool has_dprime)
{
    Measure correct{b.name, "proportion correct", conditions.axes(), {}};
    int const compared = compared_factor(b);
    MeasureAxis shown{compared >= 0 ? script.factors[std::size_t(compared)].name : "level", {}};
    std::map<std::pair<std::string, std::vector<int>>, AnswerCounts> tallies;
    std::set<double> levels;
    auto const level_name = level_names(trials);
    auto const is_used = [&](TrialRow const& row) {
        int const procedure = row.step->trial.procedure;
        return row.done->is_correct && (procedure < 0 || !is_adaptive(b.procedures[std::size_t(procedure)]));
    };
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows)
            if (is_used(row) && row.done->level && !row.step->trial.is_noise) levels.insert(*row.done->level);
    for (double const level : levels)
        if (compared < 0) shown.levels.push_back(level_name.at(level));
    // Answers without a signal, by condition: they belong to all levels of the signal.
    std::map<std::pair<std::string, std::vector<int>>, AnswerCounts> without_signal;
    auto const add = [](AnswerCounts& t, TrialRow const& row) {
        bool const is_right = *row.done->is_correct, is_signal = row.step->trial.answer == "yes";
        t.correct += is_right;
        t.trials += 1;
        (is_signal ? t.signals : t.noises) += 1;
        if (is_signal)
            t.hits += is_right;
        else
            t.false_alarms += !is_right;
    };
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows) {
            if (!is_used(row)) continue;
            std::vector<int> at = conditions.of(row);
            if (compared >= 0) {
                at.push_back(place_on(shown, compared_label(script, b, row.step->trial)));
            } else if (!levels.empty() && row.step->trial.is_noise) {
                add(without_signal[{o.participant, at}], row);
                continue;
            } else
                at.push_back(place_on(shown, levels.empty()    ? "all"
                                             : row.done->level ? level_name.at(*row.done->level)
                                                               : "none"));
            add(tallies[{o.participant, at}], row);
        }
    correct.axes.push_back(shown);
    Measure dprime = correct;
    dprime.name = "d'";
    for (auto const& [key, t] : tallies) {
        correct.observations.push_back({key.first, key.second, t.correct / t.trials});
        AnswerCounts both = t;
        std::vector<int> const condition(key.second.begin(), key.second.end() - 1);
        if (auto const noise = without_signal.find({key.first, condition}); noise != without_signal.end()) {
            both.noises += noise->second.noises;
            both.false_alarms += noise->second.false_alarms;
        }
        double const d =
            b.task == Task::two_interval || b.task == Task::yes_no ? signed_dprime(b.task, both) : kUnknown;
        if (std::isfinite(d)) dprime.observations.push_back({key.first, key.second, d});
    }
    std::vector<Measure> out{correct};
    if (has_dprime) out.push_back(dprime);
    return out;
}

/// One measure for each procedure, method of estimation and proportion correct;
/// runs of one observer count as repetitions.
std::vector<Measure> thresholds(Script const& script, Block const& b, std::vector<ObserverTrials> const& trials,
                                int block, Conditions const& conditions, BlockResult const& result)
{
    std::map<std::string, std::vector<int>> cells;
    auto const groups = groups_of(script, trials, block, {compared_factor(b)});
    for (ObserverTrials const& o : trials)
        for (TrialRow const& row : o.rows) cells[cell_name(script, groups, row)] = conditions.of(row);
    std::map<std::pair<std::string, std::string>, std::set<double>> proportions; // by procedure and method
    for (ThresholdRun const& run : result.runs)
        for (ThresholdEstimate const& e : run.estimates)
            proportions[{run.procedure, e.method}].insert(e.proportion);
    std::map<std::string, Measure> all;
    Compare const& c = *b.compare;
    for (ThresholdRun const& run : result.runs)
        for (ThresholdEstimate const& e : run.estimates) {
            std::string name = fmt::format("threshold, {}: {}", run.procedure, e.method);
            if (proportions[{run.procedure, e.method}].size() > 1)
                name += fmt::format(", {:.1f} % correct", 100 * e.proportion);
            if (c.scale != Scale::linear) name += fmt::format(", {} of the level", name_of(c.scale));
            Measure& m = all.try_emplace(name, Measure{b.name, name, conditions.axes(), {}}).first->second;
            double const level = e.level.value;
            if (!(level >= std::min(c.low, c.high) && level <= std::max(c.low, c.high))) continue;
            m.observations.push_back({run.participant, cells[run.cell], to_scale(c.scale, level)});
        }
    std::vector<Measure> out;
    for (auto& [unused, m] : all) out.push_back(std::move(m));
    return out;
}

} // namespace

std::vector<ParticipantFactor> participant_factors(Script const& script,
                                                   std::vector<RecordedSession const*> const& sessions)
{
    std::vector<ParticipantFactor> out;
    for (Counterbalance const& c : script.counterbalances) {
        if (c.factor < 0 || c.method != Balance::between) continue;
        auto const f = std::size_t(c.factor);
        ParticipantFactor p{script.factors[f].name, level_names(script.factors[f]), {}};
        std::set<int> found;
        for (RecordedSession const* session : sessions)
            for (PlanStep const& step : session->plan.steps) {
                int level = f < step.levels.size() ? step.levels[f] : -1;
                if (level < 0 && step.kind == PlanStepKind::trial && !step.trial.stimuli.empty())
                    level = step.trial.stimuli.front().levels[f];
                if (level < 0) continue;
                p.level[session->plan.participant_id] = level;
                found.insert(level);
                break;
            }
        if (found.size() > 1) out.push_back(std::move(p));
    }
    return out;
}

std::vector<Measure> measures_of(Script const& script, std::vector<ObserverTrials> const& observers, int block,
                                 BlockResult const& result)
{
    Block const& b = script.blocks[std::size_t(block)];
    auto const trials = counted(observers, block);
    Conditions const conditions(script, trials);
    switch (b.task) {
    case Task::pair:
    case Task::pair_with_reference:
        return {jods(script, b, trials, conditions)};
    case Task::rating:
    case Task::magnitude:
    case Task::adjustment:
        return {judgements(b, trials, conditions)};
    case Task::ranking:
        return {ranks(script, b, trials, conditions)};
    case Task::two_interval:
    case Task::same_different:
    case Task::abx:
    case Task::oddity:
    case Task::yes_no: {
        bool const has_dprime = result.detections.empty() || // adaptive procedures only
                                std::any_of(result.detections.begin(), result.detections.end(),
                                            [](DetectionResult const& d) { return !d.model.empty(); });
        auto all = detections(script, b, trials, conditions, has_dprime);
        if (b.compare && !b.compare->vary.empty())
            for (Measure& m : thresholds(script, b, trials, block, conditions, result))
                all.push_back(std::move(m));
        return all;
    }
    case Task::questionnaire:
    case Task::free_walk:
        break;
    }
    return {};
}

std::vector<Measure> questionnaire_measures(Script const& script,
                                            std::vector<RecordedSession const*> const& sessions)
{
    std::map<std::pair<std::string, std::string>, Measure> all;
    for (RecordedSession const* session : sessions)
        for (AnsweredQuestionnaire const& q : answered_questionnaires(script, *session))
            for (std::size_t k = 0; k < q.scores.subscales.size(); ++k) {
                std::string const& score = q.questionnaire->subscales[k].name;
                Measure& m = all.try_emplace({q.questionnaire->name, score},
                                             Measure{q.questionnaire->name, score, {{"time", {}}}, {}})
                                 .first->second;
                int const time = place_on(m.axes[0], fmt::format("{}", q.time_point));
                if (q.scores.subscales[k].value)
                    m.observations.push_back({session->plan.participant_id, {time}, *q.scores.subscales[k].value});
            }
    std::vector<Measure> out;
    for (auto& [unused, m] : all) out.push_back(std::move(m));
    return out;
}

} // namespace study
