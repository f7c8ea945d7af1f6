// The method multi_image (Fei and Wang): photons by distance impostors. Diffuse light is gathered in one lattice
// over the scene, the light gathering volume (LGV), caustics in the pixels of the camera (SSLGV). Points that no
// pixel shows, as in mirrors, take caustics from the photon map.
//
// Unlike the paper: the LGV is divided by the area of the surfaces in each cell (PhotonLattices). The paper's
// A C_0^2 / (4 N) is alike for all cells, so that radiance grows with the area of surfaces in a cell: it is right
// for one C_0 by the size of the cells, and not in their corners (tests/photons/light_gathering_volume_test.cpp).
// Neighbours exchange whole vectors, numerators and denominators alike, instead of what goes in their direction.

#include "gi/methods/photons/limits.h"
#include "gi/methods/photons/methods.h"
#include "gi/methods/photons/photon_renderer.h"
#include "gi/methods/photons/screen_volume.h"
#include "gi/methods/whitted/caustic_light.h"
#include "gi/methods/whitted/lobe_light.h"

#include <algorithm>

namespace gi {
namespace {

class MultiImageLight : public SurfaceLight {
public:
    /// @param caustics  null = none
    MultiImageLight(PhotonLattices const& volume, std::vector<ScreenVolume> const& screens,
                    PhotonMap const* caustics)
        : volume_(volume), screens_(screens), caustics_(caustics)
    {
    }
    void indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts&) const override
    {
        for (std::size_t i = 0; i < points.size(); ++i) {
            TreePoint& p = points[i];
            out[i] = vec3{0};
            if (!(p.wo.z > 0)) continue;
            if (caustics_ != nullptr) layer_of(*p.sample, p.scatterings + 1) += p.throughput * caustics(p);
            if (vec3 const response = diffuse_response(p); max_component(response) > 0)
                out[i] = response * volume_.irradiance(p.at.position, p.at.frame.normal);
            out[i] +=
                glossy_radiance(p, p.direct ? 8 : 1, [&](vec3 wi) { return volume_.radiance(p.at.position, wi); });
        }
    }

private:
    vec3 caustics(TreePoint const& p) const
    {
        // Four coefficients are too few for a caustic seen in a glossy lobe.
        if (bsdf_detail::is_matt(p.at.bsdf) || p.glossy_traced)
            for (ScreenVolume const& s : screens_) {
                vec3 irradiance;
                if (s.view().irradiance_at(p.at.position, p.at.geometric_normal, p.at.frame.normal, irradiance))
                    return diffuse_response(p) * irradiance;
            }
        return caustics_->radiance(p.at, p.wo, p.glossy_traced);
    }

    PhotonLattices const& volume_;
    std::vector<ScreenVolume> const& screens_;
    PhotonMap const* caustics_;
};

class MultiImageRenderer : public PhotonRenderer {
public:
    MultiImageRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving,
                       Report& report, StopRequest const* stop)
        : PhotonRenderer(world, settings, first_moving, report, stop), volume_(volume_of(settings.of<PhotonSettings>()))
    {
        check_bytes(PhotonLattices::bytes(volume_of(settings.of<PhotonSettings>()), world.bounds, surface_area(world)),
                    "a light gathering volume", "choose fewer --volume-cells");
        check_impostors(settings.of<PhotonSettings>(), first_moving < world.triangles.size());
    }
    void changed(Changes const& c) override
    {
        PhotonRenderer::changed(c);
        soup_moved_ = soup_moved_ || c.geometry;
        if (c.materials || c.coverage) cut_outs_.reset();
        if (c.geometry || c.materials || c.coverage) cameras_.clear();
    }

protected:
    bool stores(LightVertex const&) const override { return true; } // all tell what light reaches
    PhotonRays rays_kind() const override { return PhotonRays::impostors; }
    std::string_view timer_name() const override { return "light gathering volume"; }
    std::size_t bytes_per_photon() const override { return 200; }
    int cascades_about_camera() const override { return settings_.of<PhotonSettings>().lattice_cascades; }
    void take(PhotonSet&& set) override
    {
        if (set.surfaces_changed || set.middle_changed)
            volume_.place(world_, set.visibility, {set.middle, set.focus, first_moving_, set.only_moved},
                          set.stop);
        volume_.update(set.photons, set.stop);
    }
    SurfaceLight const* light(std::span<FrameView const> views, PhotonMap const* caustics,
                              BuildStop const& stop) override
    {
        if (caustics != nullptr) {
            place_screens(views);
            if (of_caustics_ != caustics_version()) {
                StageTimer const timer(report_, "caustics on screen");
                of_caustics_.reset();
                for (ScreenVolume& s : screens_) s.update(caustic_photons(), stop);
                of_caustics_ = caustics_version();
            }
        }
        light_.emplace(volume_, screens_, caustics);
        return &*light_;
    }
    void report_light(Report& report) override
    {
        std::size_t cells = 0;
        for (Frequency const f : {Frequency::low, Frequency::middle})
            for (PhotonLattices::Cascade const& cascade : volume_.cascades(f))
                cells += cascade.cells.values.size();
        report.count("nested lattices", double(volume_.cascades(Frequency::low).size()));
        report.count("cells with surfaces", double(cells));
        report.count("flux of photons in no cell, W (sum of channels)", volume_.lost_w());
        report.count("flux left out in cells of hardly any area, W (sum of channels)", volume_.dimmed_w());
        dvec3 on{0}, off{0};
        for (ScreenVolume const& s : screens_) {
            on += s.injected_w();
            off += s.lost_w();
        }
        report.count("flux of caustics on screen, W (luminance)", double(luminance(vec3(on))));
        report.count("flux of caustics elsewhere, W (luminance)", double(luminance(vec3(off))));
    }

private:
    void place_screens(std::span<FrameView const> views)
    {
        if (same_pictures(views, cameras_)) return;
        StageTimer const timer(report_, "surfaces on screen");
        cameras_.assign(views.begin(), views.end());
        if (!soup_)
            soup_ = make_soup(world_);
        else if (soup_moved_)
            update_soup(world_, first_moving_, *soup_);
        soup_moved_ = false;
        if (!cut_outs_) cut_outs_.emplace(world_);
        screens_.clear();
        of_caustics_.reset();
        for (FrameView const& v : views) {
            if (v.camera.orthographic) continue;
            screens_.emplace_back(ScreenVolumeSettings{.gathers = settings_.of<PhotonSettings>().screen_gathers});
            screens_.back().place(world_, *soup_, *cut_outs_, v, std::uint32_t(settings_.seed));
        }
    }

    PhotonLattices volume_;
    std::optional<TriangleSoup> soup_;
    std::optional<CutOuts> cut_outs_;
    bool soup_moved_ = false;
    std::vector<FrameView> cameras_; ///< of screens_
    std::vector<ScreenVolume> screens_;
    std::optional<std::uint32_t> of_caustics_; ///< version of those on the screens
    std::optional<MultiImageLight> light_;
};

} // namespace

RenderResult render_multi_image(World const& world, Camera const& camera, RenderSettings const& settings,
                                StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_passes("multi_image", start_passes<MultiImageRenderer>, world, camera, settings, stop, progress,
                         report);
}

std::unique_ptr<FrameRenderer> start_multi_image_frames(MovingWorld const& world, Camera const&,
                                                        RenderSettings const& settings, Report& report)
{
    return start_pass_frames(start_passes<MultiImageRenderer>, world, settings, report);
}

} // namespace gi
