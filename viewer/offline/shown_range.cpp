#include "viewer/offline/shown_range.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace viewer {

namespace {
constexpr unsigned char kNearlyBlack = 8; ///< of 255: nobody sees it beside a window or a lamp
}

void ShownRange::add(gi::Layer const& color, std::vector<unsigned char> const& bytes)
{
    constexpr std::size_t kEvery = 7; // pixels
    auto const channels = std::size_t(color.channels);
    for (std::size_t i = 0; i + channels <= bytes.size() && i + channels <= color.data.size(); i += channels) {
        if (channels == 4 && bytes[i + 3] == 0) continue;
        ++pixels_;
        auto const [least, most] = std::minmax({bytes[i], bytes[i + 1], bytes[i + 2]});
        white_ += least == 255;
        black_ += most < kNearlyBlack;
        float const y = 0.2126f * color.data[i] + 0.7152f * color.data[i + 1] + 0.0722f * color.data[i + 2];
        if (pixels_ % kEvery == 0 && y > 0 && std::isfinite(y)) logs_.push_back(std::log2(y));
    }
}

std::string ShownRange::problem(std::string const& file, double exposure_ev) const
{
    constexpr double kMostlyWhite = 0.6, kMostlyBlack = 0.98, kMiddle = 0.18, kMost_ev = 16;
    double const n = double(std::max<std::size_t>(1, pixels_)), white = double(white_) / n,
                 black = double(black_) / n;
    if (white < kMostlyWhite && black < kMostlyBlack) return {};
    double shows_ev = std::numeric_limits<double>::infinity();
    if (!logs_.empty()) {
        std::vector<float> logs = logs_;
        auto const middle = logs.begin() + std::ptrdiff_t(logs.size() / 2);
        std::ranges::nth_element(logs, middle);
        shows_ev = std::log2(kMiddle) - double(*middle);
    }
    if (black >= kMostlyBlack && shows_ev > kMost_ev)
        return fmt::format("'{}' is black: next to no light reaches what the camera sees. Lights may be missing "
                           "or without power, or "
                           "a mesh around the scene hides its sky; lightwell info lists its lights",
                           file);
    if (logs_.empty()) return fmt::format("'{}' is white: its values are not finite", file);
    return fmt::format(
        "{:.0f} % of '{}' is {}, which lies beyond what a PNG shows at --exposure {:g}: --exposure {:.1f} "
        "shows its middle",
        100 * std::max(white, black), file, white > black ? "white" : "black", exposure_ev, shows_ev);
}

} // namespace viewer
