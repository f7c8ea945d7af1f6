#include "study/report/page.h"
#include "study/script/procedure_settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace study {

namespace {

PsychometricChoice function_of(std::string const& name)
{
    auto const names = psychometric_names();
    auto const known = std::find(names.begin(), names.end(), name);
    if (known != names.end()) return {Psychometric(known - names.begin()), {}};
    return {Psychometric::formula, std::make_shared<Formula const>(Formula::psychometric(name))};
}

} // namespace

SimulatedTruth read_truth(std::string const& json, std::string const& name)
{
    SimulatedTruth t;
    try {
        auto const j = nlohmann::json::parse(json);
        for (auto const& [factor, levels] : j.at("quality_jod").items())
            for (auto const& [level, jod] : levels.items()) t.quality_jod[factor][level] = jod.get<double>();
        for (auto const& [setting, v] : j.at("varied").items()) {
            if (v.contains("parameters")) continue; // no threshold of one setting
            SimulatedTruth::Varied varied{v.at("threshold").get<double>(), v.at("slope").get<double>()};
            varied.function = function_of(v.at("function").get<std::string>());
            bool const is_linear = varied.function.function == Psychometric::normal; // before scales were recorded
            varied.scale = scale_of(v.value("scale", is_linear ? "linear" : "log10")).value_or(Scale::log10);
            t.varied[setting] = varied;
        }
        t.lapse = j.at("lapse").get<double>();
    } catch (FormulaError const& e) {
        throw ScriptError(name, {}, "it has no true parameters of simulated observers", e.what(), "move it away");
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
    SimulatedTruth::Varied const& v = it->second;
    return level_of_proportion(v.function, v.scale, harder_up, {v.threshold, v.slope, guess, truth.lapse},
                               proportion);
}

} // namespace study
