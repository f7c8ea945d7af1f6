// Pictures that show more than their views.

#include "viewer/engine/picture_margin.h"

#include "gi/scene/model/camera.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

ViewCommand view_of(double turn_deg = 0, double nod_deg = 0)
{
    ViewCommand v{"window", {}, 640, 480, -1};
    v.camera.yfov_rad = glm::radians(60.0);
    v.camera.world_from_camera = glm::rotate(gi::dmat4(1), glm::radians(turn_deg), gi::dvec3{0, 1, 0}) *
                                 glm::rotate(gi::dmat4(1), glm::radians(nod_deg), gi::dvec3{1, 0, 0});
    return v;
}

/// The rays of a picture with a margin are those of its view, and go on beyond its edges.
TEST(PictureMargin, RaysOfTheViewStay)
{
    ViewCommand off = view_of();
    off.camera.off_axis = gi::ViewTangents{-0.3, 0.9, -0.2, 0.5};
    for (ViewCommand const& v : {view_of(20, -7), off}) {
        glm::ivec2 const margin(24, 8);
        gi::CameraRays const own = gi::camera_rays(v.camera, v.width, v.height, {}),
                             wide = gi::camera_rays(with_margin(v.camera, {v.width, v.height}, margin),
                                                    v.width + 48, v.height + 16, {});
        for (gi::vec2 const at : {gi::vec2{0, 0}, gi::vec2{640, 480}, gi::vec2{311.5f, 20.25f}}) {
            gi::vec3 const a = own.through(at).direction, b = wide.through(at + gi::vec2(margin)).direction;
            EXPECT_LT(glm::length(a - b), 1e-6f);
        }
    }
    EXPECT_EQ(with_margin(off.camera, {640, 480}, {0, 0}), off.camera);
}

/// A head that turns by 2 degrees sees, at the corners of 640x480 pixels and 60 degrees,
/// up to 31 pixels more at one side: tan(atan(0.7698) + 2 deg) is 0.8267, and 0.0569 of 1.5396 of a half's width
/// are 23.7 pixels in the middle of the edge.
TEST(PictureMargin, IsWhatTheHeadTurnsTo)
{
    glm::ivec2 const turned = margin_for(view_of(), view_of(2).camera),
                     nodded = margin_for(view_of(), view_of(0, 1).camera);
    EXPECT_GE(turned.x, 24);
    EXPECT_LE(turned.x, 32);
    EXPECT_EQ(turned.x % 4, 0);
    EXPECT_LE(turned.y, 16); // the corners move up and down
    EXPECT_GE(nodded.y, 8);
    EXPECT_EQ(margin_for(view_of(), view_of().camera), glm::ivec2(0));
    EXPECT_EQ(margin_for(view_of(), view_of(90).camera), glm::ivec2(52, 40)); // a twelfth at most
    EXPECT_LE(margin_for(view_of(), view_of(180).camera).x, 52);
    ViewCommand flat = view_of();
    flat.camera.orthographic = true;
    EXPECT_EQ(margin_for(flat, view_of(2).camera), glm::ivec2(0));
}

TEST(PictureMargin, IsCutOff)
{
    gi::Picture p{7, 6, {}, {}};
    for (int c : {3, 1}) {
        gi::Layer& layer = p.add(c == 3 ? "color" : "depth", c);
        for (std::size_t i = 0; i < layer.data.size(); ++i) layer.data[i] = float(i);
    }
    gi::Picture const inner = without_margin(p, {2, 1});
    EXPECT_EQ(inner.width, 3);
    EXPECT_EQ(inner.height, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 3; ++x) {
            int const at = (y + 1) * 7 + x + 2;
            EXPECT_EQ(inner.find("depth")->data[std::size_t(3 * y + x)], float(at));
            EXPECT_EQ(inner.find("color")->data[std::size_t(3 * (3 * y + x) + 2)], float(3 * at + 2));
        }
}

} // namespace
} // namespace viewer::test
