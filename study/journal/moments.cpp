#include "study/journal/moments.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>

namespace study {

std::string utc_text(double unix_s)
{
    auto const ms = std::int64_t(std::llround(unix_s * 1000));
    std::int64_t const day = ms >= 0 ? ms / 86400000 : (ms - 86399999) / 86400000, rest = ms - day * 86400000;
    std::chrono::year_month_day const date{std::chrono::sys_days{std::chrono::days{day}}};
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", int(date.year()), unsigned(date.month()),
                       unsigned(date.day()), rest / 3600000, rest / 60000 % 60, rest / 1000 % 60, rest % 1000);
}

std::optional<double> unix_time(std::string const& utc)
{
    int year = 0, used = 0;
    unsigned month = 0, day = 0, hour = 0, minute = 0, second = 0, ms = 0;
    if (std::sscanf(utc.c_str(), "%4d-%2u-%2uT%2u:%2u:%2u.%3uZ%n", &year, &month, &day, &hour, &minute, &second,
                    &ms, &used) != 7 ||
        used != int(utc.size()))
        return {};
    std::chrono::year_month_day const date{std::chrono::year{year}, std::chrono::month{month},
                                           std::chrono::day{day}};
    if (!date.ok() || hour > 23 || minute > 59 || second > 60) return {};
    auto const days = std::chrono::sys_days{date}.time_since_epoch().count();
    return double(days) * 86400 + hour * 3600 + minute * 60 + second + ms * 0.001;
}

std::optional<double> last_moment(JournalEntry const& entry)
{
    struct Moment {
        using Maybe = std::optional<double>;
        Maybe operator()(SessionStarted const& e) const { return e.clock_s; }
        Maybe operator()(CalibrationDone const&) const { return {}; }
        Maybe operator()(TrialDone const& e) const
        {
            Maybe last = e.response_s;
            for (StimulusShown const& s : e.shown)
                last = std::max(last.value_or(s.onset_s), s.onset_s + s.duration_s);
            return last;
        }
        Maybe operator()(StepDone const& e) const { return e.end_s; }
        Maybe operator()(ItemAnswered const& e) const { return e.time_s; }
        Maybe operator()(QuestionnaireDone const& e) const { return e.end_s; }
        Maybe operator()(ParticipantAsked const&) const { return {}; }
        Maybe operator()(NoteTaken const& e) const { return e.time_s; }
        Maybe operator()(SessionEnded const& e) const { return e.time_s; }
    };
    return std::visit(Moment{}, entry);
}

std::optional<double> last_unix_time(SessionRecord const& record)
{
    std::optional<double> start, clock, last;
    for (JournalEntry const& entry : record.entries) {
        auto const moment = last_moment(entry);
        if (auto const* const started = std::get_if<SessionStarted>(&entry)) {
            start = unix_time(started->utc);
            clock = last = started->clock_s;
        } else if (moment && last) {
            last = std::max(*last, *moment);
        }
    }
    if (!start) return {};
    return *start + (*last - *clock);
}

} // namespace study
