#pragma once
// Prepares a finished eye's picture for a projected wall: warps it by a mesh, fades it where projectors overlap,
// matches its colours to the neighbours', and raises its black to theirs. Input and output are display-encoded; gain and weight multiply the
// light, which is v^gamma for a value v.
//
// Order for interlaced stereo on warped walls: each eye through the display pass into a TextureTarget, then
// through the wall pass into another, then both through a display pass with PictureValues::encoded into the
// window. Interlacing before warping would mix the eyes.

#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"
#include "viewer/displays/surface.h"

#include <optional>
#include <vector>

namespace viewer {

/// A position on the target and the picture position shown there; both 0..1 from the lower left corner, x to the
/// right, y up. Positions may lie outside the target; outside the picture it is black.
struct WarpVertex {
    glm::vec2 position{0};
    glm::vec2 picture{0};
    float weight = 1; ///< factor on light, 0..1

    bool operator==(WarpVertex const&) const = default;
};

/// A grid of columns x rows vertices, rows from the lowest; linear interpolation in two triangles per cell.
struct WarpMesh {
    int columns = 2, rows = 2; ///< >= 2
    std::vector<WarpVertex> vertices{
        {{0, 0}, {0, 0}, 1}, {{1, 0}, {1, 0}, 1}, {{0, 1}, {0, 1}, 1}, {{1, 1}, {1, 1}, 1}};

    bool operator==(WarpMesh const&) const = default;
};

/// Width of the overlap with the neighbour on each side, as shares of the picture (0 = none), and the fading of
/// light over it: with t from 0 at the picture's edge to 1, weight = (2t)^p / 2 for t < 1/2, 1 - (2 (1 - t))^p / 2
/// above, so that two neighbours' weights sum to 1 (P. Bourke, "Edge blending using commodity projectors", 2004).
struct EdgeBlend {
    float left = 0, right = 0, bottom = 0, top = 0; ///< each >= 0; two sides together <= 1
    float power = 2;                                ///< p > 0: 1 = linear

    bool operator==(EdgeBlend const&) const = default;
};

struct WallSettings {
    WarpMesh mesh;
    EdgeBlend blend;
    // Maps of a calibration over the target's pixels; null = none.
    std::shared_ptr<PixelMap const>
        positions{}; ///< in the picture (parse_picture_positions()), in place of the mesh's
    std::shared_ptr<PixelMap const> blend_map{};   ///< factors on light, 0..1, multiplied with the formula
    std::shared_ptr<PixelMap const> black_level{}; ///< light of black, 0..1: out = black + (1 - black) * light
    glm::vec3 gain{1};                 ///< factor on light, per channel, >= 0; values above white are clipped
    glm::vec3 gamma{2.2f};             ///< of the display, > 0
    std::optional<Surface> surface{};  ///< of a wall that is not flat: a SurfacePass goes before

    bool operator==(WallSettings const&) const = default;
};

/// One wall. Belongs to the context that was current at its creation.
class WallPass {
public:
    /// Throws InputError on a mesh with fewer than 2 x 2 vertices or the wrong number of vertices, non-finite
    /// values, overlaps larger than the picture, and gains, gammas or maps of light out of range.
    explicit WallPass(WallSettings const& settings);
    enum class Outside { black, kept };
    /// Draws the picture with bilinear filtering; outside the mesh and where `positions` has none it is black, or what was there stays, for walls
    /// that share a viewport. If mesh, size, blend and gain have no effect, its bytes stay unchanged.
    void draw(DrawTarget const& target, ShownPicture const& encoded, Outside outside = Outside::black) const;

private:
    WallSettings settings_;
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array}, buffer_{GlObject::Kind::buffer},
        indices_{GlObject::Kind::buffer}, map_, black_, positions_;
    int index_count_ = 0;
};

} // namespace viewer
