#include "ar/runtime/light_check.h"

#include "ar/capture/clock.h"
#include "ar/light/lamps.h"
#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/pipeline.h"
#include "ar/pipeline/synthesize.h"
#include "ar/runtime/scratch_folder.h"
#include "ar/runtime/truth.h"
#include "gi/core/error.h"
#include "gi/scene/generate/write_glb.h"

#include <cmath>
#include <numbers>

namespace ar {
namespace {

double angle_deg(cv::Vec3d const& a, cv::Vec3d const& b)
{
    double const lengths = cv::norm(a) * cv::norm(b);
    return lengths > 0 ? glm::degrees(std::acos(std::clamp(a.dot(b) / lengths, -1.0, 1.0))) : 180;
}

/// Net flux of luminance: integral of L w dw.
cv::Vec3d flux_of(cv::Mat const& map)
{
    cv::Vec3d sum(0, 0, 0);
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i) {
            glm::dvec3 const d = texel_direction(map.size(), i, j);
            double const light = texel_sr(map.size(), j) * luminance(cv::Vec3d(map.at<cv::Vec3f>(j, i)));
            sum += light * cv::Vec3d(d.x, d.y, d.z);
        }
    return sum;
}

void compare_irradiance(cv::Mat const& estimate, cv::Mat const& truth, glm::dvec3 to_camera, LightChecked& out)
{
    LightBasis const normals(200);
    double error = 0, all = 0, facing_error = 0, facing_all = 0;
    cv::Vec3d mean_estimate(0, 0, 0), mean_truth(0, 0, 0);
    for (int k = 0; k < normals.count(); ++k) {
        glm::dvec3 const n = normals.direction(k);
        cv::Vec3d const a = irradiance_exact(estimate, n), b = irradiance_exact(truth, n);
        mean_estimate += a;
        mean_truth += b;
        error += (a - b).dot(a - b);
        all += b.dot(b);
        if (n.y < 0.5 && glm::dot(n, to_camera) < 0.5) continue;
        facing_error += (a - b).dot(a - b);
        facing_all += b.dot(b);
    }
    out.irradiance_rms = std::sqrt(error / all);
    out.facing_rms = std::sqrt(facing_error / facing_all);
    out.mean_ratio = luminance(mean_estimate) / luminance(mean_truth);
    out.white_deg = angle_deg(mean_estimate, mean_truth);
    double const up = luminance(irradiance_exact(estimate, {0, 1, 0})),
                 true_up = luminance(irradiance_exact(truth, {0, 1, 0}));
    out.up_ratio = up / true_up;
    out.up_sigmas = std::abs(up - true_up) / std::max(1e-12, up * out.light.faces[2].sigma);
    out.vector_deg = angle_deg(flux_of(estimate), flux_of(truth));
    SplitMap const lamps = split_lamps(truth);
    if (lamps.lamps.empty()) return;
    Lamp const& strongest = lamps.lamps[0];
    out.truth_lamp_share = std::max(0.0, strongest.direction.y) * luminance(strongest.irradiance) / true_up;
    auto const found = dominant_lamp(out.light.fit);
    if (!found) return;
    glm::dvec3 const d = found->direction;
    out.lamp_deg = glm::degrees(std::acos(std::clamp(glm::dot(d, strongest.direction), -1.0, 1.0)));
}

/// The same frame with the virtual figure and ball, lit by a map.
cv::Mat composite(Session session, ScratchFolder const& folder, cv::Mat const& light,
                  SyntheticCamera const& camera, PosedFrame const& frame, gi::StopRequest const& stop,
                  gi::Report& report)
{
    session.light = folder / "light.exr";
    write_map(session.light, light);
    CalibratedCamera const ar_camera{camera.model, camera.photometry, {}};
    Pipeline pipeline(session, ar_camera, synthetic_markers(DeskMarkers::board), report);
    Frame f;
    f.size_px = camera.model.size_px;
    f.planes[0] = frame.rgb;
    FrameResult r = pipeline.find(f, 0, frame.world_from_camera);
    pipeline.add(r, f, 0, stop);
    return r.rgb;
}

void compare_composites(gi::Scene const& near, cv::Mat const& truth, SyntheticCamera const& camera,
                        PosedFrame const& frame, gi::StopRequest const& stop, gi::Report& report,
                        LightChecked& out)
{
    ScratchFolder const folder;
    Session session;
    session.real.scene = folder / "near.glb";
    session.virtual_things.scene = folder / "statue.glb";
    session.virtual_things.at_m = {-0.02, 0, -0.1};
    session.render.resolution = 1;
    session.match_noise = false;
    gi::write_glb(session.real.scene, near, report);
    gi::write_glb(session.virtual_things.scene, generate_statue(), report);
    double const up = 1 / std::numbers::pi;
    cv::Vec3d const mean = up * irradiance_exact(truth, {0, 1, 0});
    cv::Mat const even(32, 64, CV_32FC3, cv::Scalar(mean[0], mean[1], mean[2]));
    cv::Mat const by_truth = composite(session, folder, truth, camera, frame, stop, report);
    auto const flip_of = [&](cv::Mat const& light) {
        return errors_against_truth(composite(session, folder, light, camera, frame, stop, report), frame.rgb,
                                    by_truth);
    };
    TruthErrors const e = flip_of(out.light.map);
    out.flip = e.flip_affected.value_or(-1);
    out.flip_nothing = e.camera_affected.value_or(-1);
    out.flip_even = flip_of(even).flip_affected.value_or(-1);
}

} // namespace

