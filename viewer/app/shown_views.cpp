#include "viewer/app/shown_views.h"

#include "gi/core/xxhash.h"
#include "gi/surfaces/lit_picture.h"
#include "viewer/app/fill_hidden.h"
#include "viewer/app/pose_at.h"
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

/// The next size that is no power of two, and neither is its half: llvmpipe compiles shaders anew, for half a second, when
/// a texture's size becomes one.
int no_power_of_two(int n)
{
    auto const is_power = [](int v) { return (v & (v - 1)) == 0; };
    while (is_power(n) || is_power((n + 1) / 2)) ++n;
    return n;
}

/// For each view the first one of the eyes of the same user.
std::vector<int> heads_of(std::vector<ViewCommand> const& views)
{
    constexpr double kApart_m = 0.1; // eyes of a head, if nobody says that they are partners
    auto const at = [&](std::size_t k) { return gi::dvec3(views[k].camera.world_from_camera[3]); };
    std::vector<int> heads(views.size());
    for (std::size_t k = 0; k < views.size(); ++k) {
        heads[k] = int(k);
        for (std::size_t j = 0; j < k; ++j) {
            if (views[k].partner != int(j) && !(glm::length(at(k) - at(j)) < kApart_m)) continue;
            int const from = std::max(heads[k], heads[j]), to = std::min(heads[k], heads[j]);
            std::replace(heads.begin(), heads.begin() + std::ptrdiff_t(k) + 1, from, to);
        }
    }
    return heads;
}

} // namespace

void ShownViews::upload(std::optional<Shown>& to, gi::Picture const& picture, HiddenPixels const& hidden)
{
    if (!to) to.emplace(Shown{{}, Reprojection(reprojection_), Reprojection(reprojection_)});
    std::span<float const> color = floats(picture, "color"), depth = floats(picture, gi::seen_depth_of(picture));
    if (hidden && 3 * hidden->size() == color.size()) {
        color_.assign(color.begin(), color.end());
        depth_.assign(depth.begin(), depth.end());
        fill_hidden(*hidden, picture.width, color_, 3);
        if (!depth.empty()) fill_hidden(*hidden, picture.width, depth_, 1);
        color = color_;
        depth = depth_;
    }
    to->picture.upload({picture.width, picture.height}, color, depth);
}

void ShownViews::take(std::shared_ptr<LiveFrame const> frame, std::vector<int> const& views)
{
    frame_ = std::move(frame);
    if (frame_->result.scene) {
        if (!renderer_ && why_no_surfaces_.empty()) renderer_.emplace();
        if (renderer_) renderer_->take(frame_->result.scene);
        if (renderer_) renderer_->take(frame_->result.cells);
    }
    is_light_added_ = false;
    number_views();
    views_.resize(frame_->result.views.size());
    std::vector<char> is_uploaded(views_.size());
    for (int const view : views) {
        if (view < 0 || std::size_t(view) >= views_.size() || is_uploaded[std::size_t(view)]) continue;
        View& to = views_[std::size_t(view)];
        ViewPicture const& v = frame_->result.views[std::size_t(view)];
        upload(to.own, v.picture, v.hidden);
        if (v.compared)
            upload(to.other, *v.compared, v.hidden);
        else
            to.other.reset();
        is_uploaded[std::size_t(view)] = 1;
    }
    for (std::size_t view = 0; view < views_.size(); ++view)
        if (!is_uploaded[view]) views_[view] = {};
}

void ShownViews::number_views()
{
    bool const alone = frame_->ordered.empty();
    std::vector<ViewCommand> const &own = frame_->command.views, &all = alone ? own : frame_->ordered;
    heads_ = heads_of(all);
    names_.clear();
    for (ViewCommand const& v : all) names_.push_back(v.name);
    numbers_.resize(own.size());
    for (std::size_t k = 0; k < own.size(); ++k)
        numbers_[k] = alone ? k : std::size_t(std::ranges::find(names_, own[k].name) - names_.begin());
}

