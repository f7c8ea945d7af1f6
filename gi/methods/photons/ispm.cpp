#include "gi/light_paths/kernel_cover.h"
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
        std::vector<Place> places;
        for (std::uint32_t i = 0; i < points.size(); ++i) {
            std::optional<Place> const place = find_place(points[i], i);
            if (place)
                places.push_back(*place);
            else
                out[i] = points[i].wo.z > 0 ? map_.radiance(points[i].at, points[i].wo, points[i].glossy_traced)
                                            : vec3{0};
        }
        std::ranges::sort(places, {}, &Place::block);
        for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
            while (end < places.size() && places[end].block == places[begin].block) ++end;
            splat_block(points, std::span(places).subspan(begin, end - begin), out);
        }
    }

private:
    static constexpr int kBlock = 4; ///< px; points that are this near on screen share a list of photons
    struct Place {
        std::uint64_t block;
        std::uint32_t point, screen, tile;
    };

    std::optional<Place> find_place(TreePoint const& p, std::uint32_t i) const
    {
        if (!(p.wo.z > 0)) return {};
        for (std::uint32_t k = 0; k < screens_.size(); ++k) {
            ScreenMap const& screen = screens_[k].view().screen;
            glm::ivec2 const pixel = screen.pixel_of(p.at.position);
            if (pixel.x < 0) continue;
            std::uint64_t const x = std::uint64_t(pixel.x / kBlock), y = std::uint64_t(pixel.y / kBlock);
            return Place{std::uint64_t(k) << 48 | y << 24 | x, i, k, std::uint32_t(screen.tile_of(pixel))};
        }
        return {};
    }
    /// Of the tile's photons only those that reach the block are tested against each of its points.
    void splat_block(std::span<TreePoint const> points, std::span<Place const> places, std::span<vec3> out) const
    {
        TilesView const tiles = screens_[places[0].screen].view();
        vec3 low{kInf}, high{-kInf};
        for (Place const& p : places) {
            low = glm::min(low, points[p.point].at.position);
            high = glm::max(high, points[p.point].at.position);
        }
        thread_local std::vector<PhotonKernel> near;
        near.clear();
        for (std::uint32_t const k : tiles.of_tile(places[0].tile)) {
            PhotonKernel const& kernel = tiles.kernels[k];
            vec3 const way = kernel.position - glm::clamp(kernel.position, low, high);
            if (glm::dot(way, way) < square(kernel.radius)) near.push_back(kernel);
        }
        for (Place const& p : places) {
            TreePoint const& point = points[p.point];
            PhotonSum sum(point.at, point.wo, point.glossy_traced);
            for (PhotonKernel const& kernel : near) sum.add(kernel, tiles.photons[kernel.photon]);
            out[p.point] = sum.radiance();
        }
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
        std::vector<Photon> photons(set.photons.begin(), set.photons.end());
        sort_along_curve(photons); // lists of tiles then read neighbours one after the other
        float const shrunk = set.number == 0
                                 ? settings_.photons.kernel_size
                                 : shrunk_ * std::sqrt((float(set.number) - 1 + kAlpha) / float(set.number));
        Bounds box;
        for (Photon const& p : photons) box = joined(box, {p.position, p.position});
        float const largest = box.empty() ? 0 : kLargest * max_component(box.high - box.low);
        if (!(largest > 0)) photons.clear(); // they all lie at one point: no area to spread them over
        // As many photons in a kernel as make noise and blur fall at the same pace: a power of 2/3 of all.
        float const each = 24 * std::pow(float(set.paths) / 65536, kAlpha);
        std::vector<float> radii = settings_.photons.kernel_by == KernelBy::density
                                       ? radii_by_density(photons, largest, std::size_t(std::max(1.0f, each)),
                                                          settings_.seed + set.number, set.stop)
                                       : radii_by_footprint(photons, largest, each);
        std::vector<PhotonKernel> kernels;
        for (std::uint32_t i = 0; i < photons.size(); ++i) {
            radii[i] *= shrunk;
            kernels.push_back({photons[i].position, radii[i], photons[i].normal, i});
        }
        std::vector<float> const shares =
            covered_shares(view(world_), set.visibility, photons, kernels, set.stop, set.counts);
        for (std::size_t i = 0; i < photons.size(); ++i) photons[i].flux /= shares[i];
        screens_.clear(); // nothing is interrupted from here on
        cameras_.clear();
        photons_ = std::move(photons);
        map_ = PhotonMap(photons_, radii);
        kernels_ = std::move(kernels);
        shrunk_ = shrunk;
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
                                      View<PhotonKernel const>{kernels_.data(), kernels_.size()},
                                      View<Photon const>{photons_.data(), photons_.size()});
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
    std::vector<PhotonKernel> kernels_;
    float shrunk_ = 1; ///< factor of the radii
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
