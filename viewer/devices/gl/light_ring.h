#pragma once
// The newest pictures of light on the GPU (gi/surfaces/light_picture.h), of all views: what one does not show, another or
// an older one may; what a picture shows in flat mirrors counts as pictures from behind them. All views of a head ask them in the same order, so that both eyes see a place in the same light, and
// so do two walls that meet there.

#include "gi/scene/model/world.h"
#include "gi/surfaces/light_cells.h"
#include "viewer/devices/gl/gl_program.h"

#include <array>
#include <vector>

namespace viewer {

/// The light of one view of a frame.
struct LightOfView {
    int view = 0;
    int head = 0; ///< the same for all views of the eyes of one user
    gi::LightPicture const* light = nullptr;
};

/// What a picture may show.
struct SeenPart {
    glm::vec3 eye{0};                 ///< from the world's origin, m
    std::array<glm::vec3, 4> edges{}; ///< directions of the picture's corners from there
    gi::Bounds moved;                 ///< and places in this box
    bool in_mirror = false;           ///< `eye` is behind the mirror
};

class LightRing {
public:
    static constexpr int kPictures = 24; ///< most that a look-up asks; as in surface_light.glsl

    /// Adds the light of a frame. The newest two of each view are kept, and some older ones of other places, for who comes back.
    /// Those of other lamps go.
    /// @param origin  of the world
    void add(std::vector<LightOfView> const& frame, gi::dvec3 origin);
    void take(std::shared_ptr<gi::LightCellTable const> cells);
    /// What is drawn from now on is of this time; light that was added since fades in over kFade_s. @param pose_s  of the
    /// viewer's clock, as recordings have it
    void show_at(double pose_s);
    bool fades() const { return share_ < 1; }
    void forget_pictures() { entries_.clear(); }
    void clear();
    bool empty() const { return entries_.empty(); }
    /// Binds those that may show what a view of this head sees to unit 2, and sets the uniforms of
    /// shaders/surface_light.glsl.
    void bind(GlProgram const& program, int head, SeenPart const& seen) const;

private:
    static constexpr double kFade_s = 0.15;
    static constexpr int kNewest = 2; ///< pictures of a view that are always kept
    struct Entry {
        int view = 0, head = 0, layer = 0;
        std::uint32_t mirror = 0; ///< in which it shows what it does, LightTexel; 0 = none
        int age = 0; ///< newer pictures of the view
        glm::vec3 eye{0};
        glm::mat3 texel_from_world{1};
        glm::vec2 at{0.5f};
        glm::ivec2 size{};
        bool without_punctual = false;
        std::vector<gi::MirrorPlane> mirrors; ///< that it shows
    };
    static Entry from_behind(Entry const& picture, std::uint32_t mirror);
    static bool may_show(Entry const& picture, SeenPart const& seen);
    static glm::vec3 axis(Entry const& picture);
    float gap_without(Entry const& picture) const;
    std::vector<Entry> asked_by(int head, SeenPart const& seen) const;
    void fit(std::vector<LightOfView> const& frame);
    void add(LightOfView const& of, gi::dvec3 origin);
    void make_cells();

    GlObject texels_, slopes_;                ///< a layer for each
    std::uint64_t lamps_ = 0;                 ///< LightPicture::lamps of all entries
    int width_ = 0, height_ = 0, layers_ = 0; ///< of the textures; pictures may be smaller
    std::shared_ptr<gi::LightCellTable const> known_; ///< what no picture shows; null = nothing
    GlObject cells_;
    bool is_new_ = false;              ///< light was added since show_at()
    double shown_s_ = 0, begun_s_ = 0,
           fade_s_ = kFade_s;          ///< of the last show_at(); when light began to fade in, for how long
    float share_ = 1;                  ///< of the newest light
    glm::vec3 mean_{0}; ///< of the light of the last dozen pictures, smoothed
    std::vector<Entry> entries_;
};

} // namespace viewer
