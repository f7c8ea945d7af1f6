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

void HmdEyes::fit(std::size_t eye, glm::ivec2 size_px)
{
    if (eye < eyes_.size() && eyes_[eye].target.shown().size_px == size_px) return;
    Eye made{TextureTarget(TextureTarget::Format::bytes, size_px), nullptr, {}};
    if (eye < eyes_.size())
        eyes_[eye] = std::move(made);
    else
        eyes_.push_back(std::move(made));
}

void HmdEyes::begin(double surfaces_scale, FrameCommand const& moment, DriveBodies const& drive)
{
    views_.begin(surfaces_scale, &moment, drive);
    glFlush();
}

double HmdEyes::drawing_s()
{
    GLint is_known = 0;
    if (is_timed_) glGetQueryObjectiv(ended_.id(), GL_QUERY_RESULT_AVAILABLE, &is_known);
    if (is_known != 0) {
        GLuint64 from = 0, to = 0;
        glGetQueryObjectui64v(begun_.id(), GL_QUERY_RESULT, &from);
        glGetQueryObjectui64v(ended_.id(), GL_QUERY_RESULT, &to);
        drawing_s_ = to > from ? 1e-9 * double(to - from) : 0;
        is_timed_ = false;
    }
    return drawing_s_;
}

void HmdEyes::draw(std::vector<EyeToDraw> const& eyes, gi::ToneMapSettings const& tone)
{
    bool const times = !is_timed_;
    if (times) glQueryCounter(begun_.id(), GL_TIMESTAMP);
    DisplaySettings settings;
    settings.tone = tone;
    for (std::size_t k = 0; k < eyes.size(); ++k) {
        EyeToDraw const& wanted = eyes[k];
        fit(k, wanted.size_px);
        int const view = int(k % 2);
        bool const is_middle = k >= 2;
        EyeView const drawn = is_middle ? views_.middle(view, *wanted.now, wanted.size_px)
                                        : views_.eye(view, wanted.now ? &*wanted.now : nullptr);
        Eye& eye = eyes_[k];
        eye.surfaces = nullptr;
        eye.depth = views_.depth(view, is_middle ? ViewPart::middle : ViewPart::whole);
        if (drawn.is_drawn)
            eye.surfaces = &surface_display_->encoded({0, int(k)}, pass_, drawn, settings);
        else
            pass_.draw(eye.target.target(), drawn, drawn, settings);
    }
    if (times) glQueryCounter(ended_.id(), GL_TIMESTAMP);
    is_timed_ = true;
}

void HmdEyes::clear(std::vector<glm::ivec2> const& sizes_px, float grey)
{
    for (std::size_t k = 0; k < sizes_px.size(); ++k) {
        fit(k, sizes_px[k]);
        eyes_[k].surfaces = nullptr;
        eyes_[k].depth = {};
        viewer::clear(eyes_[k].target.target(), grey);
    }
}

DrawTarget HmdEyes::target(std::size_t eye)
{
    Eye& e = eyes_[eye];
    if (e.surfaces != nullptr) stretch(std::exchange(e.surfaces, nullptr)->target(), e.target.target());
    return e.target.target();
}

std::vector<unsigned> HmdEyes::textures() const
{
    std::vector<unsigned> all;
    for (Eye const& e : eyes_) all.push_back((e.surfaces ? *e.surfaces : e.target).shown().texture);
    return all;
}

std::vector<ShownDepth> HmdEyes::depths() const
{
    std::vector<ShownDepth> all;
    for (Eye const& e : eyes_) all.push_back(e.depth);
    return all;
}

} // namespace viewer
