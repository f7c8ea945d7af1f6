#pragma once
// A finished eye's picture on a wall of projectors: bent by a mesh, faded where projectors overlap, its colours
// matched to the neighbours'. What comes in and goes out is display-encoded; of a display that makes light v^gamma
// of a value v, light is multiplied by gain and weight.
//
// Order for interlaced stereo on bent walls: each eye through the display pass into a TextureTarget, through the
// wall pass into another, both through a display pass with PictureValues::encoded into the window. Interlacing
// before bending would mix the eyes.

#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

#include <optional>
#include <vector>

namespace viewer {

/// A place of the target and what is shown there; both 0..1 from the lower left corner, x to the right, y up.
/// Positions may lie beyond the target; what lies beyond the picture is black.
struct WarpVertex {
    glm::vec2 position{0};
    glm::vec2 picture{0};
    float weight = 1; ///< of light, 0..1

    bool operator==(WarpVertex const&) const = default;
};

/// A grid of columns x rows vertices, rows from the lowest; linear between them, in two triangles per cell.
struct WarpMesh {
    int columns = 2, rows = 2; ///< >= 2
    std::vector<WarpVertex> vertices{
        {{0, 0}, {0, 0}, 1}, {{1, 0}, {1, 0}, 1}, {{0, 1}, {0, 1}, 1}, {{1, 1}, {1, 1}, 1}};

    bool operator==(WarpMesh const&) const = default;
};

/// How wide the overlap with the neighbour is on each side, in parts of the picture (0 = none), and how light
/// fades over it: with t from 0 at the picture's edge to 1, weight = (2t)^p / 2 for t < 1/2, 1 - (2 (1 - t))^p / 2
/// above, so that two neighbours' weights have the sum 1 (P. Bourke, "Edge blending using commodity projectors",
/// 2004).
struct EdgeBlend {
    float left = 0, right = 0, bottom = 0, top = 0; ///< each >= 0; two sides together <= 1
    float power = 2;                                ///< p > 0: 1 = straight

    bool operator==(EdgeBlend const&) const = default;
};

/// Weights of light, one float per pixel, rows from the top, stretched over the picture; from a calibration tool.
struct BlendMap {
    glm::ivec2 size_px{};
    std::vector<float> weights;

    bool operator==(BlendMap const&) const = default;
};

struct WallSettings {
    WarpMesh mesh;
    EdgeBlend blend;
    std::optional<BlendMap> blend_map; ///< times the formula
    glm::vec3 gain{1};                 ///< of light, per channel, >= 0; what passes white is clipped
    glm::vec3 gamma{2.2f};             ///< of the display, > 0

    bool operator==(WallSettings const&) const = default;
};

/// One wall. Belongs to the context that was current when it was made.
class WallPass {
public:
    /// Throws InputError on a mesh without 2 x 2 vertices or with another number of them, values that are not
    /// finite, overlaps beyond the picture, and gains or gammas out of range.
    explicit WallPass(WallSettings const& settings);
    /// Black where the mesh is not. The picture is filtered bilinearly; where mesh, size, blend and gain change
    /// nothing its bytes stay the same.
    void draw(DrawTarget const& target, ShownPicture const& encoded) const;

private:
    WallSettings settings_;
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array}, buffer_{GlObject::Kind::buffer},
        indices_{GlObject::Kind::buffer}, map_;
    int index_count_ = 0;
};

} // namespace viewer
