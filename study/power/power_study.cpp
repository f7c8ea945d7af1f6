#include "study/power/power_study.h"

#include "study/power/simulated_record.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace study {
namespace {

struct Found {
    double p = kUnknown, estimate = kUnknown;
    Interval interval{kUnknown, kUnknown};
    std::string unit;
};

std::vector<std::string> tests_in(Analysis const& a)
{
    std::vector<std::string> names;
    for (EffectResult const& e : a.effects) names.push_back(e.measure + ": " + e.effect);
    for (BlockResult const& b : a.blocks)
        if (!b.scales.empty())
            for (ItemDifference const& d : b.scales[0].differences)
                names.push_back(b.scales[0].items[std::size_t(d.a)].name + " - " +
                                b.scales[0].items[std::size_t(d.b)].name);
    return names;
}

/// The name without blanks, with colons for crosses, in alphabetic order: "light:method", "exact-good".
std::string compact(std::string name)
{
    for (std::size_t at; (at = name.find(" x ")) != std::string::npos;) name.replace(at, 3, ":");
    std::erase(name, ' ');
    std::vector<std::string> parts;
    for (std::size_t at = 0; at <= name.size();) {
        std::size_t const end = std::min(name.find(':', at), name.size());
        parts.push_back(name.substr(at, end - at));
        at = end + 1;
    }
    std::sort(parts.begin(), parts.end());
    return fmt::format("{}", fmt::join(parts, ":"));
}

std::optional<Found> find_test(Analysis const& a, std::string const& wanted)
{
    std::string const name = compact(wanted);
    for (EffectResult const& e : a.effects)
        if (name == compact(e.effect) || name == compact(e.measure + ":" + e.effect))
            return Found{e.test.p_gg, e.test.partial_eta2, e.test.eta2, "partial eta squared"};
    for (BlockResult const& b : a.blocks)
        if (!b.scales.empty())
            for (ItemDifference const& d : b.scales[0].differences) {
                std::string const& first = b.scales[0].items[std::size_t(d.a)].name;
                std::string const& second = b.scales[0].items[std::size_t(d.b)].name;
                double const v = d.value.value;
                Interval const i = d.value.interval;
                if (name == compact(first + "-" + second)) return Found{d.p, v, i, b.scales[0].unit};
                if (name == compact(second + "-" + first))
                    return Found{d.p, -v, {-i.high, -i.low}, b.scales[0].unit};
            }
    return {};
}

/// The plans of the participants, reduced to the tested block; fewer if stopped.
std::vector<Plan> plans_of(Script const& s, int block, int participants, std::function<bool(double)> const& go_on)
{
    std::vector<Plan> plans;
    for (int p = 1; p <= participants && go_on(0); ++p) {
        plans.push_back(make_plan(s, p));
        std::erase_if(plans.back().steps, [&](PlanStep const& step) {
            return step.kind != PlanStepKind::trial || step.block != block || step.trial.phase == Phase::practice;
        });
    }
    return plans;
}

class Simulator {
public:
    Simulator(Script const& script, ObserverModel const& model, PowerSettings const& settings,
              std::function<bool(double)> const& go_on)
        : model_(model), settings_(settings), go_on_(go_on)
    {
        most_ = settings.participants.back();
        std::vector<int> repeats = settings.repeats;
        if (repeats.empty()) repeats.push_back(script.blocks[std::size_t(settings.block)].repeats);
        for (int const r : repeats) {
            Script own = script;
            own.blocks[std::size_t(settings.block)].repeats = r;
            own.participants.count = std::max(own.participants.count, most_ * kLarge);
            scripts_.push_back(std::move(own));
        }
        study_.block = script.blocks[std::size_t(settings.block)].name;
        study_.test = settings.test;
        study_.simulations_planned = settings.simulations;
        for (Script const& s : scripts_)
            for (double const e : settings.effects)
                for (int const n : settings.participants) {
                    PowerPoint p;
                    p.repeats = s.blocks[std::size_t(settings.block)].repeats;
                    p.participants = n;
                    p.effect = e;
                    study_.points.push_back(p);
                }
        estimates_.resize(study_.points.size());
        covered_.resize(study_.points.size(), 0);
    }

    PowerStudy run()
    {
        for (Script const& s : scripts_) {
            plans_.push_back(plans_of(s, settings_.block, most_, go_on_));
            study_.is_complete = study_.is_complete && int(plans_.back().size()) == most_;
        }
        if (settings_.has_recovery && study_.is_complete) study_.is_complete = find_truth();
        for (int i = 0; i < settings_.simulations && study_.is_complete; ++i) study_.is_complete = simulate(i);
        for (std::size_t k = 0; k < study_.points.size(); ++k) {
            PowerPoint& p = study_.points[k];
            if (p.simulations > 0) {
                p.power = double(p.found) / p.simulations;
                p.interval = wilson(p.found, p.simulations);
            }
            if (estimates_[k].empty()) continue;
            p.estimate = mean(estimates_[k]);
            p.deviation = standard_deviation(estimates_[k]);
            if (std::isfinite(p.truth)) p.coverage = double(covered_[k]) / double(estimates_[k].size());
        }
        return study_;
    }

private:
    /// Participants of the simulation for the true values: this times the largest number.
    static constexpr int kLarge = 20;

