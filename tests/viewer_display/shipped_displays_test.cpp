// Every display of data/displays loads without a doubt, comes back as it was, and is what it says.

#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/mesh_samples.h"
#include "viewer/displays/examples.h"
#include "viewer/displays/import.h"
#include "viewer/displays/views.h"

#include <filesystem>
#include <set>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

TEST(ShippedDisplays, LoadWithoutADoubtAndComeBack)
{
    int count = 0;
    for (auto const& entry : fs::directory_iterator(LIGHTWELL_SOURCE_DIR "/data/displays")) {
        if (entry.path().extension() != ".yaml") continue;
        ++count;
        Display const d = shipped(entry.path().filename().string());
        gi::Report report;
        EXPECT_EQ(parse_display(to_yaml(d), "again", report), d) << entry.path();
        EXPECT_FALSE(d.name.empty());
        for (DisplayView const& view : views_of(d, {})) EXPECT_TRUE(view.camera) << view.name;
    }
    EXPECT_EQ(count, 6);
}

TEST(ShippedDisplays, TheProgramCarriesThem)
{
    std::set<std::string> carried, on_disk;
    for (DisplayExample const& example : display_examples()) {
        carried.insert(std::string(example.name));
        bool const is_ours = example.name.ends_with(".yaml");
        fs::path const file =
            fs::path(LIGHTWELL_SOURCE_DIR "/data/displays") / (is_ours ? "" : "import") / example.name;
        auto const bytes = gi::read_bytes(file);
        EXPECT_EQ(example.text, std::string(bytes.begin(), bytes.end())) << example.name;
    }
    for (char const* folder : {"/data/displays", "/data/displays/import"})
        for (auto const& entry : fs::directory_iterator(std::string(LIGHTWELL_SOURCE_DIR) + folder))
            if (entry.is_regular_file() && entry.path().extension() != ".py")
                on_disk.insert(entry.path().filename().string());
    EXPECT_EQ(carried, on_disk);
}

TEST(ShippedDisplays, TheDomeIsAFisheye)
{
    Display const d = shipped("dome.yaml");
    ASSERT_EQ(d.walls.size(), 5u);
    double covered = 0;
    for (Wall const& wall : d.walls) {
        WallFrame const frame = wall_frame(wall.corners);
        ASSERT_TRUE(wall.warp);
        for (WarpNode const& node : wall.warp->nodes) {
            gi::dvec3 const to = glm::normalize(frame.point(node.picture.x, node.picture.y));
            double const level = std::hypot(to.x, to.z),
                         radius = std::acos(std::min(1.0, to.y)) / glm::pi<double>();
            glm::dvec2 const expected = level > 1e-12
                                            ? glm::dvec2(0.5 + radius * to.x / level, 0.5 + radius * to.z / level)
                                            : glm::dvec2(0.5);
            EXPECT_LT(glm::length(node.place - expected), 2e-6) << wall.name;
        }
    }
    // Every direction of the dome is shown once.
    constexpr int kSize = 200;
    int inside = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            glm::dvec2 const p((x + 0.5) / kSize, (y + 0.5) / kSize);
            if (glm::length(p - 0.5) > 0.49) continue;
            ++inside;
            int shown = 0;
            for (Wall const& wall : d.walls) shown += picture_at(*wall.warp, p).has_value();
            covered += shown;
        }
    EXPECT_NEAR(covered / inside, 1, 0.01);
}

} // namespace
} // namespace viewer::test
