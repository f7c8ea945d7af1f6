#include "viewer/engine/live/scene_loader.h"

#include "viewer/engine/live/background_priority.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <fmt/format.h>
#include <utility>

namespace viewer {
namespace {

/// Steps in their order, with the share of the time at their beginning (a scene
/// of 25 textures and 260,000 triangles).
struct Share {
    std::string_view step;
    double begins, ends;
};
constexpr std::array kShares{Share{"reading", 0.0, 0.05},
                             Share{"load", 0.0, 0.05},
                             Share{"textures decoded", 0.05, 0.3},
                             Share{"meshes read", 0.3, 0.4},
                             Share{"world", 0.4, 0.45},
                             Share{"first camera", 0.45, 0.5},
                             Share{"start of the method", 0.5, 0.5},
                             Share{"build (Embree BVH)", 0.5, 0.6},
                             Share{"build (BVH)", 0.5, 0.6},
                             Share{"build (hit buffers)", 0.6, 0.6},
                             Share{"hit buffers", 0.6, 1.0}};

} // namespace

double fraction_of(gi::Step const& step)
{
    auto const s = std::ranges::find(kShares, step.what, &Share::step);
    if (s == kShares.end()) return 0.5;
    double const part = step.of > 0 ? std::min(1.0, double(step.done) / double(step.of)) : 0;
    return s->begins + part * (s->ends - s->begins);
}

std::string text_of(LoadProgress const& p)
{
    std::string const counted = p.step.of > 0     ? fmt::format(" {} of {}", p.step.done, p.step.of)
                                : p.step.done > 0 ? fmt::format(" {}", p.step.done)
                                                  : "";
    return fmt::format("loading {}: {}{}, {:.1f} s", p.scene, p.step.what, counted, p.elapsed_s);
}

struct SceneLoader::Load {
    using Clock = std::chrono::steady_clock;
    std::string scene;
    Clock::time_point begun = Clock::now();
    gi::StopRequest stop;
    std::atomic<bool> ended{false};
    std::mutex mutex;
    gi::Step step{"reading"};
    double fraction = 0; ///< never decreases
    std::thread thread;
    std::function<void()> work;
    Done done;

    void run()
    {
        BackgroundPriority const priority;
        std::exception_ptr failure;
        try {
            gi::StepListener const listener(
                [this](gi::Step const& now) {
                    if (stop.requested()) throw gi::Interrupted();
                    std::lock_guard const lock(mutex);
                    step = now;
                    fraction = std::max(fraction, fraction_of(now));
                },
                &stop);
            work();
            if (stop.requested()) throw gi::Interrupted();
        } catch (...) {
            failure = std::current_exception();
        }
        done(failure);
        ended = true;
    }
};

SceneLoader::~SceneLoader()
{
    stop();
    if (running_) running_->thread.join();
}

void SceneLoader::drop_next()
{
    if (auto const dropped = std::exchange(next_, nullptr))
        dropped->done(std::make_exception_ptr(gi::Interrupted()));
}

void SceneLoader::stop()
{
    drop_next();
    if (running_) running_->stop.request();
}

void SceneLoader::collect()
{
    if (running_ && running_->ended) {
        running_->thread.join();
        running_.reset();
    }
    if (running_ || !next_) return;
    running_ = std::exchange(next_, nullptr);
    running_->thread = std::thread([load = running_] { load->run(); });
}

void SceneLoader::begin(std::string scene, std::function<void()> work, Done done)
{
    stop();
    next_ = std::make_shared<Load>();
    next_->scene = std::move(scene);
    next_->work = std::move(work);
    next_->done = std::move(done);
    collect();
}

std::optional<LoadProgress> SceneLoader::progress()
{
    collect();
    Load* const l = next_ ? next_.get() : running_.get();
    if (l == nullptr || l->ended) return {};
    std::lock_guard const lock(l->mutex);
    return LoadProgress{l->scene, l->step, std::chrono::duration<double>(Load::Clock::now() - l->begun).count(),
                        l->fraction};
}

} // namespace viewer
