#pragma once
// Caustics: light that reaches a surface by way of mirrors and glass alone (L S+ D; L a light, D a surface that is
// neither, S a mirror, glass, a pane, or the smooth coat of something else). Who is responsible for light at D:
//
//   L D           shadow rays of the ray trees, which everything blocks, panes too
//   L S+ D        photons here. No light seen in a mirror counts twice: field rays bring only what surfaces
//   reflect L S* D+ S* D  the field: its photons have gone through any S, and its rays go on at S
//                         (panes, mirrors, glass)
//
// What a camera sees of D by way of mirrors and glass are points of ray trees, which read all three.
//
// Light paths begin on smooth triangles: a point there, a sample of the lights, a shadow ray between them. So all
// of them meet one, however small it is. Each pass has photons of its own; at rest their disks shrink from pass to
// pass such that the mean of the passes converges (Knaus and Zwicker 2011). While the camera or anything
// else moves, each frame begins with the photons of the first pass: no flicker.

#include "gi/core/report.h"
#include "gi/light_paths/lit_starts.h"
#include "gi/light_paths/photon_map.h"
#include "gi/light_paths/settings.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/frame_renderer.h"
#include "gi/render/path_sample.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/motion/moving_world.h"

#include <optional>

namespace gi {

/// Triangles that mirror or refract without scattering, as far as no texture changes them. Chances are in
/// proportion to how much a material reflects and transmits, half by area, and half one triangle
/// like another: small curved things, which focus light, have many. @param focus  gets at least half of the paths
/// if smooth triangles lie there; empty = there is none
StartTargets find_caustic_targets(World const& world, Bounds const& focus);

/// How much a material mirrors and refracts without scattering, 0 to 1.
float smooth_share(Bsdf const& bsdf);

/// Whether there will be caustics, and why.
PlanItem explain_caustics(World const& world, PhotonSettings const& settings);

class Caustics {
public:
    /// All arguments must outlive it.
    Caustics(World const& world, RenderSettings const& settings, Report& report);

    /// Follows the world.
    void changed(Changes const& changes);
    /// Traces the photons of one more pass. Throws Interrupted, and then keeps what it had.
    /// @param index  of the pass; the first decides which photons are traced
    /// @param share  of the paths that the settings ask for
    void prepare(ExactVisibility const& visibility, std::uint32_t index, std::span<FrameView const> views,
                 Bounds const& focus, double share, BuildStop const& stop, PathCounts& counts);
    /// Null if the world has no smooth surface, no light reached one, or nothing is to be traced.
    PhotonMap const* map() const { return map_.empty() ? nullptr : &map_; }
    std::span<Photon const> photons() const { return photons_; } ///< of the map
    std::uint32_t version() const { return version_; }           ///< changes with the photons
    void report_counts();

private:
    void trace(ExactVisibility const& visibility, BuildStop const& stop, PathCounts& counts);
    std::vector<Photon> photons_of_set(ExactVisibility const& visibility, BuildStop const& stop,
                                       PathCounts& counts);

    World const& world_;
    RenderSettings const& settings_;
    Report& report_;
    std::optional<std::uint32_t> first_index_; ///< of the passes
    std::vector<Camera> cameras_;              ///< of the last call
    Bounds focus_;
    bool surfaces_changed_ = true, light_changed_ = true;
    StartTargets targets_;
    std::optional<bool> learned_; ///< whether chances follow the photons of a first set, because these were few
    std::vector<Photon> photons_;
    PhotonMap map_;
    std::uint32_t paths_ = 0; ///< of a set
    std::uint32_t sets_ = 0;  ///< of photons since the last change
    std::uint32_t version_ = 0;
    float shrunk_ = 1; ///< factor of the disks' radii
};

} // namespace gi