    bool goes_on()
    {
        double const all = double(settings_.simulations) * double(scripts_.size() * settings_.effects.size());
        return go_on_(double(done_) / all);
    }

    Analysis analysed(Script const& s, std::span<RecordedSession const> sessions, int participants) const
    {
        AnalysisSettings a;
        a.replicates = 2;
        a.permutations = 0;
        a.draws = 0;
        a.has_outliers = a.has_deviations = false;
        a.confidence = 1 - settings_.alpha;
        return analyze_one_block(s, sessions.first(std::size_t(participants)), settings_.block, a);
    }

    /// False if stopped.
    bool simulate_all(Script const& s, std::vector<Plan> const& plans, ObserverModel const& model,
                      std::uint64_t seed, std::vector<RecordedSession>& sessions)
    {
        for (std::size_t p = 0; p < plans.size(); ++p) {
            if (!goes_on()) return false;
            sessions.push_back(simulated_record(s, plans[p], draw_observer(model, seed, int(p) + 1)));
        }
        return true;
    }

    bool simulate(int number)
    {
        std::uint64_t const seed = Random::part(settings_.seed, std::uint64_t(number)).next();
        std::vector<std::pair<std::size_t, std::optional<Found>>> results;
        std::size_t at = 0;
        for (std::size_t r = 0; r < scripts_.size(); ++r)
            for (double const effect : settings_.effects) {
                std::vector<RecordedSession> sessions;
                if (!simulate_all(scripts_[r], plans_[r], scaled_model(model_, settings_.scaled, effect), seed,
                                  sessions))
                    return false;
                for (int const n : settings_.participants) {
                    if (!goes_on()) return false;
                    Analysis const a = analysed(scripts_[r], sessions, n);
                    auto found = find_test(a, settings_.test);
                    if (!found && !is_known_) refuse_test(a);
                    results.emplace_back(at++, std::move(found));
                }
                ++done_;
            }
        // Interrupted simulations are discarded, so that all points have the same number of them.
        for (auto const& [point, found] : results) count(point, found);
        is_known_ = true;
        return true;
    }

    void count(std::size_t at, std::optional<Found> const& found)
    {
        PowerPoint& p = study_.points[at];
        ++p.simulations;
        if (!found || std::isnan(found->p)) {
            ++p.refused;
            return;
        }
        study_.unit = found->unit;
        p.found += found->p < settings_.alpha;
        estimates_[at].push_back(found->estimate);
        covered_[at] += found->interval.low <= p.truth && p.truth <= found->interval.high;
    }

    [[noreturn]] void refuse_test(Analysis const& a) const
    {
        std::string known;
        for (std::string const& name : tests_in(a)) known += (known.empty() ? "'" : ", '") + name + "'";
        throw ScriptError(scripts_[0].file, {},
                          fmt::format("test '{}' of block '{}'", settings_.test, study_.block),
                          "the analysis of the block has no such test",
                          known.empty() ? "simulate more participants" : "it has: " + known);
    }

    bool find_truth()
    {
        std::size_t at = 0;
        for (std::size_t r = 0; r < scripts_.size(); ++r) {
            int const n = most_ * kLarge;
            std::vector<Plan> const plans = plans_of(scripts_[r], settings_.block, n, go_on_);
            if (int(plans.size()) < n) return false;
            for (double const effect : settings_.effects) {
                std::vector<RecordedSession> sessions;
                if (!simulate_all(scripts_[r], plans, scaled_model(model_, settings_.scaled, effect),
                                  settings_.seed ^ 0x7275746821ULL, sessions))
                    return false;
                Analysis const a = analysed(scripts_[r], sessions, n);
                auto const found = find_test(a, settings_.test);
                if (!found) refuse_test(a);
                for (std::size_t k = 0; k < settings_.participants.size(); ++k)
                    study_.points[at++].truth = found->estimate;
            }
        }
        return true;
    }

    ObserverModel const& model_;
    PowerSettings const& settings_;
    std::function<bool(double)> const& go_on_;
    int most_ = 0;
    std::vector<Script> scripts_;
    std::vector<std::vector<Plan>> plans_;
    PowerStudy study_;
    std::vector<std::vector<double>> estimates_;
    std::vector<int> covered_;
    bool is_known_ = false;
    int done_ = 0;
};

} // namespace

ObserverModel scaled_model(ObserverModel const& model, std::vector<int> const& factors, double by)
{
    ObserverModel m = model;
    auto const is_scaled = [&](std::size_t f) {
        return factors.empty() || std::find(factors.begin(), factors.end(), int(f)) != factors.end();
    };
    for (std::size_t f = 0; f < m.quality.size(); ++f)
        if (is_scaled(f))
            for (double& q : m.quality[f]) q *= by;
    for (QualityInteraction& i : m.interactions) {
        bool const is_of_these = std::all_of(i.levels.begin(), i.levels.end(), [&](LevelChoice const& c) {
            return is_scaled(std::size_t(c.factor));
        });
        if (is_of_these) i.jod *= by;
    }
    for (VariedModel& v : m.varied)
        for (std::size_t f = 0; f < v.shift.size(); ++f)
            if (is_scaled(f))
                for (double& s : v.shift[f]) s *= by;
    return m;
}

PowerStudy study_power(Script const& script, ObserverModel const& model, PowerSettings const& settings,
                       std::function<bool(double)> const& go_on)
{
    return Simulator(script, model, settings, go_on).run();
}

} // namespace study
