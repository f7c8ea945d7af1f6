#include "gi/core/threads.h"

#include <map>
#include <mutex>
#include <tbb/info.h>
#include <tbb/task_arena.h>

namespace gi {

int available_threads() { return tbb::info::default_concurrency(); }

void on_threads(int threads, std::function<void()> const& work)
{
    if (threads <= 0) return work();
    static std::mutex mutex;
    static std::map<int, tbb::task_arena> arenas;
    tbb::task_arena* arena = nullptr;
    {
        std::scoped_lock const lock(mutex);
        arena = &arenas.try_emplace(threads, threads).first->second;
    }
    arena->execute(work);
}

} // namespace gi
