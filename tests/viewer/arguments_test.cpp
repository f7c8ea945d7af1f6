#include "viewer/base/arguments.h"

#include "gi/core/error.h"

#include <gtest/gtest.h>

namespace viewer {
namespace {

TEST(Arguments, Size)
{
    EXPECT_EQ(parse_size("512x384"), std::pair(512, 384));
    EXPECT_EQ(parse_size("1x65536"), std::pair(1, 65536));
    EXPECT_EQ(parse_size("16384x16384"), std::pair(16384, 16384));
    for (char const* bad : {"", "x", "512", "512x", "x384", "0x5", "-3x5", "5x65537", "16385x16384", "1.5x2",
                            "3x4x5", " 3x4", "3 x 4", "nanx3", "infx3", "1e99x3", "3X4"})
        EXPECT_THROW(parse_size(bad), gi::InputError) << bad;
}

TEST(Arguments, Point)
{
    gi::dvec3 const p = parse_point("--look-at", "1,-2.5,3e-2");
    EXPECT_EQ(p, (gi::dvec3{1, -2.5, 0.03}));
    for (char const* bad :
         {"", "1", "1,2", "1,2,", ",,", "1,2,3,4", "1;2;3", "1,2,x", "1,nan,3", "inf,0,0", "1, 2,3"})
        EXPECT_THROW(parse_point("--look-at", bad), gi::InputError) << bad;
}

TEST(Arguments, Duration)
{
    EXPECT_DOUBLE_EQ(parse_duration("--budget", "500ms"), 0.5);
    EXPECT_DOUBLE_EQ(parse_duration("--budget", "2s"), 2);
    EXPECT_DOUBLE_EQ(parse_duration("--budget", "3min"), 180);
    EXPECT_DOUBLE_EQ(parse_duration("--budget", "1.5h"), 5400);
    EXPECT_DOUBLE_EQ(parse_duration("--budget", "4"), 4);
    for (char const* bad : {"", "s", "ms", "0s", "-1s", "5 s", "5d", "nan", "infs", "1e306h", "5sms"})
        EXPECT_THROW(parse_duration("--budget", bad), gi::InputError) << bad;
}

TEST(Arguments, Target)
{
    EXPECT_DOUBLE_EQ(parse_target("--until", "relmse=0.001", "relmse"), 0.001);
    for (char const* bad : {"", "relmse", "relmse=", "relmse=0", "relmse=-1", "relmse=x", "mse=0.1", "=0.1"})
        EXPECT_THROW(parse_target("--until", bad, "relmse"), gi::InputError) << bad;
}

TEST(Arguments, Limit)
{
    EXPECT_EQ(parse_limit("--fail-above", "flip=0.05"), (std::pair<std::string, double>("flip", 0.05)));
    for (char const* bad : {"", "flip", "=1", "flip=", "flip=a", "flip=1=2"})
        EXPECT_THROW(parse_limit("--fail-above", bad), gi::InputError) << bad;
}

TEST(Arguments, Seed)
{
    for (char const* good : {"0", "7", "18446744073709551615", "0xffffffffffffffff"})
        EXPECT_EQ(check_seed(good), "") << good;
    for (char const* bad : {"-1", "18446744073709551616", "99999999999999999999", "0x10000000000000000"})
        EXPECT_NE(check_seed(bad), "") << bad;
}

TEST(Arguments, ExamplesAreOfTheOption)
{
    auto const suggestion = [](auto const& parse) -> std::string {
        try {
            parse();
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(suggestion([] { parse_target("--until", "relmse", "relmse"); }).find("write relmse=0.001"),
              std::string::npos);
    EXPECT_NE(suggestion([] { parse_limit("--fail-above", "flip"); }).find("write flip=0.05"), std::string::npos);
    EXPECT_NE(suggestion([] { parse_color("--background", "1,2"); }).find("write 0.9,0.5,0.1"), std::string::npos);
    EXPECT_NE(suggestion([] { parse_point("--look-at", "1,2"); }).find("write 1,1.6,-3"), std::string::npos);
}

TEST(Arguments, MessagesNameTheOptionAndAWayOut)
{
    try {
        parse_duration("--budget", "soon");
        FAIL();
    } catch (gi::InputError const& e) {
        EXPECT_STREQ(e.what(),
                     "--budget 'soon' is not understood (a positive duration is needed) write 500ms, 2s or 3min");
    }
}

} // namespace
} // namespace viewer
