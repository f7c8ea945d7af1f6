#pragma once
// The path tracer by kernels, with exact rays through the project's own BVH. Many paths are on their way together,
// each in a slot, from one surface to the next, by two launches: all their rays (RaysOfPaths), those to lights from the
// surface before among them, then all their scatterings. A slot whose path ends takes the next one, so that none waits
// for the longest (Novak et al. 2010); samples of a pixel are added in the order of its paths. Steps and random
// numbers are those of PathTracer, so that both trace the same paths up to rounding.

#include "gi/kernel/atomics.h"
#include "gi/methods/reference/path_steps.h"
#include "gi/render/add_samples.h"
#include "gi/render/ray_kernels.h"

namespace gi {

/// Keeps samples, one per pixel: the last one.
struct KeepSamples {
    View<PathSample> samples;

    GI_FN void add(std::size_t pixel, std::uint32_t, PathSample const& s) const { samples[pixel] = s; }
};

enum class PathStage : std::uint32_t {
    goes_on,
    ended,
    may_add, ///< ended, and all paths before it at its pixel are added, by an earlier launch
    idle     ///< all paths are taken
};

/// Where a path is, and whose it is.
struct PathSlot {
    std::uint32_t pixel = 0;
    std::uint32_t number = 0; ///< of the path, among those of its pixel
    int vertex = 0;           ///< number of surfaces before
    PathStage stage = PathStage::idle;
    std::uint32_t nearest_rays = 0, shadow_rays = 0; ///< of all paths of the slot
};

/// What a path carries to its next surface.
struct PathCarry {
    PathState state;
    std::uint32_t emitted; ///< as in Path, like the next
    std::uint32_t share, unused = 0;
    Pcg32 rng;
};

/// What the camera sees, as in PathSample.
struct FirstSurface {
    vec3 albedo, normal, position;
    float depth;
    std::uint32_t hit;
    IndirectTurn turn;
    std::array<std::uint8_t, 3> unused{};
};

/// The light that a path found.
struct PathLight {
    std::array<vec3, 3> radiance; ///< L0, L1, L2
    vec3 unshadowed;              ///< arrives where nothing lies along the shadow ray
    int scatterings;              ///< of that
};

/// That light with `unshadowed` added. @param left  of it
GI_FN inline PathLight lit(PathLight light, vec3 left)
{
    PathSample sample;
    sample.radiance = light.radiance;
    add_light(sample, light.scatterings, left * light.unshadowed);
    light.radiance = sample.radiance;
    return light;
}

/// What the kernels share. Item = slot.
struct PathSlots {
    PathSteps steps;
    std::uint32_t pixels;     ///< of the picture, in rows of steps.width
    std::uint32_t first_path; ///< of those traced now
    std::uint32_t paths;      ///< of each pixel
    ColumnView<PathSlot> slots;
    ColumnView<PathCarry> carried;
    ColumnView<PathLight> lights;
    ColumnView<FirstSurface> seen;          ///< at the first surface
    ColumnView<RayQuery> queries, shadows; ///< no_query() where there is none
    ColumnView<Hit> hits;                  ///< of queries
    ColumnView<vec3> left;                 ///< of the light along shadows
    View<std::uint32_t> added;             ///< per pixel: number of paths
    View<std::uint32_t> taken;             ///< [0]: number of paths
    View<FirstHit> first_hits;             ///< of the last path, per pixel; empty = not needed
    View<PathCounts> counts;               ///< to be added up

    GI_FN PathCounts& counts_of(std::size_t i) const { return counts[i % counts.size()]; }

