#pragma once
#include "study/journal/entries.h"

namespace study {

/// session.json: provenance, parts with their gaps and calibrations, counts, whether the session is complete. It
/// follows from the record alone.
std::string session_summary(SessionRecord const& record);

} // namespace study
