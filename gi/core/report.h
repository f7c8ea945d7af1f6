#pragma once
// What happened while a scene was loaded and a picture was made: stage times, counts, and everything
// that was skipped, clamped or missing. Nothing is dropped without a line here; the command line prints
// the losses on stderr and writes the whole report with --stats.

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
        std::string first; ///< where it was first seen, for the message
    };

    /// Count something skipped, clamped or missing, e.g. lose("degenerate triangles skipped", 3, "mesh 'door'").
    void lose(std::string const& what, std::uint64_t count = 1, std::string const& where = {});
    /// Set (not add) a plain figure, e.g. count("triangles", 52000).
    void count(std::string const& what, double value);
    /// Add seconds to a named stage.
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

/// Adds its lifetime to a stage of the report.
class StageTimer {
public:
    StageTimer(Report& report, std::string stage) : report_(report), stage_(std::move(stage)) {}
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

/// Reads a report that goes on growing: each call gives what was added since the one before.
class ReportReader {
public:
    explicit ReportReader(Report const& report) : report_(report) {}
    /// Seconds by stage.
    std::map<std::string, double> times();
    /// Losses, to another report.
    void pass_on_losses(Report& to);

private:
    Report const& report_;
    std::map<std::string, double> times_;
    std::map<std::string, std::uint64_t> losses_;
};

} // namespace gi
