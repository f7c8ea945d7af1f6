#pragma once
// One line on stderr about a running batch: done, running, failed, tasks per second, time left.

#include "gi/core/progress.h"

#include <chrono>
#include <cstddef>
#include <string>

namespace viewer::batch {

struct Counts {
    std::size_t total = 0, done = 0, running = 0, failed = 0;
};

class ProgressView {
public:
    ProgressView(std::string const& name, bool enabled) : bar_(name, enabled) {}

    void update(Counts const& now);

private:
    gi::ProgressBar bar_;
    std::size_t done_before_ = SIZE_MAX; ///< when this began
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace viewer::batch
