#include "gi/methods/vpl/visibility.h"

#include "gi/core/threads.h"
#include "gi/methods/slhb/settings.h"
#include "gi/methods/vpl/renderer.h"
#include "gi/render/fingerprint.h"
#include "gi/render/pass_loop.h"

#include <array>
#include <chrono>
#include <fmt/format.h>
#include <optional>
#include <tbb/global_control.h>

namespace gi {
namespace {

/// Names by VisibilityKind.
constexpr std::array<char const*, 6> kNames{"vpl_exact", "vpl_slhb", "vpl_imperfect",
                                            "vpl_ao",    "vpl_dao",  "vpl_none"};

/// Settings as command-line options that reproduce the picture.
std::string options_of(VisibilityKind kind, RenderSettings const& s)
{
    std::vector<std::string_view> own{"light-paths"};
    if (s.vpl.near_m > 0) own.push_back("near");
    if (kind == VisibilityKind::imperfect) own.insert(own.end(), {"points", "point-map"});
    if (kind == VisibilityKind::ambient || kind == VisibilityKind::directional) own.push_back("ao-radius");
    std::string const text = as_options(virtual_light_options(), s, own);
    if (kind != VisibilityKind::slhb) return text;
    return text + " " + as_options(slhb_options(), s, {"directions", "hit-buffer"});
}

/// Returns the settings with defaults chosen.
RenderSettings chosen(RenderSettings settings)
{
    if (settings.slhb.directions.empty()) settings.slhb.directions = "icosahedron:320";
    if (settings.slhb.resolution == 0) settings.slhb.resolution = 128;
    settings.vpl.points = settings.vpl.points_per_map();
    settings.vpl.points_percent = 0;
    return settings;
}

class VirtualLightFrames : public FrameRenderer {
public:
    VirtualLightFrames(VisibilityKind kind, MovingWorld const& world, RenderSettings const& settings,
                       Report& report)
        : kind_(kind), world_(world), settings_(chosen(settings)), report_(report)
    {
        if (settings.threads > 0)
            threads_.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
        renderer_.emplace(kind, world.world(), settings_, world.world().static_triangles, report);
    }
    void changed(Changes const& changes) override { renderer_->changed(changes); }
    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        PassLoop loop(settings_, stop, progress, report_);
        double const earlier = renderer_->rays();
        RenderResult result = loop.run(0, [&](Accumulator& sums, std::uint32_t paths) {
            for (std::uint32_t i = 0; i < paths; ++i) {
                FrameView eye{camera, settings_.width, settings_.height};
                if (moments) {
                    Moment const now = moments(sums.paths);
                    changed(now.changes);
                    eye.camera = now.camera;
                }
                renderer_->pass(passes_++, {&eye, 1}, {&sums, 1});
            }
        });
        finish(result, earlier);
        result.picture = loop.sums().picture(world_.world());
        return result;
    }
    std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths, VertexSharing,
                                    StopRequest const& stop) override
    {
        auto const begun = std::chrono::steady_clock::now();
        double const earlier = renderer_->rays();
        std::vector<Accumulator> sums;
        for (FrameView const& v : views) sums.emplace_back(v.width, v.height);
        for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i)
            on_threads(settings_.threads, [&] { renderer_->pass(passes_++, views, sums); });
        std::vector<RenderResult> results(views.size());
        PathCounts lost;
        for (std::size_t k = 0; k < views.size(); ++k) {
            results[k].paths = sums[k].paths;
            results[k].end = sums[k].paths < paths ? RenderEnd::interrupted : RenderEnd::paths;
            results[k].picture = sums[k].picture(world_.world());
            hide_pixels(results[k].picture, views[k].hidden);
            lost += sums[k].counts;
        }
        report_.lose("paths cut at 1024 surfaces", lost.cut_paths);
        report_.lose("path terms that were not finite, dropped", lost.invalid_paths);
        finish(results[0], earlier);
        results[0].seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        return results;
    }

private:
    void finish(RenderResult& result, double rays_before)
    {
        renderer_->report_work();
        result.rays = renderer_->rays() - rays_before;
        result.options = options_of(kind_, settings_);
    }

    VisibilityKind kind_;
    MovingWorld const& world_;
    RenderSettings settings_;
    Report& report_;
    std::optional<tbb::global_control> threads_;
    std::optional<VirtualLightRenderer> renderer_;
    std::uint32_t passes_ = 0; ///< so far, over all frames
};

} // namespace

RenderResult render_with_virtual_lights(VisibilityKind kind, World const& world, Camera const& camera,
                                        RenderSettings const& asked, StopRequest const& stop,
                                        RenderProgress const& progress, Report& report)
{
    std::optional<tbb::global_control> limit; // also limits the building of structures before the passes
    if (asked.threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(asked.threads));
    RenderSettings const settings = chosen(asked);
    PassLoop loop(settings, stop, progress, report);
    VirtualLightRenderer renderer(kind, world, settings, world.triangles.size(), report);
    std::uint64_t const print =
        loop.keeps_state() ? fingerprint(world, camera, settings, kNames[std::size_t(kind)]) : 0;
    FrameView const eye{camera, settings.width, settings.height};
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        for (std::uint32_t i = 0; i < paths; ++i)
            renderer.pass(loop.first_path() + sums.paths, {&eye, 1}, {&sums, 1});
    });
    renderer.report_work();
    result.rays = renderer.rays();
    result.options = options_of(kind, settings);
    result.picture = loop.sums().picture(world);
    return result;
}

std::unique_ptr<FrameRenderer> start_virtual_light_frames(VisibilityKind kind, MovingWorld const& world,
                                                          RenderSettings const& settings, Report& report)
{
    return std::make_unique<VirtualLightFrames>(kind, world, settings, report);
}

} // namespace gi
