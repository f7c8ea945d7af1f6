// The node graph of glTF: transforms, instances, skins, cameras, lights and clips.

#include "gi/core/error.h"
#include "gi/scene/motion/animation.h"
#include "tests/scene/gltf_builder.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(GltfNodes, ParentsComeFirstAndTransformsMultiply)
{
    GltfBuilder b;
    b.add_triangle(); // node 0, a child of node 2, which is a child of node 1
    b.root["nodes"][0]["translation"] = {0, 0, 5};
    b.append("nodes", {{"name", "top"}, {"scale", {2, 2, 2}}, {"children", {2}}});
    b.append("nodes", {{"matrix", {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1}}, {"children", {0}}});
    b.root["scenes"][0]["nodes"] = {1};
    Scene const scene = b.parse();
    ASSERT_EQ(scene.nodes.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(scene.nodes[i].parent, std::int32_t(i) - 1);
    EXPECT_EQ(scene.nodes[0].name, "top");
    Pose const pose = evaluate_pose(scene, std::nullopt);
    glm::dvec4 const origin = pose.world_from_node[2] * glm::dvec4(0, 0, 0, 1);
    EXPECT_EQ(dvec3(origin), dvec3(2 * (1 + 5), 0, 0));
}

TEST(GltfNodes, NodesShareAMeshAndOnlyTheShownSceneHasMeshes)
{
    GltfBuilder b;
    b.add_triangle();
    b.append("nodes", {{"mesh", 0}, {"translation", {3, 0, 0}}});
    b.append("nodes", {{"mesh", 0}});
    b.root["scenes"] = {{{"nodes", {2}}}, {{"nodes", {0, 1}}}};
    b.root["scene"] = 1;
    Scene const scene = b.parse();
    EXPECT_EQ(scene.meshes.size(), 1u);
    std::size_t shown = 0;
    for (Node const& node : scene.nodes) shown += node.meshes.size();
    EXPECT_EQ(shown, 2u);
}

TEST(GltfNodes, WithoutScenesAllRootsAreShown)
{
    GltfBuilder b;
    b.add_triangle();
    b.root.erase("scenes");
    b.root.erase("scene");
    EXPECT_EQ(b.parse().nodes.at(0).meshes.size(), 1u);
}

TEST(GltfNodes, CamerasKeepTheirOptics)
{
    GltfBuilder b;
    b.append("cameras",
             {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 2}}}});
    b.append("cameras",
             {{"type", "orthographic"}, {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 9}}}});
    b.append("nodes", {{"name", "eye"}, {"camera", 0}});
    b.append("nodes", {{"name", "plan"}, {"camera", 1}});
    Scene const scene = b.parse();
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_FALSE(scene.cameras[0].orthographic);
    EXPECT_DOUBLE_EQ(scene.cameras[0].yfov_rad, 0.5);
    EXPECT_DOUBLE_EQ(scene.cameras[0].aspect, 2);
    EXPECT_TRUE(scene.cameras[1].orthographic);
    EXPECT_DOUBLE_EQ(scene.cameras[1].ymag_m, 2);
    EXPECT_DOUBLE_EQ(scene.cameras[1].aspect, 1.5);
}

TEST(GltfNodes, PunctualLightsKeepColorRangeAndCone)
{
    GltfBuilder b;
    b.root["extensionsUsed"] = {"KHR_lights_punctual"};
    b.root["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"color", {1, 0.5, 0}}, {"intensity", 10}, {"range", 4}},
        {{"type", "spot"}, {"intensity", 2}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}},
        {{"type", "directional"}}};
    for (int i = 0; i < 3; ++i) b.append("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
    Scene const scene = b.parse();
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].type, LightType::point);
    EXPECT_EQ(scene.lights[0].intensity, (vec3{10, 5, 0}));
    EXPECT_FLOAT_EQ(scene.lights[0].range, 4);
    EXPECT_EQ(scene.lights[1].type, LightType::spot);
    EXPECT_FLOAT_EQ(scene.lights[1].cos_inner, std::cos(0.25f));
    EXPECT_FLOAT_EQ(scene.lights[1].cos_outer, std::cos(0.5f));
    EXPECT_EQ(scene.lights[2].type, LightType::directional);
    EXPECT_EQ(scene.lights[2].intensity, vec3{1});
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(scene.nodes[i].light, std::int32_t(i));
}

TEST(GltfNodes, InvisibleNodesHideAllBelowButCameras)
{
    GltfBuilder b;
    b.add_triangle(); // node 0
    b.root["extensionsUsed"] = b.root["extensionsRequired"] = {"KHR_node_visibility"};
    b.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    auto const visible = [](bool is) { return nlohmann::json{{"KHR_node_visibility", {{"visible", is}}}}; };
    b.append("nodes", {{"mesh", 0}, {"extensions", visible(false)}, {"children", {2, 3}}});
    b.append("nodes", {{"mesh", 0}, {"extensions", visible(true)}}); // below a hidden one
    b.append("nodes", {{"camera", 0}});
    b.append("nodes", {{"mesh", 0}, {"extensions", visible(true)}});
    b.root["scenes"][0]["nodes"] = {0, 1, 4};
    Scene const scene = b.parse();
    std::size_t shown = 0;
    for (Node const& node : scene.nodes) shown += node.meshes.size();
    EXPECT_EQ(shown, 2u);
    EXPECT_EQ(scene.cameras.size(), 1u);
}

