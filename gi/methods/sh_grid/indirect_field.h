#pragma once
// All that sh_grid keeps between passes and frames: voxels, what surfaces meet, photons, radiance grids, fields.
// A world that is much larger than what is shown has two levels: a fine grid around the latter, and one of all.

#include "gi/core/report.h"
#include "gi/light_paths/focus.h"
#include "gi/methods/path_rays/light_rays.h"
#include "gi/methods/sh_grid/photon_sets.h"
#include "gi/render/path_sample.h"
#include "gi/render/render_settings.h"
#include "gi/scene/motion/moving_world.h"

#include <chrono>
#include <optional>

namespace gi {

class IndirectField {
public:
    /// @param world  must outlive it  @param first_moving  index of the first triangle that may move
    /// @param stop  of building, and of the only picture; null = frames
    IndirectField(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                  StopRequest const* stop);

    /// Follows the world: geometry that moved, lights or materials that changed.
    void changed(Changes const& changes);
    /// Updates the fields for one more pass. After a change, all their cells are updated within `field_passes`
    /// calls, and after motion the photons at the same rate. In a world at rest, calls 4, 8, 16,
    /// ... average the fields of more photons and other directions.
    /// @param visibility  of the world as it is now  @param index  of the pass; the first decides which photons
    /// are traced. Throws Interrupted if a stop is requested and there is no field yet, or in frames, which
    /// must not have older light; null = never.
    void prepare(ExactVisibility const& visibility, std::uint32_t index, std::span<FrameView const> views,
                 StopRequest const* stop, PathCounts& counts);
    /// Fewer than the settings' if they would take more than half of the budget.
    int voxels() const { return voxels_; }
    std::uint32_t light_paths() const { return light_paths_; }
    /// The finest level first; empty without indirect light.
    std::span<GridLevel const> levels() const { return levels_; }
    void report_counts();
    std::string ray_options() const { return light_rays_.options(settings_.of<PhotonSettings>().rays); } ///< see LightRays

private:
    using Clock = std::chrono::steady_clock;
    static double seconds_since(Clock::time_point start)
    {
        return std::chrono::duration<double>(Clock::now() - start).count();
    }
    /// What an update works with.
    struct Now {
        ExactVisibility const& visibility;
        std::span<FrameView const> views;
        BuildStop const& stop;
        PathCounts& counts;
    };
    void fit_budget(Now const& now);
    void update(Now const& now);
    bool refines_at_rest();
    std::vector<bool> only_smooth() const;
    void place_levels(ExactVisibility const& visibility, std::span<FrameView const> views, BuildStop const& stop);
    void make_radiance_grids();
    void place_cells(GridLevel& level);
    void update_cells(ExactVisibility const& visibility, int part, int parts, BuildStop const& stop,
                      PathCounts& counts);
    /// Whether passes belong to frames, none of which shall take long, instead of to one picture.
    bool frames() const { return frames_; }
    bool moves() const { return first_moving_ < world_.triangles.size(); }
    int parts() const { return settings_.of<ShGridSettings>().field_passes; }
    RadianceBy by() const { return settings_.of<ShGridSettings>().radiance_by; }
    bool sky_shines() const { return !view(world_).environment_radiance.empty(); }

    World const& world_;
    RenderSettings const& settings_;
    std::size_t first_moving_;
    Report& report_;
    bool frames_;
    int voxels_;                ///< along the longest side
    std::uint32_t light_paths_; ///< of a set of photons
    Clock::time_point started_ = Clock::now();
    double last_update_s_ = 0;                 ///< of photons and whole fields
    std::optional<std::uint32_t> first_index_; ///< of the passes
    std::vector<Camera> cameras_;              ///< of the last call
    std::vector<bool> only_smooth_;            ///< per material, when the grids were placed

    std::vector<GridLevel> levels_;
    bool surfaces_changed_ = true, light_changed_ = true, coverage_changed_ = false, materials_changed_ = false;
    PhotonSets photons_;
    LightRays light_rays_;
    std::size_t photon_count_ = 0;
    dvec3 stored_{0}; ///< flux of photons, W
    bool has_field_ = false;
    bool update_all_ = true;    ///< cells in the next update
    std::uint32_t updates_ = 0; ///< of the whole fields since the last change, each with other directions
    int parts_left_ = 0;        ///< of the fields, that do not know the latest light
    int next_part_ = 0;
    std::uint32_t calls_at_rest_ = 0;
};

} // namespace gi
