#pragma once
// Draws the surfaces of a scene for a newer camera than that of the last finished picture, with the light of that
// picture. The first pass describes what each pixel shows, the second lights it, once a pixel; then come the sky, what
// mirrors and panes show (that of the last picture, by reprojection), and blended surfaces. Textures, outlines and
// parallax are those of the new camera; light is as old as its pictures.

#include "viewer/devices/gl/light_ring.h"
#include "viewer/devices/gl/reprojection.h"
#include "viewer/devices/gl/scene_meshes.h"

#include <map>

namespace viewer {

/// Belongs to the context that was current at its creation.
class SurfaceRenderer {
public:
    /// Surfaces from now on. What is large is uploaded by prepare().
    void take(std::shared_ptr<gi::ShownScene const> scene);
    void add_light(int view, gi::LightPicture const& light)
    {
        ring_.add(view, light, meshes_.scene().world->origin);
    }
    bool has_light() const { return !ring_.empty(); }
    /// Moves what can move, until the next take().
    void move(gi::Pose const& pose) { meshes_.move(*gi::moved_to(meshes_.scene(), pose)); }
    bool can_move() const { return has_scene_ && !meshes_.scene().moving->instances.empty(); }
    /// Uploads and compiles for about so long; true when surfaces can be drawn.
    bool prepare(double most_s);

    /// Linear radiance at size_px. The result is valid until the view's next one.
    /// @param picture  the last one of the view, with depth, of camera `of`
    ShownPicture draw(int view, gi::Camera const& camera, glm::ivec2 size_px, PictureTexture const& picture,
                      gi::Camera const& of);

private:
    struct Target {
        std::optional<TextureTarget> described, color;
        GlObject depth;
    };
    enum class Pass : std::uint8_t { described, mirrors, blended };
    void set_moved_box(GlProgram const& program) const;
    static bool takes_part(SurfaceKind const& kind, Pass pass);
    GlProgram& program(SurfaceKind const& kind, Pass pass);
    void draw_batches(Pass pass, int view, gi::Camera const& camera, glm::ivec2 size_px);
    void light(int view, gi::Camera const& camera, glm::ivec2 size_px, TextureTarget const& described);
    void draw_sky(gi::Camera const& camera, glm::ivec2 size_px);

    bool has_scene_ = false, is_ready_ = false;
    SceneMeshes meshes_;
    LightRing ring_;
    std::map<std::string, GlProgram> programs_;
    std::optional<GlProgram> lit_, sky_;
    ReprojectionMaps maps_; ///< from the last picture, and its greatest 1 / depth
    float nearest_ = 0;
    std::map<int, Target> targets_;
    GlObject no_vertices_{GlObject::Kind::vertex_array};
};

} // namespace viewer
