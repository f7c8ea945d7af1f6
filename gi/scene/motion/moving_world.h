#pragma once
// A World that can be advanced in time and edited at a cost proportional to what changed. Its arrays are always
// bit for bit those that build_world would give for the current state of the scene, at the same origin.

#include "gi/scene/model/world_parts.h"

#include <string>
#include <vector>

namespace gi {

/// What changed in an update. Tables derived within the World are already up to date; data derived elsewhere (hit
/// buffers, BVHs, shadow maps, copies on a device) must be updated by its owners.
struct Changes {
    bool geometry = false; ///< vertices, corners and Surfaces of triangles that can move
    bool bounds = false;
    bool materials = false;    ///< materials, bsdfs, flags of Surfaces
    bool coverage = false;     ///< what rays go through: masks, blending, panes
    bool lights = false;       ///< punctual lights
    bool emitters = false;     ///< which triangles emit, or how much
    bool environment = false;  ///< the map, its rotation or scale
    bool light_select = false; ///< light_select, emitters, emitter_pdf or environment_pdf
    bool cameras = false;
    std::uint32_t moved_instances = 0,
                  moved_triangles = 0; ///< number that actually moved; data of others is unchanged
    std::uint64_t flat_triangles = 0;  ///< can move and currently have no area or a non-finite vertex
    /// For --stats: "3 of 4 moving instances, 2496 triangles (skin, clip 'walk')".
    std::vector<std::string> reasons;

    bool any() const
    {
        return geometry || bounds || materials || coverage || lights || emitters || environment || light_select ||
               cameras;
    }
    /// Adds the changes of a later update.
    void add(Changes const& later);
};

/// After a change, call view(world()) again, because all arrays except vertices, triangles and Surfaces may have
/// been reallocated. Not thread-safe.
class MovingWorld {
public:
    /// As build_world.
    MovingWorld(std::shared_ptr<Scene const> scene, double time_s, Report& report,
                std::optional<dvec3> origin = std::nullopt);

    World const& world() const { return parts_.world; }
    /// Returns the instances that can move, with their reasons, in the order of their triangles.
    std::vector<Instance> const& moving() const { return parts_.moving; }
    /// True if advance(time_s) changes nothing but cameras.
    bool only_cameras_move() const;

    /// Advances to the pose of the playing clips at this time.
    Changes advance(double time_s);
    /// Advances to a pose of the same scene from another source;
    /// only driven nodes and those that clips move may differ.
    Changes advance(Pose const& pose);

    /// @param k  index into World::lights. Position and direction last only if the light's node cannot move;
    /// otherwise the next advance() resets them to the node's. Throws InputError if there is
    /// no such light, or if it is not finite.
    Changes set_light(std::size_t k, Light const& light);
    /// The intensity that the scene gives light k, whatever set_light() did.
    vec3 authored_intensity(std::size_t k) const { return authored_[parts_.light_place[k]]; }
    /// @param k  index into World::materials. Throws InputError if there is no such material, or if it refers to
    /// textures that the scene does not have.
    Changes set_material(std::size_t k, Material const& material);
    /// Sets the environment map, null = none. Rotation and scale are taken from the map. Throws InputError if its
    /// size does not match its number of texels.
    Changes set_environment(std::shared_ptr<EnvironmentMap const> map);
    /// Rotates and scales the current map. Throws InputError if the scale is negative or not finite.
    Changes turn_environment(float rotation_rad, vec3 scale);

private:
    void move_instances(Pose const& pose, Changes& changes);
    void renew_emitters(Changes& changes);
    void renew_light_select(Changes& changes);
    void check_environment(vec3 scale) const;

    WorldParts parts_;
    std::vector<InstancePlacement> next_; ///< per moving instance
    std::vector<bool> light_moves_;       ///< per light place: its node can move
    std::vector<vec3> authored_;          ///< per light place: its intensity in the scene
};

} // namespace gi
