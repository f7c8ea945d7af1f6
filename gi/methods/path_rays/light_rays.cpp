#include "gi/methods/path_rays/light_rays.h"

#include "gi/light_paths/impostor_places.h"
#include "gi/hit_buffers/options.h"

namespace gi {

LightRays::LightRays(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                     StopRequest const* stop)
    : world_(world), settings_(settings), first_moving_(first_moving), report_(report), stop_(stop)
{
    if (settings.of<PhotonSettings>().rays == PhotonRays::impostors)
        check_impostors(settings.of<PhotonSettings>(), first_moving < world.triangles.size());
}

void LightRays::changed(Changes const& c)
{
    axes_moved_ = axes_moved_ || c.geometry;
    impostors_moved_ = impostors_moved_ || c.geometry;
    if (c.materials || c.coverage) impostors_.reset();
    if (!c.coverage) return;
    axes_.reset();
    lost_ = 0;
}

PathRays const& LightRays::of(PhotonRays kind, ExactVisibility const& exact, Bounds const& focus)
{
    switch (kind) {
    case PhotonRays::look_ups:
        build_look_ups(exact);
        break;
    case PhotonRays::impostors:
        build_impostors(exact, focus);
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
        axes_.emplace(world_, with_stored_axes(settings_.of<SlhbSettings>()), settings_.seed, first_moving_, stop_);
    else if (axes_moved_)
        axes_->moved();
    axes_moved_ = false;
    rays_ = std::make_unique<LookUpRays>(world_, *axes_, exact);
}

void LightRays::build_impostors(ExactVisibility const& exact, Bounds const& focus)
{
    PhotonSettings const& s = settings_.of<PhotonSettings>();
    bool const by_hand = !s.impostor_places.empty(),
               same_focus = focus.low == impostors_about_.low && focus.high == impostors_about_.high;
    if (!by_hand && !same_focus) impostors_.reset();
    StageTimer const timer(report_, "impostors");
    if (!impostors_) {
        BuildStop const stop(stop_);
        impostors_about_ = focus;
        std::vector<vec3> centres;
        if (by_hand)
            for (dvec3 const p : read_impostor_places(s.impostor_places))
                centres.push_back(vec3(p - world_.origin));
        else
            centres = place_impostors(world_, exact, {.count = std::uint32_t(s.impostors), .focus = focus}, stop);
        impostors_.emplace(world_, centres, impostor_resolution(s.impostor_texels), std::uint32_t(settings_.seed),
                           first_moving_, stop);
    } else if (impostors_moved_) {
        impostors_->moved(world_);
    }
    impostors_moved_ = false;
    rays_ = std::make_unique<ImpostorRays>(world_, *impostors_, ImpostorSettings{.search = s.impostor_search});
}

void LightRays::report_counts()
{
    if (impostors_) report_.count("impostors", double(impostors_->view().count()));
    if (!axes_) return;
    report_.lose("layers beyond the limit of a texel", axes_->lost() - lost_);
    lost_ = axes_->lost();
}

std::string LightRays::options(PhotonRays kind) const
{
    if (kind != PhotonRays::look_ups) return {};
    RenderSettings chosen = settings_;
    chosen.of<SlhbSettings>() = with_stored_axes(chosen.of<SlhbSettings>());
    return " " + as_options(hit_buffer_options(), chosen, {"directions", "hit-buffer"});
}

} // namespace gi
