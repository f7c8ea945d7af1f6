// VESA MPCDI: for each profile a channel computed by hand; damaged archives; the way to a display file and back.

#include "tests/viewer_display/calibration_samples.h"
#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/zip_sample.h"
#include "viewer/displays/calibration.h"

#include <array>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

class Mpcdi : public testing::Test {
protected:
    Mpcdi() { fs::create_directories(folder); }
    ~Mpcdi() override { fs::remove_all(folder); }

    Display imported(std::string const& xml)
    {
        gi::write_text(folder / "mpcdi.xml", xml);
        return import_display(folder / "mpcdi.xml", {}, log);
    }
    std::string refused(std::string const& xml)
    {
        return message_of([&] { imported(xml); });
    }
    void write(char const* name, PixelMap const& map) { gi::write_text(folder / name, text_of(pfm_bytes(map))); }
    std::string skipped() const
    {
        std::string all;
        for (SkippedPart const& part : log.parts()) all += part.what + " (" + part.where + ")\n";
        return all;
    }
    static void expect_corners(Wall const& wall, gi::dvec3 ll, gi::dvec3 lr, gi::dvec3 ul)
    {
        EXPECT_NEAR(glm::distance(wall.corners.lower_left, ll), 0, 1e-9) << wall.name;
        EXPECT_NEAR(glm::distance(wall.corners.lower_right, lr), 0, 1e-9) << wall.name;
        EXPECT_NEAR(glm::distance(wall.corners.upper_left, ul), 0, 1e-9) << wall.name;
    }

    fs::path const folder = fs::path(testing::TempDir()) / "lightwell_mpcdi";
    gi::Report report;
    ImportLog const log{report, "out_files/"};
};

glm::vec3 same_place(glm::dvec2 p) { return {p.x, p.y, 0}; }

TEST_F(Mpcdi, Profile2d)
{
    write("right.pfm", made_map(8, 4, [](glm::dvec2 p) { return glm::vec3(p.x, 0.5 * p.y, 0); }));
    write_grey(folder / "alpha.png", 4, 2, [](glm::dvec2 p) { return p.x < 0.5 ? 0.2 : 1; });
    Display const d = imported(
        mpcdi_xml("2d",
                  mpcdi_region("left", 1600, 1000, "", R"(x="0" y="0" xsize="0.55" ysize="1")") +
                      mpcdi_region("right", 1600, 1000, "", R"(x="0.5" y="0.25" xsize="0.5" ysize="0.75")"),
                  mpcdi_fileset("right", mpcdi_warp("right.pfm", "2d") + mpcdi_light("alphaMap", "alpha.png", 2) +
                                             mpcdi_light("betaMap", "alpha.png", 1)),
                  R"(xResolution="3000" yResolution="1000")"));
    ASSERT_EQ(d.walls.size(), 2u);
    // The picture of 3 : 1 is 6 x 2 m, 3 m before the eye at the origin; parts count from its upper left corner.
    expect_corners(d.walls[0], {-3, -1, -3}, {0.3, -1, -3}, {-3, 1, -3});
    expect_corners(d.walls[1], {0, -1, -3}, {3, -1, -3}, {0, 0.5, -3});
    Wall const& right = d.walls[1];
    EXPECT_EQ(right.warp_map->file, "out_files/right_positions.pfm");
    // The lowest row of the map takes what is at (0.5 * 3.5 / 4) from the top.
    EXPECT_NEAR(glm::distance(right.warp_map->map->at(2, 3), glm::vec3(2.5 / 8, 0.5 * 3.5 / 4, 0)), 0, 1e-6);
    EXPECT_NEAR(right.blend_picture->light.map->at(0, 1).x, 0.04, 1e-6);
    EXPECT_NEAR(right.black_level_picture->light.map->at(0, 1).x, 0.2, 1e-6);
    EXPECT_EQ(d.windows[1].width_px, 1600);
    EXPECT_EQ(d.windows[1].x_px, 1600);
    EXPECT_EQ(d.users.size(), 1u);
    EXPECT_NE(skipped().find("does not say where the picture is"), std::string::npos) << skipped();
    EXPECT_EQ(skipped().find("not imported"), std::string::npos) << skipped();
}

