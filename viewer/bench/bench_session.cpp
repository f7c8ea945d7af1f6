#include "viewer/bench/bench_session.h"

#include "viewer/offline/load_world.h"

namespace viewer {

std::unique_ptr<RenderSession> bench_session(std::string const& scene, std::vector<Change> const& settings,
                                             gi::Report& report)
{
    auto const load = [](std::string const& name, gi::Report& r) {
        RenderOptions options;
        options.scene = name;
        return load_lit_scene(options, r);
    };
    auto session = std::make_unique<RenderSession>(load, 0, report);
    for (Change const& change : settings) session->apply(change);
    session->apply({"scene", scene});
    return session;
}

gi::Layer reference_of(RenderSession const& session, ViewCommand const& view, int paths, gi::Report& report)
{
    gi::RenderSettings s;
    s.width = view.width;
    s.height = view.height;
    s.paths = std::uint32_t(paths);
    s.seed = 99; // differs from that of the frames
    s.bounces = session.settings().render.bounces;
    return *gi::find_method("reference")
                .render(session.world(), view.camera, s, {}, {}, report)
                .picture.find("color");
}

} // namespace viewer
