// A small user of a headset for tests: shows each eye a picture of its own and logs what the runtime says of every
// frame. The room has a white ball of radius 0.25 m at (0, 1.6, -2), the sky is blue 17 degrees above the horizon,
// the rest is red for the left eye and green for the right. Depths, where the runtime takes them, are those of the ball;
// all else is infinitely far.
//   hmd_client --graphics egl|glx|none --frames N [--log FILE] [--every N] [--keep] [--recentre] [--seated] [--depths] [--insets]
// Prints a line per change of phase and, last, counts and facts as JSON.

#include "gi/core/error.h"
#include "gi/scene/model/camera.h"
#include "viewer/devices/gl/context.h"
#include "viewer/devices/xr/keeper.h"

#include <CLI/CLI.hpp>
#include <GLFW/glfw3.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace viewer::test {
namespace {

struct Options {
    std::string graphics = "egl", log;
    int frames = 250, every = 1;
    double patience_s = 60;
    bool keep = false, recentre = false, seated = false, depths = false, insets = false;
};

double now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct Drawn {
    std::vector<std::uint8_t> pixels;
    std::vector<float> per_m; ///< 1 / depth
};

Drawn draw(HmdView const& view, HmdEye eye)
{
    gi::CameraRays const rays = gi::camera_rays(view.camera, view.width, view.height, gi::dvec3(0));
    gi::vec3 const ahead(-gi::dvec3(view.camera.world_from_camera[2]));
    Drawn drawn;
    drawn.pixels.reserve(std::size_t(view.width) * std::size_t(view.height) * 4);
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            gi::Ray const ray = rays.through({float(x) + 0.5f, float(y) + 0.5f});
            gi::vec3 const to_ball = gi::vec3(0, 1.6f, -2) - ray.origin;
            float const along = glm::dot(to_ball, ray.direction);
            float const inside = 0.25f * 0.25f - (glm::dot(to_ball, to_ball) - along * along);
            bool const is_ball = along > 0 && inside > 0;
            gi::vec3 colour = eye == HmdEye::left ? gi::vec3(255, 0, 0) : gi::vec3(0, 255, 0);
            if (ray.direction.y > 0.3f) colour = {0, 0, 255};
            if (is_ball) colour = {255, 255, 255};
            for (int c = 0; c < 3; ++c) drawn.pixels.push_back(std::uint8_t(colour[c]));
            drawn.pixels.push_back(255);
            float const depth = (along - std::sqrt(std::max(inside, 0.0f))) * glm::dot(ray.direction, ahead);
            drawn.per_m.push_back(is_ball ? 1 / depth : 0);
        }
    return drawn;
}

/// Textures that take a picture from the CPU.
class Uploads {
public:
    HmdPicture upload(std::vector<HmdView> const& views)
    {
        for (std::size_t v = 0; v < views.size(); ++v) {
            int const w = views[v].width, h = views[v].height;
            if (v == textures_.size()) {
                textures_.push_back(made(GL_RGBA8, w, h));
                depths_.push_back({made(GL_R32F, w, h), false, 1});
            }
            Drawn const drawn = draw(views[v], HmdEye(v % 2));
            glTextureSubImage2D(textures_[v], 0, 0, 0, w, h, GL_RGBA, GL_UNSIGNED_BYTE, drawn.pixels.data());
            glTextureSubImage2D(depths_[v].texture, 0, 0, 0, w, h, GL_RED, GL_FLOAT, drawn.per_m.data());
        }
        return {views, textures_, depths_, TextureValues::srgb, FirstRow::top};
    }

private:
    static unsigned made(GLenum format, int w, int h)
    {
        unsigned texture = 0;
        glCreateTextures(GL_TEXTURE_2D, 1, &texture);
        glTextureStorage2D(texture, 1, format, w, h);
        return texture;
    }

    std::vector<unsigned> textures_;
    std::vector<ShownDepth> depths_;
};

