#pragma once
// Times of one frame, known after it was shown.

#include "viewer/protocol/bytes.h"

#include <optional>
#include <string>
#include <string_view>

namespace viewer {

/// How the swap time was measured. none: not shown (off-screen). finish: glFinish after the swap. fence: a fence
/// after the swap. oml: glXWaitForSbcOML. openxr: reported by the runtime.
enum class SwapMethod { none, finish, fence, oml, openxr };
inline constexpr int kSwapMethods = 5;
std::string_view name_of(SwapMethod method);

/// Times in s are on the clock of the session, which starts at 0.
struct FrameTimes {
    std::uint64_t frame = 0;
    double pose_s = 0;    ///< when the poses were measured
    double display_s = 0; ///< expected display time
    double swap_s = 0;    ///< when it was shown, as measured by swap_method
    SwapMethod swap_method = SwapMethod::none;
    double swap_uncertainty_ms = 0; ///< half the width of the interval centred on swap_s
    double input_ms = 0, wait_ms = 0, render_ms = 0, upload_ms = 0, draw_ms = 0; ///< of the CPU
    std::optional<double> gpu_ms;                                                ///< if a GPU renders
    int paths = 1;                                                               ///< per pixel
    int width = 0, height = 0;        ///< rendered pixels of the first view
    int dropped = 0;                  ///< refreshes of the display without a new picture since the previous frame
    double late_ms = 0;               ///< swap_s - display_s; < 0 = early
    bool reprojected = false;         ///< an older picture was reprojected to the newer pose
    std::optional<double> tracker_ms; ///< age of the newest tracker packet when the poses were measured

    bool operator==(FrameTimes const&) const = default;
};

/// Writes the times into a record, without frame, pose_s and display_s, which the frame command holds.
void put(ByteWriter& to, FrameTimes const& times);
/// Throws BadBytes.
FrameTimes get_frame_times(ByteReader& from);

/// Comment lines ("# name: meaning") and the line of column names, each ending with "\n".
std::string frame_times_header();
/// One line of CSV.
std::string csv_line(FrameTimes const& times);

} // namespace viewer
