#include "viewer/app/hmd_eyes.h"

#include "gi/surfaces/lit_picture.h"
#include "viewer/app/fill_hidden.h"
#include "viewer/engine/picture_margin.h"

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
        ViewPicture const& view = frame.result.views[eye];
        gi::Picture const& p = view.picture;
        gi::Layer const* const depth = p.find(gi::seen_depth_of(p));
        std::span<float const> color = p.find("color")->data,
                               depths = depth == nullptr ? std::span<float const>() : depth->data;
        if (view.hidden) {
            color_.assign(color.begin(), color.end());
            depth_.assign(depths.begin(), depths.end());
            fill_hidden(*view.hidden, p.width, color_, 3);
            if (depth != nullptr) fill_hidden(*view.hidden, p.width, depth_, 1);
            color = color_;
            depths = depth_;
        }
        pictures_[eye].upload({p.width, p.height}, color, depths);
    }
}

void HmdEyes::draw(LiveFrame const& frame, std::array<gi::Camera, 2> const& now,
                   std::array<glm::ivec2, 2> const& sizes_px, bool reproject, gi::ToneMapSettings const& tone)
{
    make_targets(sizes_px);
    for (std::size_t eye = 0; eye < 2; ++eye) {
        gi::Camera const &rendered = frame.command.views[eye].camera, &to = reproject ? now[eye] : rendered;
        glm::ivec2 const margin = frame.result.views[eye].margin_px;
        EyeView view;
        view.picture = pictures_[eye].shown();
        if (!(rendered == to) || margin != glm::ivec2(0))
            view.picture = reprojections_[eye].draw(
                pictures_[eye], with_margin(rendered, view.picture.size_px - 2 * margin, margin), to,
                sizes_px[eye]);
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
