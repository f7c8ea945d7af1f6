#include "viewer/study/physical_setting.h"

#include "gi/core/error.h"
#include "gi/core/text.h"

#include <fmt/format.h>
#include <vector>

namespace viewer {
namespace {

/// Numbers, then perhaps a unit: "4 x 3 deg".
struct Measure {
    std::vector<double> numbers;
    std::string unit;
};
std::optional<Measure> measure_of(std::string const& text)
{
    Measure m;
    std::string_view rest = text;
    while (true) {
        std::string_view const word = gi::take_word(rest);
        if (word.empty()) return m.numbers.empty() ? std::nullopt : std::optional(m);
        if (auto const v = gi::parse_finite(word, kBrightest_cd_m2); v && m.unit.empty())
            m.numbers.push_back(*v);
        else if (word == "x" && m.numbers.size() == 1 && m.unit.empty())
            continue;
        else if (m.unit.empty())
            m.unit = word;
        else
            return {};
    }
}

StimulusLength length_of(std::string const& key, std::string const& text, bool is_size)
{
    auto const m = measure_of(text);
    std::string const unit = m && !m->unit.empty() ? m->unit : "deg";
    bool const is_known = unit == "deg" || unit == "cm" || unit == "px";
    std::size_t const wanted = is_size ? 1 : 2;
    if (!m || !is_known || m->numbers.size() < wanted || m->numbers.size() > 2)
        throw gi::InputError(key + ": " + text, "this is no length in deg, cm or px",
                             is_size ? "write size: 4 deg, or size: 4 x 3 deg"
                                     : "write place: -5 2.5 deg (right, up)");
    StimulusLength l{m->numbers[0], m->numbers.back(),
                     unit == "deg"  ? StimulusUnit::deg
                     : unit == "cm" ? StimulusUnit::cm
                                    : StimulusUnit::px};
    double const most = l.unit == StimulusUnit::deg ? (is_size ? 170 : 80) : 1e5;
    double const least = is_size ? 1e-3 : -most;
    if (!(l.x >= least && l.x <= most && l.y >= least && l.y <= most))
        throw gi::InputError(key + ": " + text, fmt::format("lengths are {:g} to {:g} {}", least, most, unit),
                             "correct it");
    return l;
}

bool is_physical_unit(std::optional<StimulusLength> const& l) { return l && l->unit != StimulusUnit::px; }

} // namespace

char const* name_of(StimulusUnit unit)
{
    constexpr char const* kNames[]{"deg", "cm", "px"};
    return kNames[int(unit)];
}

bool PhysicalStimulus::needs_screen() const { return is_physical_unit(size) || is_physical_unit(place); }

bool is_physical_setting(std::string const& key)
{
    return key == "size" || key == "place" || key == "luminance" || key == "mean_luminance" ||
           key == "peak_luminance";
}

void set_physical(PhysicalStimulus& s, std::string const& key, std::string const& text)
{
    if (key == "size" || key == "place") {
        (key == "size" ? s.size : s.place) = length_of(key, text, key == "size");
        return;
    }
    auto const m = measure_of(text);
    if (!m || m->numbers.size() != 1 || !(m->unit.empty() || m->unit == "cd/m2"))
        throw gi::InputError(key + ": " + text, "this is no luminance", "write " + key + ": 80 cd/m2");
    if (!(m->numbers[0] > 0))
        throw gi::InputError(key + ": " + text, "luminances are above 0", "write a positive number");
    s.luminance = {key == "luminance"        ? LuminanceOf::white
                   : key == "mean_luminance" ? LuminanceOf::mean
                                             : LuminanceOf::peak,
                   m->numbers[0]};
}

std::string text_of(PhysicalStimulus const& s)
{
    std::string text;
    for (auto const& [name, l] : {std::pair{"size", s.size}, {"place", s.place}})
        if (l) text += fmt::format("{} {} {} {};", name, l->x, l->y, name_of(l->unit));
    if (s.luminance) text += fmt::format("luminance {} {};", int(s.luminance->of), s.luminance->cd_m2);
    return text;
}

} // namespace viewer
