#pragma once
// Flat mirrors of a scene: what they show is drawn as geometry, for the newest pose, as all else.

#include "gi/surfaces/shown_scene.h"

#include <vector>

namespace viewer {

struct PlanarMirror {
    glm::vec3 normal{0};  ///< unit
    float distance_m = 0; ///< dot(normal, place) of its places, which count from the world's origin
    gi::Bounds bounds;    ///< of its triangles
    float area_m2 = 0;
};

class PlanarMirrors {
public:
    /// Of a scene as it is when it is new.
    void take(gi::ShownScene const& scene);
    /// Of what has moved.
    void move(gi::ShownScene::Moved const& now);
    std::vector<PlanarMirror> const& all() const { return mirrors_; }

private:
    /// Triangles of a mirror.
    struct Group {
        bool moves = false;
        std::vector<gi::uvec3> triangles; ///< into all vertices, or those that can move
    };
    static PlanarMirror mirror_of(Group const& group, std::vector<gi::vec3> const& positions);

    std::vector<PlanarMirror> mirrors_;
    std::vector<Group> groups_; ///< of the same
};

} // namespace viewer
