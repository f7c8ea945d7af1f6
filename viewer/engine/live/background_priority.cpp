#include "viewer/engine/live/background_priority.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <tbb/task_scheduler_observer.h>
#include <unistd.h>

namespace viewer {
namespace {

constexpr int kNice = 6;

/// Lowers the priority of this thread only (Linux keeps priorities per thread). If refused, nothing changes.
void give_way() { static_cast<void>(setpriority(PRIO_PROCESS, id_t(syscall(SYS_gettid)), kNice)); }

} // namespace

struct BackgroundPriority::Observer : tbb::task_scheduler_observer {
    void on_scheduler_entry(bool worker) override
    {
        if (worker) give_way();
    }
};

BackgroundPriority::BackgroundPriority() : observer_(std::make_unique<Observer>())
{
    give_way();
    observer_->observe(true);
}

BackgroundPriority::~BackgroundPriority() { observer_->observe(false); }

} // namespace viewer