void ShownViews::begin(double surfaces_scale, FrameCommand const* moment, DriveBodies const& drive)
{
    constexpr double kPrepare_s = 0.01;
    surfaces_scale_ = surfaces_scale;
    drew_surfaces_ = false;
    hashes_.assign(views_.size(), 0);
    drawn_.clear();
    prepare(kPrepare_s);
    is_ready_ = has_surfaces() && !prepares_;
    pose_s_ = moment ? std::optional(moment->pose_s) : std::nullopt;
    if (!is_ready_) return;
    if (moment && renderer_->can_move()) renderer_->move(pose_at(frame_->result, *moment, drive));
    renderer_->light(moment ? lights_at(frame_->result, *moment) : frame_->result.scene->lights);
    if (!moment) return;
    // What depends on no pose, so that poses are no older than drawing takes.
    FrameCommand const& rendered = frame_->command;
    bool const moved =
        !std::ranges::equal(moment->views, rendered.views, {}, &ViewCommand::camera, &ViewCommand::camera);
    if (moved || rendered.only_light) add_light();
    renderer_->update_shadows();
}

glm::ivec2 ShownViews::size_of(int view) const
{
    ViewCommand const& rendered = command(view);
    View const& shown = views_[std::size_t(view)];
    return frame_->command.only_light
               ? glm::ivec2(rendered.width, rendered.height)
               : shown.own->picture.shown().size_px - 2 * frame_->result.views[std::size_t(view)].margin_px;
}

gi::Camera ShownViews::camera_of(int view) const
{
    return with_margin(command(view).camera, size_of(view), frame_->result.views[std::size_t(view)].margin_px);
}

void ShownViews::prepare(double most_s)
{
    prepares_ = false;
    if (!has_surfaces()) return;
    try {
        prepares_ = !renderer_->prepare(most_s);
    } catch (std::exception const& e) { // a driver that compiles them not, no memory: pictures are reprojected
        why_no_surfaces_ = e.what();
        renderer_.reset();
    }
}

bool ShownViews::make_ready()
{
    surfaces_scale_ = 1;
    do prepare(1);
    while (prepares_);
    return has_surfaces();
}

std::uint64_t ShownViews::hash() const { return gi::xxh64(std::as_bytes(std::span(hashes_))); }

bool ShownViews::draws_surfaces() const
{
    return has_surfaces() && !prepares_ && tried_ == frame_->result.scene->world.get() &&
           std::ranges::none_of(frame_->result.views, [](ViewPicture const& v) { return v.compared.has_value(); });
}

void ShownViews::add_light()
{
    if (std::exchange(is_light_added_, true)) return;
    if (std::exchange(lit_names_, names_) != names_) renderer_->forget_light();
    std::vector<LightOfView> light;
    bool const alone = frame_->light.empty();
    for (std::size_t k = 0; k < heads_.size(); ++k)
        if (auto const& l = alone ? frame_->result.views[k].light : frame_->light[k])
            light.push_back({int(k), heads_[k], l.get()});
    renderer_->add_light(light);
}

std::optional<ShownPicture> ShownViews::surfaces(int view, ViewPart part, gi::Camera const& from,
                                                 gi::Camera const& to, glm::ivec2 size_px)
{
    View& shown = views_[std::size_t(view)];
    if (!is_ready_ || shown.other) return std::nullopt;
    add_light();
    if (!renderer_->has_light()) return std::nullopt;
    if (pose_s_) renderer_->show_at(*pose_s_);
    glm::ivec2 size = glm::max(glm::ivec2(glm::round(surfaces_scale_ * glm::dvec2(size_px))), glm::ivec2(1));
    size = {no_power_of_two(size.x), no_power_of_two(size.y)};
    std::size_t const number = numbers_[std::size_t(view)];
    ShownPicture const drawn =
        renderer_->draw(int(number), heads_[number], to, size, shown.own->picture, from, part);
    shown.depths[std::size_t(part)] = renderer_->depth(int(number), part);
    return drawn;
}

