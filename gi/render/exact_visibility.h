#pragma once
// Exact ray queries against a World through Embree 3 (robust, watertight mode), in packets.
// Only triangles whose material can be seen through pass the filter that tests coverage; partial coverage is a
// random decision per ray and triangle that does not depend on traversal order.
// Where something moves, it has a BVH of its own beside that of what stays, and only that one follows: its boxes
// are refitted. Measured against building it anew: docs/results/2026-11-21-moving.md.

#include "gi/core/progress.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

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
    float start = 0;        ///< m; what lies nearer does not count
};

/// What of the world rays can meet.
enum class RayWorld : std::uint8_t {
    all,
    what_stays ///< triangles that may move are passed by
};

class ExactVisibility {
public:
    /// Copies the vertices; `world` must outlive this where alpha tests are on. threads 0 = all.
    /// @param first_moving  triangle; all from there on may move
    /// @param stop  throws Interrupted where it asks for it while the BVH is built; null = it cannot be
    ExactVisibility(World const& world, bool alpha_tests, int threads, std::size_t first_moving = ~std::size_t(0),
                    StopRequest const* stop = nullptr);
    /// The vertices of triangles that may move are elsewhere now. Materials are as they were.
    void moved(World const& world);

    /// Nearest triangle beyond each origin. hits.size() == queries.size()
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits, RayWorld met = RayWorld::all) const;
    /// Is anything between origin and origin + reach * direction? blocked.size() == queries.size(); 1 = yes
    void occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked,
                  RayWorld met = RayWorld::all) const;

    /// What a query needs to know for the filter; `rtc` first, so that the filter finds the rest behind it.
    struct Context {
        explicit Context(ExactVisibility const& visibility) : owner(&visibility) { rtcInitIntersectContext(&rtc); }
        RTCIntersectContext rtc;
        ExactVisibility const* owner;
    };
    RTCScene scene() const { return scene_.get(); }

private:
    static constexpr unsigned kOpaque = 0, kCutOut = 1; ///< Embree's geometry ids

    struct ReleaseDevice {
        void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    };
    struct ReleaseScene {
        void operator()(RTCScene s) const { rtcReleaseScene(s); }
    };
    using ScenePointer = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

    /// What stays, or what moves.
    struct Part {
        std::uint32_t first = 0, last = 0;       ///< triangles of the world
        std::uint32_t first_vertex = 0;          ///< of the world; Embree's are counted from there
        std::vector<std::uint32_t> triangles[2]; ///< of each geometry, of the world; empty = all in their order
        ScenePointer scene;
        RTCGeometry geometries[2] = {}; ///< held by the scene; null = not there
        vec3* positions = nullptr;      ///< Embree's copy of the vertices
        bool usable = false;            ///< all of them, when it was built

        std::uint32_t world_triangle(unsigned geometry_id, std::uint32_t primitive) const
        {
            return triangles[geometry_id].empty() ? first + primitive : triangles[geometry_id][primitive];
        }
    };

    static void coverage_filter(RTCFilterFunctionNArguments const* arguments);
    void build(World const& world, bool moves, Part& part);
    void add_triangles(World const& world, RTCBuffer positions, unsigned geometry_id, bool moves, Part& part);
    void build_moving(World const& world);
    ScenePointer scene_of_parts(unsigned count) const;
    void check() const;
    /// @param instance  Embree's, or none
    Part const& part_of(unsigned instance) const { return parts_[instance == 1 ? 1 : 0]; }

    std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device_;
    Part parts_[2];      ///< the second one is empty where nothing moves
    ScenePointer scene_; ///< that rays go through: the first part's own, or one with instances of both
    ScenePointer still_; ///< with an instance of the first part alone; null where nothing moves
    StopRequest const* stop_;
    WorldView world_;
    bool alpha_tests_;
};

} // namespace gi
