// Maps of calibrations, against values computed by hand.

#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/map_samples.h"
#include "viewer/displays/blend.h"
#include "viewer/displays/mesh_file.h"
#include "viewer/displays/views.h"

#include <bit>
#include <fmt/format.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

std::string pfm_text(std::string const& header, std::vector<float> const& values, bool is_little_endian = true)
{
    std::string text = header;
    for (float const v : values) {
        auto const bits = std::bit_cast<std::uint32_t>(v);
        for (int k = 0; k < 4; ++k) text += char((bits >> (8 * (is_little_endian ? k : 3 - k))) & 0xff);
    }
    return text;
}

std::string pfm_message(std::string const& text)
{
    return message_of([&] { parse_picture_positions(bytes_of(text), "m.pfm"); });
}

TEST(PixelMap, RowsOfAPfmBeginBelow)
{
    // Two rows of two pixels: the lower one is the first in the file.
    std::vector<float> const values{0.25f, 0.75f, 0, 0.75f, 0.75f, 0, 0.25f, 0.25f, 9, 0.75f, 0.25f, 9};
    for (bool const is_little : {true, false}) {
        PixelMap const map = parse_picture_positions(
            bytes_of(pfm_text(is_little ? "PF\n2 2\n-1.0\n" : "PF 2 2\n1\n", values, is_little)), "m.pfm");
        EXPECT_EQ(map.at(0, 0), glm::vec3(0.25f, 0.25f, 0));
        EXPECT_EQ(map.at(1, 1), glm::vec3(0.75f, 0.75f, 0));
        // Between the middles of its pixels it is linear, beyond them constant.
        EXPECT_NEAR(value_at(map, {0.4, 0.5})->x, 0.25 + 0.5 * 0.3, 1e-6);
        EXPECT_NEAR(value_at(map, {0.1, 0.1})->y, 0.75, 1e-6);
    }
}

TEST(PixelMap, PixelsWithoutAValueDoNotCount)
{
    float const nan = std::nanf("");
    PixelMap const map = parse_picture_positions(
        bytes_of(pfm_text("PF\n2 2\n-1\n", {0.5f, 0.5f, 0, nan, nan, nan, 0, 0, 0, 0.3f, nan, 0})), "m.pfm");
    EXPECT_TRUE(has_value(map.at(0, 1)));
    EXPECT_FALSE(has_value(map.at(1, 1)));
    EXPECT_FALSE(has_value(map.at(0, 0)));
    EXPECT_FALSE(has_value(map.at(1, 0)));
    EXPECT_EQ(value_at(map, {0.45, 0.25})->x, 0.5);
    EXPECT_FALSE(value_at(map, {0.55, 0.25}));
}

TEST(PixelMap, PointsAreMetres)
{
    PixelMap const map = parse_points(
        bytes_of(pfm_text("PF\n2 2\n-1\n", {1000, 0, -2000, 0, 0, 0, 1000, 500, -2000, 1500, 500, -2000})), 0.001,
        "p.pfm");
    EXPECT_FALSE(has_value(map.at(1, 1)));
    EXPECT_NEAR(glm::distance(map.at(1, 0), glm::vec3(1.5f, 0.5f, -2)), 0, 1e-6);
}

