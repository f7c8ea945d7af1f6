// Proxies from session files to triangles in the world.

#include "ar/calibration/calibration_file.h"
#include "ar/scene/proxy_mesh.h"
#include "ar/scene/real_scene.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/model/world.h"
#include "tests/viewer/run_program.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

std::string const kLeast = "schema: ar/1\nframes: {source: frames}\ncamera: camera.yaml\nmarkers: markers.yaml\n";

ar::RealPlace real_of(std::string const& text) { return ar::parse_session(kLeast + text, "folder/s.yaml").real; }

std::string refusal(std::string const& text)
{
    try {
        real_of(text);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

gi::World world_of(gi::Scene scene)
{
    gi::Report report;
    return gi::build_world(std::make_shared<gi::Scene const>(std::move(scene)), std::nullopt, report,
                           gi::dvec3(0));
}

TEST(Proxies, AreReadFromSessions)
{
    ar::RealPlace const r = real_of(R"(real:
  planes:
    - {name: table, corner_m: [0, 0, 1], edge_u_m: [2, 0, 0], edge_v_m: [0, 0, -1], albedo: [0.5, 0.4, 0.3]}
    - {centre_m: [0, 1, 0], size_m: [0.6, 0.4], rotation_deg: [-90, 0, 0], texture: estimate, texels: 64}
  boxes: [{size_m: [1, 2, 3], position_m: [0, 1, 0], albedo: 0.9, roughness: 0, metallic: 1}]
  meshes: [{file: bust.ply, at: [1, 0, 0]}, {file: cup.obj, albedo: estimate}]
  depth: [{file: d.png, camera: c.yaml, position_m: [0, 1, 1], step_px: 2, texture: t.png}]
)");
    ASSERT_EQ(r.proxies.size(), 6u);
    EXPECT_EQ(r.estimates, "folder/albedo.yaml");
    EXPECT_TRUE(r.scene.empty());
    EXPECT_EQ(r.proxies[0].name, "table");
    EXPECT_EQ(std::get<ar::ProxyPlane>(r.proxies[0].shape).edge_u_m, gi::dvec3(2, 0, 0));
    EXPECT_EQ(r.proxies[0].surface.albedo, gi::dvec3(0.5, 0.4, 0.3));
    auto const& flat = std::get<ar::ProxyPlane>(r.proxies[1].shape);
    EXPECT_EQ(r.proxies[1].name, "planes-2");
    EXPECT_NEAR(glm::distance(flat.corner_m, gi::dvec3(-0.3, 1, 0.2)), 0, 1e-12);
    EXPECT_NEAR(glm::normalize(glm::cross(flat.edge_u_m, flat.edge_v_m)).y, 1, 1e-12);
    EXPECT_EQ(r.proxies[1].surface.from, ar::AlbedoFrom::estimate_texture);
    EXPECT_EQ(r.proxies[1].surface.texels, 64);
    EXPECT_EQ(r.proxies[2].surface.metallic, 1);
    EXPECT_EQ(std::get<ar::ProxyMesh>(r.proxies[3].shape).placed.scene, "folder/bust.ply");
    EXPECT_EQ(r.proxies[3].surface.from, ar::AlbedoFrom::materials);
    EXPECT_EQ(r.proxies[4].surface.from, ar::AlbedoFrom::estimate);
    EXPECT_EQ(std::get<ar::ProxyDepth>(r.proxies[5].shape).step_px, 2);
    EXPECT_EQ(r.proxies[5].surface.texture, "folder/t.png");
}

TEST(Proxies, ThatAreWrongAreRefusedWithTheirPlace)
{
    EXPECT_NE(refusal("real: {planes: [{size_m: [1, 1]}]}\n").find("s.yaml:5:17: no 'centre_m'"),
              std::string::npos)
        << refusal("real: {planes: [{size_m: [1, 1]}]}\n");
    EXPECT_NE(refusal("real: {at: [0, 0, 0], planes: []}\n").find("no 'scene'"), std::string::npos);
    EXPECT_NE(refusal("real: {planes: []}\n").find("nothing real"), std::string::npos);
    EXPECT_NE(refusal("real: {boxes: [{size_m: [1, 1, 0]}]}\n").find("s.yaml:5:"), std::string::npos);
    EXPECT_NE(refusal("real: {boxes: [{name: a, size_m: [1, 1, 1]}, {name: a, size_m: [1, 1, 1]}]}\n")
                  .find("another 'a'"),
              std::string::npos);
    EXPECT_NE(refusal("real: {boxes: [{size_m: [1, 1, 1], albedo: estimate, metallic: 1}]}\n").find("metal"),
              std::string::npos);
    EXPECT_NE(refusal("real: {boxes: [{size_m: [1, 1, 1], albedo: 1, texture: a.png}]}\n").find("albedo is there"),
              std::string::npos);
    EXPECT_NE(refusal("real: {boxes: [{size_m: [1, 1, 1], colour: 1}]}\n").find("s.yaml:5:"), std::string::npos);
    EXPECT_NE(refusal("real: {planes: [{corner_m: [0, 0, 0], edge_u_m: [1, 0, 0], edge_v_m: [2, 0, 0]}]}\n")
                  .find("in one line"),
              std::string::npos);
    EXPECT_NE(refusal("real: {meshes: [{file: a.ply, roughness: 0}]}\n").find("neither albedo nor texture"),
              std::string::npos);
    EXPECT_NE(refusal("real: {depth: [{file: a.exr, position_m: [0, 0, 0]}]}\n").find("no 'camera'"),
              std::string::npos);
    EXPECT_NE(refusal("real: {scene: a.glb, albedo: 0.3}\n").find("not the word estimate"), std::string::npos);
}

/// Every face of a box turned in the world looks outwards, and each has its own sixth of the texture.
TEST(Proxies, BoxesAreClosed)
{
    gi::Report report;
    ar::ProxyBox box{{0.2, 0.4, 0.6}, {{1, 2, 3}, glm::angleAxis(0.7, glm::normalize(gi::dvec3(1, 2, 3)))}};
    gi::World const w = world_of(ar::scene_of({"box", {}, box}, report));
    ASSERT_EQ(w.triangles.size(), 12u);
    double volume = 0, texture = 0;
    for (gi::uvec3 const& t : w.triangles) {
        gi::dvec3 const a = w.positions[t.x], b = w.positions[t.y], c = w.positions[t.z];
        volume += glm::dot(a, glm::cross(b, c)) / 6;
        gi::vec2 const u = w.uv0[t.y] - w.uv0[t.x], v = w.uv0[t.z] - w.uv0[t.x];
        texture += 0.5 * std::abs(u.x * v.y - u.y * v.x);
        EXPECT_GT(glm::dot(glm::cross(b - a, c - a), gi::dvec3(w.normals[t.x])), 0);
    }
    EXPECT_NEAR(volume, 0.2 * 0.4 * 0.6, 1e-6);
    EXPECT_NEAR(texture, 1, 1e-6);
}

/// A wall 2 m before the camera and a block 1.5 m before it, seen through a lens: no triangle between the two.
TEST(Proxies, OfDepthMapsAreCutAtJumps)
{
    TemporaryFolder const folder;
    ar::Calibration c;
    c.camera = {ar::LensModel::radial_tangential, {80, 60}, 70, 70, 39.5, 29.5, {-0.1, 0.02, 0, 0, 0, 0, 0, 0}};
    ar::write_calibration(folder / "c.yaml", c);
    cv::Mat map(60, 80, CV_16UC1, cv::Scalar(2000));
    map(cv::Rect(20, 20, 20, 20)) = 1500;
    map(cv::Rect(60, 0, 4, 60)) = 0;
    cv::imwrite((folder / "d.png").string(), map);
    gi::Report report;
    ar::ProxyDepth depth;
    depth.file = folder / "d.png";
    depth.camera = folder / "c.yaml";
    depth.step_px = 2;
    // Looks along -z of the world, from y = 1.
    depth.world_from_camera = {{0, 1, 0}, glm::angleAxis(glm::pi<double>(), gi::dvec3(1, 0, 0))};
    gi::Mesh const mesh = ar::mesh_of(depth, report);
    EXPECT_EQ(report.losses().at("pixels of depth maps without a depth").count, 60u);
    EXPECT_GT(report.losses().at("triangles of depth maps left out at jumps").count, 40u);
    for (gi::uvec3 const& t : mesh.triangles) {
        double const z = mesh.positions[t.x].z;
        EXPECT_TRUE(std::abs(z + 2) < 1e-4 || std::abs(z + 1.5) < 1e-4) << z;
        EXPECT_NEAR(mesh.positions[t.y].z, z, 1e-4);
        EXPECT_NEAR(mesh.positions[t.z].z, z, 1e-4);
        EXPECT_GT(mesh.normals[t.x].z, 0.99) << "towards the camera";
    }
    // What a pixel sees is where the camera would draw it.
    for (std::size_t v = 0; v < mesh.positions.size(); v += 37) {
        gi::dvec3 const p = gi::inverse(depth.world_from_camera) * gi::dvec3(mesh.positions[v]);
        auto const pixel = ar::project(c.camera, p);
        ASSERT_TRUE(pixel);
        EXPECT_NEAR(pixel->x + 0.5, double(mesh.uv0[v].x) * 80, 1e-3);
        EXPECT_NEAR(pixel->y + 0.5, double(mesh.uv0[v].y) * 60, 1e-3);
    }

    // The same in metres, of half the size.
    gi::Picture half;
    half.width = 40;
    half.height = 30;
    gi::Layer& layer = half.add("depth", 1);
    for (std::size_t i = 0; i < layer.data.size(); ++i) layer.data[i] = 2;
    gi::write_exr(folder / "d.exr", half, gi::PixelType::single, report);
    depth.file = folder / "d.exr";
    depth.step_px = 1;
    EXPECT_EQ(ar::mesh_of(depth, report).triangles.size(), 2u * 39 * 29);
    depth.metres_per_unit = 1e-3;
    EXPECT_NEAR(ar::mesh_of(depth, report).positions[0].z, -2e-3, 1e-6);
    cv::imwrite((folder / "d.png").string(), cv::Mat(60, 40, CV_16UC1, cv::Scalar(2000)));
    depth.file = folder / "d.png";
    EXPECT_THROW(ar::mesh_of(depth, report), gi::InputError) << "another shape";
    cv::imwrite((folder / "d.png").string(), cv::Mat(60, 80, CV_8UC1, cv::Scalar(20)));
    EXPECT_THROW(ar::mesh_of(depth, report), gi::InputError) << "8 bits";
}

TEST(Proxies, OfDepthMapsSayWhereDepthIsUnknown)
{
    TemporaryFolder const folder;
    ar::Calibration c;
    c.camera = {ar::LensModel::pinhole, {40, 30}, 35, 35, 19.5, 14.5, {}};
    ar::write_calibration(folder / "c.yaml", c);
    std::vector<float> z(30 * 30, 2.0f);
    Imf::Header h({{0, 0}, {39, 29}}, Imath::Box2i({0, 0}, {29, 29}));
    h.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    Imf::FrameBuffer buffer;
    buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, z.data(), Imath::V2i(0), 30, 30));
    {
        Imf::OutputFile out((folder / "d.exr").c_str(), h);
        out.setFrameBuffer(buffer);
        out.writePixels(30);
    }
    gi::Report report;
    ar::ProxyDepth depth;
    depth.file = folder / "d.exr";
    depth.camera = folder / "c.yaml";
    depth.step_px = 1;
    EXPECT_EQ(ar::mesh_of(depth, report).triangles.size(), 2u * 29 * 29);
    gi::Report::Loss const loss = report.losses().at("depth maps not used as they are");
    EXPECT_EQ(loss.count, 1u);
    EXPECT_NE(loss.first.find("30 x 30 of 40 x 30"), std::string::npos) << loss.first;
    EXPECT_NE(loss.first.find("depth is unknown outside"), std::string::npos) << loss.first;
}

