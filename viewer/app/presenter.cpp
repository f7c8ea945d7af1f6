#include "viewer/app/presenter.h"

#include "viewer/displays/compose.h"

#include <algorithm>
#include <epoxy/gl.h>

namespace viewer {
namespace {

bool has_overlay(Pane const& pane, PresentSettings const& s)
{
    return s.overlay && pane.of_wall >= 0 && pane.of_wall == s.overlay->wall;
}

} // namespace

Presenter::Presenter(std::vector<WallSettings> const& walls)
{
    for (WallSettings const& w : walls) {
        walls_.emplace_back(w);
        surfaces_.emplace_back();
        if (w.surface) surfaces_.back().emplace(*w.surface);
    }
}

void Presenter::take(std::shared_ptr<LiveFrame const> frame, std::vector<Pane> const& panes)
{
    std::vector<int> views;
    for (Pane const& pane : panes) {
        views.insert(views.end(), {pane.left, pane.right});
        for (PaneFaces const* faces : {&pane.left_faces, &pane.right_faces})
            views.insert(views.end(), faces->views.begin(), faces->views.end());
    }
    views_.take(std::move(frame), views);
}

EyeView Presenter::eye(int view, std::vector<gi::Camera> const& now)
{
    return views_.eye(view, view >= 0 && std::size_t(view) < now.size() ? &now[std::size_t(view)] : nullptr);
}

void Presenter::draw_faces(Pane const& pane, PaneFaces const& faces, DisplaySettings const& settings,
                           std::size_t side, std::vector<gi::Camera> const& now)
{
    std::vector<ShownFace> shown;
    for (std::size_t k = 0; k < faces.views.size(); ++k) {
        EyeView const picture = eye(faces.views[k], now);
        if (picture.picture.texture == 0) continue;
        while (face_targets_.size() <= k) {
            face_targets_.emplace_back(TextureTarget::Format::bytes, picture.picture.size_px);
            face_px_.push_back(picture.picture.size_px);
        }
        if (face_px_[k] != picture.picture.size_px) {
            face_targets_[k] = TextureTarget(TextureTarget::Format::bytes, picture.picture.size_px);
            face_px_[k] = picture.picture.size_px;
        }
        pass_.draw(face_targets_[k].target(), picture, picture, settings);
        gi::Camera const& camera = views_.command(faces.views[k]).camera;
        if (camera.off_axis) shown.push_back({faces.faces[k], *camera.off_axis, face_targets_[k].shown()});
    }
    surfaces_[std::size_t(pane.wall)]->draw(flat_[side]->target(), shown, faces.eye_m);
}

bool Presenter::bend(Pane const& pane, PresentSettings const& shown, DisplaySettings const& settings,
                     std::vector<gi::Camera> const& now, WallPass::Outside outside)
{
    bool const is_curved = !pane.left_faces.views.empty();
    std::array<EyeView, 2> eyes{eye(pane.left, now), {}};
    eyes[1] = pane.right >= 0 ? eye(pane.right, now) : eyes[0];
    std::array<PaneFaces const*, 2> faces{&pane.left_faces,
                                          pane.right_faces.views.empty() ? &pane.left_faces : &pane.right_faces};
    if (!is_curved && (eyes[0].picture.texture == 0 || eyes[1].picture.texture == 0)) return false;
    if (shown.swap_eyes) {
        std::swap(eyes[0], eyes[1]);
        std::swap(faces[0], faces[1]);
    }
    if (pane.right_alone) {
        eyes[0] = eyes[1];
        faces[0] = faces[1];
    }
    glm::ivec2 const size = eye_size(settings.stereo, pane.size_px);
    if (bent_px_ != size) {
        flat_ = {};
        bent_ = {};
        bent_px_ = size;
    }
    DisplaySettings alone = settings;
    alone.stereo = StereoMode::off;
    for (std::size_t side = 0; side < (settings.stereo == StereoMode::off ? 1u : 2u); ++side) {
        if (!flat_[side]) {
            flat_[side].emplace(TextureTarget::Format::bytes, size);
            bent_[side].emplace(TextureTarget::Format::bytes, size);
        }
        if (is_curved)
            draw_faces(pane, *faces[side], alone, side, now);
        else
            pass_.draw(flat_[side]->target(), eyes[side], eyes[side], alone);
        if (has_overlay(pane, shown)) draw_overlay(shown.overlay, flat_[side]->target());
        walls_[std::size_t(pane.wall)].draw(bent_[side]->target(), flat_[side]->shown(), outside);
    }
    return true;
}

/// @param wall_picture  of one eye, before it is bent, top row first
void Presenter::draw_overlay(std::shared_ptr<WallOverlay const> const& overlay, DrawTarget const& wall_picture)
{
    WallOverlay const& o = *overlay;
    if (uploaded_ != overlay) {
        if (!overlay_picture_ || overlay_picture_->shown().size_px != o.size_px)
            overlay_picture_.emplace(TextureTarget::Format::bytes, o.size_px);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage2D(overlay_picture_->shown().texture, 0, 0, 0, o.size_px.x, o.size_px.y, GL_RGB,
                            GL_UNSIGNED_BYTE, o.rgb.data());
        uploaded_ = overlay;
    }
    glm::dvec2 const px(wall_picture.size_px);
    glm::ivec2 const top_left(glm::round(px * glm::dvec2(o.place.left, 1 - o.place.bottom - o.place.height)));
    glm::ivec2 const size(glm::round(px * glm::dvec2(o.place.width, o.place.height)));
    bind(wall_picture);
    glBlitNamedFramebuffer(overlay_picture_->target().framebuffer, wall_picture.framebuffer, 0, 0, o.size_px.x,
                           o.size_px.y, top_left.x, top_left.y, top_left.x + size.x, top_left.y + size.y,
                           GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

void Presenter::draw_one(std::size_t pane, DrawTarget const& part, EyeView const& view, gi::Camera const& camera,
                         bool as_rendered, DisplaySettings const& settings, bool fades)
{
    StillFade& fade = fades_[pane];
    if (view.is_drawn) {
        TextureTarget const& drawn = surface_display_->draw(int(pane), pass_, part, view, settings);
        fade.show_surfaces(drawn, camera, settings.tone);
    } else if (fades && as_rendered) {
        LiveFrame const& f = views_.frame();
        fade.draw(pass_, fade_pass_, part, view, camera, {f.command.frame, f.result.still_frames}, settings);
    } else {
        fade.forget();
        pass_.draw(part, view, view, settings);
    }
}

void Presenter::draw(DrawTarget const& whole, glm::ivec2 on_screen_px, std::vector<Pane> const& all,
                     PresentSettings const& s, std::vector<gi::Camera> const& now)
{
    if (!surface_display_ && s.surfaces_scale > 0) surface_display_.emplace();
    views_.begin(s.surfaces_scale, s.moment ? &*s.moment : nullptr, s.drive);
    std::vector<Pane> panes = all;
    for (Pane& pane : panes)
        if (has_overlay(pane, s)) pane.wall = pane.of_wall; // also through a wall pass that changes nothing
    std::vector<char> is_drawn(panes.size()), may_fade(panes.size());
    for (std::size_t k = 0; k < panes.size(); ++k) {
        if (is_drawn[k]) continue;
        Pane const& pane = panes[k];
        DrawTarget const part = part_of(whole, pane.corner_px, pane.size_px);
        DisplaySettings settings;
        settings.tone = s.tone;
        settings.stereo = pane.stereo == StereoMode::two_windows ? StereoMode::off : mode_on(part, pane.stereo);
        settings.comparison = s.comparison;
        settings.split = s.split;
        settings.on_screen_px = on_screen_px + pane.corner_px;
        if (pane.wall < 0) {
            EyeView left = eye(pane.left, now), right = pane.right >= 0 ? eye(pane.right, now) : left;
            if (left.picture.texture == 0 || right.picture.texture == 0) continue;
            if (s.swap_eyes) std::swap(left, right);
            if (pane.right_alone) left = right;
            settings.light = s.light;
            gi::Camera const& rendered = views_.command(pane.left).camera;
            gi::Camera const& camera =
                std::size_t(pane.left) < now.size() ? now[std::size_t(pane.left)] : rendered;
            may_fade[k] = settings.stereo == StereoMode::off && settings.comparison == Comparison::off;
            if (may_fade[k])
                draw_one(k, part, left, camera, camera == rendered, settings, s.fades);
            else
                pass_.draw(part, left, right, settings);
            continue;
        }
        // Walls with meshes may share a viewport.
        bool has_picture = false;
        for (std::size_t q = k; q < panes.size(); ++q) {
            Pane const& other = panes[q];
            if (other.wall < 0 || other.corner_px != pane.corner_px || other.size_px != pane.size_px ||
                other.stereo != pane.stereo || other.right_alone != pane.right_alone)
                continue;
            is_drawn[q] = 1;
            if (bend(other, s, settings, now, has_picture ? WallPass::Outside::kept : WallPass::Outside::black))
                has_picture = true;
        }
        if (!has_picture) continue;
        EyeView const l{bent_[0]->shown(), {}};
        EyeView const r = settings.stereo == StereoMode::off ? l : EyeView{bent_[1]->shown(), {}};
        settings.values = PictureValues::encoded;
        settings.comparison = Comparison::off;
        pass_.draw(part, l, r, settings);
    }
    for (auto& [pane, fade] : fades_)
        if (pane >= may_fade.size() || !may_fade[pane]) fade.forget();
}

} // namespace viewer
