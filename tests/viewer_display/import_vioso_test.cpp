// VIOSO's .vwf: channels computed by hand, damaged files.

#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/map_samples.h"
#include "tests/viewer_display/vioso_sample.h"
#include "viewer/displays/calibration.h"

namespace viewer::test {
namespace {

std::string const kPoints = vioso_mapping("left 1", 0x40,
                                          {-1000, 500, -2000, 1, 1000, 500, -2000, 1, //
                                           -1000, -500, -2000, 1, 0, 0, 0, 0});
std::string const kPositions = vioso_mapping("flat", 0,
                                             {0.25f, 0.25f, 1, 0, 0.75f, 0.25f, 1, 0, //
                                              0.25f, 0.75f, 1, 0, 0.75f, 0.75f, 0, 0});

TEST(Vioso, MappingsAndBlend)
{
    gi::Report report;
    ImportLog const log(report, "f/");
    std::string const text =
        vioso_set(kPoints + vioso_bitmap(-2, {255, 51, 255, 255}) + vioso_bitmap(-2, {9, 9, 9, 9}) + kPositions +
                  vioso_bitmap(2, {255, 51, 255, 255}));
    Display const d = display_of(read_vioso(bytes_of(text), "v.vwf", 0.001, log), "v.vwf", log);
    ASSERT_EQ(d.walls.size(), 2u);
    // mm; the first record is the upper left pixel.
    Surface const& s = *d.walls[0].surface;
    EXPECT_NEAR(glm::distance(surface_point(s, 1, {0.25, 0.75})->at, gi::dvec3(-1, 0.5, -2)), 0, 1e-6);
    EXPECT_FALSE(surface_point(s, 1, {0.75, 0.25}));
    EXPECT_NEAR(d.walls[0].blend_picture->light.map->at(1, 0).x, std::pow(0.2, 2.2), 1e-6);
    EXPECT_EQ(d.walls[0].blend_picture->light.file, "f/left_1_blend.bmp");
    EXPECT_EQ(d.walls[1].warp_map->map->at(0, 1), glm::vec3(0.25f, 0.75f, 0));
    EXPECT_FALSE(has_value(d.walls[1].warp_map->map->at(1, 1)));
    EXPECT_NEAR(d.walls[1].blend_picture->light.map->at(1, 1).x, std::pow(0.2, 2.2), 1e-6); // rows from below
    EXPECT_EQ(d.walls[1].corners.lower_left, gi::dvec3(-1, -1, -3));
    std::string skipped;
    for (SkippedPart const& part : log.parts()) skipped += part.what + " (" + part.where + ")\n";
    for (char const* what : {"black level bitmaps", "does not state its unit: taken as 0.001 m (v.vwf, left 1)",
                             "do not say where the picture is", "taken as those of a gamma of 2.2"})
        EXPECT_NE(skipped.find(what), std::string::npos) << what << "\n" << skipped;
}

TEST(Vioso, DamagedFilesAreRefused)
{
    gi::Report report;
    auto const message = [&](std::string const& text) {
        return message_of([&] {
            ImportLog const log(report);
            display_of(read_vioso(bytes_of(text), "v.vwf", 0.001, log), "v.vwf", log);
        });
    };
    std::string huge = kPositions;
    huge.replace(20, 8, std::string("\xff\xff\0\0\xff\xff\0\0", 8));
    for (auto const& [text, wanted] :
         {std::pair{std::string("abc"), "v.vwf: this is no file of VIOSO"},
          {vioso_set(""), "no wall could be imported"},
          {kPositions.substr(0, 390), "64 bytes are missing at byte 380"},
          {vioso_mapping("a", 1, std::vector<float>(16)), "compressed and encrypted mappings are not read"},
          {vioso_mapping("a", 0, std::vector<float>(15)), "60 bytes of 'a' at byte 0"},
          {huge, "a header of 380 bytes, 65535 x 65535 pixels"},
          {kPositions + "abcd", "neither a mapping nor a bitmap at byte 444"},
          {kPositions + vioso_bitmap(-3, {1, 1, 1, 1}), "a bitmap of 2 x 3 pixels of 24 bits"}})
        EXPECT_NE(message(text).find(wanted), std::string::npos) << wanted << "\n" << message(text);
    std::string const whole = vioso_set(kPoints + vioso_bitmap(-2, {255, 51, 255, 255}));
    for (std::size_t k = 0; k < whole.size(); ++k) {
        std::string changed = whole;
        changed[k] = char(changed[k] ^ (1 << (k % 8)));
        message(changed);
        message(whole.substr(0, k));
    }
}

} // namespace
} // namespace viewer::test
