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
