#include "viewer/app/surface_display.h"

namespace viewer {

SurfaceDisplay::SurfaceDisplay()
{
    TextureTarget const from(TextureTarget::Format::bytes, {3, 3}), to(TextureTarget::Format::bytes, {3, 3});
    outlines_.draw(to.target(), from.shown());
}

void SurfaceDisplay::draw(DisplayPass& pass, DrawTarget const& to, EyeView const& view,
                          DisplaySettings const& settings)
{
    glm::ivec2 const size = view.picture.size_px;
    if (!encoded_ || encoded_->shown().size_px != size) {
        encoded_.emplace(TextureTarget::Format::bytes, size);
        smoothed_.emplace(TextureTarget::Format::bytes, size);
    }
    pass.draw(encoded_->target(), view, view, settings);
    outlines_.draw(smoothed_->target(), encoded_->shown());
    stretch(smoothed_->target(), to);
}

} // namespace viewer
