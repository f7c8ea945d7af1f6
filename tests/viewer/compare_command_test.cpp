// `lightwell compare`: its table, its verdict, its exit code.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

using Json = nlohmann::json;

/// Grey pictures one.exr (0.5), two.exr (0.6), small.exr (half the size), odd.exr (no whole factor).
class CompareCommand : public testing::Test {
protected:
    void SetUp() override
    {
        write("one.exr", 32, 16, 0.5f);
        write("two.exr", 32, 16, 0.6f);
        write("small.exr", 16, 8, 0.5f);
        write("odd.exr", 31, 16, 0.5f);
    }
    void write(std::string const& name, int width, int height, float value) const
    {
        gi::Picture picture;
        picture.width = width;
        picture.height = height;
        for (float& v : picture.add("color", 3).data) v = value;
        gi::Report report;
        gi::write_exr(folder_ / name, picture, gi::PixelType::single, report);
    }
    Outcome compare(std::string const& arguments) const { return run("compare " + arguments, folder_.path()); }

    TemporaryFolder folder_;
};

TEST_F(CompareCommand, PrintsATable)
{
    Outcome const o = compare("two.exr one.exr --metrics rmse,bias");
    EXPECT_EQ(o.code, 0) << o.err;
    std::vector<std::string> const w = words(o.out);
    ASSERT_GE(w.size(), 4u);
    EXPECT_EQ(w[0], "rmse");
    EXPECT_NEAR(std::stod(w[1]), 0.1, 1e-5);
    EXPECT_EQ(w[2], "bias");
    EXPECT_NEAR(std::stod(w[3]), 1.2, 1e-5);
}

TEST_F(CompareCommand, FailsAboveALimitAndSaysWhich)
{
    Outcome const above = compare("two.exr one.exr --fail-above rmse=0.05,relmse=1");
    EXPECT_EQ(above.code, 1);
    EXPECT_NE(above.err.find("failed: rmse is 0.1, above 0.05"), std::string::npos) << above.err;
    EXPECT_EQ(above.err.find("relmse"), std::string::npos) << above.err;
    EXPECT_EQ(compare("two.exr one.exr --fail-above rmse=0.2 --fail-above bias.r=1.3").code, 0);
    EXPECT_EQ(compare("one.exr one.exr --metrics rmse --fail-above hdrflip=0").code, 0);
}

TEST_F(CompareCommand, RefusesWhatItDoesNotKnow)
{
    for (char const* arguments :
         {"one.exr two.exr --metrics beauty", "one.exr two.exr --fail-above beauty=1",
          "one.exr two.exr --metrics rmse --fail-above beauty=1", "one.exr two.exr --fail-above bias.q=1",
          "one.exr two.exr --fail-above rmse", "one.exr two.exr --layer L7", "one.exr odd.exr",
          "one.exr two.exr --metrics ztest", "one.exr two.exr --diff nowhere/d.png",
          "one.exr two.exr --diff one.exr", "one.exr two.exr --diff d.exr", "one.exr nowhere.exr"}) {
        Outcome const o = compare(arguments);
        EXPECT_EQ(o.code, 2) << arguments << o.err;
        EXPECT_TRUE(o.out.empty()) << arguments;
        EXPECT_TRUE(o.err.starts_with("lightwell: ")) << arguments << o.err;
    }
    EXPECT_EQ(folder_.files(), (std::vector<std::string>{"odd.exr", "one.exr", "small.exr", "two.exr"}));
}

TEST_F(CompareCommand, WritesTheDifference)
{
    EXPECT_EQ(compare("one.exr two.exr --diff d.png").code, 0);
    gi::Picture const d = gi::read_picture(folder_ / "d.png");
    EXPECT_EQ(d.width, 32);
    EXPECT_EQ(d.height, 16);
}

TEST_F(CompareCommand, SaysThatItAveragedDown)
{
    Outcome const o = compare("one.exr small.exr --metrics rmse --fail-above rmse=1e-6");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("averaged down by 2 x 2"), std::string::npos) << o.err;
}

TEST_F(CompareCommand, Json)
{
    Outcome const o = compare("two.exr one.exr --fail-above rmse=0.05 --json");
    EXPECT_EQ(o.code, 1);
    auto const j = Json::parse(o.out);
    EXPECT_NEAR(j["values"]["rmse"], 0.1, 1e-5);
    EXPECT_EQ(j["failures"].size(), 1u);
    EXPECT_EQ(Json::parse(compare("one.exr one.exr --json").out)["values"]["psnr"], "inf");
}

} // namespace
} // namespace viewer::test
