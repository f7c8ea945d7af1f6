#pragma once
// Progress and interruption of long work.

#include <atomic>
#include <chrono>
#include <exception>
#include <string>

namespace gi {

/// Asks long work to stop at the next safe point. Set by the SIGINT/SIGTERM handler of the command line.
class StopRequest {
public:
    void request() { flag_.store(true, std::memory_order_relaxed); }
    bool requested() const { return flag_.load(std::memory_order_relaxed); }

private:
    std::atomic<bool> flag_{false};
};

/// Thrown by work that was asked to stop before it had anything to keep.
class Interrupted : public std::exception {
public:
    char const* what() const noexcept override { return "interrupted"; }
};

/// Building of what a picture needs: given up where a stop was asked for and the picture is far off. What takes no
/// time is ended, so that there is a first picture to keep.
class BuildStop {
public:
    /// @param stop  outlives this; null = nothing is given up
    explicit BuildStop(StopRequest const* stop) : stop_(stop) {}
    bool given_up() const
    {
        constexpr auto kLong = std::chrono::milliseconds(150);
        return stop_ != nullptr && stop_->requested() && std::chrono::steady_clock::now() - start_ > kLong;
    }

private:
    StopRequest const* stop_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// A bar on stderr when that is a terminal, else nothing. Redraws at most ten times a second.
class ProgressBar {
public:
    /// @param label what is being done, e.g. "render atrium"
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
