#include "viewer/experiment/screens/monitor_check.h"

#include "gi/core/error.h"
#include "viewer/displays/edid.h"

#include <cmath>
#include <fmt/format.h>

namespace viewer {

std::optional<MonitorInfo> monitor_of(Window const& window)
{
    glm::ivec2 const centre = window.position_px() + window.framebuffer_px() / 2;
    auto const all = monitors();
    for (MonitorInfo const& m : all)
        if (centre.x >= m.position_px.x && centre.y >= m.position_px.y &&
            centre.x < m.position_px.x + m.size_px.x && centre.y < m.position_px.y + m.size_px.y)
            return m;
    return all.empty() ? std::nullopt : std::optional(all.front());
}

std::string to_text(MonitorInfo const& m)
{
    return fmt::format("{}, {} x {} px, {}", m.name, m.size_px.x, m.size_px.y,
                       m.refresh_hz > 0 ? fmt::format("{} Hz", m.refresh_hz) : "unknown rate");
}

void check_monitor(study::DisplayModel const& model, std::optional<MonitorInfo> const& monitor, gi::Report& report)
{
    if (!monitor) {
        report.lose("display models that could not be compared with the monitor");
        return;
    }
    if (auto const& s = model.screen; s && glm::ivec2(s->width_px, s->height_px) != monitor->size_px)
        throw gi::InputError(
            fmt::format("the display model is of {} x {} px", s->width_px, s->height_px),
            fmt::format("the monitor shows {}; degrees would be wrong", to_text(*monitor)),
            "set the monitor's mode, choose the monitor with --fullscreen, or calibrate this one");
    constexpr double kRate = 0.02;
    if (model.refresh_hz > 0 && monitor->refresh_hz > 0 &&
        std::abs(model.refresh_hz / monitor->refresh_hz - 1) > kRate)
        report.lose("display models that were measured at another refresh rate", 1,
                    fmt::format("{:g} Hz, the monitor has {} Hz", model.refresh_hz, monitor->refresh_hz));
    auto const edid = monitor_at(monitor->name);
    if (edid && !model.monitor.empty() && model.monitor != to_text(*edid))
        report.lose("display models of another monitor", 1,
                    fmt::format("'{}', this one is '{}'", model.monitor, to_text(*edid)));
}

} // namespace viewer
