#include "viewer/app/requests.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "viewer/engine/picture_margin.h"
#include "viewer/engine/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace viewer {
namespace {

using Json = nlohmann::json;

Json list(gi::dvec3 v) { return {v.x, v.y, v.z}; }

gi::dvec3 point(Json const& v) { return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; }

constexpr double kTap_s = 0.05;
constexpr double kFarthest_m = 1e9, kLatest_s = 1e9;

/// Throws InputError if the absolute value exceeds the limit.
void check_within(char const* what, double value, double limit, char const* unit)
{
    if (std::abs(value) > limit)
        throw gi::InputError(fmt::format("'{}' = {:g}", what, value),
                             fmt::format("the range is {:g} to {:g} {}", -limit, limit, unit), "give less");
}

/// True for a request to set what is no setting of the viewer.
bool edits_scene(RemoteRequest const& r)
{
    std::string const key = r.arguments.at("key").get<std::string>();
    return key != kQuality && !is_setting(key);
}

Json value_of(std::string const& key, Settings const& settings)
{
    if (key != kQuality) return get(settings, key);
    auto const step = quality_of(settings);
    return step ? Json(quality_names()[*step]) : Json();
}

} // namespace

bool Requests::waits(RemoteRequest const& r) const
{
    static std::array const free{"ping", "stats", "get", "quit", "load", "session"};
    static std::array const of_scene{"set", "pick", "screenshot", "seek"};
    if (r.what == "set" && !edits_scene(r)) return false;
    if (state_.facts.scene.empty()) return std::ranges::find(free, r.what) == free.end();
    return loading_ > 0 && std::ranges::find(of_scene, r.what) != of_scene.end();
}

void Requests::begin()
{
    for (RemoteRequest const& r : std::exchange(early_, {})) try {
            if (std::optional<Json> const now = handle(r)) server_->answer(r.token, *now);
        } catch (gi::InputError const& e) {
            server_->refuse(r.token, e.what());
        }
}

std::optional<Json> Requests::handle(RemoteRequest const& r)
{
    if (waits(r)) {
        early_.push_back(r);
        return std::nullopt;
    }
    auto const done = [this, token = r.token](std::string const& wrong) {
        if (wrong.empty())
            server_->answer(token, Json::object());
        else
            server_->refuse(token, wrong);
    };
    static std::array const reads{"ping", "stats", "get", "pick", "screenshot"};
    if (std::ranges::find(reads, r.what) == reads.end()) changed_s_ = state_.clock.now_s();
    if (r.what == "ping") return Json::object();
    if (r.what == "stats") return stats();
    if (r.what == "quit") {
        state_.ends = true;
        return Json::object();
    }
    if (r.what == "camera") return camera(r);
    if (r.what == "get")
        return Json{{"value", value_of(r.arguments.at("key").get<std::string>(), state_.settings())}};
    if (r.what == "play" || r.what == "pause") {
        if (r.has("speed")) state_.change({"speed", r.arguments.at("speed")});
        state_.change({"play", r.what == "play"});
        return Json::object();
    }
    if (r.what == "seek") {
        double const time_s = r.arguments.at("time_s").get<double>();
        check_within("time_s", time_s, kLatest_s, "s");
        state_.renderer->go_to(time_s);
        return Json::object();
    }
    if (r.what == "session")
        throw gi::InputError("'session'", "no experiment runs here", "start one: lightwell study run");
    if (r.what == "load") {
        load(r);
    } else if (r.what == "set") {
        state_.change({r.arguments.at("key").get<std::string>(), r.arguments.at("value")}, done);
        if (!edits_scene(r)) return std::nullopt; // answered already
    } else if (r.what == "screenshot") {
        std::string const file = r.arguments.at("file").get<std::string>();
        if (!file.ends_with(".png") && !file.ends_with(".exr"))
            throw gi::InputError("a screenshot called '" + file + "'", "its file format is unknown",
                                 "end the name in .png or .exr");
        if (r.has("view") && r.arguments.at("view").get<int>() < 0)
            throw gi::InputError(fmt::format("view {}", r.arguments.at("view").get<int>()), "there is none",
                                 "count from 0");
        if (!r.has("view") && file.ends_with(".png") && !no_picture_.empty())
            throw gi::InputError("a screenshot of what is shown", no_picture_, "give the number of a view");
        shots_.push_back(
            {r.arguments.at("file").get<std::string>(), r.has("view") ? r.arguments.at("view").get<int>() : -1,
             r.has("converged") && r.arguments.at("converged").get<bool>(), changed_s_, false, r.token});
        state_.wants_screenshot = true;
    } else if (r.what == "key") {
        press(r);
    } else if (r.what == "pick") {
        pick(r);
    } else {
        throw gi::InputError("'" + r.what + "' cannot be done here", "the viewer does not support it",
                             "see docs/remote.md");
    }
    return std::nullopt;
}

