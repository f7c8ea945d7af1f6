#pragma once
// What stands for the visibility between a surface and a virtual light: all that differs between the methods
// vpl_*.

#include "gi/core/report.h"
#include "gi/methods/vpl/camera_paths.h"
#include "gi/methods/vpl/virtual_lights.h"
#include "gi/render/render_settings.h"

#include <algorithm>
#include <memory>
#include <span>

namespace gi {

enum class VisibilityKind : std::uint8_t {
    exact,       ///< rays
    slhb,        ///< walks along the stored axes of layered hit buffers
    imperfect,   ///< shadow maps of points, holes filled by pull-push
    ambient,     ///< the share of the hemisphere that is free within a radius
    directional, ///< rays no longer than a radius
    none         ///< everything sees everything
};

/// Receivers of one tile and the random numbers of its pass.
struct ReceiverTile {
    std::span<Receiver const> receivers;
    std::uint32_t seed;
};

/// From a receiver to a virtual light that faces it.
struct Connection {
    std::uint32_t receiver, light; ///< indices
    vec3 direction;                ///< unit, from the receiver
};

/// Shares of light that pass, 0 to 1: of a connection that of its receiver times its own. All but prepare() and
/// world_changed() may be called by several threads at once.
class VisibilityTerm {
public:
    virtual ~VisibilityTerm() = default;
    /// Before a pass. The lights stay where they are while it lasts.
    virtual void prepare(std::span<VirtualLight const> /*lights*/, std::uint32_t /*pass*/) {}
    /// Triangles that can move are elsewhere now.
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
    /// What has been done and lost since the last call.
    virtual void report_work(Report&) {}
};

/// What terms are made from; all of it outlives them.
struct TermSource {
    World const& world;
    ExactVisibility const& visibility;
    RenderSettings const& settings;
    std::size_t first_moving; ///< triangle
    Report& report;
};

std::unique_ptr<VisibilityTerm> make_term(VisibilityKind kind, TermSource const& source);

} // namespace gi
