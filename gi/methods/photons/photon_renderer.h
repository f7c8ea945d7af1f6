#pragma once
// What the photon methods have in common: when photons are traced and how many, caustics, frozen light.
//
// Each pass of a picture has photons of its own, so that the mean of the passes converges to what the method can
// tell. In frames every change begins with the first set again (the same random numbers: no flicker); while
// nothing changes, each frame has the next.

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/impostors.h"
#include "gi/light_paths/photon.h"
#include "gi/methods/path_rays/light_rays.h"
#include "gi/methods/whitted/whitted.h"
#include "gi/raster/triangle_soup.h"

#include <chrono>
#include <optional>

namespace gi {

/// One set of photons.
struct PhotonSet {
    std::vector<Photon> photons;
    std::uint32_t number;  ///< since the last change; 0 = results of earlier sets are no longer valid
    std::uint32_t paths;   ///< light paths of the set
    bool surfaces_changed; ///< since the set before: geometry, materials or coverage
    bool only_moved;       ///< of these, geometry alone
    Bounds focus;          ///< what cameras show, if the world is much larger; else empty
    vec3 middle;           ///< of nested lattices about the camera, m
    bool middle_changed;   ///< since the set before
    ExactVisibility const& visibility;
    std::span<FrameView const> views;
    BuildStop const& stop;
    PathCounts& counts;
};

/// Where the first camera is, m in the world's coordinates; the world's centre without cameras.
vec3 camera_of(std::span<FrameView const> views, World const& world);

/// True if cameras and sizes are the same.
bool same_pictures(std::span<FrameView const> a, std::span<FrameView const> b);

class PhotonRenderer : public TreeRenderer {
public:
    /// See StartPasses.
    PhotonRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                   StopRequest const* stop);

    void changed(Changes const& changes) override;
    void report_work() override;
    std::string options() const override;
    std::string asked_options() const override;

protected:
    /// Vertices of light paths that the method stores.
    virtual bool stores(LightVertex const& v) const { return v.scatterings > 0; }
    /// Whether light that comes by mirrors and glass alone has photons of its own.
    virtual bool has_caustics() const { return true; }
    bool photons_pass_panes() const override
    {
        return has_caustics() && settings_.of<PhotonSettings>().caustic_paths > 0;
    }
    /// Indirect bounces that the method's light paths give, at most.
    virtual int bounces() const { return std::min(settings_.of<PhotonSettings>().reflections, settings_.bounces); }
    virtual PhotonRays rays_kind() const { return settings_.of<PhotonSettings>().rays; }
    /// Nested lattices that follow the camera; fewer than 2 = none do.
    virtual int cascades_about_camera() const { return 0; }
    virtual std::string_view timer_name() const = 0; ///< of take()
    /// Most memory that a photon and what stores its light take, as measured.
    virtual std::size_t bytes_per_photon() const = 0;
    /// Makes light of a set of photons. Throws Interrupted; there is then no light until another call ends.
    virtual void take(PhotonSet&& set) = 0;
    /// The light of a pass, after take(). Throws Interrupted, and may then be called again.
    /// @param caustics  null = none
    virtual SurfaceLight const* light(std::span<FrameView const> views, PhotonMap const* caustics,
                                      BuildStop const& stop) = 0;
    /// Reports what is specific to the method.
    virtual void report_light(Report&) {}

    SurfaceLight const* prepare(std::uint32_t index, std::span<FrameView const> views,
                                StopRequest const* stop) override;
    std::span<Photon const> caustic_photons() const { return caustics_.photons(); }
    /// Another number for other caustic photons.
    std::uint32_t caustics_version() const { return caustics_.version(); }

private:
    using Clock = std::chrono::steady_clock;
    bool frames() const { return frames_; }
    void find_focus(std::span<FrameView const> views);
    void find_middle(std::span<FrameView const> views);
    void update(std::uint32_t index, std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts);
    void trace_set(std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts);
    void fit_budget(std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts);
    double share() const { return double(paths_) / settings_.of<PhotonSettings>().paths; }

    bool frames_; ///< passes belong to frames instead of to one picture
    Caustics caustics_;
    LightRays light_rays_;
    bool light_changed_ = true, surfaces_changed_ = true, more_than_moved_ = true, has_light_ = false;
    bool caustics_known_ = false;              ///< there may be none
    std::optional<std::uint32_t> first_index_; ///< of the passes
    std::vector<Camera> cameras_;              ///< of the last call
    Bounds focus_;                             ///< what cameras show, if the world is much larger; else empty
    std::optional<vec3> middle_;               ///< see PhotonSet
    bool middle_changed_ = true;
    std::uint32_t paths_;              ///< of a set
    std::uint32_t sets_ = 0;           ///< since the last change
    std::optional<TriangleSoup> soup_; ///< what bounce maps draw
    bool soup_moved_ = false;
    std::size_t stored_ = 0;
    dvec3 flux_{0};
};

} // namespace gi
