#include "viewer/experiment/stimuli/idle_settings.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

namespace viewer {
namespace {

std::set<std::string> varied_keys(study::Script const& s)
{
    std::set<std::string> keys;
    for (study::Factor const& f : s.factors)
        for (study::FactorLevel const& level : f.levels)
            for (auto const& [key, unused] : level.settings) keys.insert(study::plain_key(key));
    for (study::Block const& b : s.blocks) {
        if (!b.compare) continue;
        if (!b.compare->vary.empty()) keys.insert(study::plain_key(b.compare->vary));
        for (study::FurtherSetting const& f : b.compare->also) keys.insert(study::plain_key(f.setting));
    }
    return keys;
}

bool is_idle(SettingKey const& k, Settings const& s)
{
    return !k.option->read_by(s.method) || (k.option->unused && k.option->unused(s.render));
}

} // namespace

std::vector<std::string> find_idle_settings(study::Script const& s, std::vector<PlannedStimulus> const& stimuli)
{
    std::vector<std::string> found;
    std::set<std::string> const keys = varied_keys(s);
    for (SettingKey const& k : setting_keys()) {
        if (k.option == nullptr || !keys.contains(std::string(k.key))) continue;
        std::set<std::string> methods;
        bool is_used = false;
        for (PlannedStimulus const& p : stimuli) {
            if (std::ranges::none_of(p.patch,
                                     [&](auto const& one) { return study::plain_key(one.first) == k.key; }))
                continue;
            is_used |= !is_idle(k, p.settings.settings);
            methods.insert(p.settings.settings.method);
        }
        if (!is_used && !methods.empty())
            found.push_back(
                fmt::format("'{}' is varied, but changes no picture: {} {} not use it; set a method that does",
                            k.key, fmt::join(methods, ", "), methods.size() == 1 ? "does" : "do"));
    }
    return found;
}

} // namespace viewer
