#include "viewer/engine/render_session.h"

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/kernel/device.h"
#include "gi/raster/fragments.h"
#include "gi/scene/motion/animation.h"
#include "viewer/engine/picture_margin.h"

#include <algorithm>
#include <cmath>
#include <malloc.h>

namespace viewer {
namespace {

SceneStart start_of(FrameCommand const& command)
{
    SceneStart start{command.views.front().camera, 0};
    for (ViewCommand const& v : command.views) start.pixels += double(v.width) * v.height;
    return start;
}

/// Sets hidden pixels to black, without a surface.
void blacken(gi::Picture& picture, std::vector<std::uint8_t> const& hidden)
{
    std::vector<float>&color = picture.find("color")->data, &depth = picture.find("depth")->data;
    for (std::size_t i = 0; i < hidden.size(); ++i)
        if (hidden[i] != 0) color[3 * i] = color[3 * i + 1] = color[3 * i + 2] = depth[i] = 0;
}

/// Returns freed memory to the system: a session may load many scenes, and what one method leaves would stay
/// between the pieces that the next one takes.
void release_memory()
{
    gi::release_spare_fragments();
    malloc_trim(0);
}

/// Puts the headlight of a new world at the eye.
void shine(gi::MovingWorld& world, gi::dvec3 eye_m)
{
    gi::World const& w = world.world();
    world.set_light(w.lights.size() - 1, light_at(headlight_of(w), eye_m, w.origin));
}

[[noreturn]] void refuse_headlight(Change const& change)
{
    throw gi::InputError("'" + change.key + "'", "it is the headlight, which goes with the head",
                         "switch it off by headlight=false");
}

/// A view of all that is around the eye, of a quarter of it in each frame.
gi::FrameView around(FrameCommand const& command)
{
    constexpr int kSide_px = 56;
    constexpr double kFov_rad = 2.0; // of a tetrahedron's faces and a little more
    constexpr double k = 0.5773502691896258;
    static constexpr std::array<gi::dvec3, 4> kForward{gi::dvec3{k, k, k}, {-k, -k, k}, {-k, k, -k}, {k, -k, -k}};
    gi::dvec3 const eye(command.views.front().camera.world_from_camera[3]);
    gi::FrameView view;
    view.camera = gi::look_at(eye, eye + kForward[command.frame % kForward.size()], glm::degrees(kFov_rad));
    view.width = view.height = kSide_px;
    view.filter = gi::PixelFilter::centre;
    return view;
}

} // namespace

ViewCommand scaled(ViewCommand view, double scale)
{
    view.width = std::max(1, int(std::lround(view.width * scale)));
    view.height = std::max(1, int(std::lround(view.height * scale)));
    return view;
}

bool has_own_surfaces(FrameCommand const& command)
{
    return std::none_of(command.views.begin(), command.views.end(), [](ViewCommand const& v) {
        return v.camera.orthographic || v.camera.aperture_radius_m > 0;
    });
}

RenderSession::RenderSession(LoadScene load, int threads, gi::Report& report)
    : load_(std::move(load)), threads_(threads), report_(report)
{
}

bool RenderSession::moves() const
{
    return world_ && std::any_of(scene_->playbacks.begin(), scene_->playbacks.end(), [&](gi::Playback const& p) {
               return p.weight > 0 && p.speed != 0 && scene_->animations[std::size_t(p.animation)].duration_s > 0;
           });
}

void RenderSession::apply(Change const& change)
{
    if (change.key == "scene") {
        SceneChange const wanted = scene_change_of(change);
        ChooseStart choose;
        if (wanted.start) choose = [&](gi::World const&) { return *wanted.start; };
        return adopt(prepare(wanted.name, settings_, choose));
    }
    if (is_scene_edit(change.key)) return edit_scene(change);
    if (is_hidden_mask(change.key)) {
        hidden_.apply(change);
        hidden_surfaces_.apply(change);
        return hidden_light_.apply(change);
    }
    Settings changed = settings_;
    set(changed, change);
    if (change.key == "device") gi::check_device(changed.render.space);
    if (change.key == "denoise") gi::check_filter(denoise_settings(changed, 0));
    bool const switches_headlight = changed.headlight != settings_.headlight;
    settings_ = std::move(changed);
    if (switches_headlight && world_)
        rebuild(settings_.headlight ? with_headlight(*scene_) : without_headlight(*scene_));
    if (restarts_methods(change.key)) restart();
    if (change.key == "compare") compared_.reset();
}

void RenderSession::edit_scene(Change const& change)
{
    if (!world_) throw gi::InputError("'" + change.key + "'", "no scene is loaded", "load one first");
    if (is_object_edit(change.key)) return place_object(change);
    if (headlight_ && change.key.starts_with("light." + std::to_string(world_->world().lights.size() - 1) + "."))
        refuse_headlight(change);
    pending_.add(edit(*world_, change));
    std::erase_if(edits_, [&](Change const& c) { return c.key == change.key; });
    edits_.push_back(change);
}

void RenderSession::restart()
{
    main_.reset();
    compared_.reset();
    release_memory();
}

PreparedScene RenderSession::prepare(std::string const& name, Settings const& settings,
                                     ChooseStart const& choose) const
{
    PreparedScene made;
    made.change.name = name;
    gi::at_step("reading");
    made.scene = load_(name, report_);
    if (settings.headlight) made.scene = with_headlight(*made.scene);
    gi::at_step("world");
    // Not at the time of the last frame, which is not known before the scene is ready.
    made.world = std::make_unique<gi::MovingWorld>(made.scene, 0.0, report_);
    made.settings = settings;
    if (!choose) return made;
    gi::at_step("first camera");
    made.change.start = choose(made.world->world());
    if (settings.headlight) shine(*made.world, gi::dvec3(made.change.start->camera.world_from_camera[3]));
    start_method(made);
    return made;
}

/// A method that cannot start with the scene says so when a frame is rendered: the user may choose another.
void RenderSession::start_method(PreparedScene& scene) const
{
    gi::at_step("start of the method");
    try {
        scene.method = std::make_unique<MethodRunner>(scene.settings.method, *scene.world, scene.settings,
                                                      threads_, *scene.change.start, report_, true);
    } catch (gi::InputError const&) {
        scene.method.reset();
    }
}

void RenderSession::adopt(PreparedScene p)
{
    bool as_set = std::ranges::all_of(
        setting_keys(), [&](SettingKey const& k) { return !k.restarts || k.get(p.settings) == k.get(settings_); });
    if (p.settings.headlight != settings_.headlight) {
        p.scene = settings_.headlight ? with_headlight(*p.scene) : without_headlight(*p.scene);
        p.method.reset(); // it refers to the old world
        p.world = std::make_unique<gi::MovingWorld>(p.scene, 0.0, report_);
        if (settings_.headlight && p.change.start)
            shine(*p.world, gi::dvec3(p.change.start->camera.world_from_camera[3]));
        as_set = false;
    }
    if (!as_set) {
        p.settings = settings_;
        p.method.reset();
        if (p.change.start) start_method(p);
    }
    main_.reset(); // method runners refer to the old world
    compared_.reset();
    seen_.reset();
    shown_world_.reset();
    forget_cells();
    forget_smoothed();
    placed_.clear();
    edits_.clear();
    pending_ = {};
    world_ = std::move(p.world);
    scene_ = std::move(p.scene);
    note_headlight();
    main_ = std::move(p.method);
    shown_ = std::move(p.change);
    release_memory();
}

void RenderSession::rebuild(std::shared_ptr<gi::Scene const> scene)
{
    auto world = std::make_unique<gi::MovingWorld>(scene, time_s_, report_);
    restart(); // method runners refer to the old world
    seen_.reset();
    shown_world_.reset();
    forget_cells();
    forget_smoothed();
    world_ = std::move(world);
    scene_ = std::move(scene);
    note_headlight();
    pending_ = {};
    std::erase_if(edits_, [&](Change const& c) { // of all lights, where there was but the headlight
        try {
            edit(*world_, c);
            return false;
        } catch (gi::InputError const&) {
            return true;
        }
    });
}

void RenderSession::note_headlight()
{
    headlight_.reset();
    if (settings_.headlight) headlight_ = headlight_of(world_->world());
}

gi::dvec3 RenderSession::position_of(std::string const& object) const
{
    if (!world_)
        throw gi::InputError("there is no object '" + object + "'", "no scene is loaded", "load one first");
    gi::Pose now = gi::evaluate_pose(*scene_, time_s_);
    place(*scene_, placed_, now);
    return placed_object(*scene_, now, placed_, {"object." + object + ".scale", 1}).position;
}

void RenderSession::place_object(Change const& change)
{
    gi::Pose now = gi::evaluate_pose(*scene_, time_s_);
    place(*scene_, placed_, now);
    PlacedObject const object = placed_object(*scene_, now, placed_, change);
    if (headlight_ && object.node + 1 == scene_->nodes.size()) refuse_headlight(change);
    if (!scene_->nodes[object.node].driven) {
        auto scene = std::make_shared<gi::Scene>(*scene_);
        scene->nodes[object.node].driven = true;
        rebuild(std::move(scene));
    }
    std::erase_if(placed_, [&](PlacedObject const& p) { return p.node == object.node; });
    placed_.push_back(object);
}

gi::Changes RenderSession::move_to(FrameCommand const& command)
{
    time_s_ = command.scene_s;
    gi::Pose pose = gi::evaluate_pose(*scene_, time_s_);
    place(*scene_, placed_, pose);
    if (drive_) drive_(*scene_, command, pose);
    gi::Changes changes = std::exchange(pending_, {});
    std::optional<gi::dvec3> eye = std::exchange(eye_, {});
    if (!eye && !command.views.empty()) eye = eye_of(command.views);
    if (headlight_ && eye) {
        gi::Light const light = light_at(*headlight_, *eye, world_->world().origin);
        changes.add(world_->set_light(world_->world().lights.size() - 1, light));
        pose.world_from_node.back()[3] = glm::dvec4(*eye, 1);
    }
    changes.add(world_->advance(pose));
    return changes;
}

void RenderSession::forget_cells()
{
    cells_.reset();
    known_.reset();
}

void RenderSession::forget_smoothed()
{
    smoothed_.clear();
    smoothed_compared_.clear();
}

void RenderSession::learn(gi::LightPicture const& light)
{
    constexpr std::size_t kTexels = 1u << 13; // of a view
    if (cells_) cells_->learn(light, kTexels, world_->world().origin);
}

/// Brings the light of all views for those who draw surfaces. @param light  its views are those of light
void RenderSession::learn_light(FrameCommand const& light, SessionFrame& frame)
{
    if (!cells_) cells_.emplace(world_->world().bounds.radius());
    for (std::size_t k = 0; k < light.views.size(); ++k) {
        ViewCommand const& v = light.views[k];
        auto found = std::make_shared<gi::LightPicture>(main_->light(k)->picture());
        flat_mirrors_.keep_images(*found, main_->images(k), world_->world().origin);
        gi::find_mean(*found);
        found->without_punctual = main_->left_out_punctual();
        found->lamps = lamps_;
        found->camera = v.camera;
        found->camera_width = v.width;
        found->camera_height = v.height;
        learn(*found);
        frame.views[k].light = std::move(found);
    }
    gi::LightPicture around = main_->light_around();
    around.without_punctual = main_->left_out_punctual();
    if (!around.texels.empty()) cells_->learn(around, around.texels.size(), world_->world().origin);
    known_ = cells_->table();
    report_.count("cells of light for which there was no room", double(known_->left_out));
}

/// Brings the light of pictures of the views' size, in fewer texels, for those who draw surfaces next.
void RenderSession::take_light(FrameCommand const& command, SessionFrame& frame) const
{
    constexpr std::size_t kOfAView = 1u << 18, kOfAll = 1u << 20;
    std::size_t const most = std::min(kOfAView, kOfAll / frame.views.size());
    for (std::size_t k = 0; k < frame.views.size(); ++k) {
        if (command.views[k].camera.orthographic) continue;
        auto found = std::make_shared<gi::LightPicture>(
            gi::light_picture(frame.views[k].picture, command.views[k].camera, most));
        found->lamps = lamps_;
        frame.views[k].light = std::move(found);
    }
}

bool RenderSession::depends_on_poses(std::vector<ViewCommand> const& views) const
{
    if (headlight_ || drive_) return true;
    return seen_ && seen_->has_mirrors() && std::ranges::any_of(views, [&](ViewCommand const& v) {
               gi::CameraRays const rays = gi::camera_rays(v.camera, v.width, v.height, world_->world().origin);
               return !flat_mirrors_.left_out(rays, v.width, v.height).empty();
           });
}

/// Replaces the pictures of light by larger ones, if they show mirrors or panes that nobody else draws.
void RenderSession::draw_mirrors(FrameCommand const& command, SessionFrame& frame)
{
    if (!seen_->has_mirrors()) return;
    gi::StageTimer const timer(report_, kSurfacesStage);
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const v = scaled(command.views[k], command.surface_scale);
        gi::CameraRays rays = gi::camera_rays(v.camera, v.width, v.height, world_->world().origin);
        gi::PixelBox const part = flat_mirrors_.left_out(rays, v.width, v.height);
        if (part.empty()) continue;
        rays.corner += float(part.low.x) * rays.step_x + float(part.low.y) * rays.step_y;
        glm::ivec2 const size = part.high - part.low;
        seen_->look_at_mirrors(rays, size.x, size.y,
                               main_->left_out_punctual() ? gi::SeenSurfaces::Lights::few
                                                          : gi::SeenSurfaces::Lights::none);
        gi::Picture& picture = frame.views[k].picture;
        picture = gi::mirror_picture(*seen_, part, v.width, v.height, *main_->light(k), picture);
    }
}

