// nDisplay viewports whose policy names a calibration.

#include "tests/viewer_display/calibration_samples.h"
#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/vioso_sample.h"
#include "tests/viewer_display/zip_sample.h"
#include "viewer/displays/import.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

class NDisplayCalibration : public testing::Test {
protected:
    NDisplayCalibration() { fs::create_directories(folder); }
    ~NDisplayCalibration() override { fs::remove_all(folder); }

    /// A camera at z = 1.7 m, and one viewport with this policy.
    Display imported(std::string const& policy) { return imported(policy, log); }
    Display imported(std::string const& policy, ImportLog const& to)
    {
        gi::write_text(folder / "n.ndisplay", fmt::format(R"({{"nDisplay": {{
"scene": {{
 "xforms": {{"stage": {{"location": {{"x": 100, "y": 0, "z": 50}}, "rotation": {{"pitch": 0, "yaw": 90, "roll": 0}}}}}},
 "cameras": {{"head": {{"interpupillaryDistance": 6.3, "location": {{"x": 0, "y": 0, "z": 170}}}}}}, "screens": {{}}}},
"cluster": {{"nodes": {{"a": {{"window": {{"x": 0, "y": 0, "w": 400, "h": 200}}, "viewports": {{
 "v": {{"camera": "head", "region": {{"x": 0, "y": 0, "w": 400, "h": 200}}, "projectionPolicy": {}}}}}}}}}}}}}}})",
                                                          policy));
        return import_display(folder / "n.ndisplay", {}, to);
    }
    std::string skipped() const
    {
        std::string all;
        for (SkippedPart const& part : log.parts()) all += part.what + " (" + part.where + ")\n";
        return all;
    }

    fs::path const folder = fs::path(testing::TempDir()) / "lightwell_ndisplay_calibration";
    gi::Report report;
    ImportLog const log{report, "out_files/"};
};

PixelMap corner_points()
{
    return made_map(4, 2, [](glm::dvec2 p) { return glm::vec3(p.x, p.y, -2); });
}

TEST_F(NDisplayCalibration, RegionsOfMpcdi)
{
    write_zip(folder / "room.mpcdi",
              {{"mpcdi.xml", mpcdi_xml("a3", mpcdi_region("left", 400, 200) + mpcdi_region("gone", 400, 200),
                                       mpcdi_fileset("left", mpcdi_warp("p.pfm", "m")))},
               {"p.pfm", text_of(pfm_bytes(corner_points()))}});
    Display const d = imported(
        R"({"type": "MPCDI", "parameters": {"file": "C:\\Shows\\room.mpcdi", "buffer": "b", "region": "left", "origin": "stage"}})");
    ASSERT_EQ(d.walls.size(), 1u);
    // Pixel (0, 0) lights (0.125, 0.25, -2): 2 m before the stage, which is 1 m forward, 0.5 m up and looks to the right.
    auto const point = surface_point(*d.walls[0].surface, 2, {0.125, 0.75});
    ASSERT_TRUE(point);
    EXPECT_NEAR(glm::distance(point->at, gi::dvec3(2, 0.75, -1 + 0.125)), 0, 1e-6);
    EXPECT_EQ(d.users[0].head.translation_m, gi::dvec3(0, 1.7, 0));
    EXPECT_EQ(d.walls[0].surface->points.file, "out_files/left_points.pfm");
    EXPECT_EQ(log.files().size(), 1u);
    EXPECT_EQ(skipped().find("skipped"), std::string::npos) << skipped();
}

