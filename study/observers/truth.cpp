#include "study/observers/observer.h"
#include "study/plan/plan.h"

#include <nlohmann/json.hpp>

namespace study {
namespace {

using Json = nlohmann::ordered_json;

Json by_level(Script const& s, std::vector<std::vector<double>> const& values)
{
    Json out = Json::object();
    for (std::size_t f = 0; f < values.size(); ++f)
        for (std::size_t i = 0; i < values[f].size(); ++i)
            out[s.factors[f].name][s.factors[f].levels[i].name] = values[f][i];
    return out;
}

Json of_varied(Script const& s, std::vector<VariedModel> const& varied)
{
    Json out = Json::object();
    for (VariedModel const& v : varied) {
        out[v.setting] = {{"threshold", v.threshold},
                          {"slope", v.slope},
                          {"function", v.function.name()},
                          {"scale", name_of(v.scale)},
                          {"between_sd", v.between_sd}};
        for (auto const& [name, value] : v.parameters) out[v.setting]["parameters"][name] = value;
        if (!v.shift.empty()) out[v.setting]["shift"] = by_level(s, v.shift);
    }
    return out;
}

Json of_interactions(Script const& s, std::vector<QualityInteraction> const& interactions)
{
    Json out = Json::array();
    for (QualityInteraction const& i : interactions) {
        Json levels = Json::object();
        for (LevelChoice const& c : i.levels) {
            Factor const& f = s.factors[std::size_t(c.factor)];
            levels[f.name] = f.levels[std::size_t(c.level)].name;
        }
        out.push_back({{"levels", levels}, {"jod", i.jod}});
    }
    return out;
}

} // namespace

std::string truth_text(Script const& s, ObserverModel const& m, std::uint64_t seed)
{
    Json participants = Json::array();
    for (int p = 1; p <= s.participants.count; ++p) {
        Observer const o = draw_observer(m, seed, p);
        participants.push_back({{"participant", p},
                                {"quality_jod", by_level(s, o.model.quality)},
                                {"varied", of_varied(s, o.model.varied)},
                                {"rating_shift", o.rating_shift}});
    }
    Json j{{"experiment", s.id},
           {"seed", seed},
           {"quality_jod", by_level(s, m.quality)},
           {"render_ms", by_level(s, m.render_ms)},
           {"varied", of_varied(s, m.varied)},
           {"between_sd", m.between_sd},
           {"noise", m.noise},
           {"lapse", m.lapse},
           {"side_bias", m.side_bias},
           {"tie_width", m.tie_width},
           {"false_alarms", m.false_alarms},
           {"rating", {{"best", m.rating_best}, {"span_jod", m.rating_span}, {"between_sd", m.rating_sd}}},
           {"reaction", {{"median_ms", m.reaction_ms}, {"sd", m.reaction_sd}}},
           {"items", {{"mean", m.items_mean}, {"sd", m.items_sd}, {"missing", m.items_missing}}},
           {"bad", {{"dropped_frames", m.dropped}, {"timeout", m.timeout}}},
           {"display", {{"hz", m.hz}, {"period_sd_ms", m.period_sd_ms}}},
           {"participants", participants}};
    if (!m.interactions.empty()) j["interactions"] = of_interactions(s, m.interactions);
    return j.dump(2) + "\n";
}

} // namespace study
