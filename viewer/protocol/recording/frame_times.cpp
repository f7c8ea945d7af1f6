#include "viewer/protocol/recording/frame_times.h"

#include <array>
#include <fmt/format.h>
#include <limits>

namespace viewer {
namespace {

constexpr std::array<std::string_view, kSwapMethods> kNames{"none", "finish", "fence", "oml", "openxr"};

struct Column {
    char const *name, *meaning;
};
constexpr Column kColumns[] = {
    {"frame", "number of the frame"},
    {"pose_s", "s, when the poses were measured; the session's clock starts at 0"},
    {"display_s", "s, expected display time of the frame"},
    {"swap_s", "s, when the frame was shown, as measured by swap_method"},
    {"swap_method", "none (off-screen), finish (glFinish after the swap), fence, oml (glXWaitForSbcOML), openxr"},
    {"swap_uncertainty_ms", "ms, half the width of the interval centred on swap_s"},
    {"input_ms", "ms of CPU time for input and poses"},
    {"wait_ms", "ms waited for the renderer, the display or the cluster"},
    {"render_ms", "ms of rendering"},
    {"upload_ms", "ms of copying pictures to the display's GPU"},
    {"draw_ms", "ms of drawing the window"},
    {"gpu_ms", "ms of GPU rendering; empty = no GPU renders"},
    {"paths", "paths per pixel"},
    {"width_px", "pixels rendered of the first view"},
    {"height_px", "pixels rendered of the first view"},
    {"dropped", "refreshes of the display without a new picture since the previous frame"},
    {"late_ms", "ms, swap_s - display_s; < 0 = early"},
    {"reprojected", "1 = an older picture, reprojected to the newer pose"},
    {"tracker_ms", "ms, age of the newest tracker packet when the poses were measured; empty = no tracker"},
};

std::array<double, 10> numbers_of(FrameTimes const& t)
{
    return {t.swap_s,
            t.swap_uncertainty_ms,
            t.input_ms,
            t.wait_ms,
            t.render_ms,
            t.upload_ms,
            t.draw_ms,
            t.late_ms,
            t.gpu_ms.value_or(0),
            t.tracker_ms.value_or(0)};
}

std::string text_of(std::optional<double> v) { return v ? fmt::format("{}", *v) : ""; }

} // namespace

std::string_view name_of(SwapMethod method) { return kNames.at(std::size_t(method)); }

void put(ByteWriter& to, FrameTimes const& t)
{
    to.put_byte(std::uint8_t((t.gpu_ms ? 1 : 0) + (t.tracker_ms ? 2 : 0) + (t.reprojected ? 4 : 0)));
    to.put_byte(std::uint8_t(t.swap_method));
    to.put_numbers(numbers_of(t), numbers_of({}));
    for (int const v : {t.paths, t.width, t.height, t.dropped}) to.put_count(std::uint64_t(std::max(v, 0)));
}

FrameTimes get_frame_times(ByteReader& from)
{
    FrameTimes t;
    std::uint8_t const flags = from.byte(), method = from.byte();
    if (flags > 7 || method >= kSwapMethods) throw BadBytes("the times of a frame are of an unknown kind");
    t.swap_method = SwapMethod(method);
    t.reprojected = (flags & 4) != 0;
    std::array<double, 10> v;
    from.numbers(v, numbers_of({}));
    t.swap_s = v[0];
    t.swap_uncertainty_ms = v[1];
    t.input_ms = v[2];
    t.wait_ms = v[3];
    t.render_ms = v[4];
    t.upload_ms = v[5];
    t.draw_ms = v[6];
    t.late_ms = v[7];
    if ((flags & 1) != 0) t.gpu_ms = v[8];
    if ((flags & 2) != 0) t.tracker_ms = v[9];
    for (int* const n : {&t.paths, &t.width, &t.height, &t.dropped})
        *n = int(from.count(std::uint64_t(std::numeric_limits<int>::max())));
    return t;
}

std::string frame_times_header()
{
    std::string comments, names;
    for (Column const& c : kColumns) {
        comments += fmt::format("# {}: {}\n", c.name, c.meaning);
        names += (names.empty() ? "" : ",") + std::string(c.name);
    }
    return comments + names + "\n";
}

std::string csv_line(FrameTimes const& t)
{
    return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", t.frame, t.pose_s,
                       t.display_s, t.swap_s, name_of(t.swap_method), t.swap_uncertainty_ms, t.input_ms, t.wait_ms,
                       t.render_ms, t.upload_ms, t.draw_ms, text_of(t.gpu_ms), t.paths, t.width, t.height,
                       t.dropped, t.late_ms, int(t.reprojected), text_of(t.tracker_ms));
}

} // namespace viewer
