#include "viewer/base/frame_range.h"

#include "gi/core/error.h"
#include "gi/core/text.h"
#include "viewer/base/arguments.h"

#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <string_view>

namespace viewer {
namespace {

constexpr int kMostFrames = 100000, kLastFrame = 100'000'000;
constexpr double kLowestFps = 1e-3, kHighestFps = 1e5;

gi::InputError bad(std::string const& text, std::string const& why)
{
    return {"--frames '" + text + "' is not understood", why, "write 0:120@30, 0:4s@30 or 0:120@30000/1001"};
}

void parse_rate(std::string const& text, std::string_view rate, FrameRange& range)
{
    auto const slash = rate.find('/');
    auto const frames = gi::parse_finite(rate.substr(0, slash));
    auto const seconds = slash == rate.npos ? std::optional(1.0) : gi::parse_finite(rate.substr(slash + 1));
    if (!frames || !seconds || !(*frames > 0) || !(*seconds > 0) || !(*frames / *seconds >= kLowestFps) ||
        !(*frames / *seconds <= kHighestFps))
        throw bad(text,
                  fmt::format("after @, frames per second are needed, {} to {:.0f}", kLowestFps, kHighestFps));
    range.frames = *frames;
    range.per_seconds = *seconds;
}

int parse_frame(std::string const& text, std::string_view part, FrameRange const& range)
{
    bool const in_seconds = part.ends_with('s');
    auto const value = gi::parse_finite(part.substr(0, part.size() - (in_seconds ? 1 : 0)));
    if (!value) throw bad(text, fmt::format("'{}' is not a frame", part));
    double const exact = in_seconds ? *value * range.fps() : *value, frame = std::round(exact);
    if (frame < 0 || frame > kLastFrame)
        throw bad(text, fmt::format("frames are counted from 0 to {}", kLastFrame));
    if (std::abs(exact - frame) > (in_seconds ? 1e-6 * std::max(1.0, frame) : 0.0))
        throw bad(text, fmt::format("'{}' is not on a frame", part));
    return int(frame);
}

} // namespace

FrameRange parse_frame_range(std::string const& text)
{
    auto const colon = text.find(':'), at = text.find('@');
    if (colon == text.npos || at == text.npos || at < colon)
        throw bad(text, "the first frame, the one after the last, and frames per second are needed");
    FrameRange range;
    std::string_view const all = text;
    parse_rate(text, all.substr(at + 1), range);
    range.first = parse_frame(text, all.substr(0, colon), range);
    range.end = parse_frame(text, all.substr(colon + 1, at - colon - 1), range);
    if (range.end <= range.first)
        throw bad(text, "it has no frames, as the second number is the frame after the last");
    if (range.count() > kMostFrames)
        throw bad(text, fmt::format("it has {} frames, at most {} are possible", range.count(), kMostFrames));
    return range;
}

std::string FrameName::of(int frame) const { return fmt::format("{}{:0{}}{}", before, frame, digits, after); }

std::string FrameName::of_all(FrameRange const& range) const
{
    return fmt::format("{}{:0{}}-{:0{}}{}", before, range.first, digits, range.end - 1, digits, after);
}

FrameName parse_frame_name(std::string const& option, std::string const& pattern)
{
    auto const refuse = [&](std::string const& why) {
        std::string const ending = option == "--png" ? ".png" : ".exr";
        return gi::InputError(option + " '" + pattern + "' does not name frames", why, "write f_%04d" + ending);
    };
    FrameName name;
    bool found = false;
    std::string* part = &name.before;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        if (pattern[i] != '%' || pattern.compare(i, 2, "%%") == 0) {
            part->push_back(pattern[i]);
            i += pattern[i] == '%' ? 1 : 0;
            continue;
        }
        std::size_t end = i + 1;
        while (end < pattern.size() && pattern[end] >= '0' && pattern[end] <= '9') ++end;
        std::string const digits = pattern.substr(i + 1, end - i - 1);
        bool const plain = digits.empty(), padded = digits.size() == 2 && digits[0] == '0' && digits[1] > '0';
        if (end >= pattern.size() || pattern[end] != 'd' || !(plain || padded))
            throw refuse("% must be followed by d or 04d, and %% means %");
        if (found) throw refuse("it contains the frame number twice");
        found = true;
        name.digits = padded ? digits[1] - '0' : 1;
        part = &name.after;
        i = end;
    }
    if (!found) throw refuse("without the frame number all frames would be one file");
    if (name.after.find('/') != std::string::npos) throw refuse("the frame number is in the name of a folder");
    return name;
}

} // namespace viewer
