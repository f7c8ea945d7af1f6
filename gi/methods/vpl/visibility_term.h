#pragma once
// The estimate of the visibility between a surface and a virtual light:
// the only difference between the methods vpl_*.

#include "gi/core/report.h"
#include "gi/light_paths/light_paths.h"
#include "gi/methods/vpl/camera_paths.h"
#include "gi/render/pass_stop.h"
#include "gi/render/render_settings.h"

#include <algorithm>
#include <memory>
#include <span>

namespace gi {

enum class VisibilityKind : std::uint8_t {
    exact,       ///< rays
    slhb,        ///< walks along the stored axes of layered hit buffers
    imperfect,   ///< shadow maps drawn from points, with holes filled by pull-push
    ambient,     ///< unoccluded fraction of the hemisphere within a radius
    directional, ///< rays limited to a radius
    none         ///< everything is visible
};

/// The receivers of one tile, and a random seed that differs for every tile and pass.
struct ReceiverTile {
    std::span<Receiver const> receivers;
    std::uint32_t seed;
};

/// Connection of a receiver to a virtual light that faces it.
struct Connection {
    std::uint32_t receiver, light; ///< indices
    vec3 direction;                ///< unit, from the receiver
};

/// Fractions of unblocked light, 0 to 1: the total for a connection is that of its receiver times its own. All
/// functions except prepare() and world_changed() may be called by several threads at once.
class VisibilityTerm {
public:
    virtual ~VisibilityTerm() = default;
    /// Called before a pass. The span of lights stays valid during the pass. Throws Interrupted.
    virtual void prepare(std::span<LightVertex const> /*lights*/, std::uint32_t /*pass*/, PassStop const&) {}
    /// Called after dynamic triangles have moved.
    virtual void world_changed() {}
    virtual void of_receivers(ReceiverTile const&, std::span<float> shares, PathCounts&) const
    {
        std::fill(shares.begin(), shares.end(), 1.0f);
    }
    virtual void of_connections(ReceiverTile const&, std::span<Connection const>, std::span<float> shares,
                                PathCounts&) const
    {
        std::fill(shares.begin(), shares.end(), 1.0f);
    }
    /// Reports work and losses since the last call.
    virtual void report_work(Report&) {}
};

/// Input from which terms are made; must outlive them.
struct TermSource {
    World const& world;
    ExactVisibility const& visibility;
    RenderSettings const& settings;
    std::size_t first_moving; ///< index of the first dynamic triangle
    Report& report;
    StopRequest const* stop; ///< of building: throws Interrupted; null = never
};

std::unique_ptr<VisibilityTerm> make_term(VisibilityKind kind, TermSource const& source);

} // namespace gi
