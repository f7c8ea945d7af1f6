#pragma once
// Ray trees from the camera (Whitted 1980): at each surface, direct light by shadow rays,
// and one ray for each mirror or glass direction, down to a recursion limit and a cut-off weight.
// Light that has scattered before at another surface that is neither mirror nor glass is left to a SurfaceLight;
// without one it is missing. With one, the first glossy lobe along a ray that is narrow gets a ray in a random
// direction, too (Cook, Porter and Carpenter 1984).
//
// Trees advance together, one generation at a time: all nearest hits, then all surfaces, then all shadow rays.

#include "gi/core/rng.h"
#include "gi/methods/whitted/settings.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/path_step.h"
#include "gi/render/ray_path.h"

#include <optional>
#include <span>
#include <vector>

namespace gi {

/// A surface in a ray tree.
struct TreePoint {
    ShadingPoint at;
    vec3 wo; ///< unit, in at.frame
    Pcg32 rng;
    bool direct;        ///< seen by the camera, not in mirrors or through glass
    bool glossy_traced; ///< a ray computes the reflection of its glossy lobe
    int scatterings;    ///< non-delta, between it and the camera
    vec3 throughput;
    PathSample* sample;
};

/// Something drawn in front of the scene's surfaces, which neither lights nor hides anything but them.
struct Glyph {
    float distance; ///< m
    vec3 normal;    ///< unit
    vec3 radiance;  ///< towards the camera
};

/// Indirect light at surfaces.
class SurfaceLight {
public:
    virtual ~SurfaceLight() = default;
    /// Radiance that leaves surfaces towards wo by their non-delta lobes, of light that does not come directly
    /// from its source. @param out  one per point, overwritten
    virtual void indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts& counts) const = 0;
    /// The first glyph along a ray from the camera. @param reach  m, to the surface behind
    virtual std::optional<Glyph> glyph(Ray const&, float /*reach*/) const { return std::nullopt; }
};

/// Work and losses.
struct TreeCounts {
    PathCounts paths;
    std::uint64_t cut_rays = 0; ///< by the recursion limit or the cut-off weight
    double cut_weight = 0;      ///< sum of their throughputs' largest channels
};

struct TreeTracer {
    WorldView world;
    ExactVisibility const& visibility;
    CameraRays camera;
    WhittedSettings settings;
    std::uint64_t seed;
    PixelFilter filter;
    int width;
    int bounces;                         ///< indirect ones: limits what rays of glossy lobes bring
    SurfaceLight const* light = nullptr; ///< null = no indirect light
    bool panes_by_photons = false;       ///< shadow rays go through none

    /// Traces the trees number `index` of some pixels to their ends.
    /// @param samples, first  one per pixel, overwritten
    void trace(std::span<glm::ivec2 const> pixels, std::uint32_t index, std::span<PathSample> samples,
               std::span<FirstHit> first, TreeCounts& counts) const;

private:
    struct TreeRay {
        Pcg32 rng{0, 0};
        Ray ray;
        PathState state;
        PathSample* sample;
    };
    struct ShadowRay {
        RayQuery query;
        vec3 radiance;
        int scatterings; ///< see layer_of
        PathSample* sample;
    };
    bool draw_glyph(TreeRay const& r, Hit const& hit) const;
    void shade(TreeRay& r, Hit const& hit, int generation, std::vector<TreeRay>& next,
               std::vector<ShadowRay>& shadows, std::vector<TreePoint>& points, TreeCounts& counts) const;
    /// @param glossy_traced  a ray of the glossy lobe may find lights, too
    void aim_at_lights(TreeRay& r, ShadingPoint const& at, vec3 wo, int generation, bool glossy_traced,
                       std::vector<ShadowRay>& shadows) const;
    void reflect_glossy(TreeRay& r, ShadingPoint const& at, vec3 wo, std::vector<TreeRay>& next) const;
};

} // namespace gi
