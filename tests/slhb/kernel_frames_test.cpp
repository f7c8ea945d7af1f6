// Frames by kernels, on the host and on the device, against those of the CPU's own form: with the same random
// numbers they trace the same paths but for rounding, whatever moves or changes between them.

#include "gi/core/error.h"
#include "gi/hit_buffers/settings.h"
#include "gi/scene/motion/animation.h"
#include "gi/methods/paths/kernels/kernel_frames.h"
#include "tests/slhb/slhb_render.h"
#include "tests/support/on_device.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>

namespace gi::test {
namespace {

constexpr int kFrameSize = 32;
constexpr std::uint32_t kWall = 0, kBlock = 1, kLamp = 2, kBall = 3; // materials

/// A room with a block, a lamp of triangles, a small one of none, and a smooth ball with
/// a box on it that is moved from outside.
std::shared_ptr<Scene const> frame_room()
{
    Scene scene = box_with_block_and_lamp(), object;
    Light light;
    light.position = {-0.7f, 0.5f, 0.6f};
    light.intensity = vec3{0.5f, 0.4f, 0.2f};
    add_light(scene, light);
    int const m = add_material(object, lambert(vec3{0.2f, 0.3f, 0.8f}));
    add_sphere(object, {0.45f, -0.65f, 0.3f}, 0.25f, 2, m, true);
    add_box(object, {0.3f, -0.4f, 0.2f}, {0.6f, -0.2f, 0.4f}, m, false);
    append(scene, std::move(object), "object", dmat4(1));
    scene.nodes.back().driven = true;
    return std::make_shared<Scene const>(std::move(scene));
}

Camera frame_eye(double aside = 0)
{
    Camera camera = look_at({-0.6, 0.1, 0.9}, {0.2, -0.5, 0}, 70);
    camera.world_from_camera = camera.world_from_camera * glm::translate(dmat4(1), dvec3{aside, 0, 0});
    return camera;
}

RenderSettings settings_of(Schedule schedule)
{
    RenderSettings s = small_settings(kFrameSize, 2, 2);
    s.of<SlhbSettings>().schedule = schedule;
    if (schedule == Schedule::stored) s.of<SlhbSettings>().directions = "icosahedron:80";
    s.of<SlhbSettings>().resolution = 48;
    s.of<SlhbSettings>().shadow_resolution = 64;
    s.of<SlhbSettings>().light_samples = 4;
    s.of<SlhbSettings>().fresh_light_samples = 2;
    s.of<PathsSettings>().interleave = 1;
    return s;
}

std::vector<float> const& layer(RenderResult const& r, std::string const& name)
{
    return r.picture.find(name)->data;
}

std::size_t pixels_that_differ(std::vector<float> const& a, std::vector<float> const& b)
{
    std::size_t n = 0;
    for (std::size_t k = 0; k < a.size(); ++k) n += std::abs(a[k] - b[k]) > 0.01f * (std::abs(b[k]) + 0.01f);
    return n;
}

void expect_same(RenderResult const& found, RenderResult const& expected)
{
    ASSERT_EQ(found.paths, expected.paths);
    for (char const* const name : {"color", "L1", "L2", "albedo", "normal", "depth"}) {
        std::vector<float> const &a = layer(found, name), &b = layer(expected, name);
        ASSERT_EQ(a.size(), b.size());
        for (float const v : a) ASSERT_TRUE(std::isfinite(v)) << name;
        EXPECT_LE(pixels_that_differ(a, b), a.size() / 30) << name;
        double const truth = mean_of(expected.picture, name).mean;
        EXPECT_NEAR(mean_of(found.picture, name).mean, truth, 0.01 * std::abs(truth) + 1e-3) << name;
    }
    // What is seen first is the same, but for depths that rounding cannot tell apart.
    std::vector<float> const &a = layer(found, "motion"), &b = layer(expected, "motion");
    ASSERT_EQ(a.size(), b.size());
    std::size_t differ = 0;
    for (std::size_t k = 0; k < a.size(); ++k) {
        ASSERT_EQ(std::isnan(a[k]), std::isnan(b[k]));
        differ += std::abs(a[k] - b[k]) > 1e-4f * (1 + std::abs(b[k]));
    }
    EXPECT_LE(differ, a.size() / 100);
}

/// The same frames by kernels and by the CPU's own form.
template <Space S>
class Both {
public:
    explicit Both(RenderSettings const& settings, std::shared_ptr<Scene const> scene = frame_room())
        : scene_(std::move(scene)),
          world(scene_, 0, report),
          kernels(start_kernel_frames(S, world, frame_eye(), settings, report)),
          cpu_(start_frames_as_set(world, frame_eye(), settings, cpu_report_))
    {
    }

