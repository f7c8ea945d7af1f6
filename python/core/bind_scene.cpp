#include "python/core/bind_scene.h"

#include "gi/core/error.h"
#include "python/core/array.h"
#include "python/core/convert.h"
#include "python/core/errors.h"
#include "viewer/offline/load_world.h"
#include "viewer/offline/scene_light.h"

#include <algorithm>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

namespace bindings {
namespace {

constexpr char const* kLightTypes[] = {"point", "spot", "directional"};

gi::Camera looking_camera(Point position, Point target, double fov_deg, double aperture_radius_m,
                          std::optional<double> focus_distance_m)
{
    check_range("fov_deg", fov_deg, 0.001, 179);
    gi::Camera camera = gi::look_at(to_vec(position), to_vec(target), fov_deg);
    viewer::CameraChoice lens;
    if (aperture_radius_m != 0) lens.aperture_radius_m = aperture_radius_m;
    lens.focus_distance_m = focus_distance_m;
    viewer::put_lens(camera, lens, to_vec(target), "the point looked at");
    gi::check_lens(camera);
    return camera;
}

py::object matrix_of(gi::Camera const& camera)
{
    std::vector<double> rows;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) rows.push_back(camera.world_from_camera[column][row]);
    return own(std::move(rows), {4, 4});
}

void set_matrix(gi::Camera& camera, std::array<std::array<double, 4>, 4> const& rows)
{
    gi::dmat4 m;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            double const value = rows[std::size_t(row)][std::size_t(column)];
            check_range("world_from_camera", value, -1e12, 1e12);
            m[column][row] = value;
        }
    bool const is_affine = m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
    if (!is_affine || !(std::abs(glm::determinant(m)) > 1e-12))
        throw gi::InputError("world_from_camera is not a valid camera matrix",
                             "it is singular, or its last row is not 0, 0, 0, 1",
                             "give columns right, up, backward and position");
    camera.world_from_camera = m;
}

py::list lights_of(gi::World const& w)
{
    py::list lights;
    for (gi::Light const& l : w.lights) {
        py::dict d;
        d["type"] = kLightTypes[std::size_t(l.type)];
        d["position"] = to_point(gi::dvec3(l.position) + w.origin);
        d["direction"] = to_point(l.direction);
        d["intensity"] = to_point(l.intensity);
        d["cos_inner"] = l.cos_inner;
        d["cos_outer"] = l.cos_outer;
        d["range_m"] = l.range;
        lights.append(d);
    }
    return lights;
}

LoadedWorld load(std::string const& scene, std::optional<double> time_s, std::string const& environment,
                 double rotate_deg, double scale, std::string const& background, std::string const& light)
{
    if (time_s) check_range("time_s", *time_s, -1e9, 1e9);
    check_range("environment_rotate_deg", rotate_deg, -1e6, 1e6);
    check_range("environment_scale", scale, 0, 1e9);
    viewer::RenderOptions options;
    options.scene = scene;
    options.time_s = time_s;
    options.environment = environment;
    options.environment_rotate_deg = rotate_deg;
    options.environment_scale = scale;
    options.background = background;
    if (std::ranges::find(viewer::kLightChoices, light) == viewer::kLightChoices.end())
        throw gi::InputError(fmt::format("light = '{}'", light), "there is no such choice",
                             fmt::format("give one of: {}", fmt::join(viewer::kLightChoices, ", ")));
    options.light = light;
    gi::Report report;
    auto world = std::make_shared<gi::World const>(viewer::load_world(options, report));
    return {scene, std::move(world), report.losses()};
}

void bind_camera(py::module_& m)
{
    using gi::Camera;
    py::class_<Camera>(m, "Camera",
                       "A camera: look_at(position, target, fov_deg), or an assigned "
                       "world_from_camera (4 x 4, m). Looks along -Z of its frame, +Y up, +X right.")
        .def(py::init<>())
        .def_static("look_at", &looking_camera, py::arg("position"), py::arg("target"), py::arg("fov_deg") = 45.0,
                    py::kw_only(), py::arg("aperture_radius_m") = 0.0, py::arg("focus_distance_m") = py::none())
        .def("copy", [](Camera const& c) { return c; })
        .def("__eq__", [](Camera const& a, Camera const& b) { return a == b; })
        .def_readwrite("name", &Camera::name)
        .def_readonly("orthographic", &Camera::orthographic)
        .def_property(
            "fov_deg", [](Camera const& c) { return glm::degrees(c.yfov_rad); },
            [](Camera& c, double fov_deg) {
                check_range("fov_deg", fov_deg, 0.001, 179);
                c.yfov_rad = glm::radians(fov_deg);
            })
        .def_readonly("aperture_radius_m", &Camera::aperture_radius_m)
        .def_readonly("focus_distance_m", &Camera::focus_distance_m)
        .def_property_readonly("position",
                               [](Camera const& c) { return to_point(gi::dvec3(c.world_from_camera[3])); })
        .def_property("world_from_camera", &matrix_of, &set_matrix);
}

} // namespace

gi::Camera camera_of(gi::World const& world, std::string const& name)
{
    viewer::CameraChoice choice;
    choice.name = name;
    return viewer::choose_camera(world, choice).camera;
}

void bind_scene(py::module_& m)
{
    bind_camera(m);
    using Self = LoadedWorld const&;
    py::class_<LoadedWorld>(m, "World")
        .def_readonly("name", &LoadedWorld::name)
        .def("camera", [](Self w, std::string const& name) { return camera_of(*w.world, name); })
        .def_property_readonly("cameras", [](Self w) { return w.world->cameras; })
        .def_property_readonly("lights", [](Self w) { return lights_of(*w.world); })
        .def_property_readonly("origin", [](Self w) { return to_point(w.world->origin); })
        .def_property_readonly("bounds",
                               [](Self w) {
                                   gi::Bounds const& b = w.world->bounds;
                                   if (b.empty()) return std::array<Point, 2>{};
                                   return std::array{to_point(gi::dvec3(b.low) + w.world->origin),
                                                     to_point(gi::dvec3(b.high) + w.world->origin)};
                               })
        .def_property_readonly(
            "triangles",
            [](Self w) {
                auto const& t = w.world->triangles;
                static_assert(sizeof(gi::uvec3) == 3 * sizeof(std::uint32_t));
                return borrow(w.world, t.empty() ? nullptr : &t[0].x, {py::ssize_t(t.size()), 3});
            })
        .def_property_readonly(
            "positions",
            [](Self w) {
                auto const& p = w.world->positions;
                static_assert(sizeof(gi::vec3) == 3 * sizeof(float));
                return borrow(w.world, p.empty() ? nullptr : &p[0].x, {py::ssize_t(p.size()), 3});
            })
        .def_property_readonly("emitting_triangles", [](Self w) { return w.world->emitters.size(); })
        .def_property_readonly("has_environment", [](Self w) { return w.world->environment != nullptr; })
        .def_property_readonly("losses", [](Self w) {
            std::map<std::string, std::uint64_t> counts;
            for (auto const& [what, loss] : w.losses) counts[what] = loss.count;
            return counts;
        });
    m.def("load", &load, py::arg("scene"), py::arg("time_s"), py::arg("environment"),
          py::arg("environment_rotate_deg"), py::arg("environment_scale"), py::arg("background"), py::arg("light"),
          py::call_guard<py::gil_scoped_release>());
}

} // namespace bindings
