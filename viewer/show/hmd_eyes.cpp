#include "viewer/show/hmd_eyes.h"

#include <cstdlib>

namespace viewer {

HmdContext::HmdContext(gi::Report& report, WindowSettings const& settings)
{
    char const* const display = std::getenv("DISPLAY");
    if (display != nullptr && *display != '\0')
        window = std::make_unique<Window>(settings, report);
    else
        own = GlContext::surfaceless(report);
}

void HmdEyes::make_targets(std::array<glm::ivec2, 2> const& sizes_px)
{
    for (std::size_t eye = 0; eye < 2; ++eye) {
        if (targets_[eye] && sizes_[eye] == sizes_px[eye]) continue;
        targets_[eye].emplace(TextureTarget::Format::bytes, sizes_px[eye]);
        sizes_[eye] = sizes_px[eye];
    }
}

void HmdEyes::take(LiveFrame const& frame)
{
    for (std::size_t eye = 0; eye < 2; ++eye) {
        gi::Picture const& p = frame.result.views[eye].picture;
        gi::Layer const* const depth = p.find("depth");
        pictures_[eye].upload({p.width, p.height}, p.find("color")->data,
                              depth == nullptr ? std::span<float const>() : depth->data);
    }
}

void HmdEyes::draw(LiveFrame const& frame, std::array<gi::Camera, 2> const& now,
                   std::array<glm::ivec2, 2> const& sizes_px, bool reproject, gi::ToneMapSettings const& tone)
{
    make_targets(sizes_px);
    for (std::size_t eye = 0; eye < 2; ++eye) {
        gi::Camera const& rendered = frame.order.views[eye].camera;
        EyeView view;
        view.picture = reproject && !(rendered == now[eye])
                           ? reprojections_[eye].draw(pictures_[eye], rendered, now[eye], sizes_px[eye])
                           : pictures_[eye].shown();
        DisplaySettings settings;
        settings.tone = tone;
        pass_.draw(targets_[eye]->target(), view, view, settings);
    }
}

void HmdEyes::clear(std::array<glm::ivec2, 2> const& sizes_px, float grey)
{
    make_targets(sizes_px);
    for (auto const& target : targets_) viewer::clear(target->target(), grey);
}

} // namespace viewer
