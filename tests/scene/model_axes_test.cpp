// Axes and units of model files: a box of six colours, written in the frame of each format, must stand in the world
// as it is: red to the right (+x), cyan to the left, green up (+y), magenta down, blue towards the viewer (+z), yellow
// away. Its corners are at (1, 2, 3) and (2, 4, 6) m, so that no two axes can be exchanged.

#include "gi/core/report.h"
#include "gi/scene/load/assimp_convert.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"

#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

struct BoxFace {
    vec3 normal;
    vec3 color;
};
constexpr BoxFace kBox[6]{{{1, 0, 0}, {1, 0, 0}},  {{-1, 0, 0}, {0, 1, 1}}, {{0, 1, 0}, {0, 1, 0}},
                          {{0, -1, 0}, {1, 0, 1}}, {{0, 0, 1}, {0, 0, 1}},  {{0, 0, -1}, {1, 1, 0}}};
constexpr vec3 kLow{1, 2, 3}, kHigh{2, 4, 6};

/// Its four corners, counter-clockwise seen from outside.
std::array<vec3, 4> corners_of(BoxFace const& face)
{
    vec3 const a = glm::abs(face.normal), u = vec3{a.z, a.x, a.y}, v = glm::cross(face.normal, u);
    vec3 const middle = 0.5f * (kLow + kHigh), half = 0.5f * (kHigh - kLow);
    auto const at = [&](float s, float t) { return middle + half * (face.normal + s * u + t * v); };
    return {at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
}

/// The frame of a file: its numbers are `file_from_world` times those of the world.
struct FileFrame {
    mat3 file_from_world{1};
    bool is_left_handed() const { return glm::determinant(file_from_world) < 0; }

    /// Corners in the file, counter-clockwise by its numbers: in a left-handed frame, clockwise for who looks at it.
    std::array<vec3, 4> corners(BoxFace const& face) const
    {
        std::array<vec3, 4> c = corners_of(face);
        for (vec3& p : c) p = file_from_world * p;
        if (is_left_handed()) std::ranges::reverse(c);
        return c;
    }
};

class ModelAxes : public testing::Test {
protected:
    ModelAxes() : folder_(fs::temp_directory_path() / ("lightwell_axes_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_);
    }
    ~ModelAxes() override { fs::remove_all(folder_); }

    void write(std::string const& name, std::string const& text) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    /// Loads a file and expects the box.
    void expect_box(std::string const& name, std::string const& text)
    {
        SCOPED_TRACE(name + " " + where_);
        write(name, text);
        Report report;
        expect_box(load_scene((folder_ / name).string(), report), report);
    }
    static void expect_box(Scene const& scene, Report& report)
    {
        World const world = build_world(std::make_shared<Scene const>(scene), std::nullopt, report);
        ASSERT_EQ(world.triangles.size(), 12u);
        for (std::size_t t = 0; t < world.triangles.size(); ++t) {
            std::array<vec3, 3> p;
            for (int k = 0; k < 3; ++k)
                p[std::size_t(k)] = vec3(dvec3(world.positions[world.triangles[t][k]]) + world.origin);
            vec3 const normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
            BoxFace const* face = nullptr;
            for (BoxFace const& f : kBox)
                if (glm::length(f.normal - normal) < 1e-4f) face = &f;
            ASSERT_NE(face, nullptr) << normal.x << " " << normal.y << " " << normal.z;
            auto const corners = corners_of(*face);
            for (vec3 const corner : p)
                EXPECT_TRUE(std::ranges::any_of(corners, [&](vec3 c) { return glm::length(c - corner) < 1e-4f; }))
                    << corner.x << " " << corner.y << " " << corner.z;
            vec3 color = world.materials[world.triangle_material[t]].base_color;
            if (!world.colors.empty()) color = color * world.colors[world.triangles[t].x];
            EXPECT_LT(glm::length(color - face->color), 1e-4f)
                << "normal " << normal.x << " " << normal.y << " " << normal.z << ", color " << color.x << " "
                << color.y << " " << color.z;
        }
        EXPECT_TRUE(report.losses().empty()) << report.losses().begin()->first;
    }

    fs::path folder_;
    std::string where_;
};

std::string numbers(vec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

/// @param settings  lines of GlobalSettings
std::string fbx_box(FileFrame const& frame, float unit_m, std::string const& settings)
{
    std::string vertices, polygons, materials, objects, connections;
    for (int f = 0; f < 6; ++f) {
        for (vec3 const p : frame.corners(kBox[f])) {
            vec3 const q = p / unit_m;
            vertices += fmt::format("{}{},{},{}", vertices.empty() ? "" : ",", q.x, q.y, q.z);
        }
        polygons += fmt::format("{}{},{},{},{}", f > 0 ? "," : "", 4 * f, 4 * f + 1, 4 * f + 2, -(4 * f + 3) - 1);
        materials += fmt::format("{}{}", f > 0 ? "," : "", f);
        vec3 const c = kBox[f].color;
        objects +=
            fmt::format("\tMaterial: {}, \"Material::m{}\", \"\" {{\n\t\tVersion: 102\n\t\tShadingModel: "
                        "\"lambert\"\n\t\tProperties70:  {{\n\t\t\tP: \"DiffuseColor\", \"Color\", \"\", "
                        "\"A\",{},{},{}\n\t\t\tP: \"DiffuseFactor\", \"Number\", \"\", \"A\",1\n\t\t}}\n\t}}\n",
                        300 + f, f, c.x, c.y, c.z);
        connections += fmt::format("\tC: \"OO\",{},200\n", 300 + f);
    }
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: "
           "7400\n}\nGlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n" +
           settings +
           "\t}\n}\nObjects:  {\n\tGeometry: 100, \"Geometry::g\", \"Mesh\" {\n\t\tVertices: *72 {\n\t\t\ta: " +
           vertices + "\n\t\t}\n\t\tPolygonVertexIndex: *24 {\n\t\t\ta: " + polygons +
           "\n\t\t}\n\t\tGeometryVersion: 124\n\t\tLayerElementMaterial: 0 {\n\t\t\tVersion: 101\n\t\t\tName: "
           "\"\"\n\t\t\tMappingInformationType: \"ByPolygon\"\n\t\t\tReferenceInformationType: "
           "\"IndexToDirect\"\n\t\t\tMaterials: *6 {\n\t\t\t\ta: " +
           materials +
           "\n\t\t\t}\n\t\t}\n\t\tLayer: 0 {\n\t\t\tVersion: 100\n\t\t\tLayerElement:  {\n\t\t\t\tType: "
           "\"LayerElementMaterial\"\n\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t}\n\t}\n\tModel: 200, \"Model::m\", "
           "\"Mesh\" "
           "{\n\t\tVersion: 232\n\t}\n" +
           objects + "}\nConnections:  {\n\tC: \"OO\",200,0\n\tC: \"OO\",100,200\n" + connections + "}\n";
}

std::string fbx_setting(std::string const& name, int value)
{
    return fmt::format("\t\tP: \"{}\", \"int\", \"Integer\", \"\",{}\n", name, value);
}
std::string fbx_unit(double centimetres)
{
    return fmt::format("\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{}\n", centimetres);
}

TEST_F(ModelAxes, All48SystemsOfFbx)
{
    std::array<int, 3> axes{0, 1, 2}; // of the file: to the right, up, towards the viewer
    int count = 0;
    do {
        for (int signs = 0; signs < 8; ++signs) {
            FileFrame frame{mat3(0)};
            std::string settings;
            for (int k = 0; k < 3; ++k) {
                int const sign = (signs >> k & 1) != 0 ? -1 : 1;
                frame.file_from_world[k][axes[std::size_t(k)]] = float(sign);
                char const* const names[]{"CoordAxis", "UpAxis", "FrontAxis"};
                settings += fbx_setting(names[k], axes[std::size_t(k)]) +
                            fbx_setting(std::string(names[k]) + "Sign", sign);
            }
            where_ = fmt::format("axes {} {} {}, signs {}", axes[0], axes[1], axes[2], signs);
            expect_box("a.fbx", fbx_box(frame, 0.01f, settings + fbx_unit(1)));
            ++count;
        }
    } while (std::ranges::next_permutation(axes).found);
    EXPECT_EQ(count, 48);
}

TEST_F(ModelAxes, UnitsOfFbx)
{
    for (double const centimetres : {1.0, 100.0, 2.54, 30.48, 0.1}) {
        where_ = fmt::format("{} cm", centimetres);
        expect_box("a.fbx", fbx_box({}, float(0.01 * centimetres), fbx_unit(centimetres)));
    }
    where_ = "nothing stated";
    expect_box("a.fbx", fbx_box({}, 0.01f, ""));
}

/// Assimp 5.4 and later turn the root themselves (FBXConverter.cpp, correctRootTransform); nothing is turned twice.
TEST_F(ModelAxes, RootsThatAssimpHasTurned)
{
    FileFrame const z_up{mat3{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
    write("a.fbx",
          fbx_box(z_up, 0.01f,
                  fbx_setting("UpAxis", 2) + fbx_setting("FrontAxis", 1) + fbx_setting("FrontAxisSign", -1)));
    for (bool const is_turned : {false, true}) {
        Assimp::Importer importer;
        aiScene const* const read = importer.ReadFile((folder_ / "a.fbx").string(), aiProcess_Triangulate);
        ASSERT_NE(read, nullptr) << importer.GetErrorString();
        if (is_turned)
            read->mRootNode->mTransformation = aiMatrix4x4(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
        SCOPED_TRACE(is_turned);
        Report report;
        expect_box(convert_assimp(*read, folder_ / "a.fbx", report), report);
    }
}

TEST_F(ModelAxes, AxesThatAreNoneAreTold)
{
    for (std::string const& settings :
         {fbx_setting("UpAxis", 2), fbx_setting("UpAxis", 7), fbx_setting("CoordAxis", -1)}) {
        write("a.fbx", fbx_box({}, 0.01f, settings));
        Report report;
        Scene const scene = load_scene((folder_ / "a.fbx").string(), report);
        EXPECT_EQ(report.losses().begin()->first, "axes of FBX that are no three directions, taken as y up")
            << settings;
    }
}

std::string collada_box(FileFrame const& frame, float unit_m, std::string const& asset)
{
    std::string effects, materials, positions, triangles, bind;
    for (int f = 0; f < 6; ++f) {
        for (vec3 const p : frame.corners(kBox[f])) positions += numbers(p / unit_m) + " ";
        effects += fmt::format("<effect id='e{0}'><profile_COMMON><technique sid='t'><phong><diffuse><color>{1} "
                               "1</color></diffuse><specular><color>0 0 0 "
                               "1</color></specular></phong></technique></profile_COMMON></effect>",
                               f, numbers(kBox[f].color));
        materials += fmt::format("<material id='m{0}' name='m{0}'><instance_effect url='#e{0}'/></material>", f);
        triangles += fmt::format("<polylist material='s{0}' count='1'><input semantic='VERTEX' source='#v' "
                                 "offset='0'/><vcount>4</vcount><p>{1} {2} {3} {4}</p></polylist>",
                                 f, 4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3);
        bind += fmt::format("<instance_material symbol='s{0}' target='#m{0}'/>", f);
    }
    return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' "
           "version='1.4.1'><asset>" +
           asset + "</asset><library_effects>" + effects + "</library_effects><library_materials>" + materials +
           "</library_materials><library_geometries><geometry id='g'><mesh><source id='p'><float_array id='pa' "
           "count='72'>" +
           positions +
           "</float_array><technique_common><accessor source='#pa' count='24' stride='3'><param name='X' "
           "type='float'/><param name='Y' type='float'/><param name='Z' "
           "type='float'/></accessor></technique_common>"
           "</source><vertices id='v'><input semantic='POSITION' source='#p'/></vertices>" +
           triangles +
           "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id='s'><node "
           "id='n'><instance_geometry url='#g'><bind_material><technique_common>" +
           bind +
           "</technique_common></bind_material></instance_geometry></node></visual_scene></library_visual_scenes>"
           "<scene><instance_visual_scene url='#s'/></scene></COLLADA>";
}

/// COLLADA 1.4.1, up_axis: X_UP has -y to the right and z in; Y_UP x and z; Z_UP x and -y.
TEST_F(ModelAxes, AxesAndUnitsOfCollada)
{
    FileFrame const y_up, x_up{mat3{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}},
        z_up{mat3{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}};
    for (auto const& [axis, frame] : {std::pair{"Y_UP", y_up}, std::pair{"X_UP", x_up}, std::pair{"Z_UP", z_up}})
        for (float const unit : {1.0f, 0.01f, 0.0254f}) {
            where_ = fmt::format("{} {}", axis, unit);
            expect_box("a.dae",
                       collada_box(frame, unit,
                                   fmt::format("<unit meter='{}' name='u'/><up_axis>{}</up_axis>", unit, axis)));
        }
    where_ = "nothing stated";
    expect_box("a.dae", collada_box(y_up, 1, ""));
}

TEST_F(ModelAxes, ObjAndPlyAreTakenAsTheyAre)
{
    std::string obj = "mtllib a.mtl\n", mtl, ply, faces;
    for (int f = 0; f < 6; ++f) {
        mtl += fmt::format("newmtl m{}\nKd {}\nKs 0 0 0\n", f, numbers(kBox[f].color));
        for (vec3 const p : corners_of(kBox[f])) {
            obj += "v " + numbers(p) + "\n";
            ply += numbers(p) + "\n";
        }
        obj += fmt::format("usemtl m{}\nf -4 -3 -2 -1\n", f);
        faces += fmt::format("4 {} {} {} {} {}\n", 4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3,
                             numbers(255.0f * kBox[f].color));
    }
    write("a.mtl", mtl);
    expect_box("a.obj", obj);
    expect_box("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\nproperty float y\nproperty float "
               "z\nelement face 6\nproperty list uchar int vertex_indices\nproperty uchar red\nproperty uchar "
               "green\nproperty uchar blue\nend_header\n" +
                   ply + faces);
}

std::string base64(std::string const& bytes)
{
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (int k = 3; k >= 0; --k)
            out += i + std::size_t(3 - k) <= bytes.size() ? kDigits[bits >> (6 * k) & 63] : '=';
    }
    return out;
}

TEST_F(ModelAxes, GltfIsTakenAsItIs)
{
    std::string bytes, accessors, views, primitives, materials;
    for (int f = 0; f < 6; ++f) {
        std::array<vec3, 4> const c = corners_of(kBox[f]);
        for (int const i : {0, 1, 2, 0, 2, 3}) {
            vec3 const p = c[std::size_t(i)];
            bytes.append(reinterpret_cast<char const*>(&p), sizeof p);
        }
        vec3 const low = glm::min(c[0], c[2]), high = glm::max(c[0], c[2]), k = kBox[f].color;
        std::string const comma = f > 0 ? "," : "";
        views += comma + fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":72}})", 72 * f);
        accessors += comma + fmt::format(R"({{"bufferView":{},"componentType":5126,"count":6,"type":"VEC3",)"
                                         R"("min":[{},{},{}],"max":[{},{},{}]}})",
                                         f, low.x, low.y, low.z, high.x, high.y, high.z);
        primitives += comma + fmt::format(R"({{"attributes":{{"POSITION":{}}},"material":{}}})", f, f);
        materials += comma + fmt::format(R"({{"pbrMetallicRoughness":{{"baseColorFactor":[{},{},{},1],)"
                                         R"("metallicFactor":0}}}})",
                                         k.x, k.y, k.z);
    }
    expect_box("a.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                         R"("meshes":[{"primitives":[)" +
                             primitives + R"(]}],"materials":[)" + materials + R"(],"accessors":[)" + accessors +
                             R"(],"bufferViews":[)" + views +
                             R"(],"buffers":[{"byteLength":432,"uri":"data:application/octet-stream;base64,)" +
                             base64(bytes) + R"("}]})");
}

/// The text format of DirectX: left-handed, y up, z away from the viewer; faces clockwise seen from outside.
TEST_F(ModelAxes, DirectX)
{
    FileFrame const frame{mat3{{1, 0, 0}, {0, 1, 0}, {0, 0, -1}}};
    std::string vertices, faces, indices, materials;
    for (int f = 0; f < 6; ++f) {
        std::array<vec3, 4> c = corners_of(kBox[f]);
        std::ranges::reverse(c); // clockwise for who looks at it
        for (std::size_t k = 0; k < 4; ++k) {
            vec3 const p = frame.file_from_world * c[k];
            vertices += fmt::format("{};{};{};{}\n", p.x, p.y, p.z, f == 5 && k == 3 ? ";" : ",");
        }
        faces += fmt::format("4;{},{},{},{};{}\n", 4 * f, 4 * f + 1, 4 * f + 2, 4 * f + 3, f == 5 ? ";" : ",");
        indices += fmt::format("{}{}\n", f, f == 5 ? ";;" : ",");
        vec3 const k = kBox[f].color;
        materials +=
            fmt::format("Material {{\n{};{};{};1.0;;\n0.0;\n0.0;0.0;0.0;;\n0.0;0.0;0.0;;\n}}\n", k.x, k.y, k.z);
    }
    expect_box("a.x", "xof 0303txt 0032\nMesh box {\n24;\n" + vertices + "6;\n" + faces +
                          "MeshMaterialList {\n6;\n6;\n" + indices + materials + "}\n}\n");
}

} // namespace
} // namespace gi::test
