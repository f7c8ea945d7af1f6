#pragma once
#include "tests/viewer_show/live_view.h"

#include <atomic>
#include <sstream>
#include <thread>

namespace viewer::test {

/// Resident memory of a process, sampled every second.
class MemoryLog {
public:
    explicit MemoryLog(pid_t pid) : pid_(pid), thread_([this] { run(); }) {}
    ~MemoryLog() { stop(); }
    void stop()
    {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
    }
    /// MiB, in order; after stop().
    std::vector<double> const& samples() const { return samples_; }
    double now_mib() const
    {
        std::istringstream status(file_text("/proc/" + std::to_string(pid_) + "/status"));
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
        return 0;
    }

private:
    void run()
    {
        while (!stop_) {
            if (double const mib = now_mib(); mib > 0) samples_.push_back(mib);
            for (int i = 0; i < 20 && !stop_; ++i) sleep_ms(50);
        }
    }

    pid_t pid_;
    std::atomic<bool> stop_{false};
    std::vector<double> samples_;
    std::thread thread_;
};

} // namespace viewer::test
