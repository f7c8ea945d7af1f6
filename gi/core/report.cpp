#include "gi/core/report.h"

#include <algorithm>

namespace gi {

void Report::lose(std::string const& what, std::uint64_t count, std::string const& where)
{
    if (count == 0) return;
    std::lock_guard const lock(mutex_);
    Loss& loss = losses_[what];
    if (loss.count == 0) loss.first = where;
    loss.count += count;
}

void Report::count(std::string const& what, double value)
{
    std::lock_guard const lock(mutex_);
    counts_[what] = value;
}

void Report::add_time(std::string const& stage, double seconds)
{
    std::lock_guard const lock(mutex_);
    auto const it = std::find_if(times_.begin(), times_.end(), [&](auto const& t) { return t.first == stage; });
    if (it == times_.end())
        times_.emplace_back(stage, seconds);
    else
        it->second += seconds;
}

std::map<std::string, Report::Loss> Report::losses() const
{
    std::lock_guard const lock(mutex_);
    return losses_;
}

std::map<std::string, double> Report::counts() const
{
    std::lock_guard const lock(mutex_);
    return counts_;
}

std::vector<std::pair<std::string, double>> Report::times() const
{
    std::lock_guard const lock(mutex_);
    return times_;
}

std::map<std::string, double> ReportReader::times()
{
    std::map<std::string, double> added;
    for (auto const& [stage, seconds] : report_.times()) {
        added[stage] = seconds - times_[stage];
        times_[stage] = seconds;
    }
    return added;
}

void ReportReader::pass_on_losses(Report& to)
{
    for (auto const& [what, loss] : report_.losses()) {
        to.lose(what, loss.count - losses_[what], loss.first);
        losses_[what] = loss.count;
    }
}

} // namespace gi
