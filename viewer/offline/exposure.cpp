#include "viewer/offline/exposure.h"

#include "gi/core/rng.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/registry.h"
#include "gi/render/fingerprint.h"
#include "gi/render/pass_samples.h"
#include "gi/scene/motion/motion.h"
#include "viewer/engine/flat_triangles.h"
#include "viewer/offline/start_frames.h"

#include <algorithm>
#include <bit>

namespace viewer {

bool depends_on_time(gi::Scene const& scene, bool scene_still, CameraMotion const& camera)
{
    if (camera.path || camera.turn_rad != 0) return true;
    if (scene_still) return false;
    gi::Motion const motion = gi::find_motion(scene);
    auto const moves = [](std::string const& why) { return !why.empty(); };
    return std::ranges::any_of(motion.node, moves) || std::ranges::any_of(motion.morph, moves);
}

gi::RenderResult expose(gi::Method const& method, gi::MovingWorld& world, Exposure const& exposure,
                        gi::RenderSettings const& settings, gi::StopRequest const& stop,
                        gi::RenderProgress const& progress, gi::Report& report)
{
    gi::Camera const first = exposure.camera(world.world(), 0);
    bool const moves = !exposure.still && world.world().static_triangles < world.world().triangles.size();
    gi::ExposurePlan plan{method.name, settings};
    if (method.for_exposure != nullptr)
        plan = method.for_exposure(world.world(), settings, first,
                                   moves ? gi::Triangles::moving : gi::Triangles::still);
    auto const renderer =
        start_frames(gi::find_method(plan.method), world, first, plan.settings, report, stop);
    FlatTriangles flat(exposure.still ? gi::Changes{} : world.advance(exposure.from_s));
    bool const only_camera = exposure.still || world.only_cameras_move();
    auto const camera_at = [&](double fraction) {
        double const after_s = exposure.shutter_s * fraction;
        if (!exposure.still) world.advance(exposure.from_s + after_s);
        return exposure.camera(world.world(), after_s);
    };
    auto const moments = [&](std::uint32_t pass) {
        double const after_s = exposure.shutter_s * gi::moment_of_pass(settings.seed, pass);
        gi::Moment now;
        if (!exposure.still) {
            gi::StageTimer const timer(report, "world");
            now.changes = world.advance(exposure.from_s + after_s);
            flat.see(now.changes, report);
        }
        now.camera = exposure.camera(world.world(), after_s);
        if (only_camera) now.camera_at = camera_at;
        return now;
    };
    if (!gi::render_option("photons").read_by(plan.method)) gi::lose_lamp_caustics(world.world(), report);
    gi::RenderResult result = renderer->frame(first, stop, progress, moments);
    if (!exposure.still) world.advance(exposure.from_s);
    if (plan.method != method.name) {
        result.method = plan.method;
        result.why_method = plan.why.text;
    }
    return result;
}

std::uint64_t motion_fingerprint(gi::MovingWorld& world, Exposure const& exposure,
                                 gi::RenderSettings const& settings, std::string const& method)
{
    if (!exposure.still) world.advance(exposure.from_s + exposure.shutter_s);
    constexpr int kMoments = 16;
    auto const camera = [&](int i) { return exposure.camera(world.world(), exposure.shutter_s * i / kMoments); };
    std::uint64_t hash = gi::fingerprint(world.world(), camera(kMoments), settings, method, gi::options_of(method, settings));
    auto const add = [&](double v) { hash = gi::mix_bits(hash ^ std::bit_cast<std::uint64_t>(v)); };
    for (int i = 1; i < kMoments; ++i) {
        gi::Camera const c = camera(i);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row) add(c.world_from_camera[column][row]);
        add(c.yfov_rad);
        if (auto const& edge = c.off_axis)
            for (double const v : {edge->left, edge->right, edge->bottom, edge->top}) add(v);
    }
    return hash;
}

} // namespace viewer