TEST_F(Mpcdi, Profile3d)
{
    write("w.pfm", made_map(4, 4, same_place));
    std::string regions, files;
    for (auto const& [id, frustum] : {std::pair{"right", mpcdi_frustum(90, 0, 0)},
                                      {"up", mpcdi_frustum(0, 90, 0)},
                                      {"rolled", mpcdi_frustum(0, 0, 90)},
                                      {"all", mpcdi_frustum(30, 40, -20, 30, 20)}}) {
        regions += mpcdi_region(id, 100, 100, frustum);
        files += mpcdi_fileset(id, mpcdi_warp("w.pfm", "2D"));
    }
    Display const d = imported(mpcdi_xml("3d", regions, files));
    ASSERT_EQ(d.walls.size(), 4u);
    expect_corners(d.walls[0], {3, -3, -3}, {3, -3, 3}, {3, 3, -3});   // yaw turns right
    expect_corners(d.walls[1], {-3, 3, -3}, {3, 3, -3}, {-3, 3, 3});   // pitch turns upward
    expect_corners(d.walls[2], {-3, 3, -3}, {-3, -3, -3}, {3, 3, -3}); // the right wing goes down
    // The direction to the middle: turned by 30 degrees, raised by 40.
    double const yaw = glm::radians(30.0), pitch = glm::radians(40.0);
    WallFrame const f = wall_frame(d.walls[3].corners);
    EXPECT_NEAR(glm::distance(f.point(0.5, 0.5), 3.0 * gi::dvec3(std::cos(pitch) * std::sin(yaw), std::sin(pitch),
                                                                 -std::cos(pitch) * std::cos(yaw))),
                0, 1e-9);
    EXPECT_NEAR(f.width_m, 6 * std::tan(glm::radians(30.0)), 1e-9);
    EXPECT_NEAR(std::asin(f.right.y), std::asin(std::sin(glm::radians(20.0)) * std::cos(pitch)), 1e-9);
    EXPECT_EQ(d.users.size(), 1u);
    EXPECT_EQ(d.users[0].head.translation_m, gi::dvec3(0));
}

/// x right, y up, z backward in mm; or in the axes of a coordinateFrame.
TEST_F(Mpcdi, ProfileA3)
{
    write("p.pfm", made_map(4, 2, [](glm::dvec2 p) {
              return p.x < 0.25 ? glm::vec3(std::nanf("")) : glm::vec3(4000 * p.x - 2000, 1000 - 500 * p.y, -3000);
          }));
    std::string const z_up =
        "<coordinateFrame><posx>0</posx><posy>0</posy><posz>0</posz><yawx>0</yawx><yawy>0</yawy>"
        "<yawz>-1</yawz><pitchx>1</pitchx><pitchy>0</pitchy><pitchz>0</pitchz><rollx>0</rollx>"
        "<rolly>1</rolly><rollz>0</rollz></coordinateFrame>";
    Display const d = imported(mpcdi_xml("a3", mpcdi_region("a", 400, 200) + mpcdi_region("b", 400, 200, z_up),
                                         mpcdi_fileset("a", mpcdi_warp("p.pfm", "mm", "floorCenter")) +
                                             mpcdi_fileset("b", mpcdi_warp("p.pfm", "cm"))));
    ASSERT_EQ(d.walls.size(), 2u);
    EXPECT_EQ(d.users[0].head.translation_m, gi::dvec3(0, 1.7, 0));
    auto const at = [&](int wall, double x, double y) { // pixel of the 4 x 2 map
        return surface_point(*d.walls[std::size_t(wall)].surface, 2, {(x + 0.5) / 4, 1 - (y + 0.5) / 2});
    };
    EXPECT_FALSE(at(0, 0, 0));
    EXPECT_NEAR(glm::distance(at(0, 2, 1)->at, gi::dvec3(0.5, 0.625, -3)), 0, 1e-6);
    // cm; its y is forward, its z up.
    EXPECT_NEAR(glm::distance(at(1, 2, 1)->at, gi::dvec3(5, -30, -6.25)), 0, 1e-5);
    EXPECT_FALSE(at(1, 0, 0));
}