/// Replaces the pictures of light by pictures of the views' size.
void RenderSession::draw_surfaces(FrameCommand const& command, SessionFrame& frame)
{
    gi::StageTimer const timer(report_, kSurfacesStage);
    gi::LitCounts counts;
    smoothed_.resize(command.views.size());
    smoothed_compared_.resize(command.views.size());
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        ViewCommand const& view = command.views[k];
        HiddenPixels const hidden = hidden_surfaces_.pixels(scaled(view, command.surface_scale));
        // Beyond the edges of a view with hidden pixels, more are hidden.
        // A thin mask hides some at full size only.
        bool const hides = hidden || frame.views[k].hidden;
        glm::ivec2 const margin = hides ? glm::ivec2(0) : glm::ivec2(view.margin_x, view.margin_y);
        ViewCommand whole_view = view;
        whole_view.camera = with_margin(view.camera, {view.width, view.height}, margin);
        whole_view.width += 2 * margin.x;
        whole_view.height += 2 * margin.y;
        ViewCommand const v = scaled(whole_view, command.surface_scale);
        frame.views[k].margin_px = margin;
        auto const draw = [&](MethodRunner const& runner, SmoothedView& smoothed) {
            auto const lights =
                runner.left_out_punctual() ? gi::SeenSurfaces::Lights::few : gi::SeenSurfaces::Lights::none;
            gi::CameraRays const rays = gi::camera_rays(v.camera, v.width, v.height, world_->world().origin);
            if (smoothed.name != v.name) smoothed = {v.name, rays, v.width, v.height, {}};
            gi::CameraRays before = smoothed.rays; // in pixels of this picture, which may have another size
            before.step_x *= float(smoothed.width) / float(v.width);
            before.step_y *= float(smoothed.height) / float(v.height);
            seen_->look(rays, v.width, v.height, lights, smoothed.antialiasing.sample());
            gi::Picture const picture = gi::lit_picture(
                *seen_, v.width, v.height, *runner.light(k),
                hidden ? std::span<std::uint8_t const>(*hidden) : std::span<std::uint8_t const>(), counts, &before,
                gi::vec2(margin) * gi::vec2(v.width, v.height) / gi::vec2(whole_view.width, whole_view.height));
            smoothed.rays = rays;
            smoothed.width = v.width;
            smoothed.height = v.height;
            gi::Picture whole = smoothed.antialiasing.add(picture, whole_view.width, whole_view.height);
            if (frame.views[k].hidden) blacken(whole, *frame.views[k].hidden);
            return whole;
        };
        frame.views[k].picture = draw(*main_, smoothed_[k]);
        if (frame.views[k].compared) frame.views[k].compared = draw(*compared_, smoothed_compared_[k]);
    }
    report_.count("surfaces drawn", double(counts.surfaces));
    report_.count("surfaces that found no light of a similar surface", double(counts.unlike));
}

