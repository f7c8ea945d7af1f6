#include "python/core/interruptible.h"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <pybind11/pybind11.h>
#include <thread>

namespace bindings {
namespace py = pybind11;

constexpr std::chrono::milliseconds kTick{50};

void run_interruptible(std::function<void(gi::StopRequest const&)> const& work, std::function<void()> const& tick)
{
    gi::StopRequest stop;
    std::mutex mutex;
    std::condition_variable ended;
    bool has_ended = false;
    std::exception_ptr failure, raised;
    {
        py::gil_scoped_release const unlocked;
        std::thread worker([&] {
            try {
                work(stop);
            } catch (...) {
                failure = std::current_exception();
            }
            std::lock_guard const lock(mutex);
            has_ended = true;
            ended.notify_one();
        });
        std::unique_lock lock(mutex);
        while (!ended.wait_for(lock, kTick, [&] { return has_ended; })) {
            if (stop.requested()) continue;
            lock.unlock();
            {
                py::gil_scoped_acquire const locked;
                try {
                    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                    if (tick) tick();
                } catch (...) {
                    raised = std::current_exception();
                    stop.request();
                }
            }
            lock.lock();
        }
        lock.unlock();
        worker.join();
    }
    if (raised) std::rethrow_exception(raised);
    if (failure) std::rethrow_exception(failure);
}

} // namespace bindings
