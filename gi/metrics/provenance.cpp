#include "gi/metrics/provenance.h"

#include "gi/core/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>

namespace gi {
namespace {

/// "" = the picture does not say.
std::string fact(Picture const& picture, std::string const& key)
{
    auto const found = picture.metadata.find(key);
    return found == picture.metadata.end() ? "" : found->second;
}

double number(Picture const& picture, std::string const& key)
{
    return parse_finite(fact(picture, key)).value_or(std::nan(""));
}

/// Options of the command that change what is seen, with their values.
std::map<std::string, std::string> view_of(Picture const& picture)
{
    constexpr std::array kOfView{"--camera", "--look-from",    "--look-at",       "--fov",   "--eye",    "--time",
                                 "--envmap", "--envmap-scale", "--envmap-rotate", "--light", "--bounces"};
    std::istringstream words(fact(picture, "command"));
    std::map<std::string, std::string> options;
    std::string word, last;
    while (words >> word) {
        if (word.starts_with("--")) {
            last = std::ranges::find(kOfView, word) == kOfView.end() ? "" : word;
            if (!last.empty()) options[last];
        } else if (!last.empty()) {
            options[last] += (options[last].empty() ? "" : " ") + word;
        }
    }
    return options;
}

std::vector<std::string> differing(std::map<std::string, std::string> const& a,
                                   std::map<std::string, std::string> const& b)
{
    std::vector<std::string> names;
    for (auto const& [name, value] : a)
        if (!b.contains(name) || b.at(name) != value) names.push_back(name);
    for (auto const& [name, value] : b)
        if (!a.contains(name)) names.push_back(name);
    std::ranges::sort(names);
    return names;
}

/// Share of values above 1, where a file of 8 or 16 bits ends.
double share_above_one(Picture const& picture)
{
    Layer const* const color = picture.find("color");
    if (color == nullptr || color->data.empty()) return 0;
    auto const n = std::ranges::count_if(color->data, [](float v) { return v > 1; });
    return double(n) / double(color->data.size());
}

void note_clipped(char const* which, Picture const& clipped, char const* other, Picture const& whole,
                  std::vector<std::string>& notes)
{
    if (!clipped.ends_at_one || whole.ends_at_one) return;
    double const share = share_above_one(whole);
    notes.push_back(fmt::format(
        "the {} is of a file that ends at 1{}; compare two EXR files, or two PNGs of one exposure", which,
        share > 0 ? fmt::format(", {:.3g} % of the {}'s values lie above", 100 * share, other)
                  : ", and its exposure is not known"));
}

} // namespace

std::vector<std::string> provenance_notes(Picture const& image, Picture const& reference, double relmse,
                                          bool is_z_test)
{
    std::vector<std::string> notes;
    note_clipped("image", image, "reference", reference, notes);
    note_clipped("reference", reference, "image", image, notes);
    if (is_z_test && !fact(image, "denoise").empty() && fact(image, "denoise") != "none")
        notes.push_back(fmt::format("the image was filtered ({}), but its variance is that before the filter: its "
                                    "z-test says nothing; compare a picture with --denoise none",
                                    fact(image, "denoise")));
    if (fact(image, "command").empty() || fact(reference, "command").empty()) return notes;
    if (fact(image, "command") == fact(reference, "command")) return notes;
    if (fact(image, "scene") != fact(reference, "scene"))
        notes.push_back(fmt::format("the scenes have other names: '{}' and '{}'", fact(image, "scene"),
                                    fact(reference, "scene")));
    if (auto const names = differing(view_of(image), view_of(reference)); !names.empty())
        notes.push_back(fmt::format("their commands differ in {}", fmt::join(names, ", ")));
    if (fact(image, "seed") == fact(reference, "seed"))
        notes.push_back(
            fmt::format("both have seed {}: they share noise, which then seems smaller; render one with "
                        "another --seed",
                        fact(image, "seed")));
    double const paths = number(image, "paths"), paths_of_reference = number(reference, "paths");
    double const noise = number(reference, "estimated_relmse");
    if (paths_of_reference < paths && fact(reference, "method") != "reference")
        notes.push_back(fmt::format("the reference has {:g} paths, fewer than the image ({:g}): are they swapped?",
                                    paths_of_reference, paths));
    constexpr double kShareOfNoise = 0.1;
    if (noise > 0 && relmse < noise / kShareOfNoise)
        notes.push_back(
            fmt::format("the reference's own noise, an estimated relMSE of {:.2g}, is in the relMSE of {:.2g}; "
                        "give it more paths",
                        noise, relmse));
    return notes;
}

} // namespace gi
