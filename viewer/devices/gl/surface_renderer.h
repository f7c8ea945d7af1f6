#pragma once
// Draws the surfaces of a scene for a newer camera than that of the last finished picture, with the light of that
// picture. The first pass describes what each pixel shows, the second finds the light of every second pixel of every
// second row, the third lights all of them, by the light of alike surfaces around; then come punctual lights, the sky, what flat mirrors show (all of this once more, from behind them), what other mirrors and panes show (that of the last
// picture, by reprojection), and blended surfaces. Textures, outlines, parallax, hard shadows and flat mirrors are
// those of the new camera; other light is as old as its pictures.

#include "gi/surfaces/planar_mirrors.h"
#include "viewer/devices/gl/light_ring.h"
#include "viewer/devices/gl/reprojection.h"
#include "viewer/devices/gl/scene_meshes.h"
#include "viewer/devices/gl/shadow_maps.h"
#include "viewer/devices/gl/shown_depth.h"

#include <map>

namespace viewer {

/// Of what an eye sees.
enum class ViewPart : std::uint8_t { whole, middle };

/// Where the light of a pixel was found: in pictures that show its surface, in cells of space, or nowhere (that of some
/// surface around, or the mean). No surface: the sky, a curved mirror, nothing.
enum class LightSource : std::uint8_t { pictures, cells, nowhere, no_surface };
struct LightSources {
    glm::ivec2 size_px{0};
    std::vector<LightSource> sources; ///< of every second pixel of every second row
};

/// Belongs to the context that was current at its creation.
class SurfaceRenderer {
public:
    /// Surfaces from now on. What is large is uploaded by prepare().
    void take(std::shared_ptr<gi::ShownScene const> scene);
    /// Of the newest frame, of all views that may help: those that others draw, too.
    void add_light(std::vector<LightOfView> const& frame) { ring_.add(frame, meshes_.scene().world->origin); }
    /// Before that of other views.
    void forget_light() { ring_.forget_pictures(); }
    /// What is known of places that no picture shows; null = nothing.
    void take(std::shared_ptr<gi::LightCellTable const> cells) { ring_.take(std::move(cells)); }
    /// What is drawn from now on is of this time, see LightRing::show_at.
    void show_at(double pose_s) { ring_.show_at(pose_s); }
    /// Draw again soon: light fades in.
    bool fades() const { return ring_.fades(); }
    bool has_light() const { return !ring_.empty(); }
    /// Moves what can move, until the next take().
    void move(gi::Pose const& pose);
    /// Punctual lights of the scene as they are now, until the next call.
    void light(std::vector<gi::Light> const& lights) { shadows_.light(lights); }
    bool can_move() const { return has_scene_ && !meshes_.scene().moving->instances.empty(); }
    /// Uploads and compiles for about so long; true when surfaces can be drawn.
    bool prepare(double most_s);

    /// Draws the shadows of what has moved, as draw() would.
    void update_shadows() { shadows_.update(meshes_, eye_); }
    /// Linear radiance at size_px. The result is valid until the next one of this part of the view.
    /// @param head  LightOfView::head of the view
    /// @param picture  the last one of the view, with depth, of camera `of`
    ShownPicture draw(int view, int head, gi::Camera const& camera, glm::ivec2 size_px,
                      PictureTexture const& picture, gi::Camera const& of, ViewPart part = ViewPart::whole);
    /// Of what was drawn last of this part of the view, without blended surfaces. Valid as long.
    ShownDepth depth(int view, ViewPart part = ViewPart::whole) const;
    /// Of what was drawn last of the view, none before. Waits for the GPU.
    LightSources light_sources(int view) const;

private:
    struct Target {
        std::optional<TextureTarget> described, found, color;
        GlObject depth;
        GlObject lighting;               ///< to color, with lit_steps instead of depth
        GlObject found_steps, lit_steps; ///< depths that choose pixels for steps (surface_lit.frag)
    };
    enum class Pass : std::uint8_t { described, mirrors, planar, blended };
    /// What a picture is drawn with.
    struct Eye {
        int head = 0; ///< whose light is asked first
        glm::mat3 clip_from_world{
            1};          ///< of points relative to `at`, to x, y and w; the target's top row is its first
        glm::vec3 at{0}; ///< from the world's origin
        glm::mat3 world_from_pixel{1}; ///< directions with a depth of 1
        glm::vec4 kept{0};             ///< of surfaces.vert
        glm::vec2 low{-1}, high{1};    ///< of the part that is drawn, in clip space over w
        bool in_mirror = false;
    };
    struct DepthRange {
        float nearest = 0, farthest = 0;
    };
    static std::optional<DepthRange> seen_depths(gi::Bounds const& box, Eye const& eye);
    struct Seen {
        float order = 0;
        std::size_t mesh = 0;
        SurfaceBatch const* batch = nullptr;
        SurfaceRange triangles;
    };
    Eye eye_of(int head, gi::Camera const& camera, glm::ivec2 size_px) const;
    static Eye mirrored(Eye const& eye, gi::PlanarMirror const& mirror, float apart);
    static void fit(Target& to, glm::ivec2 size_px);
    float nearest_m() const;
    void bind_light(GlProgram const& program, Eye const& eye) const;
    void set_moved_box(GlProgram const& program) const;
    static bool takes_part(SurfaceKind const& kind, Pass pass);
    GlProgram& program(SurfaceKind const& kind, Pass pass);
    GlProgram const& punctual(std::size_t light);
    std::vector<Seen> seen_clusters(Pass pass, Eye const& eye) const;
    void draw_batches(Pass pass, Eye const& eye);
    struct Part { ///< of a picture
        glm::ivec2 low_px, size_px;
    };
    void light_up(GlProgram const& program, Eye const& eye, Target const& to) const;
    void light_up_in_steps(GlProgram const& first, GlProgram const& second, Eye const& eye,
                           Target const& to) const;
    void draw_lit(Eye const& eye, Target const& to, Part const& part);
    void draw_sky(Eye const& eye);
    void draw_blended(Eye const& eye);
    void draw_mirrors(Eye const& eye, Target const& to, glm::ivec2 size_px);

    bool has_scene_ = false, is_ready_ = false;
    SceneMeshes meshes_;
    LightRing ring_;
    ShadowMaps shadows_;
    gi::PlanarMirrors planar_;
    bool has_drawn_mirrors_ = false; ///< once: drivers compile then
    glm::vec4 plane_{0};             ///< of the flat mirror that is drawn
    glm::vec3 eye_{0};               ///< of the last picture, m, from the world's origin
    std::map<std::string, GlProgram> programs_;
    std::vector<GlProgram> found_, lit_; ///< of each step; found_[2]: the first, while light fades in
    std::map<std::pair<std::size_t, int>, GlProgram> punctual_; ///< by light and number of its shadow maps
    std::optional<GlProgram> sky_;
    ReprojectionMaps maps_; ///< from the last picture, and its greatest 1 / depth
    float nearest_ = 0;
    std::map<std::pair<int, ViewPart>, Target> targets_;
    Target mirror_image_;
    GlObject no_vertices_{GlObject::Kind::vertex_array};
};

} // namespace viewer
