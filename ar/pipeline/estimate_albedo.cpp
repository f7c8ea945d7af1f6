#include "ar/pipeline/estimate_albedo.h"

#include "ar/capture/clock.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/first_surfaces.h"
#include "gi/core/error.h"
#include "gi/filter/denoise.h"
#include "gi/methods/reference/reference.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr float kLeastAlbedo = 0.02f; ///< lower limit for rendering: the light is divided by it

/// A view and its camera, which stay the same in all iterations except for `white`.
struct Prepared {
    AlbedoView view;
    gi::Camera camera;
};

class Estimator {
public:
    Estimator(RealScene real, CalibratedCamera const& camera, EstimateSettings const& settings,
              gi::StopRequest const& stop, gi::Report& report)
        : real_(std::move(real)),
          camera_(camera),
          settings_(settings),
          stop_(stop),
          report_(report),
          small_(scaled(camera.model, small_size(camera.model.size_px, settings.resolution))),
          warp_(small_, covering_pinhole(small_))
    {
        patch_of_material_.assign(real_.scene.materials.size() + 1, -1);
        for (std::size_t k = 0; k < real_.patches.size(); ++k) {
            std::size_t const m = real_.patches[k].material;
            patch_of_material_[m] = int(k);
            // Highlights are not part of the albedo: those that stand out are left out of the frames.
            real_.scene.materials[m].specular = 0;
        }
    }

    void prepare(std::span<PosedFrame const> frames)
    {
        gi::World const world = build();
        SurfaceView const surfaces(world, Surfaces::all);
        glm::ivec2 const pinhole_px = warp_.from().size_px;
        for (PosedFrame const& f : frames) {
            Prepared p;
            p.camera = gi_camera(warp_.from(), f.world_from_camera);
            FirstSurfaces const s = surfaces.seen(p.camera, pinhole_px.x, pinhole_px.y, 0);
            cv::Mat patches(s.triangle.size(), CV_32SC1, cv::Scalar(-1));
            patches.forEach<int>([&](int& patch, int const* at) {
                int const t = s.triangle.at<int>(at[0], at[1]);
                if (t >= 0) patch = patch_of_material_[world.triangle_material[std::size_t(t)]];
            });
            p.view.surface = nearest(patches, -1);
            p.view.place = warp_.nearest(s.place);
            cv::Size const size(small_.size_px.x, small_.size_px.y);
            cv::resize(radiance_of(f.rgb, camera_.photometry, f.exposure), p.view.radiance, size, 0, 0,
                       cv::INTER_AREA);
            cv::Mat clipped;
            cv::resize(is_clipped(f.rgb), clipped, size, 0, 0, cv::INTER_AREA);
            p.view.clipped = clipped > 0;
            p.view.weight = cv::Mat(size, CV_32FC1, cv::Scalar(f.confidence));
            prepared_.push_back(std::move(p));
        }
    }

    std::vector<AlbedoView> render(std::vector<cv::Vec3f> const& albedos)
    {
        std::vector<cv::Vec3f> rendered = albedos;
        for (std::size_t k = 0; k < albedos.size(); ++k) {
            for (int c = 0; c < 3; ++c) rendered[k][c] = std::max(albedos[k][c], kLeastAlbedo);
            real_.scene.materials[real_.patches[k].material].base_color = {rendered[k][0], rendered[k][1],
                                                                           rendered[k][2]};
        }
        gi::World const world = build();
        std::vector<AlbedoView> views;
        for (std::size_t i = 0; i < prepared_.size(); ++i) {
            AlbedoView view = prepared_[i].view;
            double const begun_s = steady_now_s();
            view.white = warp_.smooth(color(world, prepared_[i].camera, i));
            if (double const each_s = steady_now_s() - begun_s; !std::exchange(is_told_, true)) {
                std::size_t const n = prepared_.size();
                gi::say_estimate(
                    "albedo", each_s * double(n) * settings_.most_turns,
                    fmt::format("at most: {} iterations of {} pictures, {:.1f} s each; often half of that",
                                settings_.most_turns, n, each_s));
            }
            view.white.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const* at) {
                int const patch = view.surface.at<int>(at[0], at[1]);
                if (patch < 0) return;
                for (int c = 0; c < 3; ++c) v[c] /= rendered[std::size_t(patch)][c];
            });
            views.push_back(std::move(view));
        }
        return views;
    }

    void light(std::shared_ptr<gi::EnvironmentMap const> map)
    {
        map_ = std::move(map);
        bool const emits = std::any_of(real_.scene.materials.begin(), real_.scene.materials.end(), gi::emits);
        if (!map_ && !emits && real_.scene.lights.empty())
            throw gi::InputError("the light is unknown", "albedo is reflected light over incident light",
                                 "set light: {map: FILE} in the session");
    }

    std::vector<AlbedoPatch> const& patches() const { return real_.patches; }

