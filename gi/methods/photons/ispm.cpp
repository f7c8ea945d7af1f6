#include "gi/light_paths/kernel_cover.h"
#include "gi/methods/photons/methods.h"
#include "gi/methods/photons/photon_renderer.h"
#include "gi/methods/photons/splat_light.h"

#include <algorithm>

namespace gi {
namespace {

class SplatRenderer : public PhotonRenderer {
public:
    using PhotonRenderer::PhotonRenderer;

protected:
    std::string_view timer_name() const override { return "photon map"; }
    std::size_t bytes_per_photon() const override { return 400; }
    void take(PhotonSet&& set) override
    {
        constexpr float kAlpha = 2.0f / 3; // Knaus and Zwicker 2011: how slowly kernels shrink
        // Largest radius, relative to the longest side of the box of all photons.
        constexpr float kLargest = 0.05f;
        screens_.clear();
        cameras_.clear();
        map_ = {};
        photons_ = {};
        kernels_ = {};
        std::vector<Photon> photons = std::move(set.photons);
        sort_along_curve(photons, set.stop); // lists of tiles then read neighbours one after the other
        float const shrunk = set.number == 0
                                 ? settings_.of<PhotonSettings>().kernel_size
                                 : shrunk_ * std::sqrt((float(set.number) - 1 + kAlpha) / float(set.number));
        Bounds box;
        for (Photon const& p : photons) box = joined(box, {p.position, p.position});
        float const largest = box.empty() ? 0 : kLargest * max_component(box.high - box.low);
        if (!(largest > 0)) photons.clear(); // they all lie at one point: no area to spread them over
        // Photons per kernel grow as (number of paths)^(2/3): noise and blur then decrease at the same rate.
        float const each = 24 * std::pow(float(set.paths) / 65536, kAlpha);
        std::vector<float> radii = settings_.of<PhotonSettings>().kernel_by == KernelBy::density
                                       ? radii_by_density(photons, largest, std::size_t(std::max(1.0f, each)),
                                                          settings_.seed + set.number, set.stop)
                                       : radii_by_footprint(photons, largest, each);
        std::vector<PhotonKernel> kernels;
        kernels.reserve(photons.size());
        for (std::uint32_t i = 0; i < photons.size(); ++i) {
            radii[i] *= shrunk;
            kernels.push_back({photons[i].position, radii[i], photons[i].normal, i});
        }
        std::vector<float> const shares =
            covered_shares(view(world_), set.visibility, photons, kernels, set.stop, set.counts);
        for (std::size_t i = 0; i < photons.size(); ++i) photons[i].flux /= shares[i];
        photons_ = std::move(photons);
        map_ = PhotonMap(photons_, radii, set.stop);
        kernels_ = std::move(kernels);
        shrunk_ = shrunk;
    }
    SurfaceLight const* light(std::span<FrameView const> views, PhotonMap const* caustics,
                              BuildStop const& stop) override
    {
        if (!same_pictures(views, cameras_)) {
            StageTimer const timer(report_, "photons by tiles");
            screens_.clear();
            cameras_.clear();
            screens_ = tiles_of_views(views, world_.origin, {kernels_.data(), kernels_.size()},
                                      {photons_.data(), photons_.size()}, stop);
            cameras_.assign(views.begin(), views.end());
        }
        light_.emplace(screens_, map_, caustics);
        return &*light_;
    }
    void report_light(Report& report) override
    {
        std::size_t entries = 0;
        for (PhotonTiles const& s : screens_) entries += s.entries();
        report.count("photons in lists of tiles", double(entries));
        report.count("pictures without lists of tiles, which were too long",
                     double(cameras_.size() - screens_.size()));
        report.count("mean radius of the photons' kernels, m", double(map_.mean_radius()));
    }

private:
    std::vector<Photon> photons_;
    std::vector<PhotonKernel> kernels_;
    float shrunk_ = 1; ///< factor of the radii
    PhotonMap map_;
    std::vector<FrameView> cameras_;   ///< of screens_
    std::vector<PhotonTiles> screens_; ///< none if their lists were too long
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
