#include "viewer/app/presenter.h"

#include "viewer/displays/compose.h"

#include <epoxy/gl.h>
#include <utility>

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

Presenter::SeenView Presenter::see(int view, Drawing const& d)
{
    SeenView seen{view, {}, {}, false};
    bool const is_newer = view >= 0 && std::size_t(view) < d.now.size();
    seen.picture = views_.eye(view, is_newer ? &d.now[std::size_t(view)] : nullptr);
    if (seen.picture.picture.texture == 0) return seen;
    gi::Camera const& rendered = views_.command(view).camera;
    seen.camera = is_newer ? d.now[std::size_t(view)] : rendered;
    seen.as_rendered = seen.camera == rendered;
    return seen;
}

std::array<Presenter::SeenView, 2> Presenter::see(Pane const& pane, Drawing const& d)
{
    std::array<SeenView, 2> eyes{see(pane.left, d), {}};
    eyes[1] = pane.right >= 0 ? see(pane.right, d) : eyes[0];
    if (d.settings.swap_eyes) std::swap(eyes[0], eyes[1]);
    if (pane.right_alone) eyes[0] = eyes[1];
    return eyes;
}

bool Presenter::encodes(SeenView const& seen, DisplaySettings const& settings, Drawing const& d)
{
    return settings.comparison == Comparison::off &&
           (seen.picture.is_drawn || (d.settings.fades && seen.as_rendered));
}

TextureTarget const& Presenter::encoded(std::size_t pane, SeenView const& seen, glm::ivec2 size_px,
                                        DisplaySettings settings, Drawing& d)
{
    ViewOfPane const key(pane, seen.view);
    auto const [at, fresh] = d.encoded.try_emplace(key);
    if (!fresh) return *at->second;
    StillFade& fade = fades_[key];
    if (seen.picture.is_drawn) {
        at->second = &surface_display_->encoded(key, pass_, seen.picture, settings);
        fade.show_surfaces(*at->second, seen.camera, settings.tone);
        return *at->second;
    }
    if (!encodes(seen, settings, d)) fade.forget();
    settings.stereo = StereoMode::off;
    LiveFrame const& f = views_.frame();
    at->second = &fade.draw(pass_, fade_pass_, size_px, seen.picture, seen.camera,
                            {f.command.frame, f.result.still_frames, d.settings.moment_number}, settings);
    return *at->second;
}

void Presenter::show(std::size_t pane, DrawTarget const& to, SeenView const& left, SeenView const& right,
                     DisplaySettings const& settings, Drawing& d)
{
    bool const is_alone = settings.stereo == StereoMode::off;
    if (!encodes(left, settings, d) && (is_alone || !encodes(right, settings, d)))
        return pass_.draw(to, left.picture, right.picture, settings);
    glm::ivec2 const size = eye_size(settings.stereo, to.size_px);
    TextureTarget const& l = encoded(pane, left, size, settings, d);
    TextureTarget const& r = is_alone || right.view == left.view ? l : encoded(pane, right, size, settings, d);
    SurfaceDisplay::compose(pass_, to, l, r, settings);
}

void Presenter::draw_faces(std::size_t number, Pane const& pane, PaneFaces const& faces,
                           DisplaySettings const& settings, std::size_t side, Drawing& d)
{
    std::vector<ShownFace> shown;
    for (std::size_t k = 0; k < faces.views.size(); ++k) {
        SeenView const seen = see(faces.views[k], d);
        glm::ivec2 const size = seen.picture.picture.size_px;
        if (seen.picture.picture.texture == 0) continue;
        ShownPicture face;
        if (encodes(seen, settings, d)) {
            face = encoded(number, seen, size, settings, d).shown();
        } else {
            while (face_targets_.size() <= k) face_targets_.emplace_back(TextureTarget::Format::bytes, size);
            if (face_targets_[k].shown().size_px != size)
                face_targets_[k] = TextureTarget(TextureTarget::Format::bytes, size);
            pass_.draw(face_targets_[k].target(), seen.picture, seen.picture, settings);
            face = face_targets_[k].shown();
        }
        gi::Camera const& camera = views_.command(faces.views[k]).camera;
        if (camera.off_axis) shown.push_back({faces.faces[k], *camera.off_axis, face});
    }
    surfaces_[std::size_t(pane.wall)]->draw(flat_[side]->target(), shown, faces.eye_m);
}

bool Presenter::bend(std::size_t number, Pane const& pane, DisplaySettings const& settings, Drawing& d,
                     WallPass::Outside outside)
{
    bool const is_curved = !pane.left_faces.views.empty();
    std::array<SeenView, 2> const eyes = see(pane, d);
    std::array<PaneFaces const*, 2> faces{&pane.left_faces,
                                          pane.right_faces.views.empty() ? &pane.left_faces : &pane.right_faces};
    if (!is_curved && (eyes[0].picture.picture.texture == 0 || eyes[1].picture.picture.texture == 0)) return false;
    if (d.settings.swap_eyes) std::swap(faces[0], faces[1]);
    if (pane.right_alone) faces[0] = faces[1];
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
            draw_faces(number, pane, *faces[side], alone, side, d);
        else
            show(number, flat_[side]->target(), eyes[side], eyes[side], alone, d);
        if (has_overlay(pane, d.settings)) draw_overlay(d.settings.overlay, flat_[side]->target());
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

void Presenter::draw(DrawTarget const& whole, glm::ivec2 on_screen_px, std::vector<Pane> const& all,
                     PresentSettings const& s, std::vector<gi::Camera> const& now)
{
    if (!surface_display_ && s.surfaces_scale > 0) surface_display_.emplace();
    views_.begin(s.surfaces_scale, s.moment ? &*s.moment : nullptr, s.drive);
    std::vector<Pane> panes = all;
    for (Pane& pane : panes)
        if (has_overlay(pane, s)) pane.wall = pane.of_wall; // also through a wall pass that changes nothing
    std::vector<char> is_drawn(panes.size());
    Drawing drawing{s, now, {}};
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
            auto const [left, right] = see(pane, drawing);
            if (left.picture.picture.texture == 0 || right.picture.picture.texture == 0) continue;
            settings.light = s.light;
            show(k, part, left, right, settings, drawing);
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
            if (bend(q, other, settings, drawing,
                     has_picture ? WallPass::Outside::kept : WallPass::Outside::black))
                has_picture = true;
        }
        if (!has_picture) continue;
        EyeView const l{bent_[0]->shown(), {}};
        EyeView const r = settings.stereo == StereoMode::off ? l : EyeView{bent_[1]->shown(), {}};
        settings.values = PictureValues::encoded;
        settings.comparison = Comparison::off;
        pass_.draw(part, l, r, settings);
    }
    std::erase_if(fades_, [&](auto const& f) { return !drawing.encoded.contains(f.first); });
    if (surface_display_) surface_display_->keep(drawing.encoded);
}

} // namespace viewer
