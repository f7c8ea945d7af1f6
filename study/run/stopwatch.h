#pragma once
#include <chrono>

namespace study {

/// Elapsed time since restart(), without pauses.
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

    /// Stops the watch during its lifetime.
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
