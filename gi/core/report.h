#pragma once
// Record of loading a scene and making a picture: stage times, counts, and losses (everything that was
// skipped, clamped or missing). Nothing is dropped without an entry here; the command line prints the
// losses on stderr and writes the whole report with --stats.

#include "gi/core/step.h"

#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace gi {

class Report {
public:
    struct Loss {
        std::uint64_t count = 0;
        std::string first; ///< where it first occurred, for the message
    };

    /// Counts something skipped, clamped or missing, e.g. lose("degenerate triangles skipped", 3, "mesh 'door'").
    void lose(std::string const& what, std::uint64_t count = 1, std::string const& where = {});
    /// Sets (does not add to) a number, e.g. count("triangles", 52000).
    void count(std::string const& what, double value);
    /// Adds seconds to a named stage.
    void add_time(std::string const& stage, double seconds);

    std::map<std::string, Loss> losses() const;
    std::map<std::string, double> counts() const;
    /// Stages in order of first appearance.
    std::vector<std::pair<std::string, double>> times() const;

private:
    mutable std::mutex mutex_;
    std::map<std::string, Loss> losses_;
    std::map<std::string, double> counts_;
    std::vector<std::pair<std::string, double>> times_;
};

/// Adds the time from its construction to its destruction to a stage of the report, which is a step of this
/// thread's work (at_step).
class StageTimer {
public:
    StageTimer(Report& report, std::string stage) : report_(report), stage_(std::move(stage))
    {
        at_step(stage_.c_str());
    }
    ~StageTimer()
    {
        std::chrono::duration<double> const d = Clock::now() - start_;
        report_.add_time(stage_, d.count());
    }
    StageTimer(StageTimer const&) = delete;
    StageTimer& operator=(StageTimer const&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    Report& report_;
    std::string stage_;
    Clock::time_point start_ = Clock::now();
};

/// Incremental reader of a growing report: each call returns only what was added since the previous call.
class ReportReader {
public:
    explicit ReportReader(Report const& report) : report_(report) {}
    /// Returns the added seconds by stage.
    std::map<std::string, double> times();
    /// Adds the new losses to another report.
    void pass_on_losses(Report& to);

private:
    Report const& report_;
    std::map<std::string, double> times_;
    std::map<std::string, std::uint64_t> losses_;
};

} // namespace gi
