#include "ar/markers/seen_ids.h"

#include "ar/markers/detect.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {

std::string ranges_of(std::set<int> const& numbers)
{
    std::string text;
    for (auto at = numbers.begin(); at != numbers.end();) {
        int const first = *at;
        int last = first;
        while (++at != numbers.end() && *at == last + 1) last = *at;
        text += fmt::format("{}{}", text.empty() ? "" : ", ", first);
        if (last > first) text += fmt::format(" to {}", last);
    }
    return text;
}

IdFinding compare_ids(SeenIds const& seen, MarkerMap const& map)
{
    IdFinding finding;
    std::map<std::string, std::set<int>> has;
    std::map<int, std::pair<std::string, std::set<int>>> of_thing;
    for (PlacedMarker const& m : placed_markers(map)) {
        has[m.dictionary].insert(m.id);
        of_thing[m.thing].first = m.dictionary;
        of_thing[m.thing].second.insert(m.id);
    }
    auto const unknown_of = [&](std::string const& dictionary) {
        std::set<int> unknown;
        auto const at = seen.find(dictionary);
        if (at == seen.end()) return unknown;
        std::set_difference(at->second.begin(), at->second.end(), has[dictionary].begin(), has[dictionary].end(),
                            std::inserter(unknown, unknown.end()));
        return unknown;
    };
    for (auto const& [dictionary, ids] : has) {
        if (unknown_of(dictionary).empty()) continue;
        finding.problem +=
            fmt::format("{}identifiers {} of {} were seen, the map has {}", finding.problem.empty() ? "" : "; ",
                        ranges_of(seen.at(dictionary)), dictionary, ranges_of(ids));
    }
    for (auto const& [thing, own] : of_thing) {
        auto const& [dictionary, ids] = own;
        std::set<int> const unknown = unknown_of(dictionary);
        if (unknown.empty() || ids.size() < 2) continue;
        // The board's markers, if no other things have some of them: its own and those that nothing has.
        std::set<int> here = unknown;
        std::set_intersection(seen.at(dictionary).begin(), seen.at(dictionary).end(), ids.begin(), ids.end(),
                              std::inserter(here, here.end()));
        bool const is_run = *here.rbegin() - *here.begin() + 1 == int(here.size());
        if (is_run && here.size() == ids.size())
            finding.remedy += fmt::format("{}write first_id: {} for {}", finding.remedy.empty() ? "" : "; ",
                                          *here.begin(), describe(map, thing));
    }
    return finding;
}

std::optional<OtherDictionary> other_dictionary(cv::Mat const& gray, MarkerMap const& map)
{
    constexpr std::size_t kFewest = 3; // fewer may be patterns that look like a code
    std::set<std::string> known;
    for (PlacedMarker const& m : placed_markers(map)) known.insert(m.dictionary);
    std::optional<OtherDictionary> best;
    for (std::string const& name : dictionary_names()) {
        if (known.contains(name)) continue;
        OtherDictionary other{name, {}};
        for (FoundMarker const& m : find_markers(gray, name, search_settings({}, gray.size())).markers)
            other.ids.insert(m.id);
        std::size_t const n = best ? best->ids.size() : kFewest - 1;
        bool const is_smaller =
            best && other.ids.size() == n && dictionary_size(name) < dictionary_size(best->name);
        if (other.ids.size() > n || is_smaller) best = std::move(other);
    }
    return best;
}

} // namespace ar