private:
    static glm::ivec2 small_size(glm::ivec2 size, double resolution)
    {
        return glm::max(glm::ivec2(glm::round(glm::dvec2(size) * resolution)), glm::ivec2(16));
    }

    /// As Warp::nearest, with what the pinhole does not see known as such.
    cv::Mat nearest(cv::Mat const& numbers, int outside) const
    {
        cv::Mat const shifted = numbers - outside; // Warp gives 0 there
        cv::Mat as_floats, back;
        shifted.convertTo(as_floats, CV_32F);
        warp_.nearest(as_floats).convertTo(back, CV_32S);
        return back + outside;
    }

    gi::World build()
    {
        auto const scene = std::make_shared<gi::Scene>(real_.scene);
        leave_out_views(*scene);
        if (map_) scene->environment = *map_;
        return gi::build_world(scene, std::nullopt, report_);
    }

    cv::Mat color(gi::World const& world, gi::Camera const& camera, std::size_t frame) const
    {
        gi::RenderSettings r;
        r.width = warp_.from().size_px.x;
        r.height = warp_.from().size_px.y;
        r.paths = settings_.paths;
        r.bounces = settings_.bounces;
        r.seed = frame;
        gi::RenderResult result = gi::render_reference(world, camera, r, stop_, {}, report_);
        if (result.paths > 1) gi::denoise(result.picture, {});
        return matrix_of(result.picture, "color");
    }

    RealScene real_;
    std::shared_ptr<gi::EnvironmentMap const> map_;
    CalibratedCamera const& camera_;
    EstimateSettings const& settings_;
    gi::StopRequest const& stop_;
    gi::Report& report_;
    CameraModel small_;
    Warp warp_;
    std::vector<int> patch_of_material_;
    std::vector<Prepared> prepared_;
    bool is_told_ = false; ///< how long it will take
};

cv::Size texture_size(AlbedoPatch const& p)
{
    double const longer = std::max(p.width_m, p.height_m);
    auto const side = [&](double m) { return std::max(1, int(std::lround(p.texels * m / longer))); };
    return {side(p.width_m), side(p.height_m)};
}

gi::dvec3 vector_of(cv::Vec3f const& v) { return {v[0], v[1], v[2]}; }

} // namespace

AlbedoEstimate estimate_albedos(RealScene real, std::shared_ptr<gi::EnvironmentMap const> light,
                                CalibratedCamera const& camera, std::span<PosedFrame const> frames,
                                EstimateSettings const& settings, gi::StopRequest const& stop, gi::Report& report)
{
    if (real.patches.empty())
        throw gi::InputError("no albedo to estimate", "the session specifies all of them",
                             "write albedo: estimate at a proxy, or at the real scene");
    if (frames.empty())
        throw gi::InputError("the camera was found in no frame", "albedos need frames with a pose",
                             "check with lightwell ar track, or use --poses");
    Estimator estimator(std::move(real), camera, settings, stop, report);
    estimator.light(std::move(light));
    estimator.prepare(frames);
    auto const& patches = estimator.patches();
    std::vector<AlbedoView> views;
    AlbedoEstimate out;
    out.solution = solve_albedo(
        [&](std::vector<cv::Vec3f> const& albedos) { return views = estimator.render(albedos); },
        int(patches.size()), settings.fit, {0.5f, 0.5f, 0.5f}, settings.tolerance, settings.most_turns);
    for (std::size_t k = 0; k < patches.size(); ++k) {
        PatchAlbedo const& found = out.solution.fit.patches[k];
        out.entries.push_back(
            {patches[k].name, vector_of(found.albedo), vector_of(found.spread), found.samples, {}});
        out.textures.emplace_back();
        if (patches[k].texels == 0 || found.samples == 0) continue;
        AlbedoTexture const t = fit_texture(views, int(k), texture_size(patches[k]), found, settings.fit);
        out.textures.back() = t.albedo;
        out.texels += t.albedo.total();
        out.filled += t.filled;
        out.outside += t.outside;
    }
    return out;
}

} // namespace ar
