#include "viewer/app/view_state.h"

#include "gi/core/error.h"
#include "gi/kernel/device.h"
#include "viewer/displays/stereo_mode.h"
#include "viewer/engine/quality.h"

namespace viewer {

SceneFacts facts_of(RenderSession const& s)
{
    SceneFacts f;
    if (!s.has_scene()) return f;
    gi::World const& w = s.world();
    f.scene = s.scene_name();
    for (std::size_t i = 0; i < w.scene->materials.size(); ++i)
        f.materials.push_back({w.scene->material_names[i], w.materials[i]});
    f.lights = w.lights;
    if (s.has_headlight()) f.lights.pop_back();
    f.cameras = w.cameras;
    f.origin = w.origin;
    if (!w.bounds.empty()) {
        f.center = w.origin + gi::dvec3(w.bounds.center());
        f.radius_m = double(w.bounds.radius());
    }
    f.triangles = std::uint32_t(w.triangles.size());
    f.moves = s.moves();
    f.has_environment = w.environment != nullptr;
    f.environment_rotation_rad = w.environment_rotation_rad;
    f.environment_scale = w.environment_scale.x;
    return f;
}

void ViewState::change(Change const& c, std::function<void(std::string const&)> done)
{
    if (c.key == kQuality) {
        for (Change const& part : changes_of(c)) change(part);
        if (done) done({});
        return;
    }
    if (is_setting(c.key)) {
        check_offered(settings_, c.key);
        Settings changed = settings_;
        set(changed, c);
        if (c.key == "device") {
            if (is_one_of_ranks)
                throw gi::InputError("'device' while several ranks run", "every rank needs such a device",
                                     "start them with --set device=" + get(changed, "device").get<std::string>());
            gi::check_device(changed.render.space);
        }
        if (c.key == "stereo" && changed.stereo == name_of(StereoMode::two_windows) && !has_two_windows)
            throw gi::InputError("'stereo' = two-windows", "there is no second window",
                                 "start with --set stereo=two-windows");
        if (c.key == "exposure" && settings_.auto_exposure == "on") change({"auto_exposure", "hold"});
        changed.auto_exposure = c.key == "exposure" ? settings_.auto_exposure : changed.auto_exposure;
        settings_ = std::move(changed);
        renderer->post(c);
        if (done) done({});
        return;
    }
    if (c.key == "scene") return load(scene_change_of(c).name, std::move(done));
    renderer->post(c, [this, c, done = std::move(done)](std::string const& error) {
        inbox.put([this, c, error, done] {
            if (!error.empty()) message = error;
            if (done) done(error);
            refresh_facts();
        });
    });
}

void ViewState::expose(double ev)
{
    settings_.exposure_ev = ev;
    renderer->post({"exposure", ev});
}

void ViewState::follow(Settings const& of_frame)
{
    if (follows)
        settings_ = of_frame;
    else
        settings_.updated_axes = of_frame.updated_axes;
}

void ViewState::open_scene(std::string const& name)
{
    message.clear();
    change({"scene", name});
}

void ViewState::move_selection(gi::dvec3 by)
{
    selection->picked.position += by;
    renderer->ask([this, object = selection->object, by](RenderSession& s) {
        try {
            gi::dvec3 const at = s.position_of(object) + by;
            Change const moved{"object." + object + ".position", {at.x, at.y, at.z}};
            inbox.put([this, moved] { change(moved); });
        } catch (gi::InputError const& e) {
            inbox.put([this, why = std::string(e.what())] { message = why; });
        }
    });
}

void ViewState::refresh_facts()
{
    renderer->ask([this](RenderSession& s) { inbox.put([this, now = facts_of(s)] { facts = now; }); });
    refresh_ground();
}

void ViewState::refresh_ground()
{
    if (navigation.mode() != NavigationMode::walk) return;
    renderer->ask([this, known = ground_of_](RenderSession& s) {
        if (!s.has_scene() || s.world().scene == known.lock()) return;
        auto const ground = std::make_shared<Ground const>(s.world());
        inbox.put([this, ground, scene = std::weak_ptr(s.world().scene)] {
            navigation.set_ground(ground);
            ground_of_ = scene;
        });
    });
}

gi::Camera ViewState::now() const
{
    gi::Camera c = camera;
    c.world_from_camera = navigation.world_from_camera();
    return c;
}

void ViewState::pick(glm::dvec2 at, double aspect, std::function<void(std::optional<Selection> const&)> done)
{
    // Pixels are not square if each half of a window holds a whole view.
    if (frame && !frame->command.views.empty() && frame->command.views[0].camera.off_axis) {
        gi::ViewTangents const edge = *frame->command.views[0].camera.off_axis;
        aspect = (edge.right - edge.left) / (edge.top - edge.bottom);
    }
    pick_by(now(), at, aspect, std::move(done));
}

void ViewState::pick_along(gi::dmat4 const& world_from_ray,
                           std::function<void(std::optional<Selection> const&)> done)
{
    gi::Camera ray;
    ray.world_from_camera = world_from_ray;
    pick_by(ray, {0.5, 0.5}, 1, std::move(done));
}

void ViewState::pick_by(gi::Camera const& from, glm::dvec2 at, double aspect,
                        std::function<void(std::optional<Selection> const&)> done)
{
    renderer->ask([this, at, aspect, eye = from, done = std::move(done)](RenderSession& s) {
        std::optional<Selection> found;
        if (auto const hit = viewer::pick(s.world(), eye, aspect, at)) {
            gi::Scene const& scene = *s.world().scene;
            // Use the nearest named ancestor, which is what the scene's author would call the object.
            std::int32_t node = std::int32_t(hit->node);
            while (node >= 0 && scene.nodes[std::size_t(node)].name.empty())
                node = scene.nodes[std::size_t(node)].parent;
            found = Selection{*hit, node >= 0 ? scene.nodes[std::size_t(node)].name : std::to_string(hit->node),
                              hit->material < scene.material_names.size() ? scene.material_names[hit->material]
                                                                          : "default"};
        }
        inbox.put([found, done] { done(found); });
    });
}

} // namespace viewer
