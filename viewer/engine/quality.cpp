#include "viewer/engine/quality.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"

#include <algorithm>

namespace viewer {
namespace {

struct Step {
    std::string name;
    std::vector<Change> changes;
};

/// Pictures that are shown before they are exact: light at the size and with the paths that the rate allows.
Step approximate(char const* name, double rate_hz, char const* radiance_cache)
{
    return {name,
            {{"rate", rate_hz},
             {"radiance_cache", radiance_cache},
             {"reuse", Settings{}.reuse},
             {"denoise", "atrous"},
             {"share_eyes", true},
             {"first_surfaces", true},
             {"draw_surfaces", true},
             {"reproject", true},
             {"scale", 0.0},
             {"paths", 0},
             {"refine", true}}};
}

std::vector<Step> const& steps()
{
    static std::vector<Step> const all{approximate("fast", 40, "on"),
                                       approximate("smooth", 30, "auto"),
                                       approximate("balanced", 20, "auto"),
                                       approximate("fine", 8, "auto"),
                                       {"exact",
                                        {{"rate", 4.0},
                                         {"radiance_cache", "off"},
                                         {"reuse", 1},
                                         {"denoise", "none"},
                                         {"share_eyes", false},
                                         {"first_surfaces", false},
                                         {"draw_surfaces", false},
                                         {"reproject", false},
                                         {"scale", 1.0},
                                         {"paths", 0},
                                         {"refine", true}}}};
    return all;
}

} // namespace

std::span<std::string const> quality_names()
{
    static std::vector<std::string> const names = [] {
        std::vector<std::string> all;
        for (Step const& s : steps()) all.push_back(s.name);
        return all;
    }();
    return names;
}

std::vector<Change> changes_of(Change const& change)
{
    if (change.key != kQuality) return {change};
    for (Step const& s : steps())
        if (change.value == s.name) return s.changes;
    std::string const given = change.value.is_string() ? change.value.get<std::string>() : change.value.dump();
    throw gi::InputError("'quality' = " + given, "there is no such step",
                         gi::suggest(given, {quality_names().begin(), quality_names().end()}));
}

std::optional<std::size_t> quality_of(Settings const& settings)
{
    auto const as_set = [&](Change const& c) { return get(settings, c.key) == c.value; };
    auto const found =
        std::ranges::find_if(steps(), [&](Step const& s) { return std::ranges::all_of(s.changes, as_set); });
    if (found == steps().end()) return {};
    return std::size_t(found - steps().begin());
}

std::vector<Change> parse_changes(std::span<std::string const> texts)
{
    std::vector<Change> all;
    for (std::string const& text : texts)
        for (Change const& c : changes_of(parse_change(text))) all.push_back(c);
    return all;
}

} // namespace viewer
