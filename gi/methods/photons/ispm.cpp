#include "gi/methods/photons/methods.h"
#include "gi/methods/photons/photon_renderer.h"
#include "gi/methods/photons/splat.h"
#include "gi/methods/whitted/caustic_light.h"

#include <algorithm>

namespace gi {
namespace {

/// Points on a screen take photons from the lists of its tiles, others (seen in mirrors, or behind the border)
/// from the map.
class SplatLight : public SurfaceLight {
public:
    SplatLight(std::vector<PhotonTiles> const& screens, PhotonMap const& map, PhotonMap const* caustics)
        : screens_(screens), map_(map), caustics_(caustics)
    {
    }
    void indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts&) const override
    {
        if (caustics_ != nullptr) add_caustics(*caustics_, points);
        for (std::size_t i = 0; i < points.size(); ++i) out[i] = radiance(points[i]);
    }

private:
    vec3 radiance(TreePoint const& p) const
    {
        if (!(p.wo.z > 0)) return vec3{0};
        for (PhotonTiles const& screen : screens_) {
            TilesView const tiles = screen.view();
            int const tile = tiles.screen.tile_of(p.at.position);
            if (tile < 0) continue;
            vec3 const all = splat_radiance(tiles, std::size_t(tile), p.at, p.at.bsdf, p.wo);
            if (!p.glossy_traced) return all;
            return glm::max(all - splat_radiance(tiles, std::size_t(tile), p.at, glossy_lobe(p.at.bsdf), p.wo),
                            vec3{0});
        }
        return photon_radiance(map_, p);
    }

    std::vector<PhotonTiles> const& screens_;
    PhotonMap const& map_;
    PhotonMap const* caustics_;
};

class SplatRenderer : public PhotonRenderer {
public:
    using PhotonRenderer::PhotonRenderer;

protected:
    std::string_view timer_name() const override { return "photon map"; }
    void take(PhotonSet const& set) override
    {
        constexpr float kAlpha = 2.0f / 3; // Knaus and Zwicker 2011: how slowly kernels shrink
        constexpr float kLargest = 0.05f;  // radius over the longest side of what photons reach
        photons_.assign(set.photons.begin(), set.photons.end());
        screens_.clear();
        cameras_.clear();
        shrunk_ = set.number == 0 ? settings_.photons.kernel_size
                                  : shrunk_ * std::sqrt((float(set.number) - 1 + kAlpha) / float(set.number));
        Bounds box;
        for (Photon const& p : photons_) box = joined(box, {p.position, p.position});
        float const largest = box.empty() ? 0 : kLargest * max_component(box.high - box.low);
        if (!(largest > 0)) photons_.clear(); // they all lie at one point: no area to spread them over
        // As many photons in a kernel as make noise and blur fall at the same pace: a power of 2/3 of all.
        float const each = 24 * std::pow(float(set.paths) / 65536, kAlpha);
        KernelSizes const sizes = settings_.photons.kernel_by == KernelBy::density
                                      ? sizes_by_density(photons_, largest, std::size_t(std::max(1.0f, each)))
                                      : sizes_by_footprint(photons_, largest, each);
        radii_.resize(photons_.size());
        for (std::size_t i = 0; i < radii_.size(); ++i) radii_[i] = shrunk_ * sizes.radius(i);
        map_ = PhotonMap(photons_, sizes, shrunk_);
    }
    SurfaceLight const* light(std::span<FrameView const> views, PhotonMap const* caustics) override
    {
        bool const same = std::ranges::equal(views, cameras_, [](FrameView const& v, FrameView const& w) {
            return v.camera == w.camera && v.width == w.width && v.height == w.height;
        });
        if (!same) {
            StageTimer const timer(report_, "photons by tiles");
            screens_.clear();
            cameras_.assign(views.begin(), views.end());
            for (FrameView const& v : views)
                screens_.emplace_back(screen_map(v, world_.origin),
                                      View<Photon const>{photons_.data(), photons_.size()},
                                      View<float const>{radii_.data(), radii_.size()});
        }
        light_.emplace(screens_, map_, caustics);
        return &*light_;
    }
    void report_light(Report& report) override
    {
        std::size_t entries = 0;
        for (PhotonTiles const& s : screens_) entries += s.entries();
        report.count("photons in lists of tiles", double(entries));
        report.count("mean radius of the photons' kernels, m", double(map_.mean_radius()));
    }

private:
    std::vector<Photon> photons_;
    std::vector<float> radii_; ///< m
    float shrunk_ = 1;         ///< factor of the radii
    PhotonMap map_;
    std::vector<FrameView> cameras_; ///< of screens_
    std::vector<PhotonTiles> screens_;
    std::optional<SplatLight> light_;
};

} // namespace

RenderResult render_ispm(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_passes("ispm", start_passes<SplatRenderer>, world, camera, settings, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_ispm_frames(MovingWorld const& world, Camera const&,
                                                 RenderSettings const& settings, Report& report)
{
    return start_pass_frames(start_passes<SplatRenderer>, world, settings, report);
}

} // namespace gi
