// lightwell xr info: with a runtime and without.

#include "tests/viewer_xr/monado.h"

namespace viewer::test {
namespace {

TEST_F(Monado, IsDescribedByXrInfo)
{
    start_service();
    auto const describe = [&](std::vector<std::string> const& arguments) {
        std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
        call.insert(call.end(), arguments.begin(), arguments.end());
        Child program(call, folder.path(), "info");
        EXPECT_EQ(program.wait(Seconds(60)), 0) << program.out() << program.err();
        return program.out();
    };
    std::string const text = describe({"xr", "info"});
    for (char const* expected : {"Monado", "320 x 240", "XR_MND_headless", "opaque"})
        EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
    std::puts(text.c_str());
    auto const j = nlohmann::json::parse(describe({"xr", "info", "--json"}));
    EXPECT_EQ(j["width"], 320);
    EXPECT_EQ(j["height"], 240);
    EXPECT_FALSE(j["extensions_used"].empty());
}

TEST(XrInfo, RefusesWithoutARuntimeInOneLine)
{
    TemporaryFolder const folder;
    Child program({LIGHTWELL_PROGRAM, "xr", "info"}, folder.path(), "info", {"XR_RUNTIME_JSON=/nonexistent.json"});
    EXPECT_EQ(program.wait(Seconds(60)), 2);
    EXPECT_EQ(program.out(), "");
    std::string const err = program.err();
    EXPECT_TRUE(err.starts_with("lightwell: there is no OpenXR runtime (")) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
}

} // namespace
} // namespace viewer::test
