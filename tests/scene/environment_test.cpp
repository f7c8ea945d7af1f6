// Environment maps from files: orientation, damaged texels, wrong shapes.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/load/load.h"
#include "tests/support/data.h"

#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

class Environment : public testing::Test {
protected:
    Environment() : folder_(fs::temp_directory_path() / ("lightwell_environment_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_);
    }
    ~Environment() override { fs::remove_all(folder_); }

    /// An RGB picture whose red counts the pixels.
    fs::path save(int width, int height, std::vector<float> const& first = {})
    {
        Picture picture;
        picture.width = width;
        picture.height = height;
        Layer& layer = picture.add("color", 3);
        for (std::size_t i = 0; i < picture.pixels(); ++i) layer.data[3 * i] = float(i);
        std::copy(first.begin(), first.end(), layer.data.begin());
        fs::path const file = folder_ / "map.exr";
        write_exr(file, picture, PixelType::single, report_);
        return file;
    }

    fs::path folder_;
    Report report_;
};

TEST_F(Environment, RowsRunFromTheTop)
{
    EnvironmentMap const map = load_environment(save(4, 2), report_);
    EXPECT_EQ(map.width, 4u);
    EXPECT_EQ(map.height, 2u);
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(map.radiance[i], (vec3{float(i), 0, 0}));
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(Environment, DamagedTexelsAreBlackAndCounted)
{
    float const nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    EnvironmentMap const map =
        load_environment(save(4, 2, {nan, 1, 2, -1, 3, -0.5f, 4, inf, 5, 6, 7, 8}), report_);
    EXPECT_EQ(map.radiance[0], (vec3{0, 1, 2}));
    EXPECT_EQ(map.radiance[1], (vec3{0, 3, 0}));
    EXPECT_EQ(map.radiance[2], (vec3{4, 0, 5}));
    EXPECT_EQ(map.radiance[3], (vec3{6, 7, 8}));
    ASSERT_EQ(report_.losses().size(), 1u);
    EXPECT_EQ(report_.losses().begin()->second.count, 3u);
}

TEST_F(Environment, OtherShapesAreNotedNotRefused)
{
    EXPECT_EQ(load_environment(save(3, 3), report_).radiance.size(), 9u);
    ASSERT_EQ(report_.losses().size(), 1u);
    EXPECT_NE(report_.losses().begin()->first.find("twice as wide"), std::string::npos);
}

/// What a reader says of a file is counted.
TEST_F(Environment, MapsOfPartsOfAPictureAreCounted)
{
    Picture picture;
    picture.width = 4;
    picture.height = 2;
    picture.add("color", 3).data[0] = 1;
    write_exr(folder_ / "map.exr", picture, PixelType::half, report_);
    std::vector<unsigned char> bytes = read_bytes(folder_ / "map.exr");
    std::string const text(bytes.begin(), bytes.end());
    std::size_t const at = text.find(std::string("displayWindow\0box2i\0", 20)) + 20 + 4; // after the size
    bytes[at + 8] = 5;                                                                    // xMax
    write_text(folder_ / "map.exr", std::string(bytes.begin(), bytes.end()));
    EnvironmentMap const map = load_environment(folder_ / "map.exr", report_);
    EXPECT_EQ(map.width, 6u);
    EXPECT_EQ(map.radiance[0], (vec3{1, 0, 0}));
    ASSERT_TRUE(report_.losses().contains("environment maps not used as they are"));
    EXPECT_NE(report_.losses().at("environment maps not used as they are").first.find("covers 4 x 2 of 6 x 2"),
              std::string::npos);
}

TEST_F(Environment, ChannelsThatAreNoColoursAreRefusedByName)
{
    for (int const channels : {1, 2}) {
        Picture picture;
        picture.width = 4;
        picture.height = 2;
        picture.add(channels == 1 ? "Z" : "color", channels);
        write_exr(folder_ / "map.exr", picture, PixelType::single, report_);
        try {
            load_environment(folder_ / "map.exr", report_);
            FAIL();
        } catch (InputError const& e) {
            EXPECT_NE(std::string(e.what()).find(channels == 1 ? "its layers: Z" : "its layers: RG"),
                      std::string::npos)
                << e.what();
        }
    }
}

TEST_F(Environment, OnePixelIsRefused) { EXPECT_THROW(load_environment(save(1, 1), report_), InputError); }

TEST_F(Environment, MissingFilesAreRefused)
{
    EXPECT_THROW(load_environment(folder_ / "none.exr", report_), InputError);
}

/// The outdoor map's sun stands about 75 degrees high.
TEST_F(Environment, TheSunStandsWhereItShould)
{
    LIGHTWELL_NEED_DATA(shared_data() / "envmaps/kloppenheim_05_1k.hdr");
    EnvironmentMap const map = load_environment(shared_data() / "envmaps/kloppenheim_05_1k.hdr", report_);
    ASSERT_EQ(map.width, 1024u);
    ASSERT_EQ(map.height, 512u);
    std::size_t brightest = 0;
    for (std::size_t i = 0; i < map.radiance.size(); ++i)
        if (luminance(map.radiance[i]) > luminance(map.radiance[brightest])) brightest = i;
    double const elevation = 90 - (double(brightest / map.width) + 0.5) / map.height * 180;
    EXPECT_NEAR(elevation, 75, 5);
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(Environment, DamagedPicturesGiveFiniteMaps)
{
    LIGHTWELL_NEED_DATA(shared_data() / "hard_meshes/exr/BrightRingsNanInf.exr");
    EnvironmentMap const map = load_environment(shared_data() / "hard_meshes/exr/BrightRingsNanInf.exr", report_);
    for (vec3 const& v : map.radiance) ASSERT_TRUE(all_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0);
    EXPECT_FALSE(report_.losses().empty());
}

} // namespace
} // namespace gi::test
