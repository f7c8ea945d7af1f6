#pragma once
// A World that is taken from one moment to the next, and changed by hand, at the cost of what changed. At every
// time its arrays are, bit for bit, those of build_world for the scene as it then is, at the same origin.

#include "gi/scene/model/world_parts.h"

#include <string>
#include <vector>

namespace gi {

/// What is no longer as it was. Tables that follow from it within the World are up to date already; what others
/// derived (hit buffers, BVHs, shadow maps, copies on a device) is theirs to renew.
struct Changes {
    bool geometry = false; ///< vertices, corners and Surfaces of triangles that can move
    bool bounds = false;
    bool materials = false;    ///< materials, bsdfs, flags of Surfaces
    bool coverage = false;     ///< where a material lets rays through: masks, blending
    bool lights = false;       ///< punctual lights
    bool emitters = false;     ///< which triangles emit, or how much
    bool environment = false;  ///< the map, its rotation or scale
    bool light_select = false; ///< light_select, emitters, emitter_pdf or environment_pdf
    bool cameras = false;
    std::uint32_t moved_instances = 0,
                  moved_triangles = 0; ///< those that did move; the others' arrays are untouched
    std::uint64_t flat_triangles = 0;  ///< that can move and have no area now, or a vertex that is not finite
    std::vector<std::string>
        reasons; ///< for --stats: "3 of 4 moving instances, 2496 triangles (skin, clip 'walk')"

    bool any() const
    {
        return geometry || bounds || materials || coverage || lights || emitters || environment || light_select ||
               cameras;
    }
    /// Of this and, after it, that.
    void add(Changes const& later);
};

/// Arrays may move in memory when something changes, but for the vertices, triangles and Surfaces: take
/// view(world()) anew. Not for use by several threads at once.
class MovingWorld {
public:
    /// As build_world.
    MovingWorld(std::shared_ptr<Scene const> scene, double time_s, Report& report,
                std::optional<dvec3> origin = std::nullopt);

    World const& world() const { return parts_.world; }
    /// Instances that can move, in the order of their triangles, and why.
    std::vector<Instance> const& moving() const { return parts_.moving; }

    /// To what the clips that play say of this time.
    Changes advance(double time_s);
    /// To a pose that something else made, of the same scene: only driven nodes and those that clips move may
    /// differ.
    Changes advance(Pose const& pose);

    /// @param k  index into World::lights. Place and direction count only where the light's node cannot move: else
    /// they are the node's again with the next advance. Throws InputError where there is no such light, or it is
    /// not finite.
    Changes set_light(std::size_t k, Light const& light);
    /// @param k  index into World::materials. Throws InputError where there is no such material, or its textures
    /// are not the scene's.
    Changes set_material(std::size_t k, Material const& material);
    /// Null: none. Rotation and scale are the map's. Throws InputError where its size is not that of its texels.
    Changes set_environment(std::shared_ptr<EnvironmentMap const> map);
    /// Turn and scale the map that is there. Throws InputError for a scale that is negative or not finite.
    Changes turn_environment(float rotation_rad, vec3 scale);

private:
    void move_instances(Pose const& pose, Changes& changes);
    void renew_emitters(Changes& changes);
    void renew_light_select(Changes& changes);
    void check_environment(vec3 scale) const;

    WorldParts parts_;
    std::vector<InstancePlacement> next_; ///< per moving instance
    std::vector<bool> light_moves_;       ///< per light place: its node can move
};

} // namespace gi
