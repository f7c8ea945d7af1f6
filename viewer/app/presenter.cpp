#include "viewer/app/presenter.h"

#include "viewer/displays/compose.h"

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
    for (WallSettings const& w : walls) {
        walls_.emplace_back(w);
        surfaces_.emplace_back();
        if (w.surface) surfaces_.back().emplace(*w.surface);
    }
}

void Presenter::take(std::shared_ptr<LiveFrame const> frame, std::vector<Pane> const& panes)
{
    frame_ = std::move(frame);
    while (shown_.size() < frame_->result.views.size()) shown_.emplace_back();
    for (Shown& s : shown_) s.fresh = false;
    for (Pane const& pane : panes) {
        std::vector<int> views{pane.left, pane.right};
        for (PaneFaces const* faces : {&pane.left_faces, &pane.right_faces})
            views.insert(views.end(), faces->views.begin(), faces->views.end());
        for (int const view : views) {
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

void Presenter::make_targets(std::size_t side, glm::ivec2 size_px)
{
    if (flat_[side] && bent_px_ == size_px) return;
    flat_[side].emplace(TextureTarget::Format::bytes, size_px);
    bent_[side].emplace(TextureTarget::Format::bytes, size_px);
}

EyeView Presenter::curved(Pane const& pane, PaneFaces const& faces, DisplaySettings const& settings,
                          std::size_t side, glm::ivec2 size_px, std::vector<gi::Camera> const& now)
{
    make_targets(side, size_px);
    DisplaySettings alone = settings;
    alone.stereo = StereoMode::off;
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
        pass_.draw(face_targets_[k].target(), picture, picture, alone);
        gi::Camera const& camera = frame_->command.views[std::size_t(faces.views[k])].camera;
        if (camera.off_axis) shown.push_back({faces.faces[k], *camera.off_axis, face_targets_[k].shown()});
    }
    surfaces_[std::size_t(pane.wall)]->draw(flat_[side]->target(), shown, faces.eye_m);
    walls_[std::size_t(pane.wall)].draw(bent_[side]->target(), flat_[side]->shown());
    return {bent_[side]->shown(), {}};
}

void Presenter::draw_on_surface(Pane const& pane, DrawTarget const& target, PresentSettings const& shown,
                                DisplaySettings const& settings, std::vector<gi::Camera> const& now)
{
    PaneFaces const *left = &pane.left_faces, *right = &pane.right_faces;
    if (right->views.empty()) right = left;
    if (shown.swap_eyes) std::swap(left, right);
    if (pane.right_alone) left = right;
    glm::ivec2 const size = eye_size(settings.stereo, pane.size_px);
    EyeView const l = curved(pane, *left, settings, 0, size, now);
    EyeView const r = settings.stereo == StereoMode::off ? l : curved(pane, *right, settings, 1, size, now);
    bent_px_ = size;
    DisplaySettings joined = settings;
    joined.values = PictureValues::encoded;
    joined.comparison = Comparison::off;
    pass_.draw(target, l, r, joined);
}

ShownPicture Presenter::bent(Pane const& pane, EyeView const& eye, DisplaySettings const& settings,
                             std::size_t side, glm::ivec2 size_px)
{
    make_targets(side, size_px);
    DisplaySettings alone = settings;
    alone.stereo = StereoMode::off;
    pass_.draw(flat_[side]->target(), eye, eye, alone);
    walls_[std::size_t(pane.wall)].draw(bent_[side]->target(), flat_[side]->shown());
    return bent_[side]->shown();
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
        bool const is_curved = !pane.left_faces.views.empty();
        EyeView left = eye(pane.left, now), right = pane.right >= 0 ? eye(pane.right, now) : left;
        if (!is_curved && (left.picture.texture == 0 || right.picture.texture == 0)) continue;
        if (s.swap_eyes) std::swap(left, right);
        if (pane.right_alone) left = right;
        DrawTarget const part = part_of(whole, pane.corner_px, pane.size_px);
        DisplaySettings settings;
        settings.tone = s.tone;
        settings.stereo = pane.stereo == StereoMode::two_windows ? StereoMode::off : mode_on(part, pane.stereo);
        settings.comparison = s.comparison;
        settings.split = s.split;
        settings.on_screen_px = on_screen_px + pane.corner_px;
        if (is_curved)
            draw_on_surface(pane, part, s, settings, now);
        else if (pane.wall >= 0)
            draw_on_wall(pane, part, left, right, settings);
        else
            pass_.draw(part, left, right, settings);
    }
}

} // namespace viewer
