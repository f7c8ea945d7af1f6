#include "study/observers/observer.h"

#include "study/script/condition.h"

#include <algorithm>
#include <set>
#include <stdexcept>

namespace study {
namespace {

constexpr std::uint64_t kSimulation = 0x51b7e44a90c3d21fULL; ///< separate random streams from those of plans
constexpr double kStep_jod = 0.5;

std::set<int> judged_factors(Script const& s)
{
    std::set<int> judged, crossed;
    for (Block const& b : s.blocks) {
        if (b.pairs) judged.insert(b.pairs->factor);
        if (b.compare && b.compare->factor >= 0) judged.insert(b.compare->factor);
        if (b.rank >= 0) judged.insert(b.rank);
        if (b.task == Task::rating || b.task == Task::magnitude) crossed.insert(b.cross.begin(), b.cross.end());
    }
    return judged.empty() ? crossed : judged;
}

VariedModel usual_varied(Block const& b)
{
    Compare const& c = *b.compare;
    double const low = to_scale(c.scale, c.low), high = to_scale(c.scale, c.high);
    VariedModel v{c.vary, c.scale, c.low, c.high, from_scale(c.scale, (low + high) / 2), 2, (high - low) / 16};
    v.function = fitted_function(b.procedures, c.scale);
    for (Procedure const& p : b.procedures)
        if (p.is_many()) {
            v.function = *p.psychometric;
            v.threshold = p.threshold[p.threshold.size() / 2];
            v.slope = p.slope[p.slope.size() / 2];
            for (QuestGrid const& g : p.parameters)
                v.parameters.emplace_back(g.name, g.values[g.values.size() / 2]);
            return v;
        }
    if (v.function.function == Psychometric::logistic)
        v.slope = 14 / (high - low); // about as steep as the normal one
    else if (!v.function.takes_levels())
        v.slope = (high - low) / 8;
    return v;
}

double sum_of(std::vector<std::vector<double>> const& values, std::vector<int> const& levels)
{
    double sum = 0;
    for (std::size_t f = 0; f < values.size() && f < levels.size(); ++f)
        if (!values[f].empty() && levels[f] >= 0) sum += values[f][std::size_t(levels[f])];
    return sum;
}

} // namespace

ObserverModel usual_observers(Script const& s)
{
    ObserverModel m;
    m.quality.resize(s.factors.size());
    m.render_ms.resize(s.factors.size());
    for (int const f : judged_factors(s)) {
        int best = 0;
        for (LevelChoice const& c : s.reference)
            if (c.factor == f) best = c.level;
        double next = 0;
        auto& quality = m.quality[std::size_t(f)];
        quality.assign(s.factors[std::size_t(f)].levels.size(), 0.0);
        for (std::size_t i = 0; i < quality.size(); ++i)
            if (int(i) != best) quality[i] = next -= kStep_jod;
    }
    for (Block const& b : s.blocks) {
        if (!b.compare || b.compare->vary.empty()) continue;
        bool const is_known = std::any_of(m.varied.begin(), m.varied.end(),
                                          [&](VariedModel const& v) { return v.setting == b.compare->vary; });
        if (!is_known) m.varied.push_back(usual_varied(b));
    }
    return m;
}

Observer draw_observer(ObserverModel const& model, std::uint64_t seed, int participant)
{
    Random random = Random::part(seed ^ kSimulation, std::uint64_t(participant));
    std::uint64_t const high = random.next();
    Observer o{model, 0, (high << 32) | random.next()};
    for (auto& levels : o.model.quality)
        for (double& q : levels) q += model.between_sd * random.normal();
    for (VariedModel& v : o.model.varied) {
        double const u = to_scale(v.scale, v.threshold) + v.between_sd * random.normal();
        v.threshold = from_scale(v.scale, std::clamp(u, to_scale(v.scale, v.low), to_scale(v.scale, v.high)));
    }
    o.rating_shift = model.rating_sd * random.normal();
    return o;
}

Random Observer::random(std::uint64_t purpose) const { return Random::part(seed, purpose); }

double Observer::quality(std::vector<int> const& levels) const
{
    double q = sum_of(model.quality, levels);
    for (QualityInteraction const& i : model.interactions)
        if (std::all_of(i.levels.begin(), i.levels.end(),
                        [&](LevelChoice const& c) { return levels[std::size_t(c.factor)] == c.level; }))
            q += i.jod;
    return q;
}
double Observer::threshold(VariedModel const& v, std::vector<int> const& levels) const
{
    double const shift = sum_of(v.shift, levels);
    return shift == 0 ? v.threshold : from_scale(v.scale, to_scale(v.scale, v.threshold) + shift);
}
double Observer::render_ms(std::vector<int> const& levels) const { return sum_of(model.render_ms, levels); }

VariedModel const& Observer::varied(std::string const& setting) const
{
    for (VariedModel const& v : model.varied)
        if (v.setting == setting) return v;
    throw std::logic_error("no model of '" + setting + "'");
}

} // namespace study
