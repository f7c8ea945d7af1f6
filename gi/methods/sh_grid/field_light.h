#pragma once
// Indirect light at surfaces from the spherical-harmonics field (Chang, Park and Ihm, sec. 4): the coefficients of
// the 27 cells around a point, weighted by distance, convolved with the surface's lobes.
//
// Against leaks through walls, which the paper does not treat, cells weigh less the further behind the surface
// their centres lie, the less they see of sides that light can reach, and the less likely nothing is between them
// and the point (Chebyshev's bound from mean and variance of the distance in that direction, as in variance shadow
// maps, Donnelly and Lauritzen 2006). Exact shadow rays to a few cells, chosen by these weights, decide: the mean
// is that of the cells that they reach.

#include "gi/light_paths/photon_map.h"
#include "gi/methods/sh_grid/indirect_field.h"
#include "gi/methods/whitted/tree_tracer.h"

#include <atomic>

namespace gi {

class FieldLight : public SurfaceLight {
public:
    /// @param levels  the finest first, empty without indirect light; with the other arguments must outlive it
    /// @param caustics  null = none
    FieldLight(std::span<GridLevel const> levels, PhotonMap const* caustics, ExactVisibility const& visibility,
               ShGridSettings const& settings);

    /// Also adds the light of caustics, which has scattered once, to that layer of the points' samples.
    void indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts& counts) const override;
    std::optional<Glyph> glyph(Ray const& ray, float reach) const override;
    /// Points so far from which no cell is seen: they get no indirect light.
    std::uint64_t unseen() const { return unseen_; }

private:
    /// A cell near a point, and its weight.
    struct NearCell {
        FieldCell const* cell;
        vec3 center; ///< m
        float weight, cell_m;
    };
    /// The cells around a point of a surface, the coarse level's only where the fine one ends or has none.
    void find_cells(vec3 position, vec3 normal, std::vector<NearCell>& out) const;
    void add_cells(std::size_t level, vec3 position, vec3 normal, float share, std::vector<NearCell>& out) const;
    vec3 reflect(TreePoint& point, FieldCell const& around) const;
    /// A ray from a point to a cell.
    struct ShadowRay {
        RayQuery query;
        NearCell near;
        float weight;
        std::uint32_t point; ///< its index
    };
    void add(NearCell const& near, float weight, FieldCell& out) const; ///< distances in m
    /// Adds the weighted mean of the cells that are seen, per point, whose rays follow each other.
    /// @param seen  set to 1 for points that see one
    void add_visible(std::span<ShadowRay const> rays, std::span<FieldCell> out, PathCounts& counts,
                     std::span<std::uint8_t> seen) const;

    std::vector<CellsView<FieldCell>> levels_;
    PhotonMap const* caustics_;
    ExactVisibility const& visibility_;
    int degree_, coefficients_;
    ShGridSettings const& settings_;
    mutable std::atomic<std::uint64_t> unseen_ = 0;
};

/// Radiance that arrives from a direction, not below 0.
vec3 field_radiance(FieldCell const& cell, int degree, vec3 direction);
/// Irradiance by convolution with a clamped cosine in closed form, W/m^2, not below 0.
vec3 field_irradiance(FieldCell const& cell, int degree, vec3 normal);

} // namespace gi
