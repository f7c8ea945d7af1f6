#include "ar/pipeline/light_samples.h"

#include <array>
#include <cmath>

namespace ar {
namespace {

constexpr int kRaysAcross = 5; ///< rays across a pixel and its neighbours, half a pixel apart
cv::Size const kBackground{128, 64};
constexpr double kDarkAlbedo = 0.03;

/// Kind of surface and light at a pixel, with a filter two pixels wide.
struct PixelView {
    enum class What { surface, background, border, not_matt } what = What::border;
    LightPixel pixel;
};

class Looker {
public:
    Looker(gi::World const& world, LightTransfer const& transfer, CameraModel const& camera,
           std::vector<int> const& patch_of_material)
        : world_(world),
          view_(gi::view(world)),
          transfer_(transfer),
          camera_(camera),
          patch_of_material_(patch_of_material)
    {
    }

    PixelView operator()(gi::RigidPose const& pose, int x, int y) const
    {
        std::array<gi::RayQuery, kRaysAcross * kRaysAcross> queries;
        gi::vec3 const from(pose.position - world_.origin);
        for (int k = 0; k < kRaysAcross * kRaysAcross; ++k) {
            auto const d =
                direction_of(camera_, {x + 0.5 * (k % kRaysAcross - 2), y + 0.5 * (k / kRaysAcross - 2)});
            if (!d) return {};
            queries[std::size_t(k)].ray = {from, gi::vec3(glm::normalize(pose.rotation * *d))};
            queries[std::size_t(k)].seed = std::uint32_t(k);
        }
        std::array<gi::Hit, kRaysAcross * kRaysAcross> hits;
        transfer_.visibility().nearest(queries, hits);
        constexpr std::size_t middle = kRaysAcross * kRaysAcross / 2;
        std::size_t missed = 0;
        for (gi::Hit const& h : hits) missed += h.triangle == gi::kNoTriangle;
        PixelView out;
        if (missed == hits.size()) out.what = PixelView::What::background;
        if (missed > 0) return out;
        return averaged(queries, hits, middle);
    }

private:
    PixelView averaged(std::span<gi::RayQuery const> queries, std::span<gi::Hit const> hits,
                       std::size_t middle) const
    {
        auto const at = [&](std::size_t k) {
            return gi::shading_point(view_, hits[k].triangle, hits[k].barycentric, queries[k].ray.direction);
        };
        gi::ShadingPoint const centre = at(middle);
        std::uint32_t const material = world_.triangle_material[hits[middle].triangle];
        PixelView out;
        gi::dvec3 sum(0), squares(0);
        double weights = 0;
        for (std::size_t k = 0; k < hits.size(); ++k) {
            gi::ShadingPoint const p = at(k);
            std::uint32_t const m = world_.triangle_material[hits[k].triangle];
            bool const is_near = std::abs(glm::dot(p.position - centre.position, centre.geometric_normal)) <
                                 0.01f * hits[middle].distance;
            if (m != material || glm::dot(p.frame.normal, centre.frame.normal) < 0.98f || !is_near) return out;
            if (!gi::bsdf_detail::is_matt(p.bsdf) || gi::max_component(p.emission) > 0) {
                out.what = PixelView::What::not_matt;
                return out;
            }
            gi::dvec3 const albedo(gi::albedo(p.bsdf));
            int const i = int(k) % kRaysAcross - 2, j = int(k) / kRaysAcross - 2;
            double const weight = (1 - std::abs(i) / 3.0) * (1 - std::abs(j) / 3.0);
            sum += weight * albedo;
            squares += weight * albedo * albedo;
            weights += weight;
        }
        gi::dvec3 const mean = sum / weights, spread = glm::sqrt(glm::max(squares / weights - mean * mean, 0.0));
        out.what = PixelView::What::surface;
        out.pixel.point = receiving_point(centre);
        out.pixel.patch = patch_of_material_[material];
        out.pixel.albedo = {mean.x, mean.y, mean.z};
        out.pixel.albedo_spread = spread.y / std::max(mean.y, 1e-6);
        if (out.pixel.patch >= 0) {
            out.pixel.albedo = cv::Vec3d::all(1);
            out.pixel.albedo_spread = 0;
        }
        return out;
    }

    gi::World const& world_;
    gi::WorldView view_;
    LightTransfer const& transfer_;
    CameraModel const& camera_;
    std::vector<int> const& patch_of_material_;
};

double pixel_sr(CameraModel const& camera, int x, int y)
{
    auto const l = direction_of(camera, {x - 0.5, y}), r = direction_of(camera, {x + 0.5, y}),
               u = direction_of(camera, {x, y - 0.5}), b = direction_of(camera, {x, y + 0.5});
    return l && r && u && b ? glm::length(glm::cross(*r - *l, *b - *u)) : 0;
}

/// Sums of what is seen behind all surfaces.
class Background {
public:
    explicit Background(LightBasis const& basis)
        : basis_(basis),
          cells_(std::size_t(basis.count())),
          light_(cv::Mat::zeros(kBackground, CV_64FC3)),
          sr_(cv::Mat::zeros(kBackground, CV_64F)),
          clipped_(std::size_t(basis.count()), 0.0)
    {
    }