    Changes place(dvec3 at, double turn_rad = 0)
    {
        Pose pose = evaluate_pose(*scene_, 0);
        pose.world_from_node.back() =
            glm::rotate(glm::translate(dmat4(1), at), turn_rad, dvec3{0.2, 1, 0.1}) * pose.world_from_node.back();
        return world.advance(pose);
    }
    Changes paint(std::uint32_t material, vec3 color)
    {
        Material m = world.world().materials.at(material);
        (m.emission == vec3{0} ? m.base_color : m.emission) = color;
        return world.set_material(material, m);
    }
    /// @return the pictures by kernels, which are held to the others
    std::vector<RenderResult> next(Changes const& changes, std::span<FrameView const> views, char const* what)
    {
        SCOPED_TRACE(what);
        kernels->changed(changes);
        cpu_->changed(changes);
        auto found = kernels->views(views, 2, VertexSharing::exact, {});
        auto const expected = cpu_->views(views, 2, VertexSharing::none, {});
        EXPECT_EQ(found.size(), expected.size());
        for (std::size_t k = 0; k < found.size(); ++k) expect_same(found[k], expected[k]);
        return found;
    }
    std::vector<float> next(Changes const& changes, char const* what)
    {
        FrameView const view{frame_eye(), kFrameSize, kFrameSize};
        return layer(next(changes, {&view, 1}, what)[0], "color");
    }
    void update_axes(int axes)
    {
        ask<FollowingAxes>(*kernels)->update_axes(axes);
        ask<FollowingAxes>(*cpu_)->update_axes(axes);
    }

private:
    std::shared_ptr<Scene const> scene_;
    Report cpu_report_;

public:
    Report report;
    MovingWorld world;
    std::unique_ptr<FrameRenderer> kernels;

private:
    std::unique_ptr<FrameRenderer> cpu_;
};

constexpr Schedule kSchedules[] = {Schedule::stored, Schedule::temporal, Schedule::streamed};

template <Space S>
void check_motion()
{
    for (Schedule const schedule : kSchedules) {
        SCOPED_TRACE(int(schedule));
        Both<S> both(settings_of(schedule));
        auto const first = both.next({}, "at first");
        EXPECT_GT(pixels_that_differ(both.next(both.place({-0.2, 0.1, 0}, 0.3), "moved"), first), 200u);
        both.next(both.place({-0.4, 0.2, -0.1}, 0.9), "moved on");
        both.next({}, "at rest");
        Material glows = both.world.world().materials.at(kBall);
        glows.emission = vec3{4};
        both.next(both.world.set_material(kBall, glows), "and glows");
        both.next(both.place({-0.3, 0.2, 0}, 0.5), "a lamp that moves");
        both.next(both.place({-0.4, 6, -0.1}, 0.9), "out of the bounds");
        both.next(both.place({0, 0, 0}), "back");
        EXPECT_EQ(both.report.losses().count("frames outside the bounds of the hit buffers, which were rebuilt"),
                  schedule == Schedule::streamed ? 0u : 1u);
    }
}
LIGHTWELL_TEST_BOTH(KernelFrames, FollowWhatMoves, check_motion);

template <Space S>
void check_changes()
{
    for (Schedule const schedule : kSchedules) {
        SCOPED_TRACE(int(schedule));
        Both<S> both(settings_of(schedule));
        std::vector<float> before = both.next({}, "at first");
        auto const shows = [&](Changes const& changes, char const* what) {
            std::vector<float> now = both.next(changes, what);
            EXPECT_GT(pixels_that_differ(now, before), now.size() / 8) << what;
            before = std::move(now);
        };
        Light light = both.world.world().lights.at(0);
        light.intensity = vec3{3, 2, 1};
        shows(both.world.set_light(0, light), "light");
        shows(both.paint(kWall, {0.8f, 0.2f, 0.1f}), "material of what stays");
        both.next(both.paint(kBall, {0.9f, 0.9f, 0.1f}), "material of what moves");
        shows(both.paint(kLamp, {2, 4, 20}), "emission");
        auto sky = std::make_shared<EnvironmentMap>();
        sky->width = sky->height = 2;
        sky->radiance.assign(4, vec3{0.3f, 0.4f, 0.6f});
        both.next(both.world.set_environment(sky), "a sky, which is not seen");
        shows(both.paint(kLamp, vec3{0}), "a lamp less");
        light.intensity = vec3{0};
        both.world.set_environment(nullptr);
        Changes dark = both.world.set_light(0, light);
        dark.environment = true;
        for (float const v : both.next(dark, "nothing shines")) EXPECT_EQ(v, 0);
        Material veil = both.world.world().materials.at(kBlock);
        veil.alpha_mode = AlphaMode::blend;
        veil.alpha = 0.4f;
        light.intensity = vec3{2};
        Changes changes = both.world.set_light(0, light);
        changes.add(both.world.set_material(kBlock, veil));
        shows(changes, "a block that lets light through");
    }
}
LIGHTWELL_TEST_BOTH(KernelFrames, ShowWhatChanges, check_changes);

/// A sky that comes while frames go on lengthens paths: another bounce has axes.
template <Space S>
void check_sky()
{
    Scene open;
    add_quad(open, {-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, add_material(open, lambert(vec3{0.5f})));
    add_sphere(open, {0, -0.4f, 0}, 0.5f, 2, add_material(open, lambert(vec3{0.8f, 0.5f, 0.3f})), false);
    open.nodes.back().driven = true;
    Light light;
    light.position = {0, 1, 0};
    add_light(open, light);
    auto const scene = std::make_shared<Scene const>(std::move(open));
    for (Schedule const schedule : kSchedules)
        for (int const bounces : {0, 1}) {
            SCOPED_TRACE(int(schedule));
            RenderSettings s = settings_of(schedule);
            s.bounces = bounces;
            Both<S> both(s, scene);
            both.next({}, "by a lamp");
            auto sky = std::make_shared<EnvironmentMap>();
            sky->width = sky->height = 2;
            sky->radiance.assign(4, vec3{1, 2, 3});
            both.next(both.world.set_environment(sky), "by the sky");
            both.next({}, "and again");
            both.next(both.world.turn_environment(1, vec3{2}), "brighter");
            both.next(both.world.set_environment(nullptr), "by the lamp again");
        }
}
LIGHTWELL_TEST_BOTH(KernelFrames, ShowASkyThatComesAndGoes, check_sky);

template <Space S>
void check_following()
{
    Both<S> both(settings_of(Schedule::stored));
    both.update_axes(8);
    for (int k = 0; k < 7; ++k) both.next(both.place({-0.05 * k, 0.02 * k, 0}), "8 of 40");
    DynamicUpdate const f = ask<FollowingAxes>(*both.kernels)->dynamic_update();
    EXPECT_EQ(f.stored, 40);
    EXPECT_GE(f.axes, 8);
    EXPECT_LT(f.axes, 40);
    both.update_axes(0);
    both.next({}, "all, and nothing moved");
    EXPECT_EQ(ask<FollowingAxes>(*both.kernels)->dynamic_update().axes, 40);
}
LIGHTWELL_TEST_BOTH(KernelFrames, MayFollowInSomeDirections, check_following);

template <Space S>
void check_views()
{
    std::vector<std::uint8_t> hidden;
    for (int y = 0; y < kFrameSize; ++y)
        for (int x = 0; x < kFrameSize; ++x) hidden.push_back(std::hypot(x - 15.5, y - 15.5) > 16);
    Both<S> both(settings_of(Schedule::stored));
    std::vector<FrameView> views{{frame_eye(), kFrameSize, kFrameSize},
                                 {frame_eye(0.3), 24, 20},
                                 {frame_eye(0.06), kFrameSize, kFrameSize}};
    views[1].filter = PixelFilter::centre;
    auto const whole = both.next({}, views, "three views");
    Both<S> alone(settings_of(Schedule::stored));
    for (std::size_t k = 0; k < 3; ++k) { // none of the others counts, nor of a partner
        auto const one =
            start_kernel_frames(S, alone.world, frame_eye(), settings_of(Schedule::stored), alone.report)
                ->views({&views[k], 1}, 2, VertexSharing::exact, {});
        EXPECT_EQ(layer(one[0], "color"), layer(whole[k], "color")) << k;
    }
    views[2].partner = 0;
    auto const partners =
        start_kernel_frames(S, alone.world, frame_eye(), settings_of(Schedule::stored), alone.report)
            ->views(views, 2, VertexSharing::cached, {});
    EXPECT_EQ(layer(partners[2], "color"), layer(whole[2], "color"));
    EXPECT_TRUE(partners[2].light_from.empty());
    views[0].hidden = views[2].hidden = hidden;
    views[2].partner = -1;
    auto const some = both.next(both.place({-0.1, 0, 0}), views, "with hidden pixels");
    for (std::size_t k : {0u, 2u})
        for (Layer const& l : some[k].picture.layers) {
            if (l.name == "motion") continue;
            for (std::size_t i = 0; i < l.data.size(); ++i) {
                if (hidden[i / std::size_t(l.channels)] != 0) {
                    ASSERT_EQ(l.data[i], 0) << l.name;
                }
            }
        }
    EXPECT_GT(both.report.counts().at("pixels not rendered, as nobody sees them"), 0);
    views.pop_back();
    views[0].hidden = {};
    both.next({}, views, "two, and none hidden");
}
LIGHTWELL_TEST_BOTH(KernelFrames, OfSeveralViewsAreThoseOfEach, check_views);

template <Space S>
void check_moments()
{
    auto const scene = frame_room();
    auto const render = [&](bool by_kernels) {
        Report report;
        MovingWorld world(scene, 0, report);
        RenderSettings s = settings_of(Schedule::streamed);
        s.paths = 4;
        auto const frames = by_kernels ? start_kernel_frames(S, world, frame_eye(), s, report)
                                       : start_frames_as_set(world, frame_eye(), s, report);
        return frames->frame(frame_eye(), {}, {}, [&](std::uint32_t pass) {
            Pose pose = evaluate_pose(*scene, 0);
            pose.world_from_node.back() =
                glm::translate(dmat4(1), dvec3{-0.1 * pass, 0, 0}) * pose.world_from_node.back();
            return Moment{world.advance(pose), frame_eye(0.01 * pass)};
        });
    };
    RenderResult const found = render(true), expected = render(false);
    EXPECT_EQ(found.paths, 4u);
    EXPECT_EQ(found.picture.find("motion"), nullptr);
    EXPECT_LE(pixels_that_differ(layer(found, "color"), layer(expected, "color")),
              layer(expected, "color").size() / 30);
}
LIGHTWELL_TEST_BOTH(KernelFrames, MayBeOfManyMoments, check_moments);

template <Space S>
void check_end()
{
    Both<S> both(settings_of(Schedule::temporal));
    StopRequest stop;
    stop.request();
    FrameView const view{frame_eye(), kFrameSize, kFrameSize};
    auto const one = both.kernels->views({&view, 1}, 5, VertexSharing::none, stop);
    EXPECT_EQ(one[0].paths, 1u);
    EXPECT_EQ(one[0].end, RenderEnd::interrupted);
    EXPECT_GT(mean_of(one[0].picture).mean, 0);
    EXPECT_EQ(both.kernels->views({&view, 1}, 5, VertexSharing::none, {})[0].end, RenderEnd::paths);
}
LIGHTWELL_TEST_BOTH(KernelFrames, EndWithFewerPathsWhereTheyAreStopped, check_end);

/// Narrow lobes follow what moves, and come and go.
template <Space S>
void check_mirror()
{
    Scene scene = box_with_block_and_lamp(), object;
    add_sphere(scene, {-0.5f, -0.3f, 0}, 0.25f, 2, add_material(scene, mirror(vec3{0.9f})), true);
    add_sphere(object, {0.4f, -0.3f, 0.3f}, 0.25f, 2, add_material(object, glass(1.5f, false)), true);
    append(scene, std::move(object), "object", dmat4(1));
    scene.nodes.back().driven = true;
    RenderSettings s = settings_of(Schedule::stored);
    Both<S> both(s, std::make_shared<Scene const>(std::move(scene)));
    both.next({}, "at first");
    both.next(both.place({-0.2, 0.1, 0}), "moved");
    both.next(both.place({-0.3, 0.3, -0.4}), "moved on");
    for (std::uint32_t const m : {3u, 4u}) // the mirror, then the glass
        both.next(both.world.set_material(m, lambert(vec3{0.5f})), "a narrow lobe less");
    both.next(both.place({0, 0, 0}), "moved, all broad");
    both.next(both.world.set_material(4, mirror(vec3{0.8f})), "a mirror that moves");
    both.next(both.place({-0.2, 0.2, 0}), "moved");
}
LIGHTWELL_TEST_BOTH(KernelFrames, OfNarrowLobesFollowWhatMoves, check_mirror);

TEST(KernelFrames, RefuseWhatKernelsLackAndGoOn)
{
    Both<Space::host> both(settings_of(Schedule::stored));
    FrameView const view{orthographic({0, 0, 0.9}, {0, 0, 0}, 1), kFrameSize, kFrameSize};
    EXPECT_THROW(both.kernels->views({&view, 1}, 1, VertexSharing::none, {}), InputError);
    EXPECT_EQ(ask<PairFrames>(*both.kernels), nullptr);
    both.next({}, "and goes on");
    RenderSettings gather = settings_of(Schedule::stored), device = gather;
    gather.of<SlhbSettings>().gather = true;
    EXPECT_THROW(start_kernel_frames(Space::host, both.world, frame_eye(), gather, both.report), InputError);
    if (device_present()) return;
    device.space = Space::device;
    EXPECT_THROW(start_slhb_frames(both.world, frame_eye(), device, both.report), InputError);
}

} // namespace
} // namespace gi::test