TEST_F(Mpcdi, ProfileSl)
{
    write("lens.pfm", made_map(4, 4, same_place));
    write("points.pfm", made_map(4, 4, [](glm::dvec2 p) { return glm::vec3(p.x, p.y, -2); }));
    std::string const pose =
        "<coordinateFrame><posx>1</posx><posy>2</posy><posz>3</posz><yawx>0</yawx><yawy>-1</yawy>"
        "<yawz>0</yawz><pitchx>1</pitchx><pitchy>0</pitchy><pitchz>0</pitchz><rollx>0</rollx>"
        "<rolly>0</rolly><rollz>-1</rollz></coordinateFrame>";
    std::string const lens = "<distortionMap><path>lens.pfm</path></distortionMap>";
    Display const d = imported(mpcdi_xml(
        "sl",
        mpcdi_region("a", 40, 40, mpcdi_frustum(0, 0, 0) + pose) +
            mpcdi_region("b", 40, 40, mpcdi_frustum(0, 0, 0) + pose),
        mpcdi_fileset("a", lens) + mpcdi_fileset("b", mpcdi_warp("points.pfm", "m", "centerOfMass") + lens)));
    ASSERT_EQ(d.walls.size(), 2u);
    expect_corners(d.walls[0], {-2, -1, 0}, {4, -1, 0}, {-2, 5, 0}); // seen from the projector at (1, 2, 3)
    EXPECT_EQ(d.users[std::size_t(d.walls[0].user)].head.translation_m, gi::dvec3(1, 2, 3));
    ASSERT_TRUE(d.walls[0].warp_map);
    ASSERT_TRUE(d.walls[1].surface);
    EXPECT_EQ(d.users[std::size_t(d.walls[1].user)].head.translation_m, gi::dvec3(0));
    EXPECT_NE(skipped().find("distortionMap beside points"), std::string::npos) << skipped();
    EXPECT_NE(skipped().find("originOf3DData centerOfMass"), std::string::npos) << skipped();
}

TEST_F(Mpcdi, ArchivesBecomeDisplayFilesThatReadBack)
{
    PixelMap const map = made_map(6, 4, same_place);
    write_grey(folder / "a.png", 6, 4, [](glm::dvec2 p) { return p.y; });
    write_zip(folder / "room.mpcdi",
              {{"mpcdi.xml", mpcdi_xml("3d", mpcdi_region("R 1", 60, 40, mpcdi_frustum(10, 0, 0)),
                                       mpcdi_fileset("R 1", mpcdi_warp("maps/w.pfm", "2d") +
                                                                mpcdi_light("alphaMap", "A.png", 2.2) +
                                                                mpcdi_light("betaMap", "a.png", 2.2)))},
               {"maps/w.pfm", text_of(pfm_bytes(map))},
               {"a.png", gi::read_text(folder / "a.png")}});
    Display const d = import_display(folder / "room.mpcdi", {}, log);
    ASSERT_EQ(log.files().size(), 3u);
    fs::create_directories(folder / "out_files");
    for (KeptFile const& file : log.files()) gi::write_text(folder / file.name, text_of(file.bytes));
    EXPECT_EQ(parse_display(to_yaml(d), (folder / "out.yaml").string(), report), d);
    EXPECT_EQ(log.files()[0].name, "out_files/R_1_positions.pfm");
    EXPECT_EQ(text_of(log.files()[0].bytes), text_of(pfm_bytes(map)));
}

