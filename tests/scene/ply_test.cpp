// PLY: what the many programs that write it write.

#include "gi/core/error.h"
#include "gi/core/report.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/ply/ply_values.h"
#include "gi/scene/model/world.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

constexpr char const* kPlySquare = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
constexpr char const* kXyz = "property float x\nproperty float y\nproperty float z\n";

class PlyFolder : public testing::Test {
protected:
    PlyFolder() : folder_(fs::temp_directory_path() / ("lightwell_ply_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_);
    }
    ~PlyFolder() override { fs::remove_all(folder_); }

    Scene load_bytes(std::string const& bytes)
    {
        std::ofstream(folder_ / "a.ply", std::ios::binary) << bytes;
        return load_scene((folder_ / "a.ply").string(), report_);
    }
    Scene load(std::string const& header, std::string const& values)
    {
        return load_bytes("ply\nformat ascii 1.0\n" + header + "end_header\n" + values);
    }
    std::string refusal(std::string const& bytes)
    {
        try {
            load_bytes(bytes);
        } catch (InputError const& e) {
            return e.what();
        }
        ADD_FAILURE() << bytes << " was read";
        return {};
    }
    void picture(std::string const& name, int value) const
    {
        cv::imwrite((folder_ / name).string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(value, value, value)));
    }
    std::uint64_t lost(std::string const& what) const
    {
        auto const losses = report_.losses();
        auto const it = losses.find(what);
        return it == losses.end() ? 0 : it->second.count;
    }

    fs::path folder_;
    Report report_;
};

std::string element(std::string const& name, int rows, std::string const& properties)
{
    return "element " + name + " " + std::to_string(rows) + "\n" + properties;
}
std::string square_and(std::string const& rest) { return element("vertex", 4, kXyz) + rest; }

/// Corners of all triangles, by their positions as digits: "00 10 11".
std::string corners_of(Scene const& scene)
{
    std::string text;
    for (Mesh const& mesh : scene.meshes)
        for (uvec3 const t : mesh.triangles) {
            text += text.empty() ? "" : ", ";
            for (unsigned const v : {t.x, t.y, t.z}) {
                vec3 const p = mesh.positions.at(v);
                text += (v == t.x ? "" : " ") + std::to_string(int(p.x)) + std::to_string(int(p.y));
            }
        }
    return text;
}

