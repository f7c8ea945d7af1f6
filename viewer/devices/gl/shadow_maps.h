#pragma once
// Shadow maps of a scene's punctual lights, so that hard shadows are those of the surfaces that are drawn, however
// old their other light is. What never moves is drawn once; what moves, over a copy of that.

#include "viewer/devices/gl/gl_program.h"
#include "viewer/devices/gl/scene_meshes.h"

#include <glm/mat4x4.hpp>
#include <map>

namespace viewer {

class ShadowMaps {
public:
    /// Of this scene from now on; its lights count if it is another world, or has more or fewer.
    void take(gi::ShownScene const& scene);
    /// The scene's lights as they are now. Where one has moved, its shadows are drawn anew.
    void light(std::vector<gi::Light> const& lights);
    /// Draws what is missing, one map a call; true when nothing is. @param eye  around it maps are finest; m, from
    /// the world's origin
    bool prepare(SceneMeshes const& meshes, glm::vec3 eye);
    /// Draws all that is missing or has moved.
    void update(SceneMeshes const& meshes, glm::vec3 eye);
    /// To block 1 and units 1 and 13 of shaders/surface_punctual.glsl.
    void bind() const;
    /// 0 to 4.
    std::vector<gi::Light> const& lights() const { return lights_; }
    /// Of a light, once they are prepared: 1, 2 or 6.
    int maps(std::size_t light) const { return maps_of(lights_[light], window_m_ > 0); }

private:
    struct Map {
        glm::mat4 clip_from_world{1};
        bool is_drawn = false;
        glm::ivec2 low_px{0}, high_px{0}; ///< what moving surfaces may have covered
    };
    static int maps_of(gi::Light const& light, bool windowed);
    void place(SceneMeshes const& meshes, glm::vec3 eye);
    void draw_still(SceneMeshes const& meshes, std::size_t map);
    void draw_moving(SceneMeshes const& meshes);
    enum class Part : std::uint8_t { still, moving };
    void draw(SceneMeshes const& meshes, std::size_t map, GlObject const& into, Part part);
    GlProgram& program(SurfaceKind const& kind, bool has_alphas);

    std::vector<gi::Light> lights_;
    std::shared_ptr<gi::World const> world_;
    std::shared_ptr<std::vector<gi::Material> const> materials_;
    bool is_placed_ = false;
    glm::vec3 middle_{0};          ///< of the window of maps that do not cover the whole scene
    float window_m_ = 0;           ///< its side; 0 = there is none
    int side_px_ = 0, layers_ = 0; ///< of the textures
    bool copies_are_old_ = true;   ///< in shown_
    std::vector<Map> maps_;
    GlObject still_, shown_; ///< a layer for each; shown_: with what moves, if anything can
    GlObject block_, framebuffer_;
    GlObject facets_;         ///< tables of gi/scene/shading/ggx_albedo.h
    std::uint64_t moves_ = 0; ///< SceneMeshes::moves_so_far of what is drawn
    std::map<std::string, GlProgram> programs_;
};

} // namespace viewer
