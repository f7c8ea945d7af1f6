#include "gi/slhb/frames.h"

#include "gi/base/error.h"
#include "gi/slhb/renderer.h"
#include "gi/slhb/settings.h"
#include "gi/transport/pass_loop.h"

#include <chrono>
#include <optional>
#include <tbb/global_control.h>

namespace gi {
namespace {

class SlhbFrames : public FrameRenderer {
public:
    SlhbFrames(MovingWorld const& world, Camera const& camera, RenderSettings const& settings, Report& report)
        : world_(world), asked_(settings), settings_(settings), report_(report)
    {
        if (settings.slhb.space == Space::device)
            throw InputError("--device cuda with frames that follow each other", "its kernels render one picture",
                             "leave it out, or render with --device cpu");
        if (settings.threads > 0)
            threads_.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
        if (settings.slhb.packed && world.world().static_triangles < world.world().triangles.size())
            throw InputError("--packed with something that moves",
                             "the range of packed depths is that of what stays", "leave out --packed");
        auto const begun = std::chrono::steady_clock::now();
        start(camera);
        start_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    }

    void changed(Changes const& changes) override
    {
        if (changes.materials || changes.coverage || changes.environment) {
            restart_ = true; // also the plan may be another one
            return;
        }
        if (changes.geometry || changes.lights || changes.light_select)
            renderer_->world_moved(changes.geometry, changes.lights || changes.light_select);
    }

    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        PassLoop loop(settings_, stop, progress, report_, moments ? std::exchange(start_s_, 0) : 0);
        see(camera);
        double const earlier = renderer_->rays();
        RenderResult result = loop.run(0, [&](Accumulator& sums, std::uint32_t paths) {
            for (std::uint32_t i = 0; i < paths; ++i) {
                if (moments) {
                    Moment const now = moments(sums.paths);
                    changed(now.changes);
                    see(now.camera);
                }
                renderer_->pass(passes_++, sums);
            }
        });
        renderer_->report_work();
        result.rays = renderer_->rays() - earlier;
        result.options = as_options(settings_.slhb);
        result.picture = loop.sums().picture(world_.world());
        if (!moments) renderer_->add_motion(result.picture);
        renderer_->end_frame();
        report_.lose("layers beyond the limit of a texel", renderer_->lost_layers() - lost_);
        lost_ = renderer_->lost_layers();
        return result;
    }

private:
    void see(Camera const& camera)
    {
        if (restart_) start(camera);
        renderer_->set_camera(camera);
    }

    void start(Camera const& camera)
    {
        World const& world = world_.world();
        TriangleSoup soup = make_soup(world);
        settings_.slhb = choose_frame_settings(asked_, world, soup);
        renderer_.emplace(world, camera, settings_, std::move(soup), world.static_triangles, report_);
        restart_ = false;
        lost_ = 0;
    }

    MovingWorld const& world_;
    RenderSettings asked_, settings_; ///< the second with those of slhb chosen
    Report& report_;
    std::optional<tbb::global_control> threads_;
    std::optional<SlhbRenderer> renderer_;
    std::uint32_t passes_ = 0;
    std::uint64_t lost_ = 0; ///< layers that were reported
    bool restart_ = false;
    double start_s_ = 0; ///< that the first start took
};

} // namespace

std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report)
{
    return std::make_unique<SlhbFrames>(world, camera, settings, report);
}

} // namespace gi