SessionFrame RenderSession::render(FrameCommand const& command, gi::StopRequest const& stop, OnStop on_stop)
{
    try {
        return render_whole(command, stop, on_stop);
    } catch (gi::Interrupted const&) {
        static_cast<void>(added_.times()); // are not the next frame's
        throw;
    }
}

SessionFrame RenderSession::render_whole(FrameCommand const& command, gi::StopRequest const& stop, OnStop on_stop)
{
    if (!world_) throw gi::InputError("there is nothing to render", "no scene is loaded", "load one first");
    gi::Changes changes;
    {
        gi::StageTimer const timer(report_, "world");
        changes = move_to(command);
    }
    constexpr float kOtherLight = 0.01f, kMoved = 0.8f; // what cells of light are worth then
    bool const other_light = scene_change(changes, false) == gi::SceneChange::light;
    lamps_ += other_light;
    if (cells_ && other_light)
        cells_->doubt(kOtherLight);
    else if (cells_ && changes.geometry)
        cells_->doubt(kMoved);
    if (!settings_.draw_surfaces) {
        shown_world_.reset();
        forget_cells();
    } else {
        std::shared_ptr<gi::ShownScene const> const before = shown_world_;
        shown_world_ = gi::shown_scene(world_, changes, before.get());
        if (!before || before->world != shown_world_->world || before->materials != shown_world_->materials)
            flat_mirrors_.take(*shown_world_);
        flat_mirrors_.move(*shown_world_->moved);
    }
    SessionFrame frame;
    frame.scene = shown_world_;
    if (shown_world_) frame.placed = placed_;
    frame.headlight = headlight_;
    frame.moved = changes.geometry;
    frame.lamps = lamps_;
    if (command.views.empty()) return frame;
    if (seen_) {
        gi::StageTimer const timer(report_, "update of surfaces");
        seen_->end_frame();
        seen_->changed(changes);
    }
    FrameCommand light = command; // the views of the pictures of light
    bool const smaller = command.light_scale < 1 && has_own_surfaces(command);
    if (!smaller) light.light_scale = 1;
    if (smaller)
        for (ViewCommand& v : light.views) v = scaled(v, command.light_scale);
    if (!seen_ && (smaller || (settings_.first_surfaces && gi::SeenSurfaces::mirrors_in(world_->world())))) {
        gi::StageTimer const timer(report_, "update of surfaces");
        seen_ = std::make_unique<gi::SeenSurfaces>(world_->world(), threads_);
    }
    bool const leaves_out = smaller && gi::SeenSurfaces::has_few_lights(world_->world());
    gi::SeenSurfaces* const seen = smaller || settings_.first_surfaces ? seen_.get() : nullptr;
    SceneStart const start = start_of(light);
    if (!main_)
        main_ = std::make_unique<MethodRunner>(settings_.method, *world_, settings_, threads_, start, report_);
    std::vector<HiddenPixels> hidden, hidden_light;
    for (ViewCommand const& v : command.views) hidden.push_back(hidden_.pixels(v));
    for (ViewCommand const& v : light.views)
        hidden_light.push_back(smaller ? hidden_light_.pixels(v) : hidden_.pixels(v));
    std::vector<gi::RenderResult> results =
        main_->render(light, hidden_light, changes, settings_, seen, leaves_out, stop,
                      settings_.compare.empty() ? on_stop : OnStop::shorten,
                      smaller && settings_.draw_surfaces ? around(command) : gi::FrameView());
    frame.still_frames = main_->still_frames();
    frame.dynamic_update = main_->dynamic_update();
    frame.options = results[0].options;
    frame.choice = main_->choice();
    frame.paths = int(results[0].paths);
    for (std::size_t k = 0; k < results.size(); ++k) {
        frame.rays += results[k].rays;
        frame.views.push_back({std::move(results[k].picture), {}, hidden[k]});
    }
    if (!settings_.compare.empty() && settings_.compare != settings_.method) {
        if (!compared_)
            compared_ =
                std::make_unique<MethodRunner>(settings_.compare, *world_, settings_, threads_, start, report_);
        std::vector<gi::RenderResult> others =
            compared_->render(light, hidden_light, changes, settings_, seen, leaves_out, stop, OnStop::shorten);
        for (std::size_t k = 0; k < others.size(); ++k) {
            frame.rays += others[k].rays;
            frame.views[k].compared = std::move(others[k].picture);
        }
    }
    bool const only_light = smaller && command.only_light;
    if (!smaller || only_light || other_light) forget_smoothed();
    if (settings_.draw_surfaces) {
        if (smaller)
            learn_light(light, frame);
        else
            take_light(command, frame);
    }
    frame.cells = known_;
    if (only_light && !draws_all_)
        draw_mirrors(command, frame);
    else if (smaller)
        draw_surfaces(command, frame);
    if (only_light) forget_smoothed();
    frame.stages_s = added_.times();
    return frame;
}

} // namespace viewer
