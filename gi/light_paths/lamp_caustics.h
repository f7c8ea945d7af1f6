#pragma once
// Caustics of lamps without extent (point, spot, directional), for methods whose paths begin at the camera. By mirrors
// and refracting glass such paths reach a lamp with probability 0; photons find that light (L S+ D, see caustics.h). What
// comes through panes alone is left to shadow rays (gi/render/panes.h).
//
// Each path of a pixel has photons of its own, that depend on its number only: paths stay independent, so that their
// variance includes that of the photons, and renders are resumed and shared bit for bit. Disks shrink from path to path
// such that the mean converges (Knaus and Zwicker 2011, eq. 20).

#include "gi/core/report.h"
#include "gi/light_paths/lit_starts.h"
#include "gi/light_paths/photon_map.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/path_sample.h"
#include "gi/render/render_settings.h"
#include "gi/scene/model/plan.h"

namespace gi {

class LampCaustics {
public:
    /// All arguments must outlive it.
    LampCaustics(World const& world, RenderSettings const& settings, Report& report);

    /// False if no lamp can shine by way of a smooth surface, or the settings ask for no photons.
    static bool exist(World const& world, RenderSettings const& settings);
    /// Traces the photons of paths number `index`. Throws Interrupted, and then keeps what it had.
    void prepare(ExactVisibility const& visibility, std::uint32_t index, BuildStop const& stop,
                 PathCounts& counts);
    /// Null if no light reached anything.
    PhotonMap const* map() const { return map_.empty() ? nullptr : &map_; }

private:
    std::vector<Photon> photons_of(ExactVisibility const& visibility, std::uint32_t index, BuildStop const& stop,
                                   PathCounts& counts) const;
    void learn(ExactVisibility const& visibility, BuildStop const& stop, PathCounts& counts);

    World const& world_;
    RenderSettings const& settings_;
    Report& report_;
    StartTargets targets_;
    std::uint32_t paths_; ///< of a set
    bool has_learned_ = false;
    std::vector<Photon> photons_;
    PhotonMap map_; ///< of them
};

/// Whether there are any, and who finds them.
PlanItem explain_lamp_caustics(World const& world, RenderSettings const& settings);
/// The options that differ from their defaults, where there are any; and what tells states of renders that lacked the light
/// of lamps behind glass from those that have it.
std::string lamp_caustic_options(World const& world, RenderSettings const& settings);
std::string lamp_light_version(World const& world);
/// Of a picture by a method that does not find them.
void lose_lamp_caustics(World const& world, Report& report);

} // namespace gi
