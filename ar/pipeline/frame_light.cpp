#include "ar/pipeline/frame_light.h"

#include "ar/composite/warp.h"
#include "ar/light/lat_long.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/light_samples.h"
#include "ar/pipeline/local_scene.h"
#include "gi/core/error.h"
#include "gi/filter/denoise.h"
#include "gi/methods/reference/reference.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr int kTurns = 5;             ///< of light and albedos
constexpr std::size_t kAnchor = 60;   ///< pixels of known albedo that give a first estimate alone
constexpr double kLeastLit = 0.25;    ///< share of the pixels that a lamp lights, with unknown albedos
constexpr double kGainShare = 0.3;    ///< of the gain asked of lamps, as textures hide a part of it
constexpr double kLeastSpread = 0.06; ///< relative, of pixels whose albedo is estimated
constexpr double kUnknownSigma = 0.1; ///< relative, of irradiance, where some albedos are estimated with it
constexpr double kScaleSigma = 0.5;   ///< relative, where no albedo is known
constexpr float kUndetermined = 0.2f;

/// Light of the surfaces from lights that the model contains itself.
std::vector<cv::Mat> own_light(gi::World const& world, CameraModel const& camera,
                               std::span<PosedFrame const> frames, gi::StopRequest const& stop, gi::Report& report)
{
    if (world.lights.empty() && world.emitters.empty()) return {};
    Warp const warp(camera, covering_pinhole(camera));
    std::vector<cv::Mat> out;
    for (PosedFrame const& f : frames) {
        gi::RenderSettings r;
        r.width = warp.from().size_px.x;
        r.height = warp.from().size_px.y;
        r.paths = 32;
        r.bounces = 6;
        gi::RenderResult result =
            gi::render_reference(world, gi_camera(warp.from(), f.world_from_camera), r, stop, {}, report);
        gi::denoise(result.picture, {});
        out.push_back(warp.smooth(matrix_of(result.picture, "color")));
    }
    return out;
}

class LightEstimator {
public:
    LightEstimator(gi::World const& world, RealScene const& real, FrameLightSettings const& settings)
        : settings_(settings), basis_(settings.directions), transfer_(world, basis_)
    {
        patch_of_material_.assign(world.materials.size(), -1);
        for (std::size_t k = 0; k < real.patches.size(); ++k) {
            patch_of_material_[real.patches[k].material] = int(k);
            out_.albedos.push_back({real.patches[k].name, cv::Vec3d::all(settings.mean_albedo), 0});
        }
    }

    FrameLight run(gi::World const& world, CameraModel const& camera, Photometry const& photometry,
                   std::span<PosedFrame const> frames, std::vector<cv::Mat> const& own)
    {
        pixels_ = light_pixels(world, transfer_, basis_, camera, photometry, frames, own, patch_of_material_,
                               settings_.samples);
        out_.counts = pixels_.counts;
        std::size_t known = 0;
        for (LightPixel const& p : pixels_.surfaces) {
            if (p.patch < 0)
                ++known;
            else
                ++out_.albedos[std::size_t(p.patch)].samples;
        }
        any_unknown_ = known < pixels_.surfaces.size();
        bool const is_anchored = known >= kAnchor;
        spreads_.assign(out_.albedos.size(), 0.3);
        out_.scale_is_known = known > 0;
        if (any_unknown_)
            for (int turn = 0; turn < kTurns; ++turn)
                fit_albedos(fit(turn == 0 && is_anchored ? Rows::known_albedo : Rows::all, Lamps::one));
        out_.fit = fit(Rows::all, Lamps::all);
        finish();
        return std::move(out_);
    }

private:
    enum class Rows { all, known_albedo };
    enum class Lamps { all, one }; ///< one, sooner found, while albedos change

