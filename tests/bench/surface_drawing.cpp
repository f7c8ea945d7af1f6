// How long drawing the surfaces of a scene takes (viewer/devices/gl/surface_renderer.h) while a head walks, with
// nothing else on the machine.
//   bench_surface_drawing SCENE PATH [--size WxH] [--scale S]... [--pictures N]
// Prints ms of a picture at each scale, and a sum of all that was drawn: equal sums, equal pictures.

#include "viewer/app/user_avatars.h"
#include "viewer/bench/shown/head_path.h"
#include "viewer/devices/gl/context.h"
#include "viewer/devices/gl/surface_renderer.h"
#include "viewer/engine/picture_margin.h"
#include "viewer/engine/render_session.h"
#include "viewer/offline/choose_camera.h"

#include <algorithm>
#include <chrono>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace {

using namespace viewer;

double now_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void run(std::string const& scene, std::string const& head, glm::ivec2 whole, std::vector<double> const& scales,
         int pictures)
{
    gi::Report report;
    GlContext const gl = GlContext::surfaceless(report);
    RecordedScenes const scenes = scenes_with({}, {}, report);
    RenderSession session(scenes.load, 0, report);
    session.apply({"draw_surfaces", true});
    session.apply({"scene", scene});
    Walker walker(HeadPath(head), choose_camera(session.world(), {}).camera, 60, whole, 0, std::nullopt);
    double const seconds = walker.path().seconds();
    SurfaceRenderer renderer;
    PictureTexture picture;
    gi::Camera of;
    constexpr int kLight = 4;
    for (int k = 0; k < kLight; ++k) {
        FrameCommand command;
        command.frame = std::uint64_t(k);
        command.only_light = k > 0;
        command.light_scale = 0.25;
        command.paths = 1;
        Viewpoint const at = walker.at(0.25 * seconds * k / kLight, 0, 0);
        command.world_from_room = at.world_from_room;
        command.views = at.views;
        SessionFrame const frame = session.render(command, {});
        ViewPicture const& view = frame.views[0];
        renderer.take(frame.scene);
        renderer.take(frame.cells);
        if (view.light) renderer.add_light({{0, 0, view.light.get()}});
        gi::Layer const* const depth = view.picture.find(gi::seen_depth_of(view.picture));
        picture.upload({view.picture.width, view.picture.height}, view.picture.find("color")->data,
                       depth ? std::span<float const>(depth->data) : std::span<float const>());
        of = with_margin(command.views[0].camera, whole, view.margin_px);
    }
    while (!renderer.prepare(1)) {
    }
    for (double const scale : scales) {
        glm::ivec2 const size(glm::round(scale * glm::dvec2(whole)));
        std::vector<double> ms;
        double sum = 0;
        for (int k = -2; k < pictures; ++k) {
            double const t = seconds * (0.25 + 0.5 * std::max(k, 0) / pictures);
            glFinish();
            double const from = now_s();
            ShownPicture const shown = renderer.draw(0, 0, walker.at(t, 0, 0).views[0].camera, size, picture, of);
            glFinish();
            if (k >= 0) ms.push_back(1e3 * (now_s() - from));
            std::vector<float> rgb(std::size_t(3 * size.x * size.y));
            glGetTextureImage(shown.texture, 0, GL_RGB, GL_FLOAT, GLsizei(rgb.size() * sizeof(float)), rgb.data());
            if (k >= 0)
                for (float const v : rgb) sum += v / double(rgb.size()) / pictures;
        }
        std::ranges::sort(ms);
        fmt::print("{} {}x{}: median {:.1f} ms, longest {:.1f}; mean {:.9f}\n", scene, size.x, size.y,
                   ms[ms.size() / 2], ms.back(), sum);
    }
}

} // namespace

int main(int argc, char** argv)
try {
    glm::ivec2 whole(1280, 800);
    std::vector<double> scales;
    std::vector<std::string> files;
    int pictures = 40;
    for (int i = 1; i < argc; ++i) {
        std::string const a = argv[i];
        auto const value = [&] { return std::string(i + 1 < argc ? argv[++i] : ""); };
        if (a == "--size") {
            if (std::sscanf(value().c_str(), "%dx%d", &whole.x, &whole.y) != 2) return 2;
        } else if (a == "--scale")
            scales.push_back(std::stod(value()));
        else if (a == "--pictures")
            pictures = std::max(1, std::stoi(value()));
        else
            files.push_back(a);
    }
    if (files.size() != 2) {
        fmt::print(stderr, "usage: bench_surface_drawing SCENE PATH [--size WxH] [--scale S]... [--pictures N]\n");
        return 2;
    }
    if (scales.empty()) scales = {0.4, 0.5, 1};
    run(files[0], files[1], whole, scales, pictures);
    return 0;
} catch (std::exception const& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
}
