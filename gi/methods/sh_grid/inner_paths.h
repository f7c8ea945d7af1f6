#pragma once
// Light paths that begin on the surfaces of a fine grid, with the light that comes to them from outside of it:
// from the sky and parallel lights, by samples of the lights, and from surfaces of the coarse grid, by rays in
// random directions. Paths from the lights then end where they enter the fine grid, except through mirrors and
// glass. So a room in a large world, which light reaches only through its windows, gets as many photons as any.
//
// Where such light arrives that a picture shows is learned from a first set, with other random numbers.

#include "gi/core/alias_table.h"
#include "gi/light_paths/light_paths.h"
#include "gi/methods/sh_grid/radiance_grid.h"
#include "gi/render/frame_renderer.h"

namespace gi {

/// What is around a fine grid, and that grid itself.
struct InnerWorld {
    WorldView world;
    ExactVisibility const& visibility;
    CellsView<BlockVoxels> fine;
    PatchesView fine_patches;
    CellsView<BlockVoxels> coarse;
    PatchesView coarse_patches;
    View<PatchLight const> coarse_light; ///< from photons of paths from the lights

    bool is_inside(vec3 position, std::uint32_t triangle) const
    {
        return patch_at(fine, fine_patches, position, triangle) != kNoCell;
    }
};

class InnerPaths {
public:
    /// @param samples  of triangles that stay; kept  @param shown  per side of patches (2 x patch, + 1: back), how
    /// often a picture's light may come from there
    InnerPaths(std::span<PatchSample const> samples, std::vector<float> shown);

    /// Traces a first set, and lets later ones follow it. @param paths  count, seed and pass of its paths
    void learn(InnerWorld const& world, LightPaths const& paths, PathCounts& counts);
    /// Starts paths.first to paths.last - 1 of paths.count, without those that no light reaches.
    std::vector<LightStart> trace(InnerWorld const& world, LightPaths const& paths, PathCounts& counts) const;

private:
    struct Start {
        LightStart light;
        std::uint32_t sample, side;
    };
    std::vector<Start> trace_set(InnerWorld const& world, LightPaths const& paths, std::uint64_t stream,
                                 PathCounts& counts) const;
    std::vector<Start> trace_block(InnerWorld const& world, LightPaths const& paths, std::uint64_t stream,
                                   std::uint32_t first, std::uint32_t last, PathCounts& counts) const;

    std::vector<PatchSample> samples_;
    std::vector<float> shown_;
    AliasTable choice_; ///< of samples
};

/// How often light of a side of a patch may reach a picture: rays from the cameras, and from what they meet in
/// random directions. The same rays for the same cameras. @param sides  number of them
std::vector<float> count_shown_sides(World const& world, ExactVisibility const& visibility,
                                     std::span<FrameView const> views, CellsView<BlockVoxels> const& grid,
                                     PatchesView const& patches, std::size_t sides);

} // namespace gi
