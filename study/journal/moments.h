#pragma once
// Times of events: a session's clocks and calendar time.

#include "study/journal/entries.h"

namespace study {

/// "2026-11-22T08:00:00.000Z". @param unix_s seconds since 1970, UTC, without leap seconds
std::string utc_text(double unix_s);
/// Inverse of utc_text; none if the text has another form.
std::optional<double> unix_time(std::string const& utc);

/// Latest time in an entry, on the monotonic clock of its part.
std::optional<double> last_moment(JournalEntry const& entry);
/// Latest time of a record by the wall clock: start of its last part plus elapsed monotonic time.
std::optional<double> last_unix_time(SessionRecord const& record);

} // namespace study
