#include "viewer/app/surface_display.h"

namespace viewer {

SurfaceDisplay::SurfaceDisplay()
{
    TextureTarget const from(TextureTarget::Format::bytes, {3, 3}), to(TextureTarget::Format::bytes, {3, 3});
    outlines_.draw(to.target(), from.shown());
}

TextureTarget const& SurfaceDisplay::smoothed(int number, DisplayPass& pass, EyeView const& view,
                                              DisplaySettings const& settings)
{
    glm::ivec2 const size = view.picture.size_px;
    auto at = textures_.find(number);
    if (at == textures_.end() || at->second.encoded.shown().size_px != size) {
        constexpr auto kBytes = TextureTarget::Format::bytes;
        at = textures_.insert_or_assign(number, Textures{{kBytes, size}, {kBytes, size}}).first;
    }
    auto const& [encoded, smoothed] = at->second;
    pass.draw(encoded.target(), view, view, settings);
    outlines_.draw(smoothed.target(), encoded.shown());
    return smoothed;
}

TextureTarget const& SurfaceDisplay::draw(int number, DisplayPass& pass, DrawTarget const& to, EyeView const& view,
                                          DisplaySettings const& settings)
{
    TextureTarget const& drawn = smoothed(number, pass, view, settings);
    stretch(drawn.target(), to);
    return drawn;
}

} // namespace viewer
