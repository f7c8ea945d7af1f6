#pragma once
#include "study/journal/entries.h"

namespace study {

/// Text of session.json: provenance, parts with their gaps and calibrations, counts, whether the session is
/// complete. It depends only on the record.
std::string session_summary(SessionRecord const& record);

} // namespace study
