#pragma once
// When things happened: clocks of a session and the calendar.

#include "study/journal/entries.h"

namespace study {

/// "2026-11-22T08:00:00.000Z". @param unix_s seconds since 1970, UTC, without leap seconds
std::string utc_text(double unix_s);
/// Of what utc_text writes; none where it is something else.
std::optional<double> unix_time(std::string const& utc);

/// The last moment that an entry knows of, on the monotonic clock of its part.
std::optional<double> last_moment(JournalEntry const& entry);
/// The last moment of a record by the wall clock: where its last part started, and the monotonic clock since.
std::optional<double> last_unix_time(SessionRecord const& record);

} // namespace study