/// A triangle on one joint (node 1), with weights that sum to two at the first vertex.
GltfBuilder skinned_triangle()
{
    GltfBuilder b;
    nlohmann::json& attributes = b.add_triangle()["attributes"];
    std::vector<std::uint16_t> const joints(12, 0);
    int const weights = b.add_floats({1, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", 4);
    attributes["JOINTS_0"] = b.add_accessor(b.add_view(joints), kUshort, 3, "VEC4");
    attributes["WEIGHTS_0"] = weights;
    b.append("nodes", {{"name", "joint"}});
    b.root["nodes"][0]["skin"] = 0;
    b.append("skins", {{"joints", {1}}});
    return b;
}

TEST(GltfNodes, SkinsNormaliseWeightsAndDefaultToIdentity)
{
    GltfBuilder const b = skinned_triangle();
    Report report;
    Scene const scene = b.parse(report);
    ASSERT_EQ(scene.skins.size(), 1u);
    EXPECT_EQ(scene.nodes.at(std::size_t(scene.skins[0].joints.at(0))).name, "joint");
    EXPECT_EQ(scene.skins[0].inverse_bind.at(0), mat4(1));
    EXPECT_EQ(scene.meshes[0].weights[0], (vec4{0.5f, 0.5f, 0, 0}));
    EXPECT_EQ(scene.meshes[0].joints.size(), 3u);
    EXPECT_EQ(lost(report, "vertex weights that do not sum to one, normalised"), 1u);
}

TEST(GltfNodes, FurtherJointsAreCountedAndBadJointsRefused)
{
    GltfBuilder b = skinned_triangle();
    nlohmann::json& attributes = b.root["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_1"] = attributes["JOINTS_0"];
    attributes["WEIGHTS_1"] = attributes["WEIGHTS_0"];
    Report report;
    b.parse(report);
    EXPECT_EQ(lost(report, "joints beyond the fourth of a vertex ignored"), 1u);
    // The skin has one.
    attributes["JOINTS_0"] = b.add_accessor(b.add_view(std::vector<std::uint16_t>(12, 7)), kUshort, 3, "VEC4");
    EXPECT_THROW(b.parse(), InputError);
}

TEST(GltfNodes, ClipsKeepKeysAndTheFirstPlays)
{
    GltfBuilder b;
    b.add_triangle();
    int const times = b.add_floats({0, 1, 3}, "SCALAR", 1);
    int const places = b.add_floats({0, 0, 0, 1, 0, 0, 1, 2, 0}, "VEC3", 3);
    int const turns =
        b.add_accessor(b.add_view(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 32767, 0, 0, 0, 0, 0, 32767}),
                       kShort, 3, "VEC4", true);
    std::vector<float> spline(3 * 9, 0.0f);
    int const scales = b.add_floats(spline, "VEC3", 3);
    auto const channel = [](int sampler, char const* path) {
        return nlohmann::json{{"sampler", sampler}, {"target", {{"node", 0}, {"path", path}}}};
    };
    b.append("animations",
             {{"name", "walk"},
              {"samplers",
               {{{"input", times}, {"output", places}, {"interpolation", "STEP"}},
                {{"input", times}, {"output", turns}},
                {{"input", times}, {"output", scales}, {"interpolation", "CUBICSPLINE"}}}},
              {"channels", {channel(0, "translation"), channel(1, "rotation"), channel(2, "scale")}}});
    b.append("animations",
             {{"samplers", {{{"input", times}, {"output", places}}}}, {"channels", {channel(0, "translation")}}});
    Scene const scene = b.parse();
    ASSERT_EQ(scene.animations.size(), 2u);
    Animation const& walk = scene.animations[0];
    EXPECT_EQ(walk.name, "walk");
    EXPECT_DOUBLE_EQ(walk.duration_s, 3);
    ASSERT_EQ(walk.channels.size(), 3u);
    EXPECT_EQ(walk.channels[0].interpolation, Interpolation::step);
    EXPECT_EQ(walk.channels[0].values.size(), 9u);
    EXPECT_EQ(walk.channels[1].interpolation, Interpolation::linear);
    EXPECT_EQ(walk.channels[1].values[5], 1.0f);
    EXPECT_EQ(walk.channels[2].interpolation, Interpolation::cubic_spline);
    ASSERT_EQ(scene.playbacks.size(), 1u);
    EXPECT_EQ(scene.playbacks[0].animation, 0);
}

TEST(GltfNodes, ContradictoryClipsAreRefused)
{
    auto const with_times = [](std::vector<float> const& times) {
        GltfBuilder b;
        b.add_triangle();
        int const input = b.add_floats(times, "SCALAR", 1);
        int const output = b.add_floats(std::vector<float>(9, 0.0f), "VEC3", 3);
        b.append("animations",
                 {{"samplers", {{{"input", input}, {"output", output}}}},
                  {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}});
        return b;
    };
    EXPECT_NO_THROW(with_times({0, 1, 2}).parse());
    EXPECT_THROW(with_times({0, 1, 1}).parse(), InputError);
    EXPECT_THROW(with_times({-1, 0, 1}).parse(), InputError);
    EXPECT_THROW(with_times({0, 1}).parse(), InputError);
    EXPECT_THROW(with_times({0, 1, std::nanf("")}).parse(), InputError);
}

} // namespace
} // namespace gi::test
