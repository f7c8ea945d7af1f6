#pragma once
// Progress and interruption of long computations.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <string>

namespace gi {

/// Stops a long computation at its next safe point. Set by the command line's signal handler. Tests override when
/// it is requested and by which clock (tests/support/stop_at_ask.h).
class StopRequest {
public:
    virtual ~StopRequest() = default;
    void request()
    {
        auto none = kNever.count();
        at_.compare_exchange_strong(none, now().count(), std::memory_order_relaxed);
    }
    bool requested() const { return requested_at() != kNever; }
    /// True some time after it was requested first.
    bool requested_before(std::chrono::nanoseconds time) const
    {
        std::chrono::nanoseconds const at = requested_at();
        return at != kNever && now() - at > time;
    }
    virtual std::chrono::nanoseconds now() const { return std::chrono::steady_clock::now().time_since_epoch(); }

protected:
    static constexpr std::chrono::nanoseconds kNever = std::chrono::nanoseconds::min();
    virtual std::chrono::nanoseconds requested_at() const
    {
        return std::chrono::nanoseconds(at_.load(std::memory_order_relaxed));
    }

private:
    std::atomic<std::int64_t> at_{kNever.count()}; ///< ns of now()
    static_assert(std::atomic<std::int64_t>::is_always_lock_free, "signal handlers may set nothing else");
};

/// Thrown when a computation is stopped before it has a result worth keeping.
class Interrupted : public std::exception {
public:
    char const* what() const noexcept override { return "interrupted"; }
};

/// Decides whether to abandon the preparation of a picture (BVHs, hit buffers) and its first pass after a stop
/// request. What was begun less than 150 ms ago goes on, so that there is a first picture to keep, but all of it
/// together only until 80 ms after the request.
class BuildStop {
public:
    /// @param stop  must outlive this object; null = never abandon
    explicit BuildStop(StopRequest const* stop) : stop_(stop)
    {
        if (stop != nullptr) start_ = stop->now();
    }
    bool given_up() const
    {
        constexpr auto kBegun = std::chrono::milliseconds(150), kLeft = std::chrono::milliseconds(80);
        return stop_ != nullptr && stop_->requested() &&
               (stop_->requested_before(kLeft) || stop_->now() - start_ > kBegun);
    }

private:
    StopRequest const* stop_;
    std::chrono::nanoseconds start_{}; ///< by the request's clock
};

/// "8 s", "1 min 20 s", "2 h 5 min": rounded as estimates are.
std::string text_of_seconds(double seconds);
/// Tells on stderr how long something will take, before it does: "synthesize: about 1 min 20 s (60 pictures, 1.3 s
/// each)". What takes less than three seconds is not worth a line.
void say_estimate(std::string const& task, double seconds, std::string const& how);

/// Progress bar on stderr if stderr is a terminal, else no output. Redraws at most ten times a second.
class ProgressBar {
public:
    /// @param label name of the task, e.g. "render atrium"
    explicit ProgressBar(std::string label, bool enabled = true);
    ~ProgressBar(); ///< clears the line
    /// @param fraction 0..1   @param detail free text behind the bar, e.g. "128/1024 paths, relMSE 0.003"
    void update(double fraction, std::string const& detail = {});
    ProgressBar(ProgressBar const&) = delete;
    ProgressBar& operator=(ProgressBar const&) = delete;

private:
    std::string label_;
    bool enabled_;
    bool drawn_ = false;
    std::chrono::steady_clock::time_point start_, last_;
};

} // namespace gi
