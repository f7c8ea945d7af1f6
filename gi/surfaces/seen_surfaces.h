#pragma once
// The surfaces that a picture shows, one per pixel, and the light of a few punctual lights on them: the nearest
// one by rasterisation; where that is a mirror or a pane, the one that it shows, found by exact rays. A surface
// seen in a mirror is described as its image behind the mirror: where it seems to be and how it seems to face.

#include "gi/raster/cut_outs.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/motion.h"
#include "gi/scene/motion/moving_world.h"
#include "gi/scene/shading/shading_point.h"

#include <memory>
#include <optional>

namespace gi {

struct SeenSurface {
    vec3 albedo{0}; ///< times what mirrors and panes on the way leave of the light
    vec3 normal{0}; ///< of shading, unit, as mirrored
    /// M, from the world's origin; on the pixel's ray, at the distance that light
    /// has travelled (longer via mirrors).
    vec3 position{0};
    vec3 emitted{
        0}; ///< radiance of emission, or of the background; times the same as the albedo. Plus what mirrors and
            ///< panes on the way bring of it by their other lobes (a lamp reflected in a window)
    vec3 moved{0};                     ///< m, as mirrored, since the previous frame
    vec3 direct{0};                    ///< radiance of the light of punctual lights; times the same
    float depth = 0;                   ///< m along the camera's axis; 0 = no surface
    std::uint8_t lit = 0, blocked = 0; ///< bits of lights that reach it or would, by shadow rays of its own
    bool in_mirror = false;            ///< or behind a pane
    bool is_image = false; ///< it is not where it seems to be: mirrored, or refracted by more than a thin pane
    bool is_reflected = false; ///< by one mirror, and nothing else was on the way
};

class SeenSurfaces {
public:
    /// @param world  must outlive this object; its arrays must not be reallocated  @param threads  0 = all
    SeenSurfaces(World const& world, int threads);

    /// Call for every change of the world.
    void changed(Changes const& changes);
    /// Ends a frame: SeenSurface::moved is counted from its state.
    void end_frame() { earlier_.corners.clear(); }

    /// Rasterises a view. Not for orthographic cameras; a lens is a pinhole.
    /// @param lights  few: with the light of punctual lights, if there are at most kMostLights
    /// @param at  where rays pass their pixels, 0..1 from the top left corner
    enum class Lights : std::uint8_t { none, few };
    void look(CameraRays const& camera, int width, int height, Lights lights = Lights::none, vec2 at = vec2{0.5f});
    /// The same if only row_of_mirrors will be asked.
    void look_at_mirrors(CameraRays const& camera, int width, int height, Lights lights);
    CameraRays const& camera() const { return camera_; } ///< of the last view, with a pinhole
    vec2 at() const { return at_; }
    /// Surfaces of a row of the last view. Safe for concurrent calls.
    void row(int y, std::span<SeenSurface> out) const { fill(y, out, Pixels::all); }
    float depth(int x, int y) const; ///< of the last view, m along its axis; 0 = nothing
    /// The same for those pixels of a row that show a mirror or a pane; the others stay as they are.
    void row_of_mirrors(int y, std::span<SeenSurface> out) const { fill(y, out, Pixels::mirrors); }
    /// True if some triangle's material is a mirror or a pane all over.
    static bool mirrors_in(World const& world);
    bool has_mirrors() const { return !mirrors_.empty(); }
    /// False only if a picture shows no mirror and no pane. @param width, height  px
    bool may_show_mirrors(CameraRays const& camera, int width, int height) const;
    static constexpr std::size_t kMostLights = 4;
    static bool can_light(World const& world);      ///< there are lamps, but not many
    static bool has_few_lights(World const& world); ///< and no panes: OpenGL can light surfaces, too

private:
    struct Way;
    struct Sent;
    enum class Pixels : std::uint8_t { all, mirrors, coarse };
    void fill(int y, std::span<SeenSurface> out, Pixels which) const;
    bool arrive(std::uint32_t triangle, vec2 weights, int y, Way& way, std::vector<Way>& aside,
                std::vector<Sent>& sent, SeenSurface& out) const;
    std::optional<bool> known_shadow(SeenSurface const& s, std::uint32_t light, int x, int y) const;
    void light(ShadingPoint const& at, Way const& way, SeenSurface const& s, int y, std::vector<Sent>& sent,
               SeenSurface& out) const;
    void find_needs();
    std::size_t first_moving() const { return world_.static_triangles; }

    World const& world_;
    int threads_;
    WorldView view_;
    TriangleSoup soup_;
    CutOuts cut_outs_;
    std::vector<Bounds> mirrors_;            ///< boxes of mirrors and panes
    std::unique_ptr<ExactVisibility> exact_; ///< null without mirrors and without few punctual lights
    CameraRays camera_{};
    vec2 at_{0.5f};
    PerspectiveGrid grid_;
    NearestMap map_;
    std::uint32_t lights_ = 0;        ///< punctual lights in the last view
    bool panes_ = false;              ///< the world has some
    std::vector<SeenSurface> coarse_; ///< every fourth pixel, with its own shadow rays
    std::vector<Corners> now_;        ///< of triangles that can move
    EarlierCorners earlier_;
};

} // namespace gi
