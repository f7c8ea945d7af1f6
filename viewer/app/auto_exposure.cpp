#include "viewer/app/auto_exposure.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr double kMiddle = 0.18, kMost_ev = 16, kAdapts_s = 0.4, kStarts_ev = 0.1, kRests_ev = 0.01;
constexpr std::size_t kPixels = 4096; // of a view

bool is_in_margin(ViewPicture const& v, std::size_t i)
{
    glm::ivec2 const at(int(i % std::size_t(v.picture.width)), int(i / std::size_t(v.picture.width))),
        end = glm::ivec2(v.picture.width, v.picture.height) - v.margin_px;
    return at.x < v.margin_px.x || at.y < v.margin_px.y || at.x >= end.x || at.y >= end.y;
}

} // namespace

std::optional<double> metered_exposure_ev(std::vector<ViewPicture> const& views)
{
    std::vector<double> logs;
    for (ViewPicture const& v : views) {
        gi::Layer const* const color = v.picture.find("color");
        if (color == nullptr) continue;
        std::size_t const pixels = color->data.size() / 3, step = std::max<std::size_t>(1, pixels / kPixels);
        for (std::size_t i = 0; i < pixels; i += step) {
            if (v.hidden && (*v.hidden)[i]) continue;
            if (is_in_margin(v, i)) continue;
            float const* const c = color->data.data() + 3 * i;
            double const y = 0.2126 * double(c[0]) + 0.7152 * double(c[1]) + 0.0722 * double(c[2]);
            if (y > 1e-9 && std::isfinite(y)) logs.push_back(std::log2(y));
        }
    }
    if (logs.empty()) return {};
    std::ranges::sort(logs);
    std::size_t const cut = logs.size() / 20;
    double sum = 0;
    for (std::size_t i = cut; i < logs.size() - cut; ++i) sum += logs[i];
    return std::clamp(std::log2(kMiddle) - sum / double(logs.size() - 2 * cut), -kMost_ev, kMost_ev);
}

std::optional<double> AutoExposure::see(std::vector<ViewPicture> const& views, double ev, double time_s)
{
    double const seconds = time_s - std::exchange(seen_s_, time_s);
    std::optional<double> const target = metered_exposure_ev(views);
    if (!target) return {};
    double const off = *target - ev;
    if (std::exchange(first_, false)) return *target;
    if (!moves_ && std::abs(off) < kStarts_ev) return {};
    moves_ = std::abs(off) > kRests_ev;
    return ev + off * (1 - std::exp(-std::max(0.0, seconds) / kAdapts_s));
}

} // namespace viewer
