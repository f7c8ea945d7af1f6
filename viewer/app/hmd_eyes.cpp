#include "viewer/app/hmd_eyes.h"

#include <cstdlib>
#include <epoxy/gl.h>

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

void HmdEyes::draw(std::array<gi::Camera, 2> const* now, std::array<glm::ivec2, 2> const& sizes_px,
                   gi::ToneMapSettings const& tone)
{
    make_targets(sizes_px);
    GLint is_known = 0;
    if (is_timed_) glGetQueryObjectiv(ended_.id(), GL_QUERY_RESULT_AVAILABLE, &is_known);
    if (is_known != 0) {
        GLuint64 from = 0, to = 0;
        glGetQueryObjectui64v(begun_.id(), GL_QUERY_RESULT, &from);
        glGetQueryObjectui64v(ended_.id(), GL_QUERY_RESULT, &to);
        drawing_s_ = to > from ? 1e-9 * double(to - from) : 0;
        is_timed_ = false;
    }
    bool const times = !is_timed_;
    if (times) glQueryCounter(begun_.id(), GL_TIMESTAMP);
    DisplaySettings settings;
    settings.tone = tone;
    for (std::size_t eye = 0; eye < 2; ++eye) {
        EyeView const view = views_.eye(int(eye), now ? &(*now)[eye] : nullptr);
        if (view.is_drawn)
            surface_display_->draw(pass_, targets_[eye]->target(), view, settings);
        else
            pass_.draw(targets_[eye]->target(), view, view, settings);
    }
    if (times) glQueryCounter(ended_.id(), GL_TIMESTAMP);
    is_timed_ = true;
}

void HmdEyes::clear(std::array<glm::ivec2, 2> const& sizes_px, float grey)
{
    make_targets(sizes_px);
    for (auto const& target : targets_) viewer::clear(target->target(), grey);
}

} // namespace viewer
