#pragma once
// Exact ray queries against a World through Embree 3 (robust, watertight mode), in packets.
// Only triangles whose material can be seen through pass the filter that tests coverage; partial coverage is a
// random decision per ray and triangle that does not depend on traversal order.

#include "gi/scene/camera.h"
#include "gi/scene/world.h"

#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>
#include <span>

namespace gi {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct Hit {
    std::uint32_t triangle = kNoTriangle; ///< index into World::triangles, kNoTriangle = missed
    vec2 barycentric{0};                  ///< weights of vertices 1 and 2
    float distance = kInf;
};

struct RayQuery {
    static constexpr float kFar = 1e30f;

    Ray ray;
    float reach = kFar;     ///< m; what lies beyond does not count
    std::uint32_t seed = 0; ///< decides partial coverage
};

class ExactVisibility {
public:
    /// Copies the vertices; `world` must outlive this where alpha tests are on. threads 0 = all.
    ExactVisibility(World const& world, bool alpha_tests, int threads);

    /// Nearest triangle beyond each origin. hits.size() == queries.size()
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits) const;
    /// Is anything between origin and origin + reach * direction? blocked.size() == queries.size(); 1 = yes
    void occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked) const;

    /// What a query needs to know for the filter; `rtc` first, so that the filter finds the rest behind it.
    struct Context {
        explicit Context(ExactVisibility const& visibility) : owner(&visibility) { rtcInitIntersectContext(&rtc); }
        RTCIntersectContext rtc;
        ExactVisibility const* owner;
    };
    RTCScene scene() const { return scene_.get(); }

private:
    static constexpr unsigned kOpaque = 0, kCutOut = 1; ///< Embree's geometry ids

    static void coverage_filter(RTCFilterFunctionNArguments const* arguments);
    void add_triangles(World const& world, RTCBuffer positions, unsigned geometry_id);
    std::uint32_t world_triangle(unsigned geometry_id, std::uint32_t primitive) const
    {
        return triangles_[geometry_id].empty() ? primitive : triangles_[geometry_id][primitive];
    }

    struct ReleaseDevice {
        void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    };
    struct ReleaseScene {
        void operator()(RTCScene s) const { rtcReleaseScene(s); }
    };
    std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device_;
    std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene> scene_;
    std::vector<std::uint32_t> triangles_[2]; ///< of each geometry, as indices into World::triangles; empty = all
    WorldView world_;
};

} // namespace gi
