#include "gi/methods/sh_grid/sh_grid.h"

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/options.h"
#include "gi/methods/sh_grid/field_light.h"
#include "gi/methods/whitted/whitted.h"

#include <algorithm>

namespace gi {
namespace {

class ShGridRenderer : public TreeRenderer {
public:
    ShGridRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                   StopRequest const* stop)
        : TreeRenderer(world, settings, first_moving, report, stop),
          field_(world, settings, first_moving, report, stop),
          caustics_(world, settings, report)
    {
    }
    void changed(Changes const& changes) override
    {
        TreeRenderer::changed(changes);
        field_.changed(changes);
        caustics_.changed(changes);
    }
    void report_work() override
    {
        TreeRenderer::report_work();
        if (light_) unseen_ += light_->unseen();
        light_.reset();
        report_.lose("points of surfaces from which no cell of the field is seen, without indirect light",
                     unseen_);
        unseen_ = 0;
        field_.report_counts();
        caustics_.report_counts();
    }
    std::string asked_options() const override
    {
        return TreeRenderer::options() + " " + changed_options(photon_options(), settings_, {}) + " " +
               changed_options(sh_grid_options(), settings_, {}) + field_.ray_options();
    }
    std::string options() const override
    {
        RenderSettings chosen = settings_;
        PhotonSettings& photons = chosen.of<PhotonSettings>();
        photons.caustic_paths = int(photon_share() * photons.caustic_paths);
        photons.paths = int(field_.light_paths());
        chosen.of<ShGridSettings>().voxels = field_.voxels();
        return TreeRenderer::options() + " " +
               changed_options(photon_options(), chosen, {"photons", "caustic-photons"}) + " " +
               changed_options(sh_grid_options(), chosen, {"voxels"}) + field_.ray_options();
    }

protected:
    SurfaceLight const* prepare(std::uint32_t index, std::span<FrameView const> views,
                                StopRequest const* stop) override
    {
        PathCounts counts;
        field_.prepare(*visibility_, index, views, stop, counts);
        auto const levels = field_.levels();
        caustics_.prepare(*visibility_, index, views, levels.size() > 1 ? levels[0].bounds : Bounds{},
                          photon_share(), BuildStop(stop), counts);
        rays_ += double(counts.nearest_rays + counts.shadow_rays);
        work_.paths += counts;
        if (light_) unseen_ += light_->unseen();
        light_.reset();
        if (levels.empty() && caustics_.map() == nullptr) return nullptr;
        light_.emplace(levels, caustics_.map(), *visibility_, settings_.of<ShGridSettings>());
        return &*light_;
    }

protected:
    bool photons_pass_panes() const override { return settings_.of<PhotonSettings>().caustic_paths > 0; }

private:
    /// Of the photons that the settings ask for: less if a budget allows no more.
    double photon_share() const { return double(field_.light_paths()) / settings_.of<PhotonSettings>().paths; }

    IndirectField field_;
    Caustics caustics_;
    std::uint64_t unseen_ = 0; ///< see FieldLight::unseen()
    std::optional<FieldLight> light_;
};

} // namespace

RenderResult render_sh_grid(World const& world, Camera const& camera, RenderSettings const& settings,
                            StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_passes("sh_grid", start_passes<ShGridRenderer>, world, camera, settings, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_sh_grid_frames(MovingWorld const& world, Camera const&,
                                                    RenderSettings const& settings, Report& report)
{
    return start_pass_frames(start_passes<ShGridRenderer>, world, settings, report);
}

} // namespace gi