TEST_F(NDisplayCalibration, ExplicitPfm)
{
    gi::write_text(folder / "p.pfm", text_of(pfm_bytes(corner_points())));
    write_grey(folder / "alpha.png", 4, 2, [](glm::dvec2 p) { return p.x < 0.5 ? 0.2 : 1; });
    Display const d = imported(
        R"({"type": "mpcdi", "parameters": {"MPCDIType": "Explicit PFM", "pfm": "p.pfm", "scale": "100", "alpha": "alpha.png", "alpha_gamma": "2"}})");
    auto const point = surface_point(*d.walls[0].surface, 2, {0.125, 0.75});
    EXPECT_NEAR(glm::distance(point->at, gi::dvec3(0.125, 0.25, -2)), 0, 1e-6);
    EXPECT_NEAR(d.walls[0].blend_picture->light.map->at(0, 0).x, 0.04, 1e-6);
    // Unreal's axes: x forward, y right, z up.
    Display const unreal =
        imported(R"({"type": "mpcdi", "parameters": {"pfm": "p.pfm", "scale": "100", "ue_space": "true"}})");
    EXPECT_NEAR(
        glm::distance(surface_point(*unreal.walls[0].surface, 2, {0.125, 0.75})->at, gi::dvec3(0.25, -2, -0.125)),
        0, 1e-6);
    EXPECT_EQ(log.files().back().name, "out_files/v_points_2.pfm");
    // The kept file reads back as the same points.
    EXPECT_EQ(parse_points(log.files().back().bytes, 1, "p").values, unreal.walls[0].surface->points.map->values);
}

TEST_F(NDisplayCalibration, MappingsOfVioso)
{
    std::vector<float> const here{100, 50, -200, 1, 200, 50, -200, 1, 100, -50, -200, 1, 200, -50, -200, 1};
    gi::write_text(folder / "v.vwf",
                   vioso_set(vioso_mapping("other", 0x40, here) + vioso_mapping("mine", 0x40, here) +
                             vioso_bitmap(-2, {255, 51, 255, 255})));
    Display const d = imported(
        R"({"type": "vioso", "parameters": {"file": "v.vwf", "index": "1", "UnitsInMeter": "100", "origin": "stage"}})");
    auto const point = surface_point(*d.walls[0].surface, 2, {0.25, 0.75}); // (1, 0.5, -2) m of the stage
    EXPECT_NEAR(glm::distance(point->at, gi::dvec3(2, 1, 0)), 0, 1e-6);
    EXPECT_TRUE(d.walls[0].blend_picture);
    EXPECT_EQ(log.files().size(), 2u);
    EXPECT_NE(message_of([&] {
                  imported(R"({"type": "vioso", "parameters": {"file": "v.vwf", "index": "2"}})");
              }).find("v.vwf has no mapping 2 (it has 2, counted from 0)"),
              std::string::npos);
}

TEST_F(NDisplayCalibration, WhatCannotBeReadIsNamed)
{
    for (auto const& [policy, wanted] :
         {std::pair{R"({"type": "mpcdi", "parameters": {"file": "gone.mpcdi", "region": "a"}})",
                    "whose calibration cannot be read, skipped: "},
          {R"({"type": "mpcdi", "parameters": {"pfm": "../gone.pfm"}})", "'gone.pfm' is missing"},
          {R"({"type": "easyblend", "parameters": {"file": "a.pol"}})", "easyblend: not supported, viewport skipped: only its maker's library reads its files"},
          {R"({"type": "domeprojection", "parameters": {"file": "config.xml"}})",
           "export them as MPCDI"},
          {R"({"type": "mpcdi", "parameters": {"region": "a"}})", "a policy mpcdi without a file"},
          {R"({"type": "camera"})", "policy camera: not supported, viewport skipped"}}) {
        std::string const message = message_of([&, p = policy] { imported(p, ImportLog(report)); });
        EXPECT_NE(message.find("no wall could be imported"), std::string::npos) << message;
        EXPECT_NE(message.find(wanted), std::string::npos) << message;
    }
    EXPECT_NE(message_of([&] {
                  gi::write_text(folder / "p.pfm", text_of(pfm_bytes(corner_points())));
                  imported(R"({"type": "mpcdi", "parameters": {"pfm": "p.pfm", "origin": "nowhere"}})");
              }).find("there is no transform 'nowhere'"),
              std::string::npos);
}

} // namespace
} // namespace viewer::test
