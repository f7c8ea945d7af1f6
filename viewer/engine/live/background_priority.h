#pragma once
// Gives computing threads a lower priority than the threads for input, sockets and display. Otherwise, with as
// many computing threads as cores, a window's thread would wait some 10 ms each time for processor time.

#include <memory>

namespace viewer {

/// While this object exists, oneTBB threads that join work in this process get a lower priority. The calling
/// thread gets it permanently.
class BackgroundPriority {
public:
    BackgroundPriority();
    ~BackgroundPriority();

private:
    struct Observer;
    std::unique_ptr<Observer> observer_;
};

} // namespace viewer
