#include "gi/methods/vpl/visibility.h"

#include "gi/methods/slhb/directions/stored_axes.h"
#include "gi/methods/slhb/settings.h"
#include "gi/methods/vpl/renderer.h"

#include <array>
#include <fmt/format.h>

namespace gi {
namespace {

/// Names by VisibilityKind.
constexpr std::array<char const*, 6> kNames{"vpl_exact", "vpl_slhb", "vpl_imperfect",
                                            "vpl_ao",    "vpl_dao",  "vpl_none"};

/// Settings as command-line options that reproduce the picture.
std::string options_of(VisibilityKind kind, RenderSettings const& s)
{
    std::vector<std::string_view> own{"light-paths"};
    if (s.vpl.near_m > 0) own.push_back("near");
    if (kind == VisibilityKind::imperfect) own.insert(own.end(), {"points", "point-map"});
    if (kind == VisibilityKind::ambient || kind == VisibilityKind::directional) own.push_back("ao-radius");
    std::string const text = as_options(virtual_light_options(), s, own);
    if (kind != VisibilityKind::slhb) return text;
    return text + " " + as_options(slhb_options(), s, {"directions", "hit-buffer"});
}

/// Returns the settings with defaults chosen.
RenderSettings chosen(RenderSettings settings)
{
    settings.slhb = with_stored_axes(settings.slhb);
    settings.vpl.points = settings.vpl.points_per_map();
    settings.vpl.points_percent = 0;
    return settings;
}

StartPasses passes(VisibilityKind kind)
{
    return [kind](World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                  StopRequest const* stop) {
        return std::make_unique<VirtualLightRenderer>(kind, world, settings, first_moving, report, stop);
    };
}

} // namespace

std::string VirtualLightRenderer::options() const { return options_of(kind_, settings_); }

RenderResult render_with_virtual_lights(VisibilityKind kind, World const& world, Camera const& camera,
                                        RenderSettings const& settings, StopRequest const& stop,
                                        RenderProgress const& progress, Report& report)
{
    return render_passes(kNames[std::size_t(kind)], passes(kind), world, camera, chosen(settings), stop, progress,
                         report);
}

std::unique_ptr<FrameRenderer> start_virtual_light_frames(VisibilityKind kind, MovingWorld const& world,
                                                          RenderSettings const& settings, Report& report)
{
    return start_pass_frames(passes(kind), world, chosen(settings), report);
}

} // namespace gi
