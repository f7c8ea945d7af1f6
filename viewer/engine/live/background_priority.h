#pragma once
// Threads that compute give way to those that people wait for: input, sockets, and what is shown. With as many
// threads that compute as cores, a window's thread would else wait for a share of the processor, some 10 ms each
// time.

#include <memory>

namespace viewer {

/// While it lives, threads of oneTBB that join work in this process have a lower priority; so has the calling
/// thread, for good.
class BackgroundPriority {
public:
    BackgroundPriority();
    ~BackgroundPriority();

private:
    struct Observer;
    std::unique_ptr<Observer> observer_;
};

} // namespace viewer