LightChecked check_light(cv::Mat const& truth, LightCheckSettings const& s, gi::StopRequest const& stop,
                         gi::Report& report)
{
    gi::Scene const near = generate_desk(DeskPart::near, synthetic_paper(DeskMarkers::board));
    gi::Scene lit = near;
    lit.environment = environment_of(truth);
    SyntheticCamera camera = synthetic_camera(s.size_px);
    // White paper is just below the largest byte, as with automatic exposure.
    cv::Vec3d const up = irradiance_exact(truth, {0, 1, 0});
    camera.photometry.radiance_per_unit = 0.95 * std::max({up[0], up[1], up[2]}) / std::numbers::pi;
    std::vector<PosedFrame> frames;
    for (int v = 0; v < s.views; ++v) {
        PosedFrame f;
        f.world_from_camera = synthetic_pose((v + 0.5) / s.views);
        SyntheticQuality quality;
        quality.paths = s.paths;
        cv::Mat const radiance = synthetic_radiance(lit, std::nullopt, camera.model, f.world_from_camera, quality,
                                                    std::uint64_t(v), stop, report);
        if (stop.requested()) return {};
        f.rgb = synthetic_frame(radiance, camera, std::uint64_t(v));
        frames.push_back(std::move(f));
    }
    RealScene real{near, {}};
    if (s.unknown_albedo)
        for (std::size_t k = 0; k < near.materials.size(); ++k)
            if (near.material_names[k] != "paper") {
                real.scene.materials[k].base_color = gi::vec3(0.5f);
                real.scene.materials[k].base_color_map = {};
                real.patches.push_back({near.material_names[k], k});
            }
    LightChecked out;
    double const begun_s = steady_now_s();
    out.light = estimate_light(std::move(real), camera.model, camera.photometry, frames, s.estimate, stop, report);
    out.estimate_s = steady_now_s() - begun_s;
    if (stop.requested()) return out;
    glm::dvec3 const to_camera = -(frames[0].world_from_camera.rotation * glm::dvec3(0, 0, 1));
    compare_irradiance(out.light.map, truth, to_camera, out);
    if (s.composites) compare_composites(near, truth, camera, frames[0], stop, report, out);
    return out;
}

} // namespace ar
