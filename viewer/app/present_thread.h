#pragma once
// Thread that draws and swaps, because with a software driver or when waiting for a monitor this takes longer than
// input may wait. It owns the contexts of all windows while it works.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace viewer {

class PresentThread {
public:
    PresentThread();
    /// Waits for the current work.
    ~PresentThread();

    bool busy() const;
    /// Starts work; call only if the thread is not busy. @param done  called afterwards, on that thread
    void start(std::function<void()> work, std::function<void()> done);

private:
    void run();

    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::function<void()> work_, done_;
    bool busy_ = false, ends_ = false;
    std::thread thread_;
};

} // namespace viewer
