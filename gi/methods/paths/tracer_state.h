#pragma once
// State of PathsTracer's paths while they advance. Only for the tracer's own .cpp files.

#include "gi/render/path_random.h"
#include "gi/methods/paths/tracer.h"
#include "gi/render/path_batch.h"
#include "gi/scene/shading/narrow_lobes.h"

#include <algorithm>

namespace gi {

/// State of one path that has arrived at a surface.
struct PathsTracer::State : PathState {
    RqmcStream random;
    std::uint32_t triangle, pixel;
    vec2 barycentric;
    vec3 position; ///< only read where has_position
    bool has_position = false;
    vec3 direction;          ///< of arrival
    bool along_axis = false; ///< arrived by a broad lobe (along an axis if look-ups are used)
    bool seen = true;        ///< the way so far is that to the surface which the pixel shows (seen_mirror.h)
    bool emitted = false;    ///< emission of its surface has already been added
    int vertex = 0;
    float footprint = 0; ///< approximate width of the bundle of paths that this one represents, m
    int open = -1;       ///< index of the note about its surface; -1 = none
    PathSample* sample;

    VertexNumbers* u = nullptr; ///< of the current vertex

    std::uint32_t dimension(PathDimension d) const { return dimension_of(std::uint32_t(vertex), d); }
    std::uint32_t shadow_seed() const
    {
        return hash_words(random.own_seed() + std::uint32_t(vertex), ~random.index);
    }
};

/// Next segment of a path from its surface.
struct PathsTracer::Vertex {
    std::uint32_t path;
    bool exact;
    Ray ray;           ///< if exact
    WalkOrigin origin; ///< otherwise
    std::uint32_t axis;
    LayerHit hit; ///< result of the look-up
    std::uint32_t layer;
    bool near_moving; ///< see QueryBatch
    float distance;   ///< m, to the surface hit
};

/// A note for the radiance cache whose path is still being traced.
struct PathsTracer::Open {
    std::uint32_t path;
    CacheKeys keys;
    vec3 throughput, before; ///< on arrival: the path's throughput, and its indirect light so far
    float weight;
    bool directional = false;
};

/// Direct light waiting for its shadow ray.
struct PathsTracer::ShadowRay {
    RayQuery query;
    vec3 radiance;
    vec3* to;
};

/// Direct light waiting for its shadow map look-up.
struct PathsTracer::Unshadowed {
    LightPoint const* light_point;
    ShadowMap::Place place;
    vec3 position;
    std::uint32_t triangle;
    vec3 radiance;
    vec3* to;
    PathSample* sample;
    bool of_lamp;       ///< without extent
    std::uint32_t seed; ///< of an exact ray in its place
};

/// Direct light of a block of paths, waiting for visibility tests.
struct PathsTracer::Direct {
    std::vector<Unshadowed> maps;
    std::vector<ShadowRay> rays;
    std::vector<RayQuery> queries; ///< of the rays
    std::vector<vec3> left;        ///< of their light
};

/// A surface that a path leaves.
struct PathsTracer::Leaving {
    ShadingPoint const& at;
    vec3 wo;                  ///< local
    bool narrow;              ///< some lobe is sampled by exact rays
    bool alone;               ///< light samples must account for all light, as no path continues to hit it
    bool no_punctual = false; ///< light of punctual lights is left out

    /// Probability density with which paths leave along wi, 1/sr. @param bsdf  for wi, see evaluate
    float pdf(BsdfValue const& bsdf, vec3 wi) const { return narrow ? bsdf.pdf : std::max(wi.z, 0.0f) * kInvPi; }
};

} // namespace gi
