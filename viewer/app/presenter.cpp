#include "viewer/app/presenter.h"

#include "gi/surfaces/lit_picture.h"
#include "viewer/displays/compose.h"
#include "viewer/engine/picture_margin.h"

#include <algorithm>
#include <epoxy/gl.h>

namespace viewer {
namespace {

std::span<float const> floats(gi::Picture const& picture, char const* layer)
{
    gi::Layer const* const l = picture.find(layer);
    return l == nullptr ? std::span<float const>() : std::span<float const>(l->data);
}

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

void Presenter::upload(std::optional<Shown>& to, gi::Picture const& picture) const
{
    if (!to) to.emplace(Shown{{}, Reprojection(reprojection_)});
    to->picture.upload({picture.width, picture.height}, floats(picture, "color"),
                       floats(picture, gi::seen_depth_of(picture)));
}

void Presenter::take(std::shared_ptr<LiveFrame const> frame, std::vector<Pane> const& panes)
{
    frame_ = std::move(frame);
    if (frame_->result.scene) {
        if (!renderer_ && why_no_surfaces_.empty()) renderer_.emplace();
        if (renderer_) renderer_->take(frame_->result.scene);
        if (renderer_) renderer_->take(frame_->result.cells);
    }
    shown_.resize(frame_->result.views.size());
    std::vector<char> is_uploaded(shown_.size());
    for (Pane const& pane : panes) {
        std::vector<int> views{pane.left, pane.right};
        for (PaneFaces const* faces : {&pane.left_faces, &pane.right_faces})
            views.insert(views.end(), faces->views.begin(), faces->views.end());
        for (int const view : views) {
            if (view < 0 || std::size_t(view) >= shown_.size() || is_uploaded[std::size_t(view)]) continue;
            ShownView& s = shown_[std::size_t(view)];
            ViewPicture const& v = frame_->result.views[std::size_t(view)];
            upload(s.own, v.picture);
            s.is_light = false;
            if (v.compared)
                upload(s.other, *v.compared);
            else
                s.other.reset();
            is_uploaded[std::size_t(view)] = 1;
        }
    }
    for (std::size_t view = 0; view < shown_.size(); ++view)
        if (!is_uploaded[view]) shown_[view] = {};
}

bool Presenter::can_draw_surfaces(double most_s)
{
    prepares_ = false;
    if (!(surfaces_scale_ > 0) || !renderer_ || !frame_ || !frame_->result.scene) return false;
    try {
        prepares_ = !renderer_->prepare(most_s);
    } catch (std::runtime_error const& e) { // a driver that compiles them not: pictures are reprojected
        why_no_surfaces_ = e.what();
        renderer_.reset();
        return false;
    }
    return !prepares_;
}

bool Presenter::draws_surfaces() const
{
    return surfaces_scale_ > 0 && !prepares_ && renderer_ && frame_ && frame_->result.scene &&
           tried_ == frame_->result.scene->world.get() &&
           std::ranges::none_of(frame_->result.views, [](ViewPicture const& v) { return v.hidden || v.compared; });
}

std::optional<ShownPicture> Presenter::surfaces(int view, gi::Camera const& from, gi::Camera const& to,
                                                glm::ivec2 size_px)
{
    constexpr double kPrepare_s = 0.01;
    constexpr std::size_t kMostTexels = 1u << 18;
    if (!can_draw_surfaces(kPrepare_s)) return std::nullopt;
    ShownView& shown = shown_[std::size_t(view)];
    ViewPicture const& rendered = frame_->result.views[std::size_t(view)];
    if (shown.other || rendered.hidden) return std::nullopt;
    if (!std::exchange(shown.is_light, true)) {
        if (rendered.light) {
            renderer_->add_light(view, *rendered.light);
        } else {
            gi::LightPicture light = gi::light_picture(rendered.picture, from, kMostTexels);
            light.lamps = frame_->result.lamps;
            renderer_->add_light(view, light);
        }
    }
    if (!renderer_->has_light()) return std::nullopt;
    glm::ivec2 const size = glm::max(glm::ivec2(glm::round(surfaces_scale_ * glm::dvec2(size_px))), glm::ivec2(1));
    return renderer_->draw(view, to, size, shown.own->picture, from);
}

EyeView Presenter::eye(int view, std::vector<gi::Camera> const& now)
{
    if (!frame_ || view < 0 || std::size_t(view) >= frame_->command.views.size()) return {};
    if (std::size_t(view) >= shown_.size() || !shown_[std::size_t(view)].own) return {};
    auto& own = shown_[std::size_t(view)].own;
    auto& other = shown_[std::size_t(view)].other;
    ViewCommand const& rendered = frame_->command.views[std::size_t(view)];
    EyeView e{own->picture.shown(), other ? other->picture.shown() : own->picture.shown()};
    glm::ivec2 const margin = frame_->result.views[std::size_t(view)].margin_px,
                     size = frame_->command.only_light ? glm::ivec2(rendered.width, rendered.height)
                                                       : e.picture.size_px - 2 * margin;
    bool const moved = std::size_t(view) < now.size() && !rendered.camera.orthographic &&
                       !(now[std::size_t(view)] == rendered.camera);
    own->reprojection.keep_only(size);
    if (other) other->reprojection.keep_only(size);
    gi::Camera const from = with_margin(rendered.camera, size, margin),
                     &to = moved ? now[std::size_t(view)] : rendered.camera;
    // The first time takes long, as drivers compile then: it is done while nothing moves.
    if (!moved && !rendered.camera.orthographic && surfaces_scale_ > 0 && renderer_ && frame_->result.scene &&
        tried_ != frame_->result.scene->world.get() && surfaces(view, from, to, glm::ivec2(16)))
        tried_ = frame_->result.scene->world.get();
    bool const only_light = frame_->command.only_light; // else it shows surfaces itself
    if (!moved && !only_light && margin == glm::ivec2(0)) return e;
    if (moved || only_light)
        if (auto const drawn = surfaces(view, from, to, size)) {
            drew_surfaces_ = true;
            e.picture = e.other = *drawn;
            return e;
        }
    e.picture = e.other = own->reprojection.draw(own->picture, from, to, size);
    if (other) e.other = other->reprojection.draw(other->picture, from, to, size);
    return e;
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
        gi::Camera const& camera = frame_->command.views[std::size_t(faces.views[k])].camera;
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

void Presenter::draw(DrawTarget const& whole, glm::ivec2 on_screen_px, std::vector<Pane> const& all,
                     PresentSettings const& s, std::vector<gi::Camera> const& now)
{
    surfaces_scale_ = s.surfaces_scale;
    drew_surfaces_ = false;
    bool const can_draw = can_draw_surfaces(0);
    if (can_draw && s.pose && renderer_->can_move()) renderer_->move(s.pose(*frame_));
    std::vector<Pane> panes = all;
    for (Pane& pane : panes)
        if (has_overlay(pane, s)) pane.wall = pane.of_wall; // also through a wall pass that changes nothing
    std::vector<char> is_drawn(panes.size());
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
}

} // namespace viewer
