#include "study/report/page.h"
#include "study/stats/special.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace study {

SimulatedTruth read_truth(std::string const& json, std::string const& name)
{
    SimulatedTruth t;
    try {
        auto const j = nlohmann::json::parse(json);
        for (auto const& [factor, levels] : j.at("quality_jod").items())
            for (auto const& [level, jod] : levels.items()) t.quality_jod[factor][level] = jod.get<double>();
        for (auto const& [setting, v] : j.at("varied").items())
            t.varied[setting] = {v.at("threshold").get<double>(), v.at("slope").get<double>(),
                                 v.at("function").get<std::string>() == "weibull"};
        t.lapse = j.at("lapse").get<double>();
    } catch (nlohmann::json::exception const& e) {
        throw ScriptError(name, {}, "it has no true parameters of simulated observers", e.what(), "move it away");
    }
    return t;
}

double true_level(SimulatedTruth const& truth, std::string const& setting, bool harder_up, double guess,
                  double proportion)
{
    auto const it = truth.varied.find(setting);
    if (it == truth.varied.end()) return kUnknown;
    double const f = (proportion - guess) / (1 - guess - truth.lapse);
    if (!(f > 0 && f < 1)) return kUnknown;
    SimulatedTruth::Varied const& v = it->second;
    double const sign = harder_up ? -1 : 1;
    if (v.is_weibull) return v.threshold * std::pow(-std::log1p(-f), sign / v.slope);
    return v.threshold + sign * v.slope * normal_quantile(f);
}

} // namespace study
