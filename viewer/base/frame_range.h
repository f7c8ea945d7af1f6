#pragma once
// Ranges of frames of an animation, and the times and file names of the frames.

#include <string>

namespace viewer {

/// Frames first .. end - 1: 0:120 at 30 per second lasts 4 s, and 60:120 continues 0:60 without a duplicate.
struct FrameRange {
    int first = 0, end = 0;              ///< 0 <= first < end
    double frames = 30, per_seconds = 1; ///< rate as a fraction: 30000 frames per 1001 s for NTSC

    int count() const { return end - first; }
    double fps() const { return frames / per_seconds; }
    /// Time of a frame, s. Computed from its number, so that rounding errors do not accumulate.
    double time_s(int frame) const { return frame * per_seconds / frames; }
};

/// Parses "0:120@30", "0:4s@30" (seconds must fall on a frame) or "0:120@30000/1001"; at most 100000 frames.
/// Throws InputError.
FrameRange parse_frame_range(std::string const& text);

/// File names of frames.
struct FrameName {
    std::string before, after;
    int digits = 1;

    std::string of(int frame) const;
    /// Name for the whole range, e.g. "f_0000-0119.exr".
    std::string of_all(FrameRange const& range) const;
};

/// Parses a name with one %d or %04d (1 to 9 digits), not in its folder part; %% means %. Throws InputError.
FrameName parse_frame_name(std::string const& option, std::string const& pattern);

} // namespace viewer