    void add(glm::dvec3 towards, cv::Vec3d const& radiance, double sr, bool is_clipped)
    {
        auto const k = std::size_t(basis_.nearest(towards));
        cells_[k].radiance += sr * radiance;
        cells_[k].share += sr;
        if (is_clipped) clipped_[k] += sr;
        glm::dvec2 const uv = uv_of(towards);
        cv::Point const at(std::min(int(uv.x * kBackground.width), kBackground.width - 1),
                           std::min(int(uv.y * kBackground.height), kBackground.height - 1));
        light_.at<cv::Vec3d>(at) += sr * radiance;
        sr_.at<double>(at) += sr;
    }

    void finish(LightPixels& out) const
    {
        out.seen = cells_;
        for (std::size_t k = 0; k < out.seen.size(); ++k) {
            SeenLight& s = out.seen[k];
            if (!(s.share > 0)) continue;
            s.radiance /= s.share;
            s.clipped = clipped_[k] > 0.02 * s.share;
            s.share = std::min(1.0, s.share / basis_.cell_sr());
        }
        out.background.create(kBackground, CV_32FC3);
        out.weight.create(kBackground, CV_32FC1);
        for (int j = 0; j < kBackground.height; ++j)
            for (int i = 0; i < kBackground.width; ++i) {
                double const sr = sr_.at<double>(j, i);
                out.background.at<cv::Vec3f>(j, i) =
                    sr > 0 ? cv::Vec3f(light_.at<cv::Vec3d>(j, i) / sr) : cv::Vec3f(0, 0, 0);
                out.weight.at<float>(j, i) = float(std::min(1.0, sr / texel_sr(kBackground, j)));
            }
    }

private:
    LightBasis const& basis_;
    std::vector<SeenLight> cells_; ///< sums until the end
    cv::Mat light_, sr_;
    std::vector<double> clipped_;
};

} // namespace

LightPixels light_pixels(gi::World const& world, LightTransfer const& transfer, LightBasis const& basis,
                         CameraModel const& camera, Photometry const& photometry,
                         std::span<PosedFrame const> frames, std::vector<cv::Mat> const& own_light,
                         std::vector<int> const& patch_of_material, int samples)
{
    LightPixels out;
    Background background(basis);
    Looker const look(world, transfer, camera, patch_of_material);
    double const pixels = double(camera.size_px.x) * camera.size_px.y * double(frames.size());
    int const step = std::max(1, int(std::floor(std::sqrt(pixels / samples))));
    for (std::size_t f = 0; f < frames.size(); ++f) {
        PosedFrame const& frame = frames[f];
        cv::Mat const radiance = radiance_of(frame.rgb, photometry, frame.exposure);
        cv::Mat const clipped = is_clipped(frame.rgb);
        double const white = cv::mean(radiance)[1];
        // Another phase in each frame, so that the points of the surfaces differ.
        int const shift = int(f * std::size_t(step) / frames.size());
        for (int y = step / 2; y < camera.size_px.y; y += step)
            for (int x = step / 2; x < camera.size_px.x; x += step) {
                cv::Point const at((x + shift) % camera.size_px.x, y);
                PixelView view = look(frame.world_from_camera, at.x, at.y);
                cv::Vec3d const value(radiance.at<cv::Vec3f>(at));
                bool const is_clipped = clipped.at<std::uint8_t>(at) != 0;
                if (view.what == PixelView::What::border) {
                    ++out.counts.border;
                } else if (view.what == PixelView::What::not_matt) {
                    ++out.counts.not_matt;
                } else if (view.what == PixelView::What::background) {
                    ++out.counts.background;
                    out.counts.background_clipped += is_clipped;
                    if (auto const d = direction_of(camera, {at.x, at.y}))
                        background.add(glm::normalize(frame.world_from_camera.rotation * *d), value,
                                       step * step * pixel_sr(camera, at.x, at.y), is_clipped);
                } else if (is_clipped) {
                    ++out.counts.clipped;
                } else if (std::min({view.pixel.albedo[0], view.pixel.albedo[1], view.pixel.albedo[2]}) <
                           kDarkAlbedo) {
                    ++out.counts.dark;
                } else {
                    view.pixel.radiance = value;
                    if (!own_light.empty()) view.pixel.radiance -= cv::Vec3d(own_light[f].at<cv::Vec3f>(at));
                    view.pixel.floor = 0.01 * white;
                    out.surfaces.push_back(view.pixel);
                }
            }
    }
    out.counts.used = out.surfaces.size();
    background.finish(out);
    return out;
}

} // namespace ar
