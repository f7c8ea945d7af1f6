// The methods lpv and isllpm: ray trees take indirect light from their lattices.

#include "gi/light_paths/lamp_caustics.h"
#include "gi/light_paths/memory_limit.h"
#include "gi/methods/photons/limits.h"
#include "gi/methods/photons/methods.h"
#include "gi/methods/photons/photon_renderer.h"
#include "gi/methods/whitted/caustic_light.h"
#include "gi/methods/whitted/lobe_light.h"

namespace gi {
namespace {

int glossy_directions(TreePoint const& p) { return p.direct ? 8 : 1; }

/// Of a lattice with irradiance(position, normal) and radiance(position, direction).
template <class Lattice>
class LatticeLight : public SurfaceLight {
public:
    explicit LatticeLight(Lattice const& lattice) : lattice_(lattice) {}
    /// Null = by the lattice, if it has any.
    void take_caustics(PhotonMap const* map) { caustic_map_ = map; }
    void indirect(std::span<TreePoint> points, std::span<vec3> out, PathCounts&) const override
    {
        if (caustic_map_ != nullptr) add_caustics(*caustic_map_, points);
        for (std::size_t i = 0; i < points.size(); ++i) {
            TreePoint& p = points[i];
            out[i] = vec3{0};
            if (!(p.wo.z > 0)) continue;
            if constexpr (std::is_same_v<Lattice, PhotonLattices>)
                if (caustic_map_ == nullptr) layer_of(*p.sample, p.scatterings + 1) += p.throughput * caustics(p);
            if (vec3 const response = diffuse_response(p); max_component(response) > 0)
                out[i] = response * lattice_.irradiance(p.at.position, p.at.frame.normal);
            out[i] += glossy_radiance(p, glossy_directions(p),
                                      [&](vec3 wi) { return lattice_.radiance(p.at.position, wi); });
        }
    }

private:
    vec3 caustics(TreePoint& p) const
    {
        vec3 const from = p.at.position;
        vec3 const diffuse = diffuse_response(p) * lattice_.irradiance(Frequency::high, from, p.at.frame.normal);
        return diffuse + glossy_radiance(p, glossy_directions(p),
                                         [&](vec3 wi) { return lattice_.radiance(Frequency::high, from, wi); });
    }

    Lattice const& lattice_;
    PhotonMap const* caustic_map_ = nullptr;
};

class PropagationRenderer : public PhotonRenderer {
public:
    PropagationRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving,
                        Report& report, StopRequest const* stop)
        : PhotonRenderer(world, settings, first_moving, report, stop),
          of_propagation_(propagation_of(settings.of<PhotonSettings>())),
          propagation_(of_propagation_),
          light_(propagation_)
    {
        check_bytes(LightPropagation::bytes(of_propagation_, world.bounds), "lattices", "choose fewer cells");
    }

protected:
    bool stores(LightVertex const&) const override { return true; }
    bool has_caustics() const override { return false; }
    int bounces() const override { return PhotonRenderer::bounces() - 1; } // the last is the lattice's
    std::string_view timer_name() const override { return "light propagation"; }
    std::size_t bytes_per_photon() const override { return 250; }
    int cascades_about_camera() const override { return of_propagation_.cascades; }
    void take(PhotonSet&& set) override
    {
        propagation_.update(world_, set.surfaces_changed ? Geometry::changed : Geometry::same, set.photons,
                            set.middle, set.focus, set.stop);
    }
    SurfaceLight const* light(std::span<FrameView const>, PhotonMap const*, BuildStop const&) override
    {
        return &light_;
    }
    void report_light(Report& report) override
    {
        report.count("lattices, MiB", double(LightPropagation::bytes(of_propagation_, world_.bounds)) / (1 << 20));
        if (!propagation_.cascades().empty())
            report.count("finest cells, m", double(propagation_.cascades().front().frame.cell));
    }

private:
    PropagationSettings of_propagation_;
    LightPropagation propagation_;
    LatticeLight<LightPropagation> light_;
};

class LatticeRenderer : public PhotonRenderer {
public:
    LatticeRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                    StopRequest const* stop)
        : PhotonRenderer(world, settings, first_moving, report, stop),
          of_lattices_(lattices_of(settings.of<PhotonSettings>())),
          lattices_(of_lattices_),
          light_(lattices_)
    {
        check_bytes(PhotonLattices::bytes(of_lattices_, world.bounds, surface_area(world)), "lattices",
                    "choose fewer cells");
    }

protected:
    bool stores(LightVertex const&) const override { return true; } // all tell what light reaches
    std::string_view timer_name() const override { return "light lattices"; }
    std::size_t bytes_per_photon() const override { return 200; }
    int cascades_about_camera() const override { return of_lattices_.cascades; }
    void take(PhotonSet&& set) override
    {
        of_caustics_.reset();
        if (set.surfaces_changed || set.middle_changed)
            lattices_.place(world_, set.visibility, {set.middle, set.focus, first_moving_, set.only_moved},
                            set.stop);
        lattices_.update(set.photons, set.stop);
    }
    SurfaceLight const* light(std::span<FrameView const>, PhotonMap const* caustics,
                              BuildStop const& stop) override
    {
        bool const by_kernels = settings_.of<PhotonSettings>().caustics_by == CausticsBy::kernels;
        light_.take_caustics(by_kernels ? caustics : nullptr);
        if (of_caustics_ == caustics_version()) return &light_;
        of_caustics_.reset();
        lattices_.update_caustics(
            caustics != nullptr && !by_kernels ? caustic_photons() : std::span<Photon const>{}, stop);
        of_caustics_ = caustics_version();
        return &light_;
    }
    void report_light(Report& report) override
    {
        std::size_t cells = 0;
        for (Frequency const f : {Frequency::low, Frequency::middle, Frequency::high})
            for (PhotonLattices::Cascade const& cascade : lattices_.cascades(f))
                cells += cascade.cells.values.size();
        report.count("nested lattices", double(lattices_.cascades(Frequency::low).size()));
        report.count("cells with surfaces", double(cells));
        report.count("hidden area of surfaces, m^2", lattices_.hidden_m2());
        report.count("flux of photons in no cell, W (sum of channels)", lattices_.lost_w());
        report.count("flux left out in cells of hardly any area, W (sum of channels)", lattices_.dimmed_w());
    }

private:
    PhotonLatticeSettings of_lattices_;
    PhotonLattices lattices_;
    LatticeLight<PhotonLattices> light_;
    std::optional<std::uint32_t> of_caustics_; ///< version of those in the lattices
};

} // namespace

RenderResult render_lpv(World const& world, Camera const& camera, RenderSettings const& settings,
                        StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    lose_lamp_caustics(world, report);
    return render_passes("lpv", start_passes<PropagationRenderer>, world, camera, settings, stop, progress,
                         report);
}

std::unique_ptr<FrameRenderer> start_lpv_frames(MovingWorld const& world, Camera const&,
                                                RenderSettings const& settings, Report& report)
{
    return start_pass_frames(start_passes<PropagationRenderer>, world, settings, report);
}

RenderResult render_isllpm(World const& world, Camera const& camera, RenderSettings const& settings,
                           StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_passes("isllpm", start_passes<LatticeRenderer>, world, camera, settings, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_isllpm_frames(MovingWorld const& world, Camera const&,
                                                   RenderSettings const& settings, Report& report)
{
    return start_pass_frames(start_passes<LatticeRenderer>, world, settings, report);
}

} // namespace gi
