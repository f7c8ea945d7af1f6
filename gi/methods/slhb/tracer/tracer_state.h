#pragma once
// What SlhbTracer keeps of its paths while they advance. For tracer.cpp and tracer_shading.cpp alone.

#include "gi/methods/slhb/kernels/path_random.h"
#include "gi/methods/slhb/tracer/tracer.h"
#include "gi/scene/shading/narrow_lobes.h"
#include "gi/scene/shading/shading_point.h"

#include <algorithm>

namespace gi {

/// One path on its way: how it arrived at a surface.
struct SlhbTracer::State {
    RqmcStream random;
    std::uint32_t triangle, pixel;
    vec2 barycentric;
    vec3 position; ///< only read where has_position
    bool has_position = false;
    vec3 direction; ///< of arrival
    vec3 throughput{1};
    float arrival_pdf = 0;   ///< of the direction, 1/sr; 0 = camera or delta lobe
    bool along_axis = false; ///< came by a broad lobe: along an axis, where there are look-ups
    bool emitted = false;    ///< what its surface emits has been added
    int scatterings = 0, vertex = 0;
    float footprint = 0; ///< m across, of the bundle of paths that this one stands for, about
    int open = -1;       ///< index of the note that its surface gets
    PathSample* sample;

    VertexNumbers* u = nullptr; ///< of its vertex

    std::uint32_t dimension(PathDimension d) const { return dimension_of(std::uint32_t(vertex), d); }
    vec3& bucket(int scattered) const { return sample->radiance[std::size_t(std::min(scattered, 2))]; }
};

/// Where a path wants to go from its surface.
struct SlhbTracer::Vertex {
    std::uint32_t path;
    bool exact;
    Ray ray;           ///< exact
    WalkOrigin origin; ///< else
    std::uint32_t axis;
    LayerHit hit; ///< answer of a query
    std::uint32_t layer;
    bool near_moving; ///< see QueryBatch
    float distance;   ///< m, to what it met
};

/// A note for the radiance cache whose path is under way.
struct SlhbTracer::Open {
    std::uint32_t path;
    CacheKeys keys;
    vec3 throughput, before; ///< of the path when it arrived; what it had brought by then
    float weight;
    bool directional = false;
};

/// Direct light that waits for its shadow ray.
struct SlhbTracer::ShadowRay {
    RayQuery query;
    vec3 radiance;
    vec3* to;
};

/// Direct light that waits for its shadow map.
struct SlhbTracer::Unshadowed {
    LightPoint const* light_point;
    ShadowMap::Place place;
    vec3 position;
    std::uint32_t triangle;
    vec3 radiance;
    vec3* to;
    PathSample* sample;
};

/// Direct light of a block of paths that waits for what is in its way.
struct SlhbTracer::Direct {
    std::vector<Unshadowed> maps;
    std::vector<ShadowRay> rays;
    std::vector<RayQuery> queries; ///< of the rays
    std::vector<std::uint8_t> blocked;
};

/// A surface that a path leaves.
struct SlhbTracer::Leaving {
    ShadingPoint const& at;
    vec3 wo;     ///< local
    bool narrow; ///< some lobe is for exact rays
    bool alone;  ///< light samples have to find all light: no path goes on to meet it

    /// Density with which paths leave along wi, 1/sr. @param bsdf  of wi, see evaluate
    float pdf(BsdfValue const& bsdf, vec3 wi) const { return narrow ? bsdf.pdf : std::max(wi.z, 0.0f) * kInvPi; }
};

/// From a surface to just before a lamp; its reach is not positive where that lies on the surface.
inline RayQuery shadow_ray(vec3 position, vec3 normal, float clearance, LightSample const& light,
                           std::uint32_t seed)
{
    float const side = glm::dot(light.direction, normal) > 0 ? clearance : -clearance;
    RayQuery q{.ray = {position + side * normal, light.direction}, .reach = light.distance, .seed = seed};
    if (light.distance == kInf) return q;
    // As the reference aims: from where the ray starts to short of the lamp by more than the rounding of both
    // ends.
    vec3 const way = position + light.distance * light.direction - q.ray.origin;
    float const length = glm::length(way);
    q.ray.direction = way / length;
    q.reach = length * (1 - 2e-5f) - clearance;
    return q;
}

} // namespace gi