TEST(PixelMap, DamagedFilesAreRefused)
{
    std::vector<float> const good(12, 0.5f);
    std::string const nan_only = pfm_text("PF\n2 2\n-1\n", std::vector<float>(12, std::nanf("")));
    for (auto const& [text, wanted] :
         {std::pair{std::string("P6\n2 2\n255\n"), "m.pfm:1: this is no PFM"},
          {pfm_text("Pf\n2 2\n-1\n", {1, 1, 1, 1}), "m.pfm:1: a PFM with one number a pixel"},
          {std::string("PF\n2"), "m.pfm:2: the header of a PFM is damaged"},
          {std::string("PF\n2 x\n-1\n"), "m.pfm:2: a size of 'x' px"},
          {std::string("PF\n2 1\n-1\n"), "m.pfm:2: a size of '1' px"},
          {std::string("PF\n2 999999999999\n-1\n"), "m.pfm:2: a size of '999999999999' px"},
          {std::string("PF\n16384 16384\n-1\n"), "m.pfm:3: 0 bytes of pixels"},
          {pfm_text("PF\n2 2\n0\n", good), "m.pfm:3: a scale of '0'"},
          {pfm_text("PF\n2 2\n-1\n", std::vector<float>(11, 0.5f)), "m.pfm:3: 44 bytes of pixels"},
          {pfm_text("PF\n2 2\n-1\n", {INFINITY, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
           "m.pfm: pixel (0, 1) from the upper left is infinite"},
          {pfm_text("PF\n2 2\n-1\n", {0, 1e20f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}),
           "m.pfm: pixel (0, 1) from the upper left takes its colour from (0, 1e+20)"},
          {nan_only, "m.pfm: no pixel has a position"}})
        EXPECT_EQ(pfm_message(text).find(wanted), 0u) << wanted << " | " << pfm_message(text);
    EXPECT_NE(message_of([&] { parse_light(bytes_of("PNG"), 1, "b.png"); }).find("b.png"), std::string::npos);
    std::string png("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x40\0\0\0\x40\0", 24); // 16384 x 16384 in its header
    EXPECT_NE(message_of([&] {
                  parse_light(bytes_of(png + std::string(50000, 'x')), 1, "b.png");
              }).find("b.png: a picture of 268435456 pixels"),
              std::string::npos);
    // Any byte changed, any end cut off: a map or a message.
    std::string const whole = pfm_text("PF\n2 2\n-1\n", good);
    for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string changed = whole;
        changed[k] = char(changed[k] ^ 0x55);
        pfm_message(changed);
        EXPECT_NE(pfm_message(whole.substr(0, k)), "");
    }
}

TEST(PixelMap, DisplayFilesNameThem)
{
    fs::path const folder = fs::path(testing::TempDir()) / "lightwell_display_maps";
    fs::create_directories(folder);
    auto const write = [&](char const* name, PixelMap const& map) {
        gi::write_text(folder / name, text_of(pfm_bytes(map)));
    };
    write("positions.pfm", made_map(8, 4, [](glm::dvec2 p) { return glm::vec3(1 - p.x, p.y, 0); }));
    write("points.pfm",
          made_map(8, 4, [](glm::dvec2 p) { return glm::vec3(2000 * p.x - 1000, 1000 - 1000 * p.y, -3000); }));
    write_grey(folder / "blend.png", 4, 2, [](glm::dvec2 p) { return p.x < 0.5 ? 0.2 : 1; });
    gi::write_text(folder / "bourke.data", "2\n2 2\n-2 -1 0 0 1\n2 -1 1 0 1\n-2 1 0 1 1\n2 1 1 1 1\n");
    gi::write_text(folder / "d.yaml", R"(
windows: [{name: a, size_px: [400, 200]}, {name: b, size_px: [400, 200], position_px: [400, 0]},
          {name: c, size_px: [400, 200], position_px: [800, 0]}]
users: [{name: u, head_position_m: [0, 1, 1]}]
walls:
  - {name: flat, window: a, lower_left_m: [-2, 0, -3], lower_right_m: [2, 0, -3], upper_left_m: [-2, 2, -3],
     warp: {file: positions.pfm}, blend_picture: {file: blend.png, gamma: 2},
     black_level_picture: {file: blend.png, gamma: 1}}
  - {name: bent, window: b, projection: {type: points, file: points.pfm, unit_m: 0.001, center_m: [0, 1, 0]}}
  - {name: bourke, window: c, lower_left_m: [2.5, 0, -3], lower_right_m: [6.5, 0, -3], upper_left_m: [2.5, 2, -3],
     warp: {file: bourke.data}}
)");
    gi::Report report;
    Display const d = load_display(folder / "d.yaml", report);
    Wall const& flat = d.walls[0];
    EXPECT_TRUE(needs_finish(flat));
    EXPECT_NEAR(flat.warp_map->map->at(1, 3).x, 1 - 1.5 / 8, 1e-6);
    EXPECT_NEAR(flat.blend_picture->light.map->at(0, 0).x, 0.04, 1e-6); // 51/255 squared
    EXPECT_NEAR(flat.black_level_picture->light.map->at(1, 1).y, 0.2, 1e-6);
    // The upper left pixel: x = 2 m / 16 - 1 m, y = 1 m + 1 m - 1/8 m, in front of the eye.
    auto const point = surface_point(*d.walls[1].surface, 2, {0.5 / 8, 1 - 0.5 / 4});
    ASSERT_TRUE(point);
    EXPECT_NEAR(glm::distance(point->at, gi::dvec3(-0.875, 1.875, -3)), 0, 1e-6);
    EXPECT_EQ(views_of(d, {}).size(), 3u); // the points need one face of the cube
    EXPECT_EQ(d.walls[2].warp->node(1, 1).place, glm::dvec2(1, 1));
    EXPECT_EQ(parse_display(to_yaml(d), (folder / "again.yaml").string(), report), d);

    auto const refused = [&](std::string const& from, std::string const& to) {
        std::string text = gi::read_text(folder / "d.yaml");
        text.replace(text.find(from), from.size(), to);
        return message_of([&] { parse_display(text, (folder / "d.yaml").string(), report); });
    };
    EXPECT_NE(refused("file: blend.png, gamma: 2", "file: blend.png").find("d.yaml:7:50: gamma is missing"),
              std::string::npos)
        << refused("file: blend.png, gamma: 2", "file: blend.png");
    EXPECT_NE(refused("file: points.pfm, ", "").find("d.yaml:9:41: file is missing"), std::string::npos)
        << refused("file: points.pfm, ", "");
    EXPECT_NE(refused("points.pfm", "gone.pfm").find("gone.pfm"), std::string::npos);
    EXPECT_NE(refused("unit_m: 0.001", "unit_m: 0").find("a unit of 0 m"), std::string::npos);
    fs::remove_all(folder);
}

/// domeprojection's meshes: from the upper left, in any order.
TEST(MeshFile, DomeprojectionCsv)
{
    std::string const good =
        "x;y;u;v;column;row\n0;0;0.1;0.2;0;0\n1;0;0.9;0.2;1;0\n1;1;0.9;1;1;1\n0;1;0.1;1.001;0;1\n";
    WallMesh const mesh = parse_mesh_file(good, "m.csv", 2);
    EXPECT_EQ(mesh.columns, 2);
    EXPECT_EQ(mesh.node(0, 1).place, glm::dvec2(0, 1)); // upper left
    EXPECT_EQ(mesh.node(0, 1).picture, glm::dvec2(0.1, 0.8));
    EXPECT_EQ(mesh.node(0, 0).picture, glm::dvec2(0.1, 0));
    for (auto const& [text, wanted] :
         {std::pair{"x;y", "m.csv:1: no mesh"},
          {"0;0;0;0;1;0", "m.csv:1: 1 nodes; 2 columns and 1 rows have 2"},
          {"0;0;0;0;0;a", "m.csv:1: number 6 of the line"},
          {"0;0;0;0;0;900", "m.csv:1: number 6 is no column or row"},
          {"0;0;0;0;0;0\n0;0;0;0;0;0\n1;1;1;1;1;1\n0;0;0;0;1;0", "m.csv:2: a second node"}})
        EXPECT_EQ(message_of([&, t = text] { parse_mesh_file(t, "m.csv", 1); }).find(wanted), 0u)
            << message_of([&, t = text] { parse_mesh_file(t, "m.csv", 1); });
}

} // namespace
} // namespace viewer::test
