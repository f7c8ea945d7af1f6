#pragma once
// Exact ray queries against a World through Embree 3 (robust, watertight mode).
// Where the scene plan asks for alpha tests, a filter lets rays pass through uncovered texels; partial coverage is
// a random decision per ray and triangle that does not depend on traversal order.

#include "gi/scene/world.h"

#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>

namespace gi {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct Hit {
    std::uint32_t triangle = kNoTriangle; ///< index into World::triangles, kNoTriangle = missed
    vec2 barycentric{0};                  ///< weights of vertices 1 and 2
    float distance = kInf;
};

class ExactVisibility {
public:
    /// Copies the vertices; `world` must outlive this where alpha tests are on. threads 0 = all.
    ExactVisibility(World const& world, bool alpha_tests, int threads);

    /// Nearest triangle beyond origin. @param seed decides partial coverage
    Hit nearest(vec3 origin, vec3 direction, std::uint32_t seed) const
    {
        RTCRayHit query;
        set_ray(query.ray, origin, direction, kFar, seed);
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        Context context(*this);
        rtcIntersect1(scene_.get(), &context.rtc, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
        return {query.hit.primID, {query.hit.u, query.hit.v}, query.ray.tfar};
    }

    /// Is anything between origin and origin + distance * direction?
    bool occluded(vec3 origin, vec3 direction, float distance, std::uint32_t seed) const
    {
        RTCRay ray;
        set_ray(ray, origin, direction, distance, seed);
        Context context(*this);
        rtcOccluded1(scene_.get(), &context.rtc, &ray);
        return ray.tfar < 0;
    }

private:
    static constexpr float kFar = 1e30f;

    struct Context {
        explicit Context(ExactVisibility const& owner) : world(&owner.world_) { rtcInitIntersectContext(&rtc); }
        RTCIntersectContext rtc; // first, so that the filter finds `world` behind it
        WorldView const* world;
    };

    static void set_ray(RTCRay& ray, vec3 o, vec3 d, float distance, std::uint32_t seed)
    {
        ray.org_x = o.x;
        ray.org_y = o.y;
        ray.org_z = o.z;
        ray.tnear = 0;
        ray.dir_x = d.x;
        ray.dir_y = d.y;
        ray.dir_z = d.z;
        ray.time = 0;
        ray.tfar = distance;
        ray.mask = 0xffffffffu;
        ray.id = seed;
        ray.flags = 0;
    }

    static void coverage_filter(RTCFilterFunctionNArguments const* arguments);

    struct ReleaseDevice {
        void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    };
    struct ReleaseScene {
        void operator()(RTCScene s) const { rtcReleaseScene(s); }
    };
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene> scene_;
    WorldView world_;
};

} // namespace gi
