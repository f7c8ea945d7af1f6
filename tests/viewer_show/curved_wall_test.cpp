// A dome in a window: what lies at a known point of the dome is at the pixel computed by hand, for both eyes and
// wherever the room is.

#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/layout.h"
#include "viewer/displays/display_file.h"

#include <glm/gtc/matrix_transform.hpp>

namespace viewer::test {
namespace {

using CurvedWall = Surfaceless;

/// White within 2 degrees of the direction to a point in the world, black elsewhere.
gi::Picture spot(ViewCommand const& view, gi::dvec3 point)
{
    gi::Picture picture;
    picture.width = view.width;
    picture.height = view.height;
    picture.add("depth", 1);
    gi::Layer& color = picture.add("color", 3);
    glm::dmat3 const turn(view.camera.world_from_camera);
    gi::dvec3 const to = glm::normalize(point - gi::dvec3(view.camera.world_from_camera[3]));
    gi::ViewTangents const t = *view.camera.off_axis;
    std::size_t i = 0;
    for (int y = 0; y < view.height; ++y)
        for (int x = 0; x < view.width; ++x) {
            gi::dvec3 const d =
                turn * glm::normalize(gi::dvec3{glm::mix(t.left, t.right, (x + 0.5) / view.width),
                                                glm::mix(t.top, t.bottom, (y + 0.5) / view.height), -1});
            bool const is_near = glm::dot(d, to) > std::cos(glm::radians(2.0));
            for (int c = 0; c < 3; ++c) color.data[i++] = is_near ? 1.0f : 0.0f;
        }
    return picture;
}

TEST_F(CurvedWall, AKnownPointIsAtItsPixel)
{
    gi::Report unused;
    // 200 x 200 px per eye: the circle's radius is 100 px for 90 degrees from the zenith.
    Display const display = parse_display(R"(
windows: [{name: w, size_px: [400, 200]}]
users: [{name: u, head_position_m: [0.5, 1.2, 0.3]}]
walls:
  - {name: dome, window: w, stereo: side-by-side,
     projection: {type: fisheye, center_m: [0, 1, 0], rotation_deg: [90, 0, 0], radius_m: 4}}
)",
                                          "dome.yaml", unused);
    gi::dmat4 const world_from_room = glm::translate(gi::dmat4(1), gi::dvec3{3, -2, 1}) *
                                      glm::rotate(gi::dmat4(1), glm::radians(40.0), gi::dvec3{0, 1, 0});
    Layout const layout = display_layout(display, {}, world_from_room);
    ASSERT_EQ(layout.panes[0].size(), 1u);
    ASSERT_EQ(layout.panes[0][0].left_faces.views.size(), 5u);
    // The dome's point 30 degrees above the horizon in front: (0, 1 + 4 sin 30, -4 cos 30). It is 60 degrees from
    // the zenith, so 66.67 px below the circle's middle, whose front is below: x = 100, y = 166.67 from the top.
    gi::dvec3 const in_room{0, 3, -4 * std::cos(glm::radians(30.0))};
    gi::dvec3 const in_world(world_from_room * glm::dvec4(in_room, 1));
    auto frame = std::make_shared<LiveFrame>();
    frame->command.views = layout.views;
    frame->command.world_from_room = world_from_room;
    for (ViewCommand const& view : layout.views) frame->result.views.push_back({spot(view, in_world), {}, {}});

    Presenter presenter(wall_settings(display));
    auto const panes = display_panes(display, frame->command.views, world_from_room)[0];
    presenter.take(frame, panes);
    TextureTarget const window(TextureTarget::Format::bytes, {400, 200});
    presenter.draw(window.target(), {0, 0}, panes, {}, {});
    auto const bytes = read_bytes(window.target());
    for (int eye = 0; eye < 2; ++eye) {
        double count = 0, x_sum = 0, y_sum = 0;
        for (int y = 0; y < 200; ++y)
            for (int x = 0; x < 200; ++x)
                if (bytes[std::size_t((y * 400 + eye * 200 + x) * 3)] > 127) {
                    ++count;
                    x_sum += x + 0.5;
                    y_sum += y + 0.5;
                }
        ASSERT_GT(count, 5);
        EXPECT_NEAR(x_sum / count, 100, 0.7) << "eye " << eye;
        EXPECT_NEAR(y_sum / count, 166.67, 0.7) << "eye " << eye;
    }
}

TEST_F(CurvedWall, MeshesShareAViewport)
{
    gi::Report unused;
    // Each half of the window is lit by one of two walls whose viewports are the whole of it.
    std::string const mesh = "warp: {columns: 2, rows: 2, nodes: ";
    std::string const corners =
        "lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 1, -1], ";
    Display const display = parse_display(
        "windows: [{name: w, size_px: [40, 20]}]\n"
        "users: [{name: u, head_position_m: [0, 0.5, 0]}]\nwalls:\n  - {name: a, window: w, " +
            corners + mesh +
            "[[0, 0, 0, 0], [0.5, 0, 1, 0], [0, 1, 0, 1], [0.5, 1, 1, 1]]}}\n  - {name: b, window: w, " + corners +
            mesh + "[[0.5, 0, 0, 0], [1, 0, 1, 0], [0.5, 1, 0, 1], [1, 1, 1, 1]]}}\n",
        "two.yaml", unused);
    Layout const layout = display_layout(display, {}, gi::dmat4(1));
    ASSERT_EQ(layout.views.size(), 2u);
    auto frame = std::make_shared<LiveFrame>();
    frame->command.views = layout.views;
    for (float const grey : {0.2f, 1.0f}) {
        gi::Picture picture;
        picture.width = 40;
        picture.height = 20;
        picture.add("depth", 1);
        for (float& value : picture.add("color", 3).data) value = grey;
        frame->result.views.push_back({picture, {}, {}});
    }
    Presenter presenter(wall_settings(display));
    presenter.take(frame, layout.panes[0]);
    TextureTarget const window(TextureTarget::Format::bytes, {40, 20});
    presenter.draw(window.target(), {0, 0}, layout.panes[0], {}, {});
    auto const bytes = read_bytes(window.target());
    auto const at = [&](int x) { return int(bytes[std::size_t((10 * 40 + x) * 3)]); };
    EXPECT_GT(at(5), 60);
    EXPECT_GT(at(35), at(5) + 60);
}

} // namespace
} // namespace viewer::test
