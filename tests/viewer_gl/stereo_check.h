#pragma once
// One body for every kind of target: what the GPU composes is what the CPU composes of the same eyes.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_gl/small_room.h"
#include "viewer/devices/gl/display_pass.h"
#include "viewer/devices/gl/picture_texture.h"
#include "viewer/displays/compose.h"

#include <cstdlib>
#include <gtest/gtest.h>

namespace viewer::test {

struct Eyes {
    PictureTexture left, right;

    explicit Eyes(glm::ivec2 size, double aspect)
    {
        RoomPicture const l = room_seen_by(room_eye(-0.032, aspect), size),
                          r = room_seen_by(room_eye(0.032, aspect), size);
        left.upload(size, l.rgb, l.depth_m);
        right.upload(size, r.rgb, r.depth_m);
    }
};

/// Bytes of one eye as the GPU shows it alone.
inline std::vector<unsigned char> eye_bytes(DisplayPass& pass, PictureTexture const& eye, DisplaySettings settings)
{
    settings.stereo = StereoMode::off;
    TextureTarget const target(TextureTarget::Format::bytes, eye.shown().size_px);
    pass.draw(target.target(), {eye.shown(), {}}, {}, settings);
    return read_bytes(target.target());
}

inline int largest_difference(std::vector<unsigned char> const& a, std::vector<unsigned char> const& b)
{
    if (a.size() != b.size()) return 1000;
    int most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(int(a[i]) - int(b[i])));
    return most;
}

/// Folder for pictures to look at: LIGHTWELL_TEST_PICTURES; empty = none are written.
inline std::string pictures_folder()
{
    char const* const folder = std::getenv("LIGHTWELL_TEST_PICTURES");
    return folder ? folder : "";
}

inline void keep_picture(std::string const& name, glm::ivec2 size, std::vector<unsigned char> const& bytes)
{
    if (!pictures_folder().empty()) gi::write_png(pictures_folder() + "/" + name + ".png", size.x, size.y, bytes);
}

/// Draws every mode that has one picture into the target and compares.
/// @param on_screen position of the target's top left corner on the screen
inline void check_all_modes(DrawTarget const& target, glm::ivec2 on_screen, std::string const& name)
{
    DisplayPass pass;
    DisplaySettings settings;
    settings.on_screen_px = on_screen;
    for (StereoMode const mode : kStereoModes) {
        if (mode == StereoMode::quad_buffer || mode == StereoMode::two_windows) continue;
        settings.stereo = mode;
        Eyes const eyes(eye_size(mode, target.size_px), double(target.size_px.x) / target.size_px.y);
        pass.draw(target, {eyes.left.shown(), {}}, {eyes.right.shown(), {}}, settings);
        auto const seen = read_bytes(target);
        auto const expected = compose_stereo(mode, eye_bytes(pass, eyes.left, settings),
                                             eye_bytes(pass, eyes.right, settings), target.size_px, on_screen);
        int const most = largest_difference(seen, expected);
        EXPECT_LE(most, mode == StereoMode::anaglyph_dubois ? 1 : 0) << name_of(mode) << " on " << name;
        keep_picture(name + "_" + name_of(mode), target.size_px, seen);
    }
}

} // namespace viewer::test
