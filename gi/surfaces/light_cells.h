#pragma once
// Light that falls on places of the world, kept in cells of space, for surfaces that no picture of light shows: those
// that a head turns to, and those that come into view behind others. It is learnt from pictures of light, and read by
// a shader, which interpolates between cells. Cells are cubes of several widths, each twice that of the one before,
// and one for each of the six directions that normals can have most in common with, so that a wall does not take
// the light of its other side. Narrow cells know little at first and lean on wider ones.
//
// What lies behind a thin wall may be in the same cell as what lies before it, or in the next one. So cells know whether a
// picture shows a nearer surface where they have learnt: such a cell is hidden. It does not count beside others, and what is
// seen in it begins it anew.

#include "gi/surfaces/light_picture.h"

#include <array>
#include <memory>

namespace gi {

/// For a shader: buckets of two cells each. That of a key is in bucket key / 2 % kBuckets (keys are odd) or, where that
/// is full, in one of the next two. Key 0 = none. The last bit of a hidden cell's key is 0.
struct LightCellTable {
    static constexpr std::uint32_t kBuckets = 1u << 16;
    static constexpr int kLevels = 6;
    struct Cell {
        std::uint32_t key = 0, light = 0; ///< radiance over albedo, as LightTexel::light
    };
    using Bucket = std::array<Cell, 2>;
    float narrowest_m = 0;         ///< width of cells of level 0
    bool without_punctual = false; ///< see LightPicture
    std::vector<Bucket> buckets{kBuckets};
    std::size_t left_out = 0; ///< cells for which there was no room
};

/// Of the cell of a level that contains a place, or of one beside it. The same in shaders/surface_light.glsl.
/// @param side  2 * axis of the normal's greatest component, + 1 if that is negative
std::uint32_t light_cell_key(glm::ivec3 cell, int level, int side);

class LightCells {
public:
    /// @param radius  of the scene, m
    explicit LightCells(float radius);

    /// Learns from some texels of a picture. What was learnt from pictures with other lights is forgotten.
    /// @param most  number of texels  @param origin  of the world
    void learn(LightPicture const& light, std::size_t most, dvec3 origin);
    /// What is known counts less from now on. @param share  of what it counted, 0..1
    void doubt(float share);
    std::shared_ptr<LightCellTable const> table() const;

private:
    struct Cell {
        std::uint32_t key = 0, wider = 0; ///< keys of the cell and of the next wider one around it; 0 = none
        vec3 sum{0};                      ///< of weight times light, and of weights
        vec3 weight{0};
        vec3 place{0}; ///< mean of those where it has learnt, from the world's origin
        float places = 0, width = 0;
        std::uint32_t last = 0; ///< picture that it learnt from
        bool hidden = false;    ///< by a picture since it has last learnt
    };
    static constexpr std::size_t kMostCells = LightCellTable::kBuckets * 5 / 8; ///< few buckets are full
    Cell& cell(std::uint32_t key);
    void find_hidden(LightPicture const& light, CameraRays const& rays);
    Cell const* find(std::uint32_t key) const;
    void forget_oldest();

    float narrowest_m_;
    bool without_punctual_ = false;
    std::vector<Cell> cells_;
    std::size_t used_ = 0;
    std::uint32_t pictures_ = 0;
};

} // namespace gi
