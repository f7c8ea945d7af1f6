// A shown picture, of a newer pose and a later moment than its picture of light, is that of the CPU form of the same moment.

#include "gi/scene/load/load.h"
#include "tests/support/surface_scenes.h"
#include "tests/viewer_gl/surface_comparison.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/shown_views.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer::test::shown_moment {
namespace {

using gi::dvec3, gi::vec3;

constexpr glm::ivec2 kSize{240, 160};

FrameCommand command_of(std::uint64_t frame, gi::Camera const& camera)
{
    FrameCommand c;
    c.frame = frame;
    c.scene_s = 0.02 * double(frame);
    c.paths = 4;
    c.light_scale = 0.4;
    c.only_light = true;
    c.views.push_back({"view", camera, kSize.x, kSize.y});
    return c;
}

class ShownMoment : public Surfaceless {
protected:
    struct Compared {
        double known = 0;     ///< share of pixels whose surface the picture of light shows
        double differing = 0; ///< of these, those that differ by more than 2/255
    };
    Compared compare(std::string const& scene)
    {
        RenderSession session(
            [](std::string const& name, gi::Report& r) {
                return std::make_shared<gi::Scene const>(name == "moving" ? gi::test::moving_parts()
                                                                          : gi::load_scene(name, r));
            },
            0, report);
        session.apply({"draw_surfaces", true});
        session.apply({"scene", scene});
        gi::Camera const first = session.world().cameras.at(0);
        auto const walked = [&](double steps) { // to the side, turning
            gi::Camera c = first;
            c.world_from_camera = c.world_from_camera *
                                  glm::translate(gi::dmat4(1), dvec3(0.01 * steps, 0, -0.01 * steps)) *
                                  glm::rotate(gi::dmat4(1), 0.005 * steps, dvec3(0, 1, 0));
            return c;
        };
        ShownViews views;
        auto frame = std::make_shared<LiveFrame>();
        for (std::uint64_t n = 0; n < 12; ++n) {
            frame = std::make_shared<LiveFrame>();
            frame->command = command_of(n, walked(double(n)));
            frame->result = session.render(frame->command, {});
            views.take(frame, {0});
            views.begin(1, &frame->command, {});
            views.eye(0, nullptr);
        }
        EXPECT_TRUE(views.make_ready());
        FrameCommand moment = frame->command;
        moment.scene_s += 0.03;
        moment.views[0].camera = walked(12.5);
        views.begin(1, &moment, {});
        moment.pose_s += 1; // the newest light has faded in
        views.begin(1, &moment, {});
        EyeView const eye = views.eye(0, &moment.views[0].camera);
        EXPECT_TRUE(views.drew_surfaces());
        EXPECT_EQ(eye.picture.size_px, kSize);
        std::vector<float> shown(std::size_t(3 * kSize.x * kSize.y));
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glGetTextureImage(eye.picture.texture, 0, GL_RGB, GL_FLOAT, GLsizei(shown.size() * sizeof(float)),
                          shown.data());

        // The CPU form, with the same picture of light.
        gi::Picture const& light = frame->result.views[0].picture;
        gi::MovingWorld world(frame->result.scene->world->scene, frame->command.scene_s, report,
                              session.world().origin);
        gi::SeenSurfaces seen(world.world(), 0);
        seen.changed(world.advance(moment.scene_s));
        gi::World const& w = world.world();
        gi::KeptLight const kept(
            light, gi::camera_rays(frame->command.views[0].camera, light.width, light.height, w.origin), w.origin);
        seen.look(gi::camera_rays(moment.views[0].camera, kSize.x, kSize.y, w.origin), kSize.x, kSize.y,
                  frame->result.views[0].light->without_punctual ? gi::SeenSurfaces::Lights::few
                                                                 : gi::SeenSurfaces::Lights::none);
        std::vector<float> a, b;
        std::vector<gi::SeenSurface> row(std::size_t(kSize.x));
        for (int y = 0; y < kSize.y; ++y) {
            seen.row(y, row);
            for (int x = 0; x < kSize.x; ++x) {
                gi::SeenSurface const& s = row[std::size_t(x)];
                vec3 color = s.emitted + s.direct;
                if (s.depth > 0) {
                    auto const found = kept.find(s.position - s.moved, s.normal);
                    if (!found || found->likeness < 0.3f) continue;
                    color += s.albedo * (found->direct + found->indirect);
                }
                for (int c = 0; c < 3; ++c) {
                    a.push_back(shown[std::size_t(3 * (y * kSize.x + x) + c)]);
                    b.push_back(color[c]);
                }
            }
        }
        return {double(a.size()) / double(shown.size()), share_differing(a, b)};
    }
};

TEST_F(ShownMoment, IsThatOfTheCpuForm)
{
    for (char const* scene : {"cornell", "moving"}) {
        Compared const c = compare(scene);
        fmt::print("{}: {:.3f} % of {:.1f} % of the pixels differ by more than 2/255\n", scene, 100 * c.differing,
                   100 * c.known);
        EXPECT_GT(c.known, 0.9) << scene;
        EXPECT_LT(c.differing, 0.006)
            << scene; // wanted: 0.001; light of half the pixels, with the noise of few paths
    }
}

} // namespace
} // namespace viewer::test::shown_moment