Json Requests::camera(RemoteRequest const& r)
{
    if (r.has("name")) {
        std::string const name = r.arguments.at("name").get<std::string>();
        auto const found = std::find_if(state_.facts.cameras.begin(), state_.facts.cameras.end(),
                                        [&](gi::Camera const& c) { return c.name == name; });
        if (found == state_.facts.cameras.end()) {
            std::vector<std::string> known;
            for (gi::Camera const& c : state_.facts.cameras) known.push_back(c.name);
            throw gi::InputError("there is no camera '" + name + "'", "the scene has none of that name",
                                 known.empty() ? "leave out the name, or give a position"
                                               : gi::suggest(name, known));
        }
        state_.camera = *found;
        state_.navigation.go_to(found->world_from_camera);
    }
    for (char const* what : {"position", "look_at"})
        if (r.has(what))
            for (Json const& x : r.arguments.at(what)) check_within(what, x.get<double>(), kFarthest_m, "m");
    gi::dmat4 place = state_.navigation.world_from_camera();
    if (r.has("position")) place[3] = glm::dvec4(point(r.arguments.at("position")), 1);
    if (r.has("look_at")) {
        place = gi::look_at(gi::dvec3(place[3]), point(r.arguments.at("look_at")), 45).world_from_camera;
    } else if (r.has("rotation")) {
        Json const& q = r.arguments.at("rotation");
        gi::dquat rotation;
        rotation.x = q[0].get<double>();
        rotation.y = q[1].get<double>();
        rotation.z = q[2].get<double>();
        rotation.w = q[3].get<double>();
        glm::dvec4 const at = place[3];
        place = glm::mat4_cast(glm::normalize(rotation));
        place[3] = at;
    }
    if (r.has("position") || r.has("look_at") || r.has("rotation")) state_.navigation.go_to(place);
    if (r.has("fov_deg")) {
        double const fov = r.arguments.at("fov_deg").get<double>();
        if (!(fov > 0.001 && fov < 179))
            throw gi::InputError(fmt::format("a field of view of {} degrees", fov), "the range is 0.001 to 179",
                                 "45 is usual");
        state_.camera.yfov_rad = glm::radians(fov);
    }
    gi::dmat4 const m = state_.navigation.world_from_camera();
    gi::dquat const q = glm::quat_cast(glm::dmat3(m));
    return {{"position", list(gi::dvec3(m[3]))},
            {"rotation", {q.x, q.y, q.z, q.w}},
            {"fov_deg", glm::degrees(state_.camera.yfov_rad)}};
}

void Requests::load(RemoteRequest const& r)
{
    Change const change{"scene", r.arguments.at("scene")};
    ++loading_;
    state_.change(change, [this, token = r.token](std::string const& wrong) {
        changed_s_ = state_.clock.now_s();
        if (--loading_ == 0) begin();
        if (!wrong.empty()) {
            server_->refuse(token, wrong);
            return;
        }
        loads_.push_back({state_.clock.now_s(), token});
    });
}

void Requests::press(RemoteRequest const& r)
{
    std::string const name = r.arguments.at("key").get<std::string>();
    int const code = key_code(name);
    if (code < 0)
        throw gi::InputError("there is no key '" + name + "'", "the name is unknown", "see docs/viewer.md");
    std::string const action = r.has("action") ? r.arguments.at("action").get<std::string>() : "tap";
    double const now = state_.clock.now_s();
    keys_.push_back({now, r.token, state_.navigation.world_from_camera()});
    InputEvent e;
    e.kind = InputKind::key;
    e.code = code;
    e.action = action == "release" ? InputAction::release : InputAction::press;
    controls_.take(e, 1);
    if (action == "tap") releases_.push_back({now + kTap_s, code});
}

void Requests::step()
{
    double const now = stepped_s_ = state_.clock.now_s();
    // Requests that wait for a frame get one, even if the picture rests.
    bool waits = !keys_.empty() || !loads_.empty();
    for (Shot& s : shots_) waits |= !std::exchange(s.has_frame, true) && !has_seen(s.since_s);
    if (waits) state_.renderer->again();
    std::erase_if(releases_, [&](auto const& release) {
        if (release.first > now) return false;
        InputEvent e;
        e.kind = InputKind::key;
        e.code = release.second;
        e.action = InputAction::release;
        controls_.take(e, 1);
        return true;
    });
}

void Requests::pick(RemoteRequest const& r)
{
    if (!state_.frame) throw gi::InputError("nothing to pick", "no frame was shown yet", "try again later");
    ViewCommand const& v = state_.frame->command.views[0];
    double const scale = state_.frame->command.light_scale < 1 ? 1 : state_.frame->budget.scale; // of the view
    double const width = v.width / scale, height = v.height / scale;
    double const x = r.arguments.at("x_px").get<double>(), y = r.arguments.at("y_px").get<double>();
    if (!(x >= 0 && x <= width && y >= 0 && y <= height))
        throw gi::InputError(fmt::format("the pixel {:g}, {:g}", x, y),
                             fmt::format("the view has {:g} x {:g}", width, height), "give one within it");
    bool const select = r.has("select") && r.arguments.at("select").get<bool>();
    state_.pick({x / width, y / height}, width / height,
                [this, token = r.token, select](std::optional<Selection> const& found) {
                    if (select) state_.selection = found;
                    Json result{{"object", nullptr}};
                    if (found)
                        result = {{"object", found->object},
                                  {"material", found->material},
                                  {"position", list(found->picked.position)},
                                  {"distance_m", found->picked.distance_m}};
                    server_->answer(token, result);
                });
}

