#pragma once
// Sets of photons for the grids, one after the other, each in parts: after motion, a part of a set may be traced
// at a time, while the others remain from before.

#include "gi/methods/sh_grid/grid_level.h"
#include "gi/methods/sh_grid/inner_paths.h"
#include "gi/render/render_settings.h"

#include <optional>

namespace gi {

class PhotonSets {
public:
    struct Trace {
        std::span<GridLevel> levels; ///< the finest first
        ExactVisibility const& visibility;
        PathRays const& rays; ///< of light paths
        std::span<FrameView const> views;
        BuildStop const& stop;
        PathCounts& counts;
    };
    /// Both must outlive it. @param first_moving  index of the first triangle that may move
    PhotonSets(World const& world, RenderSettings const& settings, std::size_t first_moving);

    /// The next set is the first again, as the lights or the grids have changed.
    /// @param light_paths  of a set  @param first_index  of the passes: decides which photons are traced
    void restart(std::uint32_t light_paths, std::uint32_t first_index);
    /// Traces a whole set. Throws Interrupted.
    void trace_all(Trace const& trace);
    /// Makes trace_next() trace the first set again (after motion:
    /// the same photons do not flicker), or the next one.
    void begin_parts(bool first_set);
    /// Traces one more part. Throws Interrupted.
    void trace_next(Trace const& trace);
    int parts_left() const { return parts_left_; }
    /// Photons of all parts, moved with their triangles.
    std::vector<ReflectedPhoton> photons() const;
    std::uint32_t sets() const { return sets_; } ///< traced since the last restart or motion

private:
    int parts() const { return settings_.of<ShGridSettings>().field_passes; }
    LightPaths light_paths_of(int part, Trace const& trace) const;
    template <class Vertices>
    std::vector<ReflectedPhoton> trace_part(Trace const& trace, int part, LightPaths paths, std::uint64_t stream,
                                            Vertices const& vertices);
    void trace_from_lights(Trace const& trace, int part);
    void trace_inner(Trace const& trace, int first_part, int end_part);
    void trace_parts(Trace const& trace, int first_part, int end_part);

    World const& world_;
    RenderSettings const& settings_;
    std::size_t first_moving_;
    std::uint32_t light_paths_ = 1, first_index_ = 0, sets_ = 0;
    int parts_left_ = 0, next_part_ = 0;
    std::optional<InnerPaths> inner_paths_; ///< with a fine grid
    /// By part: of paths from the lights, and from surfaces of the fine grid.
    std::vector<std::vector<ReflectedPhoton>> from_lights_, from_inside_;
};

} // namespace gi
