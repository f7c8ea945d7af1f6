#include "tests/bench/moving_view/offline.h"

#include "gi/image_io/picture_file.h"
#include "viewer/app/presenter.h"

namespace viewer {
namespace {

/// What is shown of a frame at another pose.
Seen reprojected(Options const& o, SessionFrame const& frame, FrameCommand const& command, Viewpoint const& now,
                 Settings const& settings)
{
    auto shown = std::make_shared<LiveFrame>();
    shown->command = command;
    shown->result.views = frame.views;
    shown->result.scene = frame.scene;
    PresentSettings present;
    present.tone = tone_settings(settings);
    present.surfaces_scale = settings.draw_surfaces ? o.drawn_scale : 0;
    Seen s{now, command.scene_s, {}};
    std::vector<Pane> panes;
    std::vector<gi::Camera> cameras;
    for (int e = 0; e < o.eyes; ++e) {
        panes.push_back({{0, 0}, {o.width, o.height}, StereoMode::off, e, -1});
        cameras.push_back(now.views[std::size_t(e)].camera);
    }
    Presenter presenter({});
    presenter.take(shown, panes);
    do { // until all is on the GPU
        TextureTarget const target(TextureTarget::Format::bytes, {8, 8});
        presenter.draw(target.target(), {0, 0}, {panes[0]}, present, cameras);
    } while (presenter.prepares());
    for (int e = 0; e < o.eyes; ++e) {
        TextureTarget const target(TextureTarget::Format::bytes, {o.width, o.height});
        presenter.draw(target.target(), {0, 0}, {panes[std::size_t(e)]}, present, cameras);
        s.shown.push_back(read_bytes(target.target()));
    }
    return s;
}

} // namespace

void render_offline(Options const& o, RenderSession& session, Walk& walk, std::vector<Seen>& seen)
{
    int const frames = int(walk.seconds() * o.offline_hz);
    for (int f = 0, k = 0; o.young > 0 ? f < o.young : f < frames && k < o.scored; ++f) {
        double const t = o.young > 0 ? 0 : f / o.offline_hz;
        Viewpoint const at = walk.at(std::max(0.0, t - o.late_s), 1 / o.offline_hz);
        FrameCommand command;
        command.frame = std::uint64_t(f);
        command.scene_s = t;
        command.world_from_room = at.world_from_room;
        command.tracked = at.tracked;
        command.views = at.views;
        command.light_scale = o.light_scale;
        command.surface_scale = o.surface_scale;
        command.paths = o.paths;
        if (!session.settings().first_surfaces) {
            command.light_scale = command.surface_scale = 1;
            for (ViewCommand& v : command.views)
                v.width = int(v.width * o.light_scale), v.height = int(v.height * o.light_scale);
        }
        SessionFrame const frame = session.render(command, {});
        if (o.young > 0 ? ((f + 1) & f) != 0 : t < 1 + (walk.seconds() - 1) * (k + 0.5) / o.scored) continue;
        ++k;
        if (o.late_s > 0) {
            seen.push_back(reprojected(o, frame, command, walk.at(t, 0), session.settings()));
            continue;
        }
        Seen s{at, t, {}};
        for (ViewPicture const& v : frame.views) {
            std::vector<unsigned char> const bytes =
                gi::tone_map_bytes(*v.picture.find("color"), tone_settings(session.settings()));
            std::vector<unsigned char> full(std::size_t(o.width) * std::size_t(o.height) * 3);
            for (int y = 0; y < o.height; ++y)
                for (int x = 0; x < o.width; ++x)
                    for (int c = 0; c < 3; ++c)
                        full[std::size_t(3 * (y * o.width + x) + c)] =
                            bytes[std::size_t(3 * (y * v.picture.height / o.height * v.picture.width +
                                                   x * v.picture.width / o.width) +
                                              c)];
            s.shown.push_back(std::move(full));
        }
        seen.push_back(std::move(s));
    }
}

} // namespace viewer