std::string cells(std::optional<RoomPose> const& pose)
{
    if (!pose) return ",,,,,,,";
    return fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", pose->position.x, pose->position.y,
                       pose->position.z, pose->rotation.x, pose->rotation.y, pose->rotation.z, pose->rotation.w);
}

std::string cells(HmdRawView const& raw)
{
    return fmt::format(",{:.9g},{:.9g}", fmt::join(raw.position, ","), fmt::join(raw.rotation, ",")) +
           fmt::format(",{:.9g}", fmt::join(raw.fov_rad, ","));
}

constexpr char const* kColumns =
    "frame,xr_time_ns,display_s,pose_s,has_pose,should_render"
    ",head_x,head_y,head_z,head_qx,head_qy,head_qz,head_qw"
    ",left_x,left_y,left_z,left_qx,left_qy,left_qz,left_qw,left_left,left_right,left_up,left_down"
    ",right_x,right_y,right_z,right_qx,right_qy,right_qz,right_qw,right_left,right_right,right_up,right_down"
    ",hand_left_x,hand_left_y,hand_left_z,hand_left_qx,hand_left_qy,hand_left_qz,hand_left_qw"
    ",hand_right_x,hand_right_y,hand_right_z,hand_right_qx,hand_right_qy,hand_right_qz,hand_right_qw"
    ",profile_left,select_left,move_left_x,move_left_y,aim_left_x,aim_left_y,aim_left_z,aim_left_qx,aim_left_qy"
    ",aim_left_qz,aim_left_qw";

void log_frame(std::FILE* file, HmdFrame const& f)
{
    std::string row = fmt::format("{},{},{:.9f},{:.9f},{:d},{:d}", f.frame, f.xr_time, f.display_s, f.pose_s,
                                  f.has_pose, f.should_render);
    row += cells(f.tracked.head);
    for (std::size_t eye = 0; eye < 2; ++eye) row += cells(eye < f.views.size() ? f.views[eye].raw : HmdRawView{});
    row += cells(f.tracked.left_hand) + cells(f.tracked.right_hand);
    row += fmt::format(",{},{:d},{:.9g},{:.9g}", f.hands[0].profile, f.hands[0].select, f.hands[0].move.x,
                       f.hands[0].move.y);
    row += cells(f.hands[0].aim) + "\n";
    std::fputs(row.c_str(), file);
    std::fflush(file);
}

struct Window {
    GLFWwindow* handle = nullptr;
    ~Window()
    {
        if (handle) glfwDestroyWindow(handle);
        glfwTerminate();
    }
};

std::optional<GlContext> open_context(Options const& o, Window& window, gi::Report& report)
{
    if (o.graphics == "none") return std::nullopt;
    if (o.graphics == "egl") return GlContext::surfaceless(report);
    if (!glfwInit()) throw std::runtime_error("no display");
    GlContext::context_hints();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    window.handle = glfwCreateWindow(64, 64, "hmd_client", nullptr, nullptr);
    if (!window.handle) throw std::runtime_error("no window");
    return GlContext::of_window(window.handle, report);
}

void say(std::string const& line)
{
    std::puts(line.c_str());
    std::fflush(stdout);
}

nlohmann::json facts(HmdSession const& s)
{
    HmdCounts const& c = s.counts();
    auto const mask = [&](HmdEye e) { return s.hidden(e).triangles.size() / 3; };
    return {{"phase", name(s.phase())},
            {"why", s.why()},
            {"runtime", s.info().runtime},
            {"space", s.info().space},
            {"width", s.info().width},
            {"height", s.info().height},
            {"inset_width", s.info().inset_width},
            {"takes_depths", s.takes_depths()},
            {"with_depth", c.with_depth},
            {"frames", c.frames},
            {"pictures", c.pictures},
            {"repeated", c.repeated},
            {"empty", c.empty},
            {"discarded", c.discarded},
            {"late_images", c.late_images},
            {"without_pose", c.without_pose},
            {"moved_spaces", c.moved_spaces},
            {"lost_events", c.lost_events},
            {"hidden_left", mask(HmdEye::left)},
            {"hidden_right", mask(HmdEye::right)}};
}

