#include "python/core/bind_render.h"

#include "gi/methods/registry.h"
#include "python/core/bind_scene.h"
#include "python/core/convert.h"
#include "python/core/interruptible.h"
#include "python/core/render_keywords.h"
#include "viewer/base/outputs.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/render_picture.h"

#include <mutex>
#include <pybind11/stl.h>

namespace bindings {
namespace {

constexpr char const* kEnds[] = {"paths", "budget", "error_target", "interrupted"};

/// Passes the latest status of a running render from one thread to another.
class Watched {
public:
    void put(gi::RenderStatus const& status)
    {
        std::lock_guard const lock(mutex_);
        status_ = status;
        is_new_ = true;
    }
    std::optional<gi::RenderStatus> take()
    {
        std::lock_guard const lock(mutex_);
        if (!std::exchange(is_new_, false)) return {};
        return status_;
    }

private:
    std::mutex mutex_;
    gi::RenderStatus status_;
    bool is_new_ = false;
};

py::dict to_result(gi::Picture&& picture, gi::RenderResult const& r, std::string const& asked,
                   gi::Report const& report, std::string const& note)
{
    py::dict d;
    d["layers"] = to_layers(std::move(picture));
    d["end"] = kEnds[std::size_t(r.end)];
    d["paths"] = r.paths;
    d["seconds"] = r.seconds;
    d["relmse"] = r.relmse;
    d["method"] = r.method.empty() ? asked : r.method;
    d["why_method"] = r.why_method;
    d["options"] = r.options;
    d["resumable"] = r.resumable;
    d["losses"] = losses_of(report);
    d["stages_s"] = report.times();
    d["note"] = note;
    return d;
}

/// Of a render that was interrupted. Throws where Python makes warnings errors.
void warn_of_lost_state(std::filesystem::path const& state, gi::Report const& report)
{
    std::string text = "'" + state.string() + "' does not hold the interrupted render: the next one starts afresh";
    for (auto const& [what, loss] : report.losses())
        text += "; " + what + (loss.first.empty() ? "" : " (" + loss.first + ")");
    if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

py::dict render(LoadedWorld const& scene, std::string const& method, gi::Camera const& camera,
                py::dict const& keywords, py::dict const& options, std::string const& denoise,
                py::object const& progress)
{
    gi::Method const& chosen = gi::find_method(method);
    viewer::StillPicture still{settings_of(keywords, options, method)};
    gi::RenderSettings const settings = still.settings; // `still` is moved from below
    still.filter = denoise_of(denoise, settings);
    viewer::check_distance(*scene.world, camera);
    gi::check_lens(camera);
    viewer::check_outputs({settings.checkpoint.string()}, {scene.name});
    std::string note;
    if (!viewer::check_state(settings, "give resume=True"))
        note = "there is no '" + settings.checkpoint.string() + "': started afresh";
    std::shared_ptr<gi::World const> const world = scene.world;
    gi::Report report;
    gi::Picture picture;
    Watched watched;
    still.trace = [&](gi::RenderSettings const& s, gi::StopRequest const& stop, gi::Report& r) {
        return chosen.render(
            *world, camera, s, stop, [&](gi::RenderStatus const& now) { watched.put(now); }, r);
    };
    viewer::StillEnd end;
    auto const work = [&](gi::StopRequest const& stop) {
        still.write = [&](gi::PictureRows const& rows, viewer::PictureParts parts, gi::RenderResult const&) {
            if (parts == viewer::PictureParts::complete)
                picture = rows.whole(&stop); // else an exception is raised
        };
        end = viewer::render_picture(std::move(still), stop, report);
    };
    auto const tick = [&] {
        if (progress.is_none()) return;
        if (auto const s = watched.take()) progress(s->fraction, s->paths, s->relmse);
    };
    try {
        run_interruptible(work, tick);
    } catch (py::error_already_set const&) {
        if (!settings.checkpoint.empty() && !end.result.resumable) warn_of_lost_state(settings.checkpoint, report);
        throw;
    }
    if (end.failure) std::rethrow_exception(end.failure);
    if (!end.note.empty()) note += (note.empty() ? "" : "; ") + end.note;
    return to_result(std::move(picture), end.result, method, report, note);
}

} // namespace

void bind_render(py::module_& m)
{
    m.def("methods", [] {
        std::map<std::string, std::string> methods;
        for (gi::Method const& method : gi::methods())
            if (method.offered) methods.emplace(std::string(method.name), std::string(method.summary));
        return methods;
    });
    m.def("render", &render, py::arg("world"), py::arg("method"), py::arg("camera"), py::arg("keywords"),
          py::arg("options"), py::arg("denoise"), py::arg("progress"));
}

} // namespace bindings
