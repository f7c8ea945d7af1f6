#include "ar/runtime/source_losses.h"

#include "gi/core/error.h"

namespace ar {

void report_losses(SourceCounts const& counts, SourceState const& state, gi::Report& report)
{
    if (counts.refused > 0)
        report.lose("frames that could not be read", std::size_t(counts.refused), counts.last_refusal);
    if (state.kind == SourceState::Kind::lost)
        throw gi::InputError("the source was lost: " + state.reason, describe(counts),
                             "check the file, or the camera's cable");
}

} // namespace ar