int run(Options const& o)
{
    gi::Report report;
    Window window;
    std::optional<GlContext> const context = open_context(o, window, report);
    HmdOptions options;
    if (o.seated) options = {HmdSpace::local, 1.2};
    if (o.depths) options.depths = HmdDepths::on;
    if (o.insets) options.insets = HmdInsets::on;
    HmdKeeper keeper(context ? &*context : nullptr, options);
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> const log(
        o.log.empty() ? nullptr : std::fopen(o.log.c_str(), "w"), &std::fclose);
    if (log) std::fprintf(log.get(), "%s\n", kColumns);
    std::string last;
    Uploads uploads;
    nlohmann::json result;
    bool is_recentred = false;
    int const sought_losses = o.keep ? 1 : 0;
    int shown = 0;
    double const end_s = now_s() + o.patience_s;
    while (shown < o.frames && now_s() < end_s) {
        HmdSession* const session = keeper.poll();
        std::string const state = session ? name(session->phase()) : keeper.trouble();
        if (state != last) say(last = state);
        if (keeper.ended() || keeper.losses() > sought_losses) break;
        if (!session) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            continue;
        }
        std::optional<HmdFrame> frame;
        if (context) {
            frame = session->begin_frame();
        } else {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            frame = session->poses(now_s());
        }
        if (!frame) continue;
        if (o.recentre && !is_recentred && frame->frame == 20) is_recentred = session->recentre();
        if (context) {
            bool const is_new = session->counts().pictures == 0 || frame->frame % std::uint64_t(o.every) == 0;
            if (frame->should_render && is_new)
                session->end_frame(uploads.upload(frame->views));
            else
                session->repeat_frame();
        }
        if (log) log_frame(log.get(), *frame);
        if (session->phase() == HmdPhase::focused && (!o.keep || keeper.losses() > 0)) ++shown;
        if (shown == 1) say("counting");
        result = facts(*session);
    }
    result["losses"] = keeper.losses();
    result["shown"] = shown;
    result["gl_errors"] = context ? context->errors() : 0;
    // The polite end: STOPPING and EXITING are seen through.
    if (HmdSession* const session = keeper.poll(); session && shown >= o.frames) {
        session->request_exit();
        while (now_s() < end_s && keeper.poll() != nullptr) {
            if (!context)
                std::this_thread::sleep_for(std::chrono::milliseconds(10));
            else if (session->begin_frame())
                session->end_frame();
        }
        result["ended"] = keeper.ended() ? keeper.trouble() : "";
    }
    say(result.dump());
    return shown >= o.frames ? 0 : 1;
}

} // namespace
} // namespace viewer::test

int main(int argc, char** argv)
{
    viewer::test::Options o;
    CLI::App app;
    app.add_option("--graphics", o.graphics)->check(CLI::IsMember({"egl", "glx", "none"}));
    app.add_option("--frames", o.frames);
    app.add_option("--every", o.every);
    app.add_option("--log", o.log);
    app.add_option("--patience", o.patience_s);
    app.add_flag("--keep", o.keep);
    app.add_flag("--recentre", o.recentre);
    app.add_flag("--seated", o.seated);
    app.add_flag("--depths", o.depths);
    app.add_flag("--insets", o.insets);
    CLI11_PARSE(app, argc, argv);
    try {
        return viewer::test::run(o);
    } catch (gi::InputError const& e) {
        std::fprintf(stderr, "hmd_client: %s\n", e.what());
        return 2;
    } catch (std::exception const& e) {
        std::fprintf(stderr, "hmd_client: %s\n", e.what());
        return 1;
    }
}