TEST_F(Mpcdi, WhatIsNotImportedIsNamed)
{
    std::string xml = mpcdi_xml("3d", mpcdi_region("a", 40, 40, mpcdi_frustum(0, 0, 0) + "<decodeLUT/>"));
    xml.replace(xml.find("version=\"2.0\""), 13, "version=\"3.0\" mood='good'");
    xml.replace(xml.find("</files>"), 8, "</files><extensionSet/>");
    imported(xml);
    for (char const* what :
         {"version '3.0': read as 2.0 ", "MPCDI.mood: not imported", "<extensionSet>: not imported",
          "region <decodeLUT>: not imported", "regions without a geometryWarpFile"})
        EXPECT_NE(skipped().find(what), std::string::npos) << what << "\n" << skipped();
}

TEST_F(Mpcdi, BadCalibrationsAreRefused)
{
    write("w.pfm", made_map(4, 4, same_place));
    gi::write_text(folder / "cut.pfm", "PF\n4 4\n-1\n1234");
    gi::write_text(folder / "cut.png", "\x89PNG\r\n\x1a\n");
    auto const with_file = [&](std::string const& within) {
        return mpcdi_xml("3d", mpcdi_region("a", 40, 40, mpcdi_frustum(0, 0, 0)), mpcdi_fileset("a", within));
    };
    std::string const plain = mpcdi_region("a", 40, 40, mpcdi_frustum(0, 0, 0));
    for (auto const& [xml, wanted] :
         {std::pair{std::string("<MPCDI>"), "mpcdi.xml:1: this is not XML"},
          {mpcdi_xml("4d", plain), "mpcdi.xml:3: a profile '4d' (it says what the files mean)"},
          {mpcdi_xml("", plain), "mpcdi.xml:3: the profile is missing"},
          {mpcdi_xml("3d", ""), "no wall could be imported"},
          {mpcdi_xml("3d", mpcdi_region("a", 40, 0)), "mpcdi.xml:5: a resolution of 40 x 0"},
          {mpcdi_xml("3d", mpcdi_region("a", 40, 40)), "mpcdi.xml:5: region 'a' has no frustum"},
          {mpcdi_xml("3d", mpcdi_region("a", 40, 40, mpcdi_frustum(0, 0, 0, 90))),
           "mpcdi.xml:5: a frustum without area"},
          {mpcdi_xml("3d", plain + plain), "mpcdi.xml:5: two regions 'a'"},
          {mpcdi_xml("2d", mpcdi_region("a", 40, 40, "", R"(x="0.5" y="0" xsize="1" ysize="1")")),
           "mpcdi.xml:5: a region that is no part of its buffer"},
          {mpcdi_xml("a3", mpcdi_region("a", 40, 40)), "mpcdi.xml:5: region 'a' has no geometryWarpFile"},
          {with_file(mpcdi_warp("gone.pfm", "2d")), "mpcdi.xml:7: 'gone.pfm' is missing"},
          {with_file(mpcdi_warp("../w.pfm", "2d")), "mpcdi.xml:7: '../w.pfm' leaves the calibration's folder"},
          {with_file(mpcdi_warp("/etc/passwd", "2d")), "'/etc/passwd' leaves the calibration's folder"},
          {with_file(mpcdi_warp("w.pfm", "furlong")), "mpcdi.xml:7: a geometricUnit 'furlong'"},
          {with_file(mpcdi_warp("cut.pfm", "2d")), "cut.pfm:3: 4 bytes of pixels"},
          {with_file(mpcdi_warp("w.pfm", "2d") + mpcdi_light("alphaMap", "cut.png", 2)), "cut.png"},
          {with_file(mpcdi_warp("w.pfm", "2d") + mpcdi_light("alphaMap", "cut.png", 0)), "gammaEmbedded of 0"},
          {with_file("<geometryWarpFile/>"), "mpcdi.xml:7: <geometryWarpFile> names no file"}})
        EXPECT_NE(refused(xml).find(wanted), std::string::npos) << wanted << "\n" << refused(xml);
    std::string text = with_file(mpcdi_warp("w.pfm", "2d"));
    text.replace(text.find("<yaw>0"), 6, "<yaw>x");
    EXPECT_NE(refused(text).find("mpcdi.xml:5: yaw of <yaw> is 'x' (a number is needed)"), std::string::npos)
        << refused(text);
}

