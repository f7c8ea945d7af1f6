#pragma once
// What finds the surfaces of light paths, as the settings choose it: exact rays, look-ups in hit buffers, distance
// impostors. Built when first asked for, kept, and updated when the world has changed.

#include "gi/core/report.h"
#include "gi/light_paths/impostor_rays.h"
#include "gi/methods/path_rays/look_up_rays.h"
#include "gi/render/render_settings.h"
#include "gi/scene/motion/moving_world.h"

#include <optional>

namespace gi {

class LightRays {
public:
    /// All arguments must outlive it. Throws InputError if the settings ask for
    /// impostors beyond check_impostors().
    /// @param first_moving  index of the first triangle that may move
    /// @param stop  checked while hit buffers are built; null = never
    LightRays(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
              StopRequest const* stop);
    /// Follows the world.
    void changed(Changes const& changes);
    /// For the world as it is now. Throws Interrupted. @param exact  of the world
    /// @param focus  what cameras show, if the world is much larger; else empty
    PathRays const& of(PhotonRays kind, ExactVisibility const& exact, Bounds const& focus = {});
    void report_counts();
    /// What it reads of options of other methods, as on the command line, after a space; empty if nothing.
    std::string options(PhotonRays kind) const;

private:
    void build_look_ups(ExactVisibility const& exact);
    void build_impostors(ExactVisibility const& exact, Bounds const& focus);

    World const& world_;
    RenderSettings const& settings_;
    std::size_t first_moving_;
    Report& report_;
    StopRequest const* stop_;
    bool axes_moved_ = false, impostors_moved_ = false;
    std::optional<StoredAxes> axes_; ///< of look-ups
    std::uint64_t lost_ = 0;         ///< layers, already reported
    std::optional<Impostors> impostors_;
    Bounds impostors_about_; ///< the focus when they were placed
    std::unique_ptr<PathRays> rays_;
};

} // namespace gi
