#include "gi/methods/path_rays/light_rays.h"

#include "gi/light_paths/impostor_places.h"

namespace gi {

void LightRays::changed(Changes const& c)
{
    axes_moved_ = axes_moved_ || c.geometry;
    impostors_moved_ = impostors_moved_ || c.geometry;
    if (c.materials || c.coverage) impostors_.reset();
    if (c.coverage) axes_.reset();
}

PathRays const& LightRays::of(PhotonRays kind, ExactVisibility const& exact)
{
    switch (kind) {
    case PhotonRays::look_ups:
        build_look_ups(exact);
        break;
    case PhotonRays::impostors:
        build_impostors(exact);
        break;
    case PhotonRays::exact:
        rays_ = std::make_unique<ExactPathRays>(exact);
        break;
    }
    return *rays_;
}

void LightRays::build_look_ups(ExactVisibility const& exact)
{
    StageTimer const timer(report_, "hit buffers");
    if (!axes_)
        axes_.emplace(world_, with_stored_axes(settings_.slhb), settings_.seed, first_moving_, stop_);
    else if (axes_moved_)
        axes_->moved();
    axes_moved_ = false;
    rays_ = std::make_unique<LookUpRays>(world_, *axes_, exact);
}

void LightRays::build_impostors(ExactVisibility const& exact)
{
    StageTimer const timer(report_, "impostors");
    if (!impostors_) {
        BuildStop const stop(stop_);
        ImpostorPlacement const placement{.count = std::uint32_t(settings_.photons.impostors)};
        impostors_.emplace(world_, place_impostors(world_, exact, placement, stop),
                           impostor_resolution(settings_.photons.impostor_texels), std::uint32_t(settings_.seed),
                           first_moving_, stop);
    } else if (impostors_moved_) {
        impostors_->moved(world_);
    }
    impostors_moved_ = false;
    ImpostorSettings const by{.search = settings_.photons.impostor_search};
    rays_ = std::make_unique<ImpostorRays>(world_, *impostors_, by);
}

void LightRays::report_counts()
{
    if (impostors_) report_.count("impostors", double(impostors_->view().count()));
    if (axes_) report_.lose("layers beyond the limit of a texel", axes_->lost());
}

} // namespace gi
