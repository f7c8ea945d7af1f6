#pragma once
// Saves the state of an unfinished render while its picture is still being filtered and written.

#include "gi/core/report.h"
#include "gi/render/render_settings.h"

#include <functional>
#include <future>
#include <string>

namespace viewer {

/// Saves from construction on, on a thread of its own; if none can be started, the constructor itself saves. The
/// destructor waits: the state is saved whatever becomes of the picture.
class StateSaving {
public:
    /// Takes RenderResult::save_state, which may be empty.
    explicit StateSaving(gi::RenderResult& result, gi::DiskWait wait = gi::DiskWait::yes);
    StateSaving(StateSaving const&) = delete;
    StateSaving& operator=(StateSaving const&) = delete;

    bool has_state() const { return has_state_; }
    /// Waits for it; its time and what kept it from being saved go to the report. @return whether it is saved
    bool join(gi::Report& report);

private:
    void save();

    std::function<void(gi::DiskWait)> save_;
    gi::DiskWait const wait_;
    bool const has_state_;
    double seconds_ = 0;
    std::string error_;         ///< why it could not be saved
    std::future<void> running_; ///< the last member, so that it is waited for before the others are destroyed
};

} // namespace viewer
