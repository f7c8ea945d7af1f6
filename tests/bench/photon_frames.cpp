// Frames of methods while the only lamp moves: seconds a frame, error of the indirect light, flicker, shares of
// time; and what light a thin wall lets through.
//   bench_photon_frames [--frames N] [--size N] [--photons N] [--budget S] [--reference-paths N] [--methods A,B]
//                       [SCENE...]
// Scenes keep their surfaces alone: a point light circles between the camera and what it looks at. Flicker is the
// mean of |L(t - 1) - 2 L(t) + L(t + 1)| over the mean of L, of layer L2:
// 0 for light that follows the lamp evenly.

#include "gi/core/quantile.h"
#include "gi/core/text.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/registry.h"
#include "gi/metrics/compare.h"
#include "gi/render/exact_visibility.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/motion/moving_world.h"

#include <chrono>
#include <fmt/format.h>
#include <map>

namespace {

using namespace gi;

struct Options {
    int frames = 8, size = 256;
    int photons = 0; ///< 0 = the methods' default
    double budget_s = 0;
    std::uint32_t reference_paths = 2048;
    std::vector<std::string> methods{"ispm", "lpv", "isllpm", "multi_image", "sh_grid", "paths", "slhb", "reference"};
    std::vector<std::string> scenes;
};

/// Only surfaces, and one lamp. @param lamp  in the scene's coordinates
Scene lit_by_one_lamp(Scene scene, dvec3 lamp, float intensity)
{
    for (Material& m : scene.materials) {
        m.emission = vec3{0};
        m.emissive_map = {};
    }
    scene.environment.reset();
    scene.lights.clear();
    for (Node& n : scene.nodes) n.light = -1;
    Light light;
    light.intensity = vec3{intensity};
    scene.lights.push_back(light);
    Node node;
    node.name = "lamp";
    node.translation = lamp;
    node.light = 0;
    scene.nodes.push_back(node);
    return scene;
}

std::shared_ptr<Scene const> prepare(std::string const& name, Camera& camera, vec3& lamp, float& radius)
{
    Report report;
    Scene scene = load_scene(name, report);
    World const world = build_world(std::make_shared<Scene const>(scene), std::nullopt, report);
    camera = world.cameras.at(0);
    ExactVisibility const visibility(world, plan_scene(world).alpha_tests, 0);
    CameraRays const rays = camera_rays(camera, 64, 64, world.origin);
    RayQuery const q{.ray = rays.through({32, 26})};
    Hit hit;
    visibility.nearest({&q, 1}, {&hit, 1});
    float const distance = std::min(hit.distance, world.bounds.radius());
    lamp = q.ray.origin + 0.6f * distance * q.ray.direction;
    radius = 0.05f * distance;
    return std::make_shared<Scene const>(
        lit_by_one_lamp(std::move(scene), dvec3(lamp) + world.origin, square(distance)));
}

double flicker(std::vector<std::vector<float>> const& frames)
{
    double bend = 0, sum = 0;
    for (std::size_t t = 1; t + 1 < frames.size(); ++t)
        for (std::size_t k = 0; k < frames[t].size(); ++k) {
            bend += std::abs(double(frames[t - 1][k]) - 2 * double(frames[t][k]) + double(frames[t + 1][k]));
            sum += double(frames[t][k]);
        }
    return sum > 0 ? bend / sum : 0;
}

void measure(std::string const& name, Options const& o)
{
    Camera camera;
    vec3 lamp;
    float radius = 0;
    std::shared_ptr<Scene const> const scene = prepare(name, camera, lamp, radius);
    RenderSettings s;
    s.width = s.height = o.size;
    auto const place = [&](MovingWorld& world, int frame) {
        Light light = world.world().lights.at(0);
        float const angle = 0.2f * float(frame);
        light.position = lamp + radius * vec3{std::cos(angle), 0, std::sin(angle)};
        return world.set_light(0, light);
    };
    StopRequest stop;
    Report quiet;
    MovingWorld last(scene, 0, quiet);
    place(last, o.frames - 1);
    s.paths = o.reference_paths;
    Picture const truth = find_method("reference").render(last.world(), camera, s, stop, {}, quiet).picture;
    fmt::print("{}: {} triangles, {} x {} pixels, reference of {} paths\n", name, last.world().triangles.size(),
               o.size, o.size, o.reference_paths);
    fmt::print("  {:<12} {:>8} {:>9} {:>8} {:>9} {:>7} {:>7} {:>9}  shares of time, %\n", "method", "first s",
               "frame s", "frames/s", "relMSE", "FLIP", "bias", "flicker");
    s.paths = 1;
    s.budget_s = o.budget_s;
    if (o.budget_s > 0) s.paths = 1 << 20;
    if (o.photons > 0) s.of<PhotonSettings>().paths = o.photons;
    for (std::string const& m : o.methods) {
        Report report;
        MovingWorld world(scene, 0, report);
        std::vector<double> seconds;
        std::vector<std::vector<float>> pictures;
        Picture picture;
        auto const begun = std::chrono::steady_clock::now();
        auto const since = [&](auto from) {
            return std::chrono::duration<double>(std::chrono::steady_clock::now() - from).count();
        };
        Changes const moved = place(world, 0);
        auto const frames = find_method(m).frames(world, camera, s, report);
        frames->changed(moved);
        double first_s = 0;
        std::map<std::string, double> before;
        for (int f = 0; f < o.frames; ++f) {
            auto const start = std::chrono::steady_clock::now();
            if (f > 0) frames->changed(place(world, f));
            picture = frames->frame(camera, stop, {}, {}).picture;
            if (f == 0) {
                first_s = since(begun);
                for (auto const& [stage, time_s] : report.times()) before[stage] = time_s;
            } else {
                seconds.push_back(since(start));
            }
            pictures.push_back(picture.find("L2")->data);
        }
        Comparison const c = compare(picture, truth, {"relmse", "flip", "bias"}, "L2");
        auto const value = [&](std::string const& what) {
            for (NamedValue const& v : c.values)
                if (v.name == what) return v.value;
            return std::nan("");
        };
        double all = 0;
        std::string shares;
        auto const counts = [](std::string const& stage) { // the other stages are parts or sums of these
            return stage != "trace" && !stage.ends_with("thread seconds");
        };
        for (auto const& [stage, time_s] : report.times())
            if (counts(stage)) all += time_s - before[stage];
        for (auto const& [stage, time_s] : report.times())
            if (double const share = (time_s - before[stage]) / all; counts(stage) && share > 0.005)
                shares += fmt::format(" {} {:.0f},", stage, 100 * share);
        double const frame_s = median(seconds);
        fmt::print("  {:<12} {:>8.3f} {:>9.4f} {:>8.2f} {:>9.4f} {:>7.4f} {:>7.3f} {:>9.4f} {}\n", m, first_s,
                   frame_s, 1 / frame_s, value("relmse"), value("flip"), value("bias"), flicker(pictures), shares);
        std::fflush(stdout);
    }
}

/// Two rooms of 2 m with a wall of 1 mm between them, a lamp in one. Each is looked at from the other's wall.
void measure_thin_wall(Options const& o)
{
    Scene scene;
    Material matt;
    matt.base_color = vec3{0.7f};
    matt.specular = 0;
    scene.materials.push_back(matt);
    scene.material_names.push_back("matt");
    auto const room = [&](vec3 low, vec3 high) {
        Mesh mesh;
        mesh.material = 0;
        for (int axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                vec3 corner = low, u{0}, v{0};
                corner[axis] = side == 0 ? low[axis] : high[axis];
                u[(axis + 1) % 3] = high[(axis + 1) % 3] - low[(axis + 1) % 3];
                v[(axis + 2) % 3] = high[(axis + 2) % 3] - low[(axis + 2) % 3];
                if (side == 1) std::swap(u, v); // faces inwards
                auto const first = std::uint32_t(mesh.positions.size());
                for (vec3 const p : {corner, corner + u, corner + u + v, corner + v}) mesh.positions.push_back(p);
                mesh.triangles.push_back({first, first + 1, first + 2});
                mesh.triangles.push_back({first, first + 2, first + 3});
            }
        Node node;
        node.meshes = {std::int32_t(scene.meshes.size())};
        scene.meshes.push_back(std::move(mesh));
        scene.nodes.push_back(node);
    };
    room({-2, 0, -1}, {0, 2, 1});
    room({0.001f, 0, -1}, {2, 2, 1});
    Scene const lit = lit_by_one_lamp(std::move(scene), {-1, 1.5, 0}, 1);
    Report report;
    World const world = build_world(std::make_shared<Scene const>(lit), std::nullopt, report);
    RenderSettings s;
    s.width = s.height = 64;
    s.paths = 16;
    fmt::print("thin wall: indirect light in the dark room over that in the lit one (truth 0)\n");
    for (std::string const& m : o.methods) {
        double mean[2];
        for (int dark = 0; dark < 2; ++dark) {
            dvec3 const from{dark == 0 ? -1.9 : 1.9, 1, 0};
            StopRequest stop;
            Picture const p =
                find_method(m).render(world, look_at(from, {0, 0.6, 0}, 80), s, stop, {}, report).picture;
            mean[dark] = 0;
            for (float const v : p.find("L2")->data) mean[dark] += double(v);
        }
        fmt::print("  {:<12} {:.5f}\n", m, mean[1] / mean[0]);
    }
}

} // namespace

int main(int argc, char** argv)
{
    Options o;
    for (int i = 1; i < argc; ++i) {
        std::string const a = argv[i];
        auto const number = [&] { return i + 1 < argc ? std::atof(argv[++i]) : 0; };
        if (a == "--frames")
            o.frames = int(number());
        else if (a == "--size")
            o.size = int(number());
        else if (a == "--photons")
            o.photons = int(number());
        else if (a == "--budget")
            o.budget_s = number();
        else if (a == "--reference-paths")
            o.reference_paths = std::uint32_t(number());
        else if (a == "--methods" && i + 1 < argc) {
            o.methods.clear();
            for (std::string_view const m : split_at_commas(argv[++i])) o.methods.emplace_back(m);
        } else
            o.scenes.push_back(a);
    }
    if (o.scenes.empty()) o.scenes = {"cornell", "ring"};
    for (std::string const& scene : o.scenes) measure(scene, o);
    measure_thin_wall(o);
}
