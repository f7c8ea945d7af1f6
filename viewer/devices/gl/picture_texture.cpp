#include "viewer/devices/gl/picture_texture.h"

#include "gi/core/error.h"

#include <algorithm>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <limits>

namespace viewer {

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
    texels_.resize(pixels);
    float greatest = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        float const w = has_depth_ && depth_m[i] > 0 ? 1 / depth_m[i] : 0;
        texels_[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2], w};
        greatest = std::max(greatest, w);
    }
    nearest_m_ = 1 / greatest;
    if (resized || color_.id() == 0) color_ = texture_2d(GL_RGBA32F, size_px, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(color_.id(), 0, 0, 0, size_px.x, size_px.y, GL_RGBA, GL_FLOAT, texels_.data());
    if (!has_depth_) return;
    glm::ivec2 const tiles = (size_px + kTile - 1) / kTile;
    std::vector<glm::vec2> const around = least_and_greatest(tiles);
    if (resized || around_.id() == 0) around_ = texture_2d(GL_RG32F, tiles, GL_NEAREST);
    glTextureSubImage2D(around_.id(), 0, 0, 0, tiles.x, tiles.y, GL_RG, GL_FLOAT, around.data());
}

std::vector<glm::vec2> PictureTexture::least_and_greatest(glm::ivec2 tiles) const
{
    glm::vec2 const none(std::numeric_limits<float>::infinity(), 0);
    auto const both = [](glm::vec2 a, glm::vec2 b) { return glm::vec2(std::min(a.x, b.x), std::max(a.y, b.y)); };
    auto const of = [&](int x, int y) { return std::size_t(y) * std::size_t(tiles.x) + std::size_t(x); };
    std::vector<glm::vec2> own(std::size_t(tiles.x) * std::size_t(tiles.y), none), around = own;
    for (int y = 0; y < size_px_.y; ++y)
        for (int x = 0; x < size_px_.x; ++x) {
            glm::vec2& tile = own[of(x / kTile, y / kTile)];
            tile = both(tile, glm::vec2(texels_[std::size_t(y) * std::size_t(size_px_.x) + std::size_t(x)].w));
        }
    for (int y = 0; y < tiles.y; ++y)
        for (int x = 0; x < tiles.x; ++x)
            for (int j = std::max(0, y - 1); j <= std::min(tiles.y - 1, y + 1); ++j)
                for (int i = std::max(0, x - 1); i <= std::min(tiles.x - 1, x + 1); ++i)
                    around[of(x, y)] = both(around[of(x, y)], own[of(i, j)]);
    return around;
}

} // namespace viewer
