#include "gi/core/mistakes.h"

#include <algorithm>
#include <set>
#include <tuple>

namespace gi {

bool Mistakes::suggests(std::string_view word) const
{
    std::string const quoted = "'" + std::string(word) + "'";
    return std::any_of(all_.begin(), all_.end(),
                       [&](InputError const& e) { return e.suggestion().find(quoted) != std::string::npos; });
}

bool Mistakes::suggests_key(Yaml const& map, char const* key) const
{
    std::string const where = " in " + map.path(), quoted = "'" + std::string(key) + "'";
    return std::any_of(all_.begin(), all_.end(), [&](InputError const& e) {
        return e.problem().starts_with("unknown key") && e.problem().ends_with(where) &&
               e.suggestion().find(quoted) != std::string::npos;
    });
}

std::vector<InputError> Mistakes::in_order() const
{
    std::vector<InputError> out;
    std::set<std::string> told;
    for (InputError const& e : all_)
        if (told.insert(e.what()).second) out.push_back(e);
    std::stable_sort(out.begin(), out.end(), [](InputError const& a, InputError const& b) {
        return std::tuple(a.where().file, a.where().line, a.where().column) <
               std::tuple(b.where().file, b.where().line, b.where().column);
    });
    return out;
}

} // namespace gi
