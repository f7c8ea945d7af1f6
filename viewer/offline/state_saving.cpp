#include "viewer/offline/state_saving.h"

#include <chrono>
#include <malloc.h>
#include <system_error>
#include <utility>

namespace viewer {

StateSaving::StateSaving(gi::RenderResult& result, gi::DiskWait wait)
    : save_(std::exchange(result.save_state, nullptr)), wait_(wait), has_state_(save_ != nullptr)
{
    if (!has_state_) return;
    // The files need memory as large as they are for what waits for the disk.
    // The system gives it faster from what this process has freed than from pages that were never used,
    // which a virtual machine has to ask its host for.
    malloc_trim(0);
    try {
        running_ = std::async(std::launch::async, [this] { save(); });
    } catch (std::system_error const&) { // no thread can be started
        save();
    }
}

void StateSaving::save()
{
    auto const begun = std::chrono::steady_clock::now();
    try {
        std::exchange(save_, nullptr)(wait_); // its sums are freed with it
    } catch (std::exception const& e) {
        error_ = e.what();
    }
    seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

bool StateSaving::join(gi::Report& report)
{
    if (!has_state_) return false;
    if (running_.valid()) running_.get();
    report.add_time("checkpoints", seconds_);
    if (!error_.empty()) report.lose("checkpoints that could not be written", 1, error_);
    return error_.empty();
}

} // namespace viewer
