#include "ar/capture/frame_source.h"

#include "gi/core/error.h"

#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

void check_positive(std::optional<double> value, char const* name)
{
    if (value && !(std::isfinite(*value) && *value > 0))
        throw gi::InputError(fmt::format("{} = {}", name, *value), "it has to be a number above 0",
                             "set another one");
}

void check_not_both(std::optional<bool> automatic, bool by_hand, char const* name)
{
    if (automatic.value_or(false) && by_hand)
        throw gi::InputError(fmt::format("{} is both automatic and given", name), "one would undo the other",
                             "set one of them");
}

} // namespace

void check(Controls const& c)
{
    check_positive(c.exposure_time_s, "the exposure time");
    check_positive(c.gain, "the gain");
    check_positive(c.red_gain, "the gain of red");
    check_positive(c.blue_gain, "the gain of blue");
    check_positive(c.frame_duration_s, "the frame duration");
    check_not_both(c.automatic_exposure, c.exposure_time_s || c.gain, "exposure");
    check_not_both(c.automatic_white_balance, c.red_gain || c.blue_gain, "white balance");
    if (c.red_gain.has_value() != c.blue_gain.has_value())
        throw gi::InputError("one gain of white balance without the other", "cameras take both at once",
                             "give red_gain and blue_gain");
}

std::string describe(SourceCounts const& c)
{
    std::string const missing = c.missing.empty() ? "" : fmt::format(" (not there: {})", c.missing);
    std::string text =
        fmt::format("{} frames, {} dropped{}, {} refused", c.delivered, c.dropped, missing, c.refused);
    if (c.refused > 0) text += " (last: " + c.last_refusal + ")";
    if (c.changed > 0) text += fmt::format(", {} not as they are (last: {})", c.changed, c.last_change);
    return text;
}

std::vector<std::string> cannot_set(Controls const& c, std::string const& why)
{
    std::vector<std::string> all;
    auto const add = [&](bool is_set, char const* name) {
        if (is_set) all.push_back(fmt::format("{} cannot be set: {}", name, why));
    };
    add(c.automatic_exposure.has_value(), "automatic exposure");
    add(c.exposure_time_s.has_value(), "the exposure time");
    add(c.gain.has_value(), "the gain");
    add(c.automatic_white_balance.has_value(), "automatic white balance");
    add(c.red_gain || c.blue_gain, "white balance");
    add(c.frame_duration_s.has_value(), "the frame duration");
    return all;
}

void report_counts(SourceCounts const& counts, gi::Report& report)
{
    if (counts.refused > 0)
        report.lose("frames that could not be read", std::size_t(counts.refused), counts.last_refusal);
    if (!counts.missing.empty())
        report.lose("numbered pictures that are not there", counts.dropped, "number " + counts.missing);
    if (!counts.unnumbered.empty())
        report.lose("pictures that are numbered by their order, not by their names", counts.delivered,
                    counts.unnumbered);
    if (counts.changed > 0) report.lose("frames not used as they are", counts.changed, counts.last_change);
}

void report_losses(SourceCounts const& counts, SourceState const& state, gi::Report& report)
{
    report_counts(counts, report);
    if (state.kind == SourceState::Kind::lost)
        throw gi::InputError("the source was lost: " + state.reason, describe(counts),
                             "check the file, or the camera's cable");
}

} // namespace ar
