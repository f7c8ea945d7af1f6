#include "python/core/bind_frames.h"

#include "python/core/convert.h"
#include "python/core/errors.h"
#include "python/core/frames.h"
#include "python/core/interruptible.h"

#include <pybind11/stl.h>

namespace bindings {
namespace {

using viewer::StimulusSettings;

py::dict frame_dict(MadeFrame&& made)
{
    py::list views;
    for (viewer::ViewPicture& v : made.frame.views) views.append(to_layers(std::move(v.picture)));
    py::dict d;
    d["views"] = views;
    d["paths"] = made.frame.paths;
    d["exposure_ev"] = made.exposure_ev;
    d["tone"] = made.tone;
    d["still_frames"] = made.frame.still_frames;
    d["seconds"] = made.seconds;
    d["stages_s"] = made.frame.stages_s;
    d["options"] = made.frame.options;
    return d;
}

/// @param views  (name, camera, width, height, partner)
py::dict next(Frames& frames, std::vector<std::tuple<std::string, gi::Camera, int, int, int>> const& views,
              std::optional<int> paths, double budget_s, double scene_s)
{
    check_range("budget_s", budget_s, 1e-4, 1e4);
    check_range("time_s", scene_s, -1e9, 1e9);
    if (paths) check_range("paths", *paths, 1, viewer::CommandLimits::paths);
    std::vector<viewer::ViewCommand> orders;
    for (auto const& [name, camera, width, height, partner] : views)
        orders.push_back({name, camera, width, height, partner});
    MadeFrame made;
    run_interruptible([&](gi::StopRequest const& stop) {
        made = frames.render(std::move(orders), {paths, budget_s}, scene_s, stop);
    });
    return frame_dict(std::move(made));
}

py::list keys()
{
    py::list all;
    for (viewer::SettingKey const& k : viewer::setting_keys()) {
        if (!k.is_offered()) continue;
        py::dict d;
        d["key"] = k.key;
        d["type"] = gi::name_of(k.type);
        d["what"] = k.meaning;
        d["words"] = k.words;
        d["low"] = k.low;
        d["high"] = k.high;
        all.append(d);
    }
    return all;
}

} // namespace

void bind_frames(py::module_& m)
{
    py::class_<StimulusSettings>(m, "StimulusSettings")
        .def(py::init([](study::Patch const& patch, std::string const& camera) {
                 return viewer::stimulus_settings(patch, camera);
             }),
             py::arg("patch"), py::arg("camera"))
        .def_readonly("scene", &StimulusSettings::scene)
        .def_readonly("camera", &StimulusSettings::camera)
        .def_readonly("sha256", &StimulusSettings::sha256)
        .def_property_readonly("moves",
                               [](StimulusSettings const& s) { return s.path != viewer::StimulusPath::none; });
    py::class_<Frames>(m, "Frames")
        .def(py::init([](int threads) {
                 check_range("threads", threads, 0, 4096);
                 return std::make_unique<Frames>(threads);
             }),
             py::arg("threads"))
        .def("set",
             [](Frames& f, std::string const& key, py::handle value) {
                 viewer::Change const change{key, to_json(value)};
                 py::gil_scoped_release const unlocked;
                 f.set(change);
             })
        .def("get",
             [](Frames const& f, std::string const& key) {
                 nlohmann::json value;
                 {
                     py::gil_scoped_release const unlocked;
                     value = f.get(key);
                 }
                 return from_json(value);
             })
        .def_property_readonly("losses", [](Frames const& f) { return losses_of(f.report()); })
        .def("camera", &Frames::camera, py::call_guard<py::gil_scoped_release>())
        .def("take", &Frames::take, py::call_guard<py::gil_scoped_release>())
        .def("camera_at", &Frames::camera_at, py::call_guard<py::gil_scoped_release>())
        .def("next", &next);
    m.def("setting_keys", &keys);
}

} // namespace bindings