TEST_F(Mpcdi, DamagedArchivesAreRefused)
{
    std::string const xml = mpcdi_xml("3d", mpcdi_region("a", 40, 40, mpcdi_frustum(0, 0, 0)),
                                      mpcdi_fileset("a", mpcdi_warp("w.pfm", "2d")));
    std::string const pfm = text_of(pfm_bytes(made_map(16, 16, same_place)));
    fs::path const file = folder / "a.mpcdi";
    auto const message = [&] { return message_of([&] { import_display(file, {}, log); }); };
    write_zip(file, {{"mpcdi.xml", xml}});
    EXPECT_NE(message().find("a.mpcdi/mpcdi.xml:7: 'w.pfm' is missing (the archive has no such file)"),
              std::string::npos)
        << message();
    write_zip(file, {{"w.pfm", pfm}});
    EXPECT_NE(message().find("a.mpcdi: 'mpcdi.xml' is missing"), std::string::npos) << message();
    write_zip(file, {{"mpcdi.xml", std::string(std::size_t(2) << 20, ' ')}});
    EXPECT_NE(message().find("'mpcdi.xml' states 2097152 bytes"), std::string::npos) << message();
    write_zip(file, {{"mpcdi.xml", xml}, {"w.pfm", pfm}});
    EXPECT_EQ(message(), "");
    std::string const whole = gi::read_text(file);
    gi::write_text(file, whole.substr(0, whole.size() / 2));
    EXPECT_NE(message().find("a.mpcdi: this is no zip archive, or it is damaged"), std::string::npos) << message();
    gi::write_text(file, "");
    EXPECT_NE(message(), "");
    // Any byte changed: a display, or one message.
    for (std::size_t k = 0; k < whole.size(); k += 3) {
        std::string changed = whole;
        changed[k] = char(changed[k] ^ (1 << (k % 8)));
        gi::write_text(file, changed);
        message();
    }
    fs::remove(file);
    EXPECT_NE(message().find("a.mpcdi"), std::string::npos);
}

/// A calibration of another program: six projectors around a cube, 3 m away.
TEST_F(Mpcdi, PosesOfAnotherProgram)
{
    fs::path const file = LIGHTWELL_SOURCE_DIR "/../shared/data/displays/mpcdi/cube_mapping.mpcdi.xml";
    if (!fs::exists(file)) GTEST_SKIP() << "SKIPPED: there is no " << file;
    Display const d = import_display(file, {}, log);
    ASSERT_EQ(d.walls.size(), 6u);
    for (Wall const& wall : d.walls) { // each looks at the cube's middle, or 0.5 m above it
        WallFrame const f = wall_frame(wall.corners);
        gi::dvec3 const eye = d.users[std::size_t(wall.user)].head.translation_m;
        gi::dvec3 const middle = f.point(0.5, 0.5);
        EXPECT_NEAR(glm::length(middle - eye), 3, 1e-6) << wall.name;
        EXPECT_LT(glm::length(middle - gi::dvec3(0, std::abs(eye.y) > 1 ? 0 : 0.5, 0)), 1e-4) << wall.name;
        EXPECT_NEAR(f.width_m, 2.4, 1e-3);
        EXPECT_NEAR(f.height_m, 1.35, 1e-3);
    }
}

} // namespace
} // namespace viewer::test
