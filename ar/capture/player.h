#pragma once
// Paces the frames of files.

#include "ar/capture/clock.h"
#include "ar/capture/frame_source.h"

#include <algorithm>

namespace ar {

class Player {
public:
    explicit Player(Pace pace) : pace_(pace) {}

    /// Waits until the playback time of the frame at `film_s` (seconds of the film,
    /// or of the recording machine's clock).
    /// @return the steady time at which it is due; nothing if that is later than `until_s`
    std::optional<double> wait_for(double film_s, double until_s)
    {
        if (pace_ == Pace::fastest) return steady_now_s();
        if (!shift_s_) {
            double const now_s = steady_now_s();
            shift_s_ = now_s - film_s;
            return now_s;
        }
        double const due_s = film_s + *shift_s_;
        sleep_until_s(std::min(due_s, until_s));
        if (due_s > until_s) return std::nullopt;
        return due_s;
    }
    bool is_fastest() const { return pace_ == Pace::fastest; }

private:
    Pace pace_;
    std::optional<double> shift_s_;
};

inline double until_s(std::chrono::milliseconds wait)
{
    return steady_now_s() + std::chrono::duration<double>(wait).count();
}

} // namespace ar