TEST(Proxies, TakeEstimatedAlbedos)
{
    TemporaryFolder const folder;
    ar::RealPlace real =
        real_of("real: {boxes: [{name: a, size_m: [1, 1, 1], albedo: estimate}], planes: [{name: b, "
                "centre_m: [0, 0, 0], size_m: [1, 1], texture: estimate}]}\n");
    real.estimates = folder / "albedo.yaml";
    gi::Report report;
    EXPECT_THROW(ar::real_scene(real, report), gi::InputError) << "no estimates yet";
    gi::write_png(folder / "b.png", 1, 1, std::array<unsigned char, 3>{255, 188, 0});
    std::vector<ar::AlbedoEntry> entries{{"a", {0.5, 0.25, 0.125}, {0.1, 0, 0}, 0, {}}};
    gi::write_text(real.estimates, ar::format_albedos(entries));
    EXPECT_THROW(ar::real_scene(real, report), gi::InputError) << "nothing is said of b";
    entries.push_back({"b", {0.1, 0.2, 0.3}, {}, 70, folder / "b.png"});
    gi::write_text(real.estimates, ar::format_albedos(entries));
    gi::Scene const scene = ar::real_scene(real, report);
    ASSERT_EQ(scene.materials.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k)
        if (scene.material_names[k] == "a")
            EXPECT_EQ(scene.materials[k].base_color, gi::vec3(0.5f, 0.25f, 0.125f));
        else
            EXPECT_EQ(scene.materials[k].base_color_map.texture, 0);
    EXPECT_EQ(report.losses().at("surfaces whose albedo no frame has shown: grey").count, 1u);
    EXPECT_EQ(ar::parse_albedos(ar::format_albedos({{"\"x\\: {", {}, {}, 1, {}}}), "f").at(0).name, "\"x\\: {");
}

} // namespace
} // namespace viewer::test
