#pragma once
// Exact ray queries against a World through Embree (robust, watertight mode), in packets.
// Only triangles with a (partly) transparent material go through the filter that tests coverage; partial coverage
// is a random decision per ray and triangle that does not depend on traversal order. Panes have a geometry of their
// own, which only rays towards lamps go through.
// If the scene has dynamic geometry, that gets a BVH of its own beside the static one, and only the dynamic BVH
// is updated, by refitting its boxes. Measured against rebuilding it: docs/decisions/bvh.md.

#include "gi/core/progress.h"
#include "gi/render/embree.h"
#include "gi/render/panes.h"
#include "gi/scene/model/world.h"

#include <cstdint>
#include <memory>
#include <span>

namespace gi {

class ExactVisibility {
public:
    /// Copies the vertices; with alpha tests or panes, `world` must outlive this object. threads 0 = all.
    /// @param first_moving  index of the first triangle that may move; all later ones may move too
    /// @param stop  checked while the BVH is built, which throws Interrupted if a stop is requested; null = never
    ExactVisibility(World const& world, bool alpha_tests, int threads, std::size_t first_moving = ~std::size_t(0),
                    StopRequest const* stop = nullptr);
    /// Updates the vertices of the triangles that may move. Materials must not have changed.
    void moved(World const& world);

    /// Finds the nearest triangle along each ray. hits.size() == queries.size()
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits, RayWorld met = RayWorld::all) const;
    /// Tests whether anything lies between origin and origin + reach * direction. blocked.size() ==
    /// queries.size(); 1 = yes
    void occluded(std::span<RayQuery const> queries, std::span<std::uint8_t> blocked,
                  RayWorld met = RayWorld::all) const;
    /// The share of light that comes through between origin and origin + reach * direction: 0 or 1, or what panes
    /// leave of a lamp's light (RayQuery::to_lamp). left.size() == queries.size()
    void transmittance(std::span<RayQuery const> queries, std::span<vec3> left,
                       RayWorld met = RayWorld::all) const;

    /// Intersection context with the data that filters need. `rtc` comes first, so that they can reach the rest from
    /// Embree's pointer.
    struct Context {
        explicit Context(ExactVisibility const& visibility) : owner(&visibility) { embree::begin(rtc); }
        embree::Context rtc;
        ExactVisibility const* owner;
        bool met_pane = false;              ///< some ray to a lamp went through one
        RayQuery const* crossing = nullptr; ///< the only ray, whose crossings are noted; null = they are not
        PaneCrossings crossings;
    };
    RTCScene scene() const { return scene_.get(); }

private:
    static constexpr unsigned kOpaque = 0, kCutOut = 1, kPane = 2, kGeometries = 3; ///< Embree's geometry ids

    struct ReleaseDevice {
        void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
    };
    struct ReleaseScene {
        void operator()(RTCScene s) const { rtcReleaseScene(s); }
    };
    using ScenePointer = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;

    /// The static or the dynamic geometry.
    struct Part {
        std::uint32_t first = 0, last = 0; ///< triangles of the world
        std::uint32_t first_vertex = 0;    ///< in the world; Embree's vertex indices start here
        /// Per geometry: indices of the world's triangles; empty = all, in order.
        std::vector<std::uint32_t> triangles[kGeometries];
        ScenePointer scene;
        RTCGeometry geometries[kGeometries] = {}; ///< owned by the scene; null = none
        vec3* positions = nullptr;      ///< Embree's copy of the vertices
        bool usable = false;            ///< true if all triangles were usable when the BVH was built

        std::uint32_t world_triangle(unsigned geometry_id, std::uint32_t primitive) const
        {
            return triangles[geometry_id].empty() ? first + primitive : triangles[geometry_id][primitive];
        }
    };

    struct FilteredHit {
        std::uint32_t triangle;
        vec2 barycentric;
    };
    FilteredHit filtered(RTCFilterFunctionNArguments const* arguments, unsigned i) const;
    static void coverage_filter(RTCFilterFunctionNArguments const* arguments);
    static void pane_filter(RTCFilterFunctionNArguments const* arguments);
    unsigned geometry_of(Material const& material) const;
    void build(World const& world, bool moves, Part& part);
    void add_triangles(World const& world, RTCBuffer positions, unsigned geometry_id, bool moves, Part& part);
    void build_moving(World const& world);
    ScenePointer scene_of_parts(unsigned count) const;
    void check() const;
    /// @param instance  Embree's instance id, or none
    Part const& part_of(unsigned instance) const { return parts_[instance == 1 ? 1 : 0]; }

    std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice> device_;
    Part parts_[2];      ///< static, dynamic; the second is empty without dynamic geometry
    ScenePointer scene_; ///< traced by rays: the first part's own scene, or one with instances of both
    ScenePointer still_; ///< with an instance of the first part only; null without dynamic geometry
    StopRequest const* stop_;
    WorldView world_;
    bool alpha_tests_, panes_;
};

} // namespace gi