TEST_F(PlyFolder, StripsAndTheirRestarts)
{
    std::string const list = "property list int int vertex_indices\n";
    struct Case {
        char const *header, *values, *triangles;
    };
    for (auto const& [type, strip, triangles] :
         {Case{"int int", "7 0 1 3 -1 1 2 3", "00 10 01, 10 11 01"},
          Case{"uchar int", "4 0 1 3 2", "00 10 01, 01 10 11"},
          Case{"uchar uint", "7 0 1 3 4294967295 1 2 3", "00 10 01, 10 11 01"},
          Case{"int short", "8 -1 0 1 3 -1 -1 0 1", "00 10 01"}, Case{"int int", "6 0 1 3 3 2 2", "00 10 01"},
          Case{"int int", "9 0 1 -1 1 2 3 0 -1 2", "10 11 01, 01 11 00"}}) {
        Scene const scene =
            load(square_and(element("tristrips", 1, std::string("property list ") + type + " vertex_indices\n")),
                 std::string(kPlySquare) + strip + "\n");
        EXPECT_EQ(corners_of(scene), triangles) << strip;
    }
    Scene const two =
        load(square_and(element("tristrips", 2, list)), std::string(kPlySquare) + "3 0 1 3\n3 1 2 3\n");
    EXPECT_EQ(corners_of(two), "00 10 01, 10 11 01") << "several strips";
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(PlyFolder, ElementsInAnyOrderWithListsAnywhere)
{
    std::string const faces = element("face", 1, "property list uchar int vertex_index\n");
    EXPECT_EQ(corners_of(load(faces + element("vertex", 4, kXyz), "4 0 1 2 3\n" + std::string(kPlySquare))),
              "00 10 11, 00 11 01");
    EXPECT_TRUE(report_.losses().empty());
    Scene const scene =
        load(element("note", 2, "property list uchar uchar text\nproperty int n\n") +
                 element("vertex", 4,
                         "property list uchar float extra\n" + std::string(kXyz) + "property float quality\n") +
                 element("edge", 1, "property int vertex1\nproperty int vertex2\n") +
                 element("face", 1,
                         "property uchar flags\nproperty list uchar float weights\nproperty list uchar ushort "
                         "vertex_indices\n") +
                 element("empty", 3, ""),
             "2 65 66 1\n0 2\n0 0 0 0 .5\n2 5 6 1 0 0 .5\n1 7 1 1 0 .5\n0 0 1 0 .5\n0 1\n9 3 1 2 3 4 0 1 2 3\n");
    EXPECT_EQ(corners_of(scene), "00 10 11, 00 11 01");
    EXPECT_EQ(lost("elements of PLY that are no vertices, faces or strips, skipped"), 3u);
    EXPECT_EQ(lost("properties of PLY that are not used"), 4u + 4u + 1u + 1u);
    EXPECT_NE(report_.losses().at("properties of PLY that are not used").first.find("a.ply: vertex.extra"),
              std::string::npos);
}

/// Appends numbers as bytes.
class PlyBytes {
public:
    explicit PlyBytes(bool big_endian) : swapped_(big_endian == (std::endian::native == std::endian::little)) {}
    template <class T>
    PlyBytes& add(T value)
    {
        std::string bytes(sizeof(T), '\0');
        std::memcpy(bytes.data(), &value, sizeof(T));
        if (swapped_) std::ranges::reverse(bytes);
        text += bytes;
        return *this;
    }
    void add(std::string const& type, double v)
    {
        if (type == "char" || type == "int8") add(std::int8_t(v));
        if (type == "uchar" || type == "uint8") add(std::uint8_t(v));
        if (type == "short" || type == "int16") add(std::int16_t(v));
        if (type == "ushort" || type == "uint16") add(std::uint16_t(v));
        if (type == "int" || type == "int32") add(std::int32_t(v));
        if (type == "uint" || type == "uint32") add(std::uint32_t(v));
        if (type == "float" || type == "float32") add(float(v));
        if (type == "double" || type == "float64") add(v);
    }

    std::string text;

private:
    bool swapped_;
};

TEST_F(PlyFolder, AllTypesOfAllFormats)
{
    constexpr double kCorners[4][3]{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (std::string const format : {"ascii", "binary_little_endian", "binary_big_endian"})
        for (std::string const type :
             {"char", "uchar", "short", "ushort", "int", "uint", "float", "double", "int8", "uint8", "int16",
              "uint16", "int32", "uint32", "float32", "float64"}) {
            bool const is_text = format == "ascii", is_float = type[0] == 'f' || type[0] == 'd';
            std::string const of_count = is_float ? "uchar" : type;
            PlyBytes values(format == "binary_big_endian");
            auto const add = [&](std::string const& t, double v) {
                if (is_text)
                    values.text += std::to_string(int(v)) + "\n";
                else
                    values.add(t, v);
            };
            for (auto const& corner : kCorners)
                for (double const x : corner) add(type, x);
            add(of_count, 4);
            for (int const index : {0, 1, 2, 3}) add(type, index);
            Scene const scene = load_bytes(
                "ply\nformat " + format + " 1.0\ncomment made\nobj_info made\nelement vertex 4\nproperty " + type +
                " x\nproperty " + type + " y\nproperty " + type + " z\nelement face 1\nproperty list " + of_count +
                " " + type + " vertex_indices\nend_header\n" + values.text);
            EXPECT_EQ(corners_of(scene), "00 10 11, 00 11 01") << format << " " << type;
        }
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(PlyFolder, LineEndsOfHeaders)
{
    for (std::string const end : {"\n", "\r\n", "\r"}) {
        PlyBytes values(false);
        // The first value begins with a byte that is a line end.
        values.add(std::uint8_t('\n'));
        for (float const x : {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}) values.add(x);
        values.add(std::uint8_t(4));
        for (std::int32_t const i : {0, 1, 2, 3}) values.add(i);
        std::string header;
        for (std::string const line :
             {"ply", "format binary_little_endian 1.0", "element tag 1", "property uchar t", "element vertex 4",
              "property float x", "property float y", "property float z", "element face 1",
              "property list uchar int vertex_indices", "end_header"})
            header += line + end;
        EXPECT_EQ(corners_of(load_bytes(header + values.text)), "00 10 11, 00 11 01") << int(end[0]);
    }
}

TEST_F(PlyFolder, VertexColorsAreSrgbAndTheAlbedo)
{
    struct Case {
        char const *type, *values; ///< of orange
    };
    for (auto const& [type, orange] :
         {Case{"uchar", "255 128 0"}, Case{"uint8", "255 128 0"}, Case{"ushort", "65535 32896 0"},
          Case{"float", "1 0.50196078 0"}, Case{"double", "1 0.50196078 0"}}) {
        std::string const t = type;
        for (std::string const prefix : {"", "diffuse_"}) {
            std::string values;
            for (char const* p : {"0 0 0 ", "1 0 0 ", "1 1 0 ", "0 1 0 "})
                values += p + std::string(orange) + "\n";
            Scene const scene = load(element("vertex", 4,
                                             kXyz + ("property " + t + " " + prefix + "red\nproperty " + t + " " +
                                                     prefix + "green\nproperty " + t + " " + prefix + "blue\n")) +
                                         element("face", 1, "property list uchar int vertex_indices\n"),
                                     values + "4 0 1 2 3\n");
            Mesh const& mesh = scene.meshes.at(0);
            for (vec3 const c : mesh.colors) EXPECT_LT(glm::length(c - vec3{1, 0.21586f, 0}), 1e-5f) << type;
            EXPECT_EQ(mesh.colors.size(), mesh.positions.size());
            Material const& m = scene.materials.at(std::size_t(mesh.material));
            EXPECT_EQ(m.base_color, vec3{1});
            EXPECT_EQ(m.specular, 0);
        }
    }
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(PlyFolder, BytesWrittenAsWiderIntegersAreDividedBy255)
{
    std::string const loss = "colours of integers of more than 8 bits that stay within 255, divided by 255",
                      face = "property list uchar int vertex_indices\n";
    std::uint64_t expected = 0;
    for (std::string const type : {"short", "ushort", "int", "uint", "int64", "uint64"}) {
        std::string const rgb =
            "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
        Scene const scene =
            load(element("vertex", 4, kXyz + rgb) + element("face", 1, face),
                 "0 0 0 255 128 0\n1 0 0 255 128 0\n1 1 0 255 128 0\n0 1 0 255 128 0\n4 0 1 2 3\n");
        for (vec3 const c : scene.meshes.at(0).colors)
            EXPECT_LT(glm::length(c - vec3{1, 0.21586f, 0}), 1e-4f) << type;
        EXPECT_EQ(lost(loss), expected += 4) << type;
        Scene const faces = load(square_and(element("face", 2, face + rgb)),
                                 std::string(kPlySquare) + "3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n");
        Mesh const& mesh = faces.meshes.at(0);
        EXPECT_LT(glm::length(mesh.colors.at(mesh.triangles.at(1).x) - vec3{0, 1, 0}), 1e-5f) << type;
        EXPECT_EQ(lost(loss), expected += 2) << type;
    }
    load(element("vertex", 4, kXyz + std::string("property int red\nproperty int green\nproperty int blue\n")) +
             element("face", 1, face),
         "0 0 0 256 0 0\n1 0 0 0 0 0\n1 1 0 0 0 0\n0 1 0 0 0 0\n4 0 1 2 3\n");
    EXPECT_EQ(lost(loss), expected) << "256 is no byte";
}

TEST_F(PlyFolder, ColorsOfFacesAndAlpha)
{
    Scene const scene =
        load(square_and(element("face", 2,
                                "property list uchar int vertex_indices\nproperty uchar red\nproperty uchar "
                                "green\nproperty uchar blue\nproperty uchar alpha\n")),
             std::string(kPlySquare) + "3 0 1 2 255 0 0 255\n3 0 2 3 0 255 0 7\n");
    Mesh const& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    for (unsigned k = 0; k < 3; ++k) {
        EXPECT_EQ(mesh.colors.at(mesh.triangles[0][int(k)]), (vec3{1, 0, 0}));
        EXPECT_EQ(mesh.colors.at(mesh.triangles[1][int(k)]), (vec3{0, 1, 0}));
    }
    EXPECT_EQ(lost("vertices with an alpha of their own, taken as opaque"), 3u);
}

TEST_F(PlyFolder, TexturesByCoordinatesOfVertices)
{
    picture("my t.png", 200);
    for (auto const& [u, v] : {std::pair{"s", "t"}, std::pair{"u", "v"}, std::pair{"texture_u", "texture_v"},
                               std::pair{"texture_s", "texture_t"}, std::pair{"tx", "ty"}}) {
        Scene const scene = load(
            "comment TextureFile my t.png\n" +
                element("vertex", 4, kXyz + std::string("property float ") + u + "\nproperty float " + v + "\n") +
                element("face", 1, "property list uchar int vertex_indices\n"),
            "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n");
        Mesh const& mesh = scene.meshes.at(0);
        ASSERT_EQ(mesh.uv0.size(), mesh.positions.size()) << u;
        for (std::size_t i = 0; i < mesh.uv0.size(); ++i)
            EXPECT_EQ(mesh.uv0[i], (vec2{mesh.positions[i].x, 1 - mesh.positions[i].y})) << u;
        Material const& m = scene.materials.at(std::size_t(mesh.material));
        ASSERT_GE(m.base_color_map.texture, 0) << u;
        EXPECT_EQ(m.base_color, vec3{1});
        EXPECT_TRUE(scene.textures.textures.at(std::size_t(m.base_color_map.texture)).srgb);
    }
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(PlyFolder, TexturesByCoordinatesOfFaces)
{
    picture("one.png", 50);
    picture("two.png", 250);
    std::string const faces = "property list uchar int vertex_indices\nproperty list uchar float texcoord\n";
    std::string const values = std::string(kPlySquare) + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 6 0 0 .5 .5 0 1\n";
    Scene const scene = load("comment TextureFile one.png\n" + square_and(element("face", 2, faces)), values);
    Mesh const& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.triangles.size(), 2u);
    auto const uv = [&](int t, int corner) { return mesh.uv0.at(mesh.triangles[std::size_t(t)][corner]); };
    EXPECT_EQ(uv(0, 2), (vec2{1, 0}));
    EXPECT_EQ(uv(1, 1), (vec2{0.5f, 0.5f})) << "the same vertex";
    EXPECT_EQ(uv(1, 2), (vec2{0, 0}));
    EXPECT_GE(scene.materials.at(std::size_t(mesh.material)).base_color_map.texture, 0);

    Scene const both = load("comment TextureFile one.png\ncomment TextureFile two.png\n" +
                                square_and(element("face", 2, faces + "property int texnumber\n")),
                            std::string(kPlySquare) + "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0 0 .5 .5 0 1 0\n");
    ASSERT_EQ(both.meshes.size(), 2u);
    for (Mesh const& m : both.meshes) {
        Material const& material = both.materials.at(std::size_t(m.material));
        Texture const& t = both.textures.textures.at(std::size_t(material.base_color_map.texture));
        bool const is_first = glm::length(m.uv0[m.triangles[0][2]] - vec2{1, 0}) < 1e-6f;
        EXPECT_EQ(both.textures.texels.at(t.first).r, is_first ? 250 : 50);
    }
    EXPECT_TRUE(report_.losses().empty());

    Scene const unknown =
        load("comment TextureFile one.png\n" + square_and(element("face", 2, faces + "property int texnumber\n")),
             std::string(kPlySquare) + "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 5 0 0 .5 .5 0 3\n");
    EXPECT_EQ(unknown.meshes.size(), 2u);
    EXPECT_EQ(lost("faces of PLY whose texnumber has no TextureFile"), 1u);
    EXPECT_EQ(lost("texture coordinates of faces that are not two for each corner, skipped"), 1u);
    load("comment TextureFile one.png\n" +
             square_and(element("face", 1, "property list uchar int vertex_indices\n")),
         std::string(kPlySquare) + "4 0 1 2 3\n");
    EXPECT_EQ(lost("textures of PLY without texture coordinates, skipped"), 1u);
    load("comment TextureFile gone.png\n" + square_and(element("face", 2, faces)), values);
    EXPECT_EQ(lost("textures that could not be read"), 1u);
}

TEST_F(PlyFolder, VerticesAreJoinedBesideAMeshWithColors)
{
    picture("one.png", 50);
    Scene const scene =
        load("comment TextureFile one.png\n" +
                 element("vertex", 4,
                         kXyz + std::string("property float s\nproperty float t\nproperty uchar "
                                            "red\nproperty uchar green\nproperty uchar blue\n")) +
                 element("face", 3, "property list uchar int vertex_indices\nproperty int texnumber\n"),
             "0 0 0 0 0 255 0 0\n1 0 0 1 0 0 255 0\n1 1 0 1 1 0 0 255\n0 1 0 0 1 9 9 9\n"
             "3 0 1 2 0\n3 0 2 3 0\n3 0 1 3 -1\n");
    ASSERT_EQ(scene.meshes.size(), 2u);
    for (Mesh const& mesh : scene.meshes)
        EXPECT_EQ(mesh.positions.size(), mesh.colors.empty() ? 4u : 3u) << mesh.triangles.size();
}

TEST_F(PlyFolder, LinesOfHeadersThatAreNotUnderstoodAreNamed) // Blender 2.47
{
    Scene const scene = load("Created by Blender3D 247 - www.blender.org\n" +
                                 square_and(element("face", 1, "property list uchar int vertex_indices\n")),
                             std::string(kPlySquare) + "4 0 1 2 3\n");
    EXPECT_EQ(corners_of(scene), "00 10 11, 00 11 01");
    EXPECT_NE(report_.losses()
                  .at("lines of headers of PLY that are not understood, skipped")
                  .first.find("line 3: Created"),
              std::string::npos);
}

TEST_F(PlyFolder, TextBesideWhatTheHeaderNamesIsCountedOrRefused)
{
    std::string const face = element("face", 1, "property list uchar int vertex_indices\n"),
                      loss = "values of PLY that its header does not name, skipped", square = kPlySquare;
    EXPECT_EQ(corners_of(load(square_and(face), "0 0 0 7\n1 0 0 7 8\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n")),
              "00 10 11, 00 11 01");
    EXPECT_EQ(lost(loss), 6u);
    EXPECT_NE(report_.losses().at(loss).first.find("a.ply: line 10"), std::string::npos);
    EXPECT_EQ(corners_of(load(square_and(face), square + "4 0 1 2 3\n\n4 0 1\n 2 \n")), "00 10 11, 00 11 01");
    EXPECT_EQ(lost(loss), 6u + 4u) << "lines behind the last row";
    EXPECT_EQ(corners_of(load(square_and(face), "0 0 0 1 0 0 1 1 0 0 1 0 4 0 1 2 3 9\n")), "00 10 11, 00 11 01");
    EXPECT_EQ(lost(loss), 6u + 4u + 1u) << "all on one line";
    std::string const header = "ply\nformat ascii 1.0\n" + square_and(face) + "end_header\n";
    EXPECT_NE(refusal(header + "0 0 0\n1 0\n1 1 0\n0 1 0\n4 0 1 2 3\n").find("line 11: it has fewer values"),
              std::string::npos);
}

TEST_F(PlyFolder, BytesBehindTheLastRowAreCounted)
{
    PlyBytes values(false);
    for (float const x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f}) values.add(x);
    values.add(std::uint8_t(3));
    for (std::int32_t const i : {0, 1, 2}) values.add(i);
    std::string const file = "ply\nformat binary_little_endian 1.0\n" + element("vertex", 3, kXyz) +
                             element("face", 1, "property list uchar int vertex_indices\n") + "end_header\n" +
                             values.text;
    load_bytes(file + "\n");
    EXPECT_TRUE(report_.losses().empty());
    load_bytes(file + "abc");
    EXPECT_EQ(lost("bytes of PLY behind those that its header names, skipped"), 3u);
}

TEST_F(PlyFolder, NormalsAreKeptAndPointsCounted)
{
    Scene const scene = load(
        element("vertex", 4, kXyz + std::string("property float nx\nproperty float ny\nproperty float nz\n")) +
            element("face", 3, "property list uchar int vertex_indices\n"),
        "0 0 0 0 0 2\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n4 0 1 2 3\n2 0 1\n1 0\n");
    ASSERT_EQ(scene.meshes.size(), 1u);
    for (vec3 const n : scene.meshes[0].normals) EXPECT_EQ(n, (vec3{0, 0, 1}));
    EXPECT_EQ(lost("points and lines skipped"), 2u);
}

TEST_F(PlyFolder, MistakesAreToldWithTheirLine)
{
    std::string const begin = "ply\nformat ascii 1.0\n", vertices = "element vertex 3\n" + std::string(kXyz),
                      faces = "element face 1\nproperty list uchar int vertex_indices\n", end = "end_header\n",
                      three = "0 0 0\n1 0 0\n0 1 0\n";
    struct Case {
        std::string file, part;
    };
    for (auto const& [file, part] :
         {Case{"ply", "no line end_header"}, Case{"plx\nend_header\n", "line 1 of its header: it is not"},
          Case{"ply\nelement vertex 1\nend_header\n", "no line format"},
          Case{"ply\nformat text 1.0\nend_header\n", "line 2 of its header: 'text' is no format"},
          Case{begin + "property float x\n" + end, "line 3 of its header: a property before"},
          Case{begin + "element vertex x\n" + end, "line 3 of its header: 'element vertex' needs the number"},
          Case{begin + "element vertex 1\nproperty half x\n" + end, "line 4 of its header: 'half' is no type"},
          Case{begin + "element vertex 1\nproperty list float int x\n" + end, "counted by an integer"},
          Case{begin + "element vertex 1\nproperty float\n" + end, "a name is missing"},
          Case{begin + vertices + end + three, "it has no faces"},
          Case{begin + "element vertex 1\nproperty float x\n" + faces + end + "0\n3 0 0 0\n", "no x, y and z"},
          Case{begin + vertices + faces + end + "0 0 0\n1 zero 0\n0 1 0\n3 0 1 2\n",
               "line 11: 'zero' is no number"},
          Case{begin + vertices + faces + end + three + "3 0 1 3\n", "a vertex that the file has not"},
          Case{begin + vertices + faces + end + three + "3 0 1 -1\n", "a vertex that the file has not"},
          Case{begin + vertices + faces + end + three + "3 0 1\n", "ends"},
          Case{begin + vertices + faces + end + three + "-3 0 1 2\n", "has no length"},
          Case{begin + vertices + faces + end + three + "200 0 1 2\n", "longer than the file"},
          Case{begin + "element vertex 60000000000\n" + kXyz + end + three, "ends before the 60000000000 rows"},
          Case{begin + vertices + "element face 1\nproperty list uchar int other\n" + end + three + "3 0 1 2\n",
               "has no list vertex_indices"}})
        EXPECT_NE(refusal(file).find(part), std::string::npos) << file << "\nsays: " << refusal(file);
}

TEST(PlyTypes, LargestValues)
{
    EXPECT_EQ(largest_of(PlyType::uint8), 255);
    EXPECT_EQ(largest_of(PlyType::int8), 127);
    EXPECT_EQ(largest_of(PlyType::uint16), 65535);
    EXPECT_EQ(largest_of(PlyType::int32), 2147483647);
    EXPECT_EQ(largest_of(PlyType::float64), 1);
}

TEST_F(PlyFolder, FarFromTheOriginNothingIsRounded)
{
    Scene const scene =
        load(element("vertex", 3, "property double x\nproperty double y\nproperty double z\n") +
                 element("face", 1, "property list uchar int vertex_indices\n"),
             "650000.37 12.125 5300000.37\n650001 12.125 5300000.37\n650000.37 12.75 5300000.37\n3 0 1 2\n");
    World const world = build_world(std::make_shared<Scene const>(scene), {}, report_);
    dvec3 const at = world.origin + dvec3(world.positions[0]), next = world.origin + dvec3(world.positions[1]);
    EXPECT_NEAR(at.z, 5300000.37, 1e-6);
    EXPECT_NEAR(next.x - at.x, 0.63, 1e-6);
}

} // namespace
} // namespace gi::test
