#pragma once
// Recordings for tests.

#include "viewer/protocol/recording/recording.h"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

namespace viewer::test {

/// Frame n of a walk past two walls: poses, and a change now and then.
inline RecordedFrame walk_frame(std::uint64_t n)
{
    RecordedFrame f;
    FrameCommand& o = f.command;
    double const t = double(n) / 60;
    o.frame = n;
    o.pose_s = t;
    o.display_s = t + 0.0166;
    o.scene_s = 0.5 * t;
    o.world_from_room[3] = {std::sin(t), 0, -t, 1};
    o.tracked.head = {{0.1 * std::cos(3 * t), 1.7, 0.1}, glm::normalize(gi::dquat(1, 0, 0.1 * std::sin(t), 0))};
    if (n % 3 == 0) o.tracked.left_hand = RoomPose{{0, 1, -0.3}, {1, 0, 0, 0}};
    if (n % 5 == 4) o.others = {{}, o.tracked};
    if (n % 10 == 0) o.changes = {{"exposure", 1 + t}, {"label", "a \"b\", #c\n"}};
    for (int i = 0; i < 1 + int(n % 2); ++i) {
        ViewCommand v;
        v.name = "wall, " + std::to_string(i);
        v.camera = gi::look_at({std::sin(t), 1.7, -t}, {0, 1, -t - 3}, 60);
        if (i == 1) v.camera.off_axis = gi::ViewTangents{-1, 0.5, -0.25, 0.75};
        v.width = 640;
        v.height = 480;
        v.partner = i - 1;
        o.views.push_back(v);
    }
    if (n % 4 == 3) o.light_scale = 0.375;
    if (n % 8 == 7) o.surface_scale = 0.5;
    if (n % 16 == 7) o.views[0].margin_x = 20;
    f.pixel_hash = 0x9E3779B185EBCA87u * (n + 1);
    if (n % 2 == 0) {
        f.times.emplace();
        f.times->frame = n;
        f.times->pose_s = o.pose_s;
        f.times->display_s = o.display_s;
        f.times->swap_s = t + 0.017;
        f.times->swap_method = SwapMethod::fence;
        f.times->render_ms = 11.25;
        if (n % 4 == 0) f.times->gpu_ms = 3.5;
    }
    return f;
}

inline RecordingHeader walk_header()
{
    RecordingHeader h;
    h.program = "lightwell 0.1.0 (git 1234567)";
    h.scene = "atrium";
    h.command_line = "lightwell view atrium --record walk.lwr";
    h.settings = {{"exposure", 1.0}, {"method", "slhb"}};
    h.created = "2026-05-04T12:30:00Z";
    return h;
}

inline std::string text_of(std::filesystem::path const& file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline RecordingReader reader_of(std::string const& bytes)
{
    return RecordingReader(std::make_unique<std::istringstream>(bytes), bytes.size(), "test");
}

} // namespace viewer::test
