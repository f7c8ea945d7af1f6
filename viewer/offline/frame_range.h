#pragma once
// Which frames of an animation, and when each of them is.

#include <string>

namespace viewer {

/// Frames first .. end - 1, so that 0:120 at 30 per second last 4 s and 0:60 and 60:120 join without a frame
/// twice.
struct FrameRange {
    int first = 0, end = 0;              ///< 0 <= first < end
    double frames = 30, per_seconds = 1; ///< frames per so many seconds: 30000 and 1001 for NTSC

    int count() const { return end - first; }
    double fps() const { return frames / per_seconds; }
    /// s. Computed from the number of the frame, so that nothing adds up.
    double time_s(int frame) const { return frame * per_seconds / frames; }
};

/// "0:120@30", "0:4s@30" (seconds that fall on a frame) or "0:120@30000/1001"; at most 100000 frames.
/// Throws InputError.
FrameRange parse_frame_range(std::string const& text);

/// The name of each frame's file.
struct FrameName {
    std::string before, after;
    int digits = 1;

    std::string of(int frame) const;
    /// "f_0000-0119.exr" for all of a range.
    std::string of_all(FrameRange const& range) const;
};

/// A name with one %d or %04d (1 to 9 digits) in it, not in its folder; %% stands for %. Throws InputError.
FrameName parse_frame_name(std::string const& option, std::string const& pattern);

} // namespace viewer