bool ShownViews::shows(int view) const
{
    return frame_ && view >= 0 && std::size_t(view) < std::min(frame_->command.views.size(), views_.size()) &&
           views_[std::size_t(view)].own;
}

EyeView ShownViews::eye(int view, gi::Camera const* now)
{
    if (!shows(view)) return {};
    EyeView const shown = draw(view, ViewPart::whole, now, size_of(view));
    if (shown.picture.texture != 0) drawn_.push_back(view);
    if (hashes_pictures_ && shown.picture.texture != 0) {
        glm::ivec2 const px = shown.picture.size_px;
        std::vector<float> rgb(std::size_t(3 * px.x * px.y));
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glGetTextureImage(shown.picture.texture, 0, GL_RGB, GL_FLOAT, GLsizei(rgb.size() * sizeof(float)),
                          rgb.data());
        hashes_[std::size_t(view)] = gi::xxh64(std::as_bytes(std::span(rgb)));
    }
    return shown;
}

EyeView ShownViews::middle(int view, gi::Camera const& now, glm::ivec2 size_px)
{
    return shows(view) ? draw(view, ViewPart::middle, &now, size_px) : EyeView{};
}

EyeView ShownViews::draw(int view, ViewPart part, gi::Camera const* now, glm::ivec2 size_px)
{
    View& shown = views_[std::size_t(view)];
    auto &own = shown.own, &other = shown.other;
    ViewCommand const& rendered = command(view);
    EyeView e{own->picture.shown(), other ? other->picture.shown() : own->picture.shown()};
    bool const moved = now != nullptr && !rendered.camera.orthographic && !(*now == rendered.camera);
    auto const reprojection = [&](Shown& of) -> Reprojection& {
        return part == ViewPart::whole ? of.reprojection : of.middle;
    };
    reprojection(*own).keep_only(size_px);
    if (other) reprojection(*other).keep_only(size_px);
    gi::Camera const from = camera_of(view), &to = moved ? *now : rendered.camera;
    // The first time takes long, as drivers compile then: it is done while nothing moves.
    if (!moved && !rendered.camera.orthographic && has_surfaces() && tried_ != frame_->result.scene->world.get() &&
        surfaces(view, part, from, to, glm::ivec2(16)))
        tried_ = frame_->result.scene->world.get();
    bool const only_light = frame_->command.only_light; // else it shows surfaces itself
    if (moved || only_light)
        if (auto const drawn = surfaces(view, part, from, to, size_px)) {
            drew_surfaces_ = true;
            e.picture = e.other = *drawn;
            e.is_drawn = true;
            return e;
        }
    if (moved || only_light || e.picture.size_px != size_px) {
        e.picture = e.other = reprojection(*own).draw(own->picture, from, to, size_px);
        if (other) e.other = reprojection(*other).draw(other->picture, from, to, size_px);
    }
    shown.depths[std::size_t(part)] = {own->picture.around() != 0 ? e.picture.texture : 0, true, 1};
    return e;
}

std::uint64_t shown_hash(std::span<ShownViews const* const> windows)
{
    if (windows.size() == 1) return windows[0]->hash();
    std::vector<std::uint64_t> of_windows;
    for (ShownViews const* w : windows) of_windows.push_back(w->hash());
    return gi::xxh64(std::as_bytes(std::span(of_windows)));
}

ShownFrame shown_frame(FrameCommand moment, std::span<ShownViews const* const> windows)
{
    ShownFrame shown{std::move(moment), windows[0]->drawn_scale(),
                     windows[0]->hashes_pictures() ? std::optional(shown_hash(windows)) : std::nullopt};
    if (windows.size() > 1)
        for (ShownViews const* w : windows) shown.windows.push_back({w->drawn_scale(), w->drawn_views()});
    return shown;
}

} // namespace viewer
