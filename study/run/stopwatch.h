#pragma once
#include <chrono>

namespace study {

/// Real time since restart(), less that in which it was paused.
class Stopwatch {
public:
    Stopwatch() { restart(); }
    void restart()
    {
        start_ = Clock::now();
        paused_ = {};
    }
    double ms() const
    {
        return std::chrono::duration<double, std::milli>(Clock::now() - start_ - paused_).count();
    }

    /// While it lives the watch stands.
    class Pause {
    public:
        explicit Pause(Stopwatch& watch) : watch_(watch), start_(Clock::now()) {}
        ~Pause() { watch_.paused_ += Clock::now() - start_; }
        Pause(Pause const&) = delete;
        Pause& operator=(Pause const&) = delete;

    private:
        Stopwatch& watch_;
        std::chrono::steady_clock::time_point start_;
    };

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point start_;
    Clock::duration paused_{};
};

} // namespace study
