#include "viewer/app/live_error.h"

#include "gi/metrics/flip.h"
#include "gi/metrics/metrics.h"
#include "viewer/engine/picture_margin.h"

#include <algorithm>
#include <numeric>

namespace viewer {
namespace {

/// Linear colours with exposure applied, in [0, 1], as FLIP expects.
std::vector<float> exposed(std::vector<float> const& radiance, double ev)
{
    std::vector<float> out(radiance.size());
    float const scale = float(std::exp2(ev));
    std::transform(radiance.begin(), radiance.end(), out.begin(),
                   [&](float v) { return v > 0 ? std::min(1.0f, scale * v) : 0.0f; });
    return out;
}

LiveError measure(LiveFrame const& frame)
{
    ViewPicture const& v = frame.result.views[0];
    gi::Picture const first = without_margin(v.picture, v.margin_px),
                      other = without_margin(*v.compared, v.margin_px);
    std::vector<float> const &a = first.find("color")->data, &b = other.find("color")->data;
    double const ev = frame.settings.exposure_ev;
    std::vector<float> const flip = gi::flip(exposed(a, ev), exposed(b, ev), first.width, first.height);
    return {frame.command.frame, gi::measure_errors(a, b, 3).relmse,
            std::accumulate(flip.begin(), flip.end(), 0.0) / double(flip.size())};
}

} // namespace

void ErrorMeter::see(std::shared_ptr<LiveFrame const> const& frame)
{
    if (!frame || frame->result.views.empty() || !frame->result.views[0].compared) {
        latest_.reset();
        return;
    }
    if (running_.valid() && running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
    latest();
    running_ = std::async(std::launch::async, [frame] { return measure(*frame); });
}

std::optional<LiveError> const& ErrorMeter::latest()
{
    if (running_.valid() && running_.wait_for(std::chrono::seconds(0)) == std::future_status::ready)
        latest_ = running_.get();
    return latest_;
}

} // namespace viewer
