#pragma once
// Chooses the size at which surfaces are drawn, by what drawing took.

#include <algorithm>
#include <array>

namespace viewer {

class SurfacesScale {
public:
    /// Side over that of the view.
    double next() const { return kScales[at_]; }
    /// @param seconds  from the start of a picture of this scale until it was shown
    /// @param most_s  that it should take
    void measured(double scale, double seconds, double most_s = kMost_s)
    {
        if (scale != kScales[at_]) return;
        mean_s_ = mean_s_ > 0 ? mean_s_ + (seconds - mean_s_) * 0.25 : seconds;
        if (++frames_ < kFrames) return;
        if (mean_s_ > most_s && at_ + 1 < kScales.size()) {
            change(at_ + 1);
            wait_ = std::min(2 * wait_, kLongestWait);
        } else if (at_ > 0 && frames_ > wait_ &&
                   mean_s_ * (kScales[at_ - 1] * kScales[at_ - 1]) / (scale * scale) < kToGrow * most_s) {
            change(at_ - 1);
        }
    }

private:
    static constexpr std::array kScales{1.0, 0.75, 0.5, 0.4};
    static constexpr double kMost_s = 0.045, kToGrow = 0.8;
    static constexpr int kFrames = 4, kLongestWait = 1024; ///< frames before a change; and before it grows again

    void change(std::size_t to)
    {
        at_ = to;
        mean_s_ = 0;
        frames_ = 0;
    }

    std::size_t at_ = 2;
    double mean_s_ = 0; ///< smoothed; 0 = unknown
    int frames_ = 0, wait_ = 16;
};

} // namespace viewer
