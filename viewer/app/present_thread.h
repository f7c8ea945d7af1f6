#pragma once
// The thread that draws and swaps: with a software driver, or waiting for a monitor, that takes longer than input
// may wait. It has the contexts of all windows while it works.

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace viewer {

class PresentThread {
public:
    PresentThread();
    /// Waits for the work at hand.
    ~PresentThread();

    bool busy() const;
    /// Only where it is not busy. @param done  called afterwards, on that thread
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