    GI_FN void take_path(std::size_t i, PathSlot& s) const
    {
        std::uint32_t const path = atomic_add(taken[0], 1);
        s.pixel = path % pixels;
        s.number = path / pixels;
        s.vertex = 0;
        s.stage = s.number < paths ? PathStage::goes_on : PathStage::idle;
        shadows.store(i, no_query());
        if (s.stage == PathStage::idle) {
            queries.store(i, no_query());
            atomic_add(counts_of(i).nearest_rays, std::uint64_t(s.nearest_rays));
            atomic_add(counts_of(i).shadow_rays, std::uint64_t(s.shadow_rays));
            return;
        }
        Path p = steps.start(int(s.pixel) % steps.width, int(s.pixel) / steps.width, first_path + s.number);
        lights.store(i, {});
        go_on(i, s, p);
    }
    /// To the surface that the path meets next.
    GI_FN void go_on(std::size_t i, PathSlot& s, Path& p) const
    {
        ++s.nearest_rays;
        queries.store(i, next_query(p, s.vertex));
        carried.store(i, {.state = p, .emitted = p.emitted, .share = p.share, .rng = p.rng});
    }
};

struct StartPaths : PathSlots {
    GI_FN void operator()(std::size_t i) const
    {
        PathSlot s;
        take_path(i, s);
        slots.store(i, s);
    }
};

/// What a step does with a path. @tparam Samples  where samples go
template <class Samples>
struct SlotStep : PathSlots {
    Samples samples;

protected:
    /// Adds the light of the last surface that is not in shadow.
    GI_FN void light(std::size_t i) const
    {
        vec3 const comes = shadows.load(i).reach > 0 ? left.load(i) : vec3{0};
        if (comes != vec3{0}) lights.store(i, lit(lights.load(i), comes));
    }
    /// From the surface that a path met to its next ray, and the shadow ray of the light there.
    GI_FN void scatter(std::size_t i, PathSlot& s) const
    {
        Path p;
        PathCarry const carry = carried.load(i);
        static_cast<PathState&>(p) = carry.state;
        p.emitted = carry.emitted != 0;
        p.share = carry.share;
        p.rng = carry.rng;
        p.ray = queries.load(i).ray;
        Hit const hit = hits.load(i);
        if (hit.triangle != kNoTriangle && !steps.world.light_select.empty()) steps.choose_light(p);
        PathCounts lost;
        bool const goes_on = steps.advance(p, hit, s.vertex, lost);
        if (lost.cut_paths > 0) atomic_add(counts_of(i).cut_paths, lost.cut_paths);
        bool const asks = needs_shadow_ray(p);
        if (asks) ++s.shadow_rays;
        shadows.store(i, asks ? p.shadow : no_query());
        PathLight light = lights.load(i);
        for (std::size_t k = 0; k < 3; ++k) light.radiance[k] += p.sample.radiance[k];
        light.unshadowed = p.shadow_radiance;
        light.scatterings = p.shadow_scatterings;
        lights.store(i, light);
        if (s.vertex == 0) {
            PathSample const& at = p.sample;
            seen.store(i, {at.albedo, at.normal, at.position, at.depth, at.hit ? 1u : 0u, at.turn});
            if (s.number + 1 == paths && !first_hits.empty()) first_hits[s.pixel] = p.first;
        }
        ++s.vertex;
        if (goes_on) return go_on(i, s, p);
        s.stage = PathStage::ended;
        queries.store(i, no_query());
    }
    /// Adds the sample of a path, and takes the next one.
    GI_FN void end(std::size_t i, PathSlot& s) const
    {
        PathLight const light = lights.load(i);
        FirstSurface const at = seen.load(i);
        PathSample sample;
        sample.radiance = light.radiance;
        sample.albedo = at.albedo;
        sample.normal = at.normal;
        sample.position = at.position;
        sample.depth = at.depth;
        sample.hit = at.hit != 0;
        sample.turn = at.turn;
        if (std::uint32_t const invalid = discard_invalid(sample); invalid > 0)
            atomic_add(counts_of(i).invalid_paths, std::uint64_t(invalid));
        samples.add(s.pixel, s.number, sample);
        added[s.pixel] = s.number + 1;
        take_path(i, s);
    }
};

/// One surface further.
template <class Samples>
struct ScatterPaths : SlotStep<Samples> {
    GI_FN void operator()(std::size_t i) const
    {
        PathSlot s = this->slots.load(i);
        if (s.stage == PathStage::idle) return;
        this->light(i);
        if (s.stage == PathStage::may_add)
            this->end(i, s);
        else if (s.stage == PathStage::goes_on)
            this->scatter(i, s);
        else
            this->shadows.store(i, no_query()); // it has been answered; the path waits for its turn
        if (s.stage == PathStage::ended && this->added[s.pixel] == s.number) s.stage = PathStage::may_add;
        this->slots.store(i, s);
    }
};

/// Traces paths to their ends: the last ones are too few to fill a device. @tparam panes  see KernelRays
template <class Samples, bool panes>
struct FinishPaths : SlotStep<Samples> {
    KernelRays rays;

    GI_FN void operator()(std::size_t i) const
    {
        PathSlot s = this->slots.load(i);
        if (s.stage == PathStage::idle) return;
        add_light(i);
        while (s.stage == PathStage::goes_on) {
            this->hits.store(i, rays.nearest(this->steps.world, this->queries.load(i)));
            this->scatter(i, s);
            add_light(i);
        }
        if (s.stage == PathStage::ended && this->added[s.pixel] == s.number) s.stage = PathStage::may_add;
        this->slots.store(i, s);
    }

private:
    GI_FN void add_light(std::size_t i) const
    {
        RayQuery const shadow = this->shadows.load(i);
        if (!(shadow.reach > 0)) return;
        vec3 const comes = rays.template transmittance<panes>(this->steps.world, shadow);
        if (comes != vec3{0}) this->lights.store(i, lit(this->lights.load(i), comes));
        this->shadows.store(i, no_query());
    }
};

} // namespace gi
