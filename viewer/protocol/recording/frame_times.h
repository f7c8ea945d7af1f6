#pragma once
// What is known of the times of one frame once it has been shown.

#include "viewer/protocol/bytes.h"

#include <optional>
#include <string>
#include <string_view>

namespace viewer {

/// How the time of the swap was found. none: shown nowhere (off-screen). finish: the swap was called and glFinish
/// waited. fence: a fence after the swap. oml: glXWaitForSbcOML. openxr: what the runtime says.
enum class SwapMethod { none, finish, fence, oml, openxr };
inline constexpr int kSwapMethods = 5;
std::string_view name_of(SwapMethod method);

/// Times in s are on the clock of the session, which starts at 0.
struct FrameTimes {
    std::uint64_t frame = 0;
    double pose_s = 0;    ///< when the poses were taken
    double display_s = 0; ///< when it was expected to be seen
    double swap_s = 0;    ///< when it was shown, as far as swap_method can tell
    SwapMethod swap_method = SwapMethod::none;
    double swap_uncertainty_ms = 0; ///< half the width of the interval that swap_s is in the middle of
    double input_ms = 0, wait_ms = 0, render_ms = 0, upload_ms = 0, draw_ms = 0; ///< of the CPU
    std::optional<double> gpu_ms;                                                ///< where a GPU renders
    int paths = 1;                                                               ///< per pixel
    int width = 0, height = 0; ///< pixels rendered of the first view
    int dropped = 0;           ///< frames of the display that passed without a new picture since the frame before
    double late_ms = 0;        ///< swap_s - display_s; < 0 = early
    bool reprojected = false;  ///< an older picture, shown from the newer pose
    std::optional<double> tracker_ms; ///< age of the newest tracker packet when the poses were taken

    bool operator==(FrameTimes const&) const = default;
};

/// In a record; put after frame, pose_s and display_s, which the order of the frame has.
void put(ByteWriter& to, FrameTimes const& times);
/// Throws BadBytes.
FrameTimes get_frame_times(ByteReader& from);

/// Comment lines ("# name: meaning") and the line of column names, with "\n" at the end of each.
std::string frame_times_header();
/// One line of CSV.
std::string csv_line(FrameTimes const& times);

} // namespace viewer