namespace {

void write(std::string const& file, int view, LiveFrame const& f, Snapshot const& shown, gi::Report& report)
{
    bool const exr = file.ends_with(".exr");
    if (view < 0 && !exr) return gi::write_png(file, shown.size_px.x, shown.size_px.y, shown.bytes);
    std::size_t const k = std::size_t(std::max(0, view));
    if (k >= f.result.views.size())
        throw gi::InputError(fmt::format("view {}", k), fmt::format("there are {}", f.result.views.size()),
                             "count from 0");
    gi::Picture const picture = without_margin(f.result.views[k].picture, f.result.views[k].margin_px);
    if (exr) return gi::write_exr(file, picture, gi::PixelType::single, report);
    gi::write_png(file, picture.width, picture.height,
                  gi::tone_map_bytes(*picture.find("color"), tone_settings(f.settings)));
}

} // namespace

/// Runs in the background, so that input does not wait for files.
void Requests::save(Shot const& shot, Snapshot const& shown)
{
    saving_.push_back(std::async(std::launch::async, [this, shot, shown, frame = state_.frame] {
        std::string wrong;
        try {
            write(shot.file, shot.view, *frame, shown, report_);
        } catch (gi::InputError const& e) {
            wrong = e.what();
        }
        state_.inbox.put([this, shot, wrong, number = frame->command.frame] {
            if (wrong.empty())
                server_->answer(shot.token, {{"file", shot.file}, {"frame", number}});
            else
                server_->refuse(shot.token, wrong);
        });
    }));
}

void Requests::presented(double shown_s, Snapshot const& picture)
{
    if (!state_.frame) return;
    LiveFrame const& f = *state_.frame;
    std::erase_if(shots_, [&](Shot const& shot) {
        if (!has_seen(shot.since_s) || f.command.only_light) return false;
        if (picture.empty() && shot.view < 0 && !shot.file.ends_with(".exr")) return false;
        if (shot.converged && state_.settings().refine && f.still_paths < kConvergedPaths) return false;
        save(shot, picture);
        return true;
    });
    std::erase_if(saving_, [](std::future<void> const& s) {
        return s.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    });
    std::erase_if(keys_, [&](Key const& key) {
        bool const in_frame = f.command.pose_s >= key.pressed_s;
        bool const moved = !(key.camera == state_.navigation.world_from_camera()) && state_.settings().reproject;
        if (!in_frame && !moved) return false;
        server_->answer(key.token, {{"frame", f.command.frame},
                                    {"after_ms", 1e3 * (shown_s - key.pressed_s)},
                                    {"reprojected", !in_frame}});
        return true;
    });
    std::erase_if(loads_, [&](Loaded const& l) {
        if (!has_seen(l.asked_s)) return false;
        server_->answer(l.token, Json::object());
        return true;
    });
}

Json Requests::stats() const
{
    Json j{{"scene", state_.facts.scene}, {"triangles", state_.facts.triangles}};
    if (std::optional<LoadProgress> const& l = state_.loading)
        j["loading"] = {{"scene", l->scene}, {"step", l->step.what},    {"done", l->step.done},
                        {"of", l->step.of},  {"fraction", l->fraction}, {"elapsed_s", l->elapsed_s}};
    if (state_.frame) {
        LiveFrame const& f = *state_.frame;
        j["frame"] = f.command.frame;
        j["scene_s"] = f.command.scene_s;
        j["render_ms"] = 1e3 * (f.done_s - f.begun_s);
        j["paths"] = f.command.paths;
        j["exposure"] = state_.settings().exposure_ev;
        j["still_paths"] = f.still_paths;
        j["still_frames"] = f.result.still_frames;
        j["at_rest"] = !state_.loading && loading_ == 0 && changed_s_ < stepped_s_ && !state_.drawing &&
                       state_.renderer->rests() && state_.renderer->newest() == state_.frame;
        for (ViewCommand const& v : f.command.views)
            j["views"].push_back({{"name", v.name}, {"width", v.width}, {"height", v.height}});
        j["stages_ms"] = Json::object();
        for (auto const& [stage, seconds] : f.result.stages_s) j["stages_ms"][stage] = 1e3 * seconds;
        j["options"] = f.result.options;
        j["schedule"] = f.schedule;
    }
    if (state_.live_error)
        j["compare"] = {{"relmse", state_.live_error->relmse}, {"flip", state_.live_error->flip}};
    if (!state_.message.empty()) j["message"] = state_.message;
    j["losses"] = Json::object();
    for (auto const& [what, loss] : report_.losses()) j["losses"][what] = loss.count;
    j["counts"] = report_.counts();
    return j;
}

} // namespace viewer
