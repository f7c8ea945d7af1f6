#include "study/display/luminance_fit.h"

#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

constexpr double kMost_cd_m2 = 1e5;

std::optional<PatchColour> colour_of(std::string_view word)
{
    for (auto const& [name, colour] : {std::pair{"white", PatchColour::white},
                                       {"grey", PatchColour::white},
                                       {"gray", PatchColour::white},
                                       {"w", PatchColour::white},
                                       {"red", PatchColour::red},
                                       {"r", PatchColour::red},
                                       {"green", PatchColour::green},
                                       {"g", PatchColour::green},
                                       {"blue", PatchColour::blue},
                                       {"b", PatchColour::blue}})
        if (word == name) return colour;
    return {};
}

/// The columns of channel, value and luminance.
std::array<int, 3> columns_of(gi::TextLine const& header)
{
    std::array<int, 3> at{-1, -1, -1};
    auto const names = gi::split_at_commas(header.text);
    for (int i = 0; i < int(names.size()); ++i) {
        std::string_view const n = names[std::size_t(i)];
        int const which = n == "channel" || n == "colour" || n == "color"              ? 0
                          : n == "value" || n == "level"                               ? 1
                          : n == "cd_m2" || n == "luminance" || n == "luminance_cd_m2" ? 2
                                                                                       : -1;
        if (which >= 0) at[std::size_t(which)] = i;
    }
    if (at[1] < 0 || at[2] < 0)
        throw header.error(header.text, "no columns value and cd_m2", "they hold what the photometer read",
                           "begin the file with the line: channel,value,cd_m2");
    return at;
}

} // namespace

char const* name_of(PatchColour colour)
{
    constexpr char const* kNames[]{"white", "red", "green", "blue"};
    return kNames[int(colour)];
}

std::vector<LuminanceReading> read_readings(std::string const& text, std::string const& file)
{
    std::vector<LuminanceReading> readings;
    std::vector<gi::TextLine> places;
    std::optional<std::array<int, 3>> at;
    std::string_view rest = text;
    bool is_bytes = false;
    for (int number = 1; !rest.empty(); ++number) {
        gi::TextLine const line{gi::take_until(rest, '\n'), file, number};
        if (gi::trimmed(line.text).empty() || line.text.front() == '#') continue;
        if (!at) {
            at = columns_of(line);
            continue;
        }
        auto const cells = gi::split_at_commas(line.text);
        auto const cell = [&](int column) -> std::string_view {
            return column >= 0 && column < int(cells.size()) ? cells[std::size_t(column)] : std::string_view();
        };
        LuminanceReading r;
        if ((*at)[0] >= 0) {
            auto const colour = colour_of(cell((*at)[0]));
            if (!colour)
                throw line.error(line.text, fmt::format("'{}' is no channel", cell((*at)[0])),
                                 "readings are of one", "white, red, green or blue");
            r.colour = *colour;
        }
        auto const value = gi::parse_finite(cell((*at)[1])), light = gi::parse_finite(cell((*at)[2]));
        if (!value || *value < 0 || *value > 65535)
            throw line.error(line.text, fmt::format("'{}' is no digital value", cell((*at)[1])),
                             "values are 0 to 1, or 0 to 255", "correct it");
        if (!light || *light < 0 || *light > kMost_cd_m2)
            throw line.error(line.text, fmt::format("'{}' is no luminance", cell((*at)[2])),
                             "it is a number of cd/m2 from 0 to 100000", "correct it");
        r.value = *value;
        r.cd_m2 = *light;
        is_bytes = is_bytes || r.value > 1;
        readings.push_back(r);
        places.push_back(line);
    }
    if (readings.empty())
        throw gi::InputError(gi::TextLocation{file, 0, 0}, "no readings", "there is nothing to fit",
                             "write lines like white,255,80.1 below channel,value,cd_m2");
    if (is_bytes)
        for (std::size_t i = 0; i < readings.size(); ++i) {
            if (readings[i].value > 255)
                throw places[i].error(places[i].text, fmt::format("the value {:g}", readings[i].value),
                                      "values of 8 bits end at 255", "write 0 to 255, or 0 to 1");
            readings[i].value /= 255;
        }
    return readings;
}

std::string readings_text(std::vector<LuminanceReading> const& readings)
{
    std::string text = "channel,value,cd_m2\n";
    for (LuminanceReading const& r : readings)
        text += fmt::format("{},{:.6f},{}\n", name_of(r.colour), r.value, r.cd_m2);
    return text;
}

std::vector<double> series_values(int count)
{
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(std::round(255.0 * i / (count - 1)) / 255);
    return values;
}

} // namespace study