    LightFit fit(Rows which, Lamps lamps)
    {
        used_.clear();
        std::vector<ReceivingPoint> points;
        for (std::size_t i = 0; i < pixels_.surfaces.size(); ++i)
            if (which == Rows::all || pixels_.surfaces[i].patch < 0) {
                used_.push_back(i);
                points.push_back(pixels_.surfaces[i].point);
            }
        if (!whole_.direct.empty() && used_.size() == pixels_.surfaces.size()) {
            rows_ = whole_; // what depends on the geometry alone is kept
        } else {
            rows_.direct = transfer_.direct(points);
            rows_.by_surfaces = transfer_.by_surfaces(points);
            rows_.seen = pixels_.seen;
            if (used_.size() == pixels_.surfaces.size()) whole_ = rows_;
        }
        rows_.irradiance.clear();
        rows_.sigma.clear();
        for (std::size_t const i : used_) {
            LightPixel const& p = pixels_.surfaces[i];
            cv::Vec3d const albedo = p.patch < 0 ? p.albedo : out_.albedos[std::size_t(p.patch)].albedo;
            double const model =
                p.patch < 0 ? settings_.model_sigma : std::max(kLeastSpread, spreads_[std::size_t(p.patch)]);
            cv::Vec3d e, sigma;
            for (int c = 0; c < 3; ++c) {
                e[c] = std::numbers::pi * p.radiance[c] / albedo[c];
                sigma[c] = std::hypot(model * std::max(0.0, e[c]), 0.2 * p.albedo_spread * e[c],
                                      std::numbers::pi * p.floor / albedo[c]);
            }
            rows_.irradiance.push_back(e);
            rows_.sigma.push_back(sigma);
        }
        rows_.of_disc = [this, points](glm::dvec3 towards, double half_angle_rad) {
            return transfer_.of_disc(points, towards, half_angle_rad);
        };
        LightFitSettings settings = settings_.fit;
        // Light found on few surfaces only may be a wrong albedo instead.
        if (any_unknown_) {
            settings.least_lit = std::max(settings.least_lit, kLeastLit);
            settings.least_gain *= kGainShare;
        }
        if (lamps == Lamps::one) {
            settings.most_lamps = std::min(settings.most_lamps, 1);
            settings.candidates = std::min(settings.candidates, 300);
        }
        return fit_light(basis_, rows_, settings);
    }

    /// The albedo of each patch as the median of what its pixels reflect over what the fit gives them.
    void fit_albedos(LightFit const& light)
    {
        std::vector<ReceivingPoint> points;
        for (LightPixel const& p : pixels_.surfaces) points.push_back(p.point);
        if (whole_.direct.empty()) {
            whole_.direct = transfer_.direct(points);
            whole_.by_surfaces = transfer_.by_surfaces(points);
            whole_.seen = pixels_.seen;
        }
        std::vector<std::vector<float>> lamps;
        for (FittedLamp const& l : light.lamps)
            lamps.push_back(transfer_.of_disc(points, l.direction, l.half_angle_rad));
        std::vector<std::array<std::vector<double>, 3>> ratios(out_.albedos.size());
        for (std::size_t i = 0; i < points.size(); ++i) {
            LightPixel const& p = pixels_.surfaces[i];
            if (p.patch < 0) continue;
            for (int c = 0; c < 3; ++c) {
                float const* const direct = whole_.direct.ptr<float>(int(i));
                float const* const indirect = whole_.by_surfaces[std::size_t(c)].ptr<float>(int(i));
                double e = 0;
                for (int k = 0; k < basis_.count(); ++k)
                    e += double(direct[k] + indirect[k]) * double(light.radiance.at<cv::Vec3f>(k)[c]);
                for (std::size_t l = 0; l < lamps.size(); ++l)
                    e += (double(lamps[l][i]) +
                          double(indirect[basis_.nearest(light.lamps[l].direction)]) / basis_.cell_sr()) *
                         light.lamps[l].irradiance[c];
                if (e > 0)
                    ratios[std::size_t(p.patch)][std::size_t(c)].push_back(std::numbers::pi * p.radiance[c] / e);
            }
        }
        for (std::size_t k = 0; k < ratios.size(); ++k)
            for (int c = 0; c < 3; ++c) {
                auto& r = ratios[k][std::size_t(c)];
                if (r.empty()) continue;
                auto const middle = r.begin() + std::ptrdiff_t(r.size() / 2);
                std::nth_element(r.begin(), middle, r.end());
                double const ratio = *middle;
                out_.albedos[k].albedo[c] = std::clamp(ratio, 0.02, 0.95);
                if (c != 1) continue;
                for (double& value : r) value = std::abs(value - ratio);
                std::nth_element(r.begin(), middle, r.end());
                spreads_[k] = std::min(0.5, 1.4826 * *middle / std::max(ratio, 1e-6));
            }
        if (!out_.scale_is_known) to_grey_world();
    }

    /// Only the product of albedo and light is known: the mean albedo of all pixels is set.
    void to_grey_world()
    {
        for (int c = 0; c < 3; ++c) {
            double sum = 0, n = 0;
            for (auto const& a : out_.albedos) {
                sum += double(a.samples) * a.albedo[c];
                n += double(a.samples);
            }
            if (!(sum > 0)) continue;
            for (auto& a : out_.albedos)
                if (a.samples > 0) a.albedo[c] = std::min(0.95, a.albedo[c] * settings_.mean_albedo * n / sum);
        }
    }

