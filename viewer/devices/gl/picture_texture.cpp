#include "viewer/devices/gl/picture_texture.h"

#include "gi/core/error.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <limits>

namespace viewer {
namespace {

struct Range {
    float least = std::numeric_limits<float>::infinity(), most = 0;

    void add(Range r)
    {
        least = std::min(least, r.least);
        most = std::max(most, r.most);
    }
};

} // namespace

void PictureTexture::upload(glm::ivec2 size_px, std::span<float const> rgb, std::span<float const> depth_m)
{
    std::size_t const pixels = std::size_t(std::max(size_px.x, 0)) * std::size_t(std::max(size_px.y, 0));
    if (pixels == 0 || rgb.size() != 3 * pixels || (!depth_m.empty() && depth_m.size() != pixels))
        throw gi::InputError(fmt::format("a picture of {} x {} pixels with {} values of colour and {} of depth",
                                         size_px.x, size_px.y, rgb.size(), depth_m.size()),
                             "three of colour and one of depth belong to each pixel",
                             "give the layers of one picture");
    bool const resized = size_px != size_px_;
    size_px_ = size_px;
    has_depth_ = !depth_m.empty();
    if (texels_.capacity() > 2 * pixels) texels_ = {}; // what a larger window left
    texels_.resize(pixels);
    glm::ivec2 const tiles = (size_px + kTile - 1) / kTile;
    std::vector<Range> own(std::size_t(tiles.x) * std::size_t(tiles.y));
    // On this thread alone: TBB's workers render, at a lower priority, and it would wait for them.
    for (int row = 0; row < tiles.y; ++row)
        for (int y = row * kTile; y < std::min(size_px.y, (row + 1) * kTile); ++y)
            for (int x = 0; x < size_px.x; ++x) {
                std::size_t const i = std::size_t(y) * std::size_t(size_px.x) + std::size_t(x);
                float const w = has_depth_ && depth_m[i] > 0 ? 1 / depth_m[i] : 0;
                texels_[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], w};
                own[std::size_t(row) * std::size_t(tiles.x) + std::size_t(x / kTile)].add({w, w});
            }
    if (resized || color_.id() == 0) color_ = texture_2d(GL_RGBA32F, size_px, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(color_.id(), 0, 0, 0, size_px.x, size_px.y, GL_RGBA, GL_FLOAT, texels_.data());
    if (resized || !has_depth_) around_ = {};
    nearest_m_ = std::numeric_limits<float>::infinity();
    if (!has_depth_) return;
    std::vector<Range> around = own;
    for (int y = 0; y < tiles.y; ++y)
        for (int x = 0; x < tiles.x; ++x)
            for (int j = std::max(0, y - 1); j <= std::min(tiles.y - 1, y + 1); ++j)
                for (int i = std::max(0, x - 1); i <= std::min(tiles.x - 1, x + 1); ++i)
                    around[std::size_t(y * tiles.x + x)].add(own[std::size_t(j * tiles.x + i)]);
    for (Range const& r : own) nearest_m_ = std::min(nearest_m_, 1 / r.most);
    if (around_.id() == 0) around_ = texture_2d(GL_RG32F, tiles, GL_NEAREST);
    glTextureSubImage2D(around_.id(), 0, 0, 0, tiles.x, tiles.y, GL_RG, GL_FLOAT, around.data());
}

} // namespace viewer
