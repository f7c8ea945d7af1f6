#include "viewer/app/surface_display.h"

namespace viewer {

SurfaceDisplay::SurfaceDisplay()
{
    TextureTarget const from(TextureTarget::Format::bytes, {3, 3}), to(TextureTarget::Format::bytes, {3, 3});
    outlines_.draw(to.target(), from.shown());
}

TextureTarget const& SurfaceDisplay::encoded(Key key, DisplayPass& pass, EyeView const& eye,
                                             DisplaySettings settings)
{
    glm::ivec2 const size = eye.picture.size_px;
    auto at = textures_.find(key);
    if (at == textures_.end() || at->second.encoded.shown().size_px != size) {
        constexpr auto kBytes = TextureTarget::Format::bytes;
        at = textures_.insert_or_assign(key, Textures{{kBytes, size}, {kBytes, size}}).first;
    }
    auto const& [encoded, smoothed] = at->second;
    settings.stereo = StereoMode::off;
    pass.draw(encoded.target(), eye, eye, settings);
    if (!eye.is_drawn) return encoded;
    outlines_.draw(smoothed.target(), encoded.shown());
    return smoothed;
}

void SurfaceDisplay::compose(DisplayPass& pass, DrawTarget const& to, TextureTarget const& left,
                             TextureTarget const& right, DisplaySettings settings)
{
    if (settings.stereo == StereoMode::off) return stretch(left.target(), to);
    settings.values = PictureValues::encoded;
    pass.draw(to, {left.shown(), {}}, {right.shown(), {}}, settings);
}

} // namespace viewer
