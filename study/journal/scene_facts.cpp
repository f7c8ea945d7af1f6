#include "study/journal/scene_facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>

namespace study {

namespace {
constexpr std::string_view kPrefix = "scene ";
}

std::string scene_fact(std::string const& scene) { return std::string(kPrefix) + scene; }

std::vector<std::string> changed_scenes(std::span<SessionStarted const* const> parts)
{
    struct First {
        std::string sha256, where;
    };
    std::map<std::string, First> first;
    std::map<std::string, std::set<std::string>> others; // where, by fact
    for (SessionStarted const* const part : parts) {
        std::string const where = fmt::format("{} session {}", part->participant_id, part->session);
        for (auto const& [key, value] : part->about) {
            if (!key.starts_with(kPrefix)) continue;
            auto const& known = first.try_emplace(key, First{value, where}).first->second;
            if (known.sha256 != value) others[key].insert(where);
        }
    }
    std::vector<std::string> sentences;
    for (auto const& [key, places] : others)
        sentences.push_back(
            fmt::format("the files of scene '{}' have changed: they were others for {} than for {}; what was "
                        "shown is not the same",
                        key.substr(kPrefix.size()), fmt::join(places, ", "), first[key].where));
    return sentences;
}

} // namespace study
