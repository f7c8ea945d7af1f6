#include "viewer/app/presenter.h"

#include "viewer/displays/compose.h"

#include <epoxy/gl.h>

namespace viewer {
namespace {

std::span<float const> floats(gi::Picture const& picture, char const* layer)
{
    gi::Layer const* const l = picture.find(layer);
    return l == nullptr ? std::span<float const>() : std::span<float const>(l->data);
}

void upload(PictureTexture& to, gi::Picture const& picture)
{
    to.upload({picture.width, picture.height}, floats(picture, "color"), floats(picture, "depth"));
}

} // namespace

Presenter::Presenter(std::vector<WallSettings> const& walls)
{
    for (WallSettings const& w : walls) walls_.emplace_back(w);
}

void Presenter::take(std::shared_ptr<LiveFrame const> frame, std::vector<Pane> const& panes)
{
    frame_ = std::move(frame);
    while (shown_.size() < frame_->result.views.size()) shown_.emplace_back();
    for (Shown& s : shown_) s.fresh = false;
    for (Pane const& pane : panes)
        for (int const view : {pane.left, pane.right}) {
            if (view < 0 || std::size_t(view) >= frame_->result.views.size()) continue;
            Shown& s = shown_[std::size_t(view)];
            if (s.fresh) continue;
            ViewPicture const& v = frame_->result.views[std::size_t(view)];
            upload(s.picture, v.picture);
            s.has_other = v.compared.has_value();
            if (s.has_other) upload(s.other, *v.compared);
            s.fresh = true;
        }
}

EyeView Presenter::eye(int view, std::vector<gi::Camera> const& now)
{
    if (!frame_ || view < 0 || std::size_t(view) >= frame_->command.views.size()) return {};
    Shown& s = shown_[std::size_t(view)];
    ViewCommand const& rendered = frame_->command.views[std::size_t(view)];
    if (!s.fresh) return {};
    EyeView e{s.picture.shown(), s.has_other ? s.other.shown() : s.picture.shown()};
    bool const moved = std::size_t(view) < now.size() && !rendered.camera.orthographic &&
                       !(now[std::size_t(view)] == rendered.camera);
    if (!moved) return e;
    gi::Camera const& to = now[std::size_t(view)];
    e.picture = e.other = s.reprojection.draw(s.picture, rendered.camera, to, e.picture.size_px);
    if (s.has_other) e.other = s.other_reprojection.draw(s.other, rendered.camera, to, e.other.size_px);
    return e;
}

ShownPicture Presenter::bent(Pane const& pane, EyeView const& eye, DisplaySettings const& settings,
                             std::size_t side, glm::ivec2 size_px)
{
    if (!flat_[side] || bent_px_ != size_px) {
        flat_[side].emplace(TextureTarget::Format::bytes, size_px);
        bent_[side].emplace(TextureTarget::Format::bytes, size_px);
    }
    DisplaySettings alone = settings;
    alone.stereo = StereoMode::off;
    pass_.draw(flat_[side]->target(), eye, eye, alone);
    if (overlay_) draw_overlay(flat_[side]->target());
    walls_[std::size_t(pane.wall)].draw(bent_[side]->target(), flat_[side]->shown());
    return bent_[side]->shown();
}

/// @param wall_picture  of one eye, before it is bent, top row first
void Presenter::draw_overlay(DrawTarget const& wall_picture)
{
    WallOverlay const& o = *overlay_;
    if (uploaded_ != overlay_) {
        if (!overlay_picture_ || overlay_picture_->shown().size_px != o.size_px)
            overlay_picture_.emplace(TextureTarget::Format::bytes, o.size_px);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage2D(overlay_picture_->shown().texture, 0, 0, 0, o.size_px.x, o.size_px.y, GL_RGB,
                            GL_UNSIGNED_BYTE, o.rgb.data());
        uploaded_ = overlay_;
    }
    glm::dvec2 const px(wall_picture.size_px);
    glm::ivec2 const top_left(glm::round(px * glm::dvec2(o.place.left, 1 - o.place.bottom - o.place.height)));
    glm::ivec2 const size(glm::round(px * glm::dvec2(o.place.width, o.place.height)));
    bind(wall_picture);
    glBlitNamedFramebuffer(overlay_picture_->target().framebuffer, wall_picture.framebuffer, 0, 0, o.size_px.x,
                           o.size_px.y, top_left.x, top_left.y, top_left.x + size.x, top_left.y + size.y,
                           GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

void Presenter::draw_on_wall(Pane const& pane, DrawTarget const& target, EyeView const& left, EyeView const& right,
                             DisplaySettings const& settings)
{
    glm::ivec2 const size = eye_size(settings.stereo, pane.size_px);
    EyeView const l{bent(pane, left, settings, 0, size), {}};
    EyeView const r = settings.stereo == StereoMode::off ? l : EyeView{bent(pane, right, settings, 1, size), {}};
    bent_px_ = size;
    DisplaySettings joined = settings;
    joined.values = PictureValues::encoded;
    joined.comparison = Comparison::off;
    pass_.draw(target, l, r, joined);
}

void Presenter::draw(DrawTarget const& whole, glm::ivec2 on_screen_px, std::vector<Pane> const& panes,
                     PresentSettings const& s, std::vector<gi::Camera> const& now)
{
    for (Pane const& pane : panes) {
        EyeView left = eye(pane.left, now), right = pane.right >= 0 ? eye(pane.right, now) : left;
        if (left.picture.texture == 0 || right.picture.texture == 0) continue;
        if (s.swap_eyes) std::swap(left, right);
        if (pane.right_alone) left = right;
        DrawTarget const part = part_of(whole, pane.corner_px, pane.size_px);
        DisplaySettings settings;
        settings.tone = s.tone;
        settings.stereo = pane.stereo == StereoMode::two_windows ? StereoMode::off : mode_on(part, pane.stereo);
        settings.comparison = s.comparison;
        settings.split = s.split;
        settings.on_screen_px = on_screen_px + pane.corner_px;
        overlay_ = s.overlay && pane.of_wall >= 0 && pane.of_wall == s.overlay->wall ? s.overlay : nullptr;
        Pane finished = pane;
        if (overlay_) finished.wall = pane.of_wall; // also through a wall pass that changes nothing
        if (finished.wall >= 0)
            draw_on_wall(finished, part, left, right, settings);
        else
            pass_.draw(part, left, right, settings);
    }
}

} // namespace viewer
