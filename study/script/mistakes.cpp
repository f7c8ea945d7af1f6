#include "study/script/mistakes.h"

#include "study/script/keys.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace study {

void Mistakes::check_keys(gi::Yaml const& map, char const* kind)
{
    auto const& known = script_keys().at(kind);
    attempt([&] { map.find_other_keys({known.begin(), known.end()}, all_); });
}

bool Mistakes::suggests(std::string_view word) const
{
    std::string const quoted = "'" + std::string(word) + "'";
    return std::any_of(all_.begin(), all_.end(),
                       [&](gi::InputError const& e) { return e.suggestion().find(quoted) != std::string::npos; });
}

bool Mistakes::suggests_key(gi::Yaml const& map, char const* key) const
{
    std::string const where = " in " + map.path(), quoted = "'" + std::string(key) + "'";
    return std::any_of(all_.begin(), all_.end(), [&](gi::InputError const& e) {
        return e.problem().starts_with("unknown key") && e.problem().ends_with(where) &&
               e.suggestion().find(quoted) != std::string::npos;
    });
}

std::vector<ScriptError> Mistakes::in_order() const
{
    std::vector<ScriptError> out;
    std::set<std::string> told;
    for (gi::InputError const& e : all_)
        if (told.insert(e.what()).second) out.emplace_back(e);
    std::stable_sort(out.begin(), out.end(), [](ScriptError const& a, ScriptError const& b) {
        return std::tuple(a.where().file, a.where().line, a.where().column) <
               std::tuple(b.where().file, b.where().line, b.where().column);
    });
    return out;
}

} // namespace study
