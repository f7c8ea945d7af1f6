#include "viewer/protocol/cluster/cluster_state.h"

#include <condition_variable>
#include <mutex>
#include <thread>

namespace viewer {

struct KeepAlive::Thread {
    std::mutex mutex;
    std::condition_variable wake;
    bool ends = false;
    std::thread thread;
};

KeepAlive::KeepAlive(Cluster& cluster, std::function<void()> on_loss)
{
    if (cluster.alone()) return;
    thread_ = std::make_unique<Thread>();
    Thread& t = *thread_;
    t.thread = std::thread([&t, &state = *cluster.state_, on_loss = std::move(on_loss)] {
        std::unique_lock lock(t.mutex);
        while (!t.ends) {
            try {
                state.pump();
            } catch (std::exception const& e) { // the next call throws it again
                state.broken = e.what();
                if (on_loss) on_loss();
                return;
            }
            t.wake.wait_for(lock, std::chrono::milliseconds(50), [&t] { return t.ends; });
        }
    });
}

KeepAlive::~KeepAlive()
{
    if (!thread_) return;
    {
        std::lock_guard const lock(thread_->mutex);
        thread_->ends = true;
    }
    thread_->wake.notify_one();
    thread_->thread.join();
}

} // namespace viewer
