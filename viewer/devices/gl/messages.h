#pragma once
// OpenGL debug messages (KHR_debug, core since 4.3): errors and undefined behaviour are counted in a report,
// performance hints are not.

#include "gi/core/report.h"

#include <atomic>
#include <cstdint>

namespace viewer {

class GlMessages {
public:
    /// Receives the messages of the current context until it is destroyed; the report must live as long.
    explicit GlMessages(gi::Report& report);
    GlMessages(GlMessages const&) = delete;
    GlMessages& operator=(GlMessages const&) = delete;

    std::uint64_t errors() const { return errors_; }
    /// Called by the driver, possibly from its own thread.
    void hear(unsigned type, char const* message);

private:
    gi::Report& report_;
    std::atomic<std::uint64_t> errors_{0};
};

} // namespace viewer
