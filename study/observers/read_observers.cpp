#include "study/observers/observer.h"
#include "study/script/read.h"

#include <fmt/format.h>

namespace study {
namespace {

constexpr double kAny = 1e12;

struct Number {
    char const* key;
    double* value;
    double low, high;
};

void read_numbers(gi::Yaml const& y, std::vector<Number> const& numbers)
{
    for (Number const& n : numbers)
        if (y.has(n.key)) *n.value = y.at(n.key).number(n.low, n.high);
}

void read_all_numbers(gi::Yaml const& y, std::vector<Number> const& numbers)
{
    std::set<std::string> keys;
    for (Number const& n : numbers) keys.insert(n.key);
    y.only_keys(keys);
    read_numbers(y, numbers);
}

/// Reads {factor: {level: number}}; levels that are not named have 0.
void read_by_level(gi::Yaml const& y, Script const& s, double low, double high,
                   std::vector<std::vector<double>>& out)
{
    for (auto const& [name, levels] : y.entries()) {
        int const factor = read_factor(name, s);
        auto& values = out[std::size_t(factor)];
        values.assign(s.factors[std::size_t(factor)].levels.size(), 0.0);
        for (auto const& [level, value] : levels.entries())
            values[std::size_t(read_level(level, s, factor))] = value.number(low, high);
    }
}

void read_varied(gi::Yaml const& y, Script const& s, ObserverModel& m)
{
    std::vector<std::string> known;
    for (VariedModel const& v : m.varied) known.push_back(v.setting);
    for (auto const& [name, values] : y.entries()) {
        VariedModel& v = m.varied[std::size_t(name.one_of(known, "setting that a block varies"))];
        std::vector<Number> numbers{{"threshold", &v.threshold, v.low, v.high},
                                    {"slope", &v.slope, 1e-6, kAny},
                                    {"between_sd", &v.between_sd, 0, kAny}};
        for (auto& [parameter, value] : v.parameters) numbers.push_back({parameter.c_str(), &value, -kAny, kAny});
        std::set<std::string> keys{"shift"};
        for (Number const& n : numbers) keys.insert(n.key);
        values.only_keys(keys);
        read_numbers(values, numbers);
        if (!values.has("shift")) continue;
        v.shift.resize(s.factors.size());
        read_by_level(values.at("shift"), s, -kAny, kAny, v.shift);
    }
}

void read_interactions(gi::Yaml const& y, Script const& s, ObserverModel& m)
{
    for (gi::Yaml const& entry : y.items()) {
        entry.only_keys({"levels", "jod"});
        QualityInteraction i;
        for (auto const& [name, level] : entry.at("levels").entries()) {
            int const factor = read_factor(name, s);
            i.levels.push_back({factor, read_level(level, s, factor)});
        }
        i.jod = entry.at("jod").number(-100, 100);
        m.interactions.push_back(std::move(i));
    }
}

ObserverModel read(std::string const& text, std::string const& name, Script const& s)
{
    ObserverModel m = usual_observers(s);
    gi::Yaml const y = gi::Yaml::parse(text, name, "observer");
    std::vector<Number> const shares{{"between_sd", &m.between_sd, 0, 100},
                                     {"noise", &m.noise, 0, 100},
                                     {"lapse", &m.lapse, 0, 1},
                                     {"side_bias", &m.side_bias, -100, 100},
                                     {"tie_width", &m.tie_width, 0, 100},
                                     {"false_alarms", &m.false_alarms, 0, 1}};
    std::set<std::string> keys{"quality",  "interactions", "render_ms", "varied", "rating",
                               "reaction", "items",        "bad",       "display"};
    for (Number const& n : shares) keys.insert(n.key);
    y.only_keys(keys);
    read_numbers(y, shares);
    if (y.has("quality")) read_by_level(y.at("quality"), s, -100, 100, m.quality);
    if (y.has("render_ms")) read_by_level(y.at("render_ms"), s, 0, 1e6, m.render_ms);
    if (y.has("varied")) read_varied(y.at("varied"), s, m);
    if (y.has("interactions")) read_interactions(y.at("interactions"), s, m);
    if (y.has("rating"))
        read_all_numbers(y.at("rating"), {{"best", &m.rating_best, 0, 1},
                                          {"span_jod", &m.rating_span, 1e-3, 1e3},
                                          {"between_sd", &m.rating_sd, 0, 1}});
    if (y.has("reaction"))
        read_all_numbers(y.at("reaction"), {{"median_ms", &m.reaction_ms, 1, 1e6}, {"sd", &m.reaction_sd, 0, 3}});
    if (y.has("items"))
        read_all_numbers(
            y.at("items"),
            {{"mean", &m.items_mean, 0, 1}, {"sd", &m.items_sd, 0, 1}, {"missing", &m.items_missing, 0, 1}});
    if (y.has("bad"))
        read_all_numbers(y.at("bad"), {{"dropped_frames", &m.dropped, 0, 1}, {"timeout", &m.timeout, 0, 1}});
    if (y.has("display"))
        read_all_numbers(y.at("display"), {{"hz", &m.hz, 1, 1000}, {"period_sd_ms", &m.period_sd_ms, 0, 1000}});
    return m;
}

} // namespace

ObserverModel read_observers(std::string const& text, std::string const& name, Script const& s)
{
    try {
        return read(text, name, s);
    } catch (ScriptError const&) {
        throw;
    } catch (gi::InputError const& e) {
        throw ScriptError(e);
    }
}

} // namespace study
