#pragma once
// Flat mirrors of a scene: what they show is drawn as geometry, for the newest pose, as all else. What other mirrors and
// panes show is in rendered pictures alone.

#include "gi/surfaces/lit_picture.h"
#include "gi/surfaces/mirror_boxes.h"
#include "gi/surfaces/shown_scene.h"

#include <vector>

namespace gi {

struct PlanarMirror : MirrorPlane {
    Bounds bounds; ///< of its triangles
    float area_m2 = 0;
};

class PlanarMirrors {
public:
    /// Of a scene as it is when it is new.
    void take(ShownScene const& scene);
    /// Of what has moved.
    void move(ShownScene::Moved const& now);
    std::vector<PlanarMirror> const& all() const { return mirrors_; }
    static constexpr std::size_t kMostDrawn = 2; ///< of those in a picture, the largest
    /// Of the scene's radius: what is so far from a mirror's plane is no part of it.
    static constexpr float kFlat = 4e-4f;
    /// Keeps what a picture of light shows in some of these mirrors, as light of the surfaces where they are; removes other images.
    void keep_images(LightPicture& light, std::span<SeenImage const> images, dvec3 origin) const;
    /// Pixels that may show mirrors or panes that are not drawn. @param width, height  px
    PixelBox left_out(CameraRays const& camera, int width, int height) const;

private:
    /// Triangles of a mirror.
    struct Group {
        bool moves = false;
        std::size_t instance = 0;     ///< of what moves
        std::vector<uvec3> triangles; ///< into all vertices, or those that can move
    };
    static PlanarMirror mirror_of(Group const& group, std::vector<vec3> const& positions);

    std::vector<PlanarMirror> mirrors_;
    std::vector<Group> groups_;  ///< of the same
    std::vector<Bounds> others_; ///< of all other mirrors and panes; infinite: they move
    float flat_m_ = 0;           ///< kFlat
    bool is_bent_ = false;       ///< a mirror has become so
};

} // namespace gi
