#pragma once
// What OpenGL has to say (KHR_debug, core since 4.3): errors and undefined behaviour are counted in a report,
// hints about speed are not.

#include "gi/core/report.h"

#include <atomic>
#include <cstdint>

namespace viewer {

class GlMessages {
public:
    /// Listens to the current context until that is destroyed; the report must live as long.
    explicit GlMessages(gi::Report& report);
    GlMessages(GlMessages const&) = delete;
    GlMessages& operator=(GlMessages const&) = delete;

    std::uint64_t errors() const { return errors_; }
    /// By the driver, possibly from a thread of its own.
    void hear(unsigned type, char const* message);

private:
    gi::Report& report_;
    std::atomic<std::uint64_t> errors_{0};
};

} // namespace viewer