    void finish()
    {
        out_.map = map_of(basis_, out_.fit, settings_.size);
        cv::Mat known(basis_.count(), 1, CV_32FC1);
        for (int k = 0; k < basis_.count(); ++k) {
            known.at<float>(k) = out_.fit.known[std::size_t(k)];
            if (known.at<float>(k) >= kUndetermined) continue;
            out_.undetermined_share += 1.0 / basis_.count();
            if (basis_.direction(k).y > 0) out_.undetermined_above += 2.0 / basis_.count();
        }
        out_.known = basis_.spread(known, settings_.size);
        // Directions that the camera sees are sharper than the fit.
        cv::Mat seen, weight;
        cv::resize(pixels_.background, seen, settings_.size, 0, 0, cv::INTER_NEAREST);
        cv::resize(pixels_.weight, weight, settings_.size, 0, 0, cv::INTER_NEAREST);
        for (int j = 0; j < settings_.size.height; ++j)
            for (int i = 0; i < settings_.size.width; ++i) {
                float const w = weight.at<float>(j, i);
                if (!(w > 0)) continue;
                out_.seen_share += double(w) * texel_sr(settings_.size, j) / (4 * std::numbers::pi);
                if (w < 0.8f) continue;
                auto& to = out_.map.at<cv::Vec3f>(j, i);
                for (int c = 0; c < 3; ++c) // a clipped lamp stays as bright as its shading says
                    to[c] =
                        pixels_.seen[std::size_t(basis_.nearest(texel_direction(settings_.size, i, j)))].clipped
                            ? std::max(to[c], seen.at<cv::Vec3f>(j, i)[c])
                            : seen.at<cv::Vec3f>(j, i)[c];
                out_.known.at<float>(j, i) = std::max(out_.known.at<float>(j, i), w);
            }
        out_.faces = {{{"+x", {1, 0, 0}, {}, 0},
                       {"-x", {-1, 0, 0}, {}, 0},
                       {"+y, upward", {0, 1, 0}, {}, 0},
                       {"-y, downward", {0, -1, 0}, {}, 0},
                       {"+z", {0, 0, 1}, {}, 0},
                       {"-z", {0, 0, -1}, {}, 0}}};
        for (FrameLight::Face& f : out_.faces) {
            f.irradiance = irradiance_exact(out_.map, f.normal);
            double const all = 0.2126 * f.irradiance[0] + 0.7152 * f.irradiance[1] + 0.0722 * f.irradiance[2];
            if (all > 0)
                f.sigma = std::hypot(irradiance_sigma(basis_, out_.fit, f.normal) / all,
                                     any_unknown_ ? std::max(settings_.common_sigma, kUnknownSigma)
                                                  : settings_.common_sigma,
                                     out_.scale_is_known ? 0 : kScaleSigma);
        }
    }

    FrameLightSettings const& settings_;
    LightBasis basis_;
    LightTransfer transfer_;
    std::vector<int> patch_of_material_;
    LightPixels pixels_;
    bool any_unknown_ = false;
    std::vector<double> spreads_;   ///< per patch: relative, of its pixels about its albedo
    std::vector<std::size_t> used_; ///< of the pixels, those of the rows
    LightRows rows_, whole_;
    FrameLight out_;
};

} // namespace

FrameLight estimate_light(RealScene real, CameraModel const& camera, Photometry const& photometry,
                          std::span<PosedFrame const> frames, FrameLightSettings const& settings,
                          gi::StopRequest const& stop, gi::Report& report)
{
    if (frames.empty())
        throw gi::InputError("the camera was found in no frame",
                             "light is estimated from surfaces at known places",
                             "check with lightwell ar track, or use --poses");
    leave_out_views(real.scene);
    for (gi::Material& m : real.scene.materials) m.specular = 0;
    gi::World const world = gi::build_world(std::make_shared<gi::Scene const>(real.scene), std::nullopt, report);
    if (world.triangles.empty())
        throw gi::InputError("the session models no real surface", "light is estimated from their shading",
                             "add real: planes, boxes, meshes, depth or a scene");
    std::vector<cv::Mat> const own = own_light(world, camera, frames, stop, report);
    if (stop.requested()) return {};
    return LightEstimator(world, real, settings).run(world, camera, photometry, frames, own);
}

} // namespace ar
