// lightwell view --hmd with a real runtime: what its lenses hide is not rendered,
// and a replay leaves out the same.

#include "tests/viewer_xr/monado.h"

namespace viewer::test {
namespace {

using nlohmann::json;

TEST_F(Monado, WhatItsLensesHideIsNotRendered)
{
    start_service();
    std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
    for (std::string const& a : words("view cornell --hmd --set resolution=64 --set directions=icosahedron:80 "
                                      "--set paths=1 --set scale=0.5"))
        call.push_back(a);
    for (auto const& [option, file] :
         {std::pair{"--record", "walk.lwr"}, {"--stats", "stats.json"}, {"--remote", "remote"}}) {
        call.emplace_back(option);
        call.push_back((folder / file).string());
    }
    Child program(call, folder.path(), "view", {"DISPLAY="});
    ASSERT_TRUE(wait_for([&] { return std::filesystem::exists(folder / "remote"); }, Seconds(60)))
        << program.out() << program.err();
    json stats;
    EXPECT_TRUE(wait_for(
        [&] {
            stats = json::parse(run_well(R"(remote remote {"do":"stats"})", folder.path()).out);
            return stats.value("frame", 0) >= 10;
        },
        Seconds(60)))
        << stats;
    run_well(R"(remote remote {"do":"quit"})", folder.path());
    EXPECT_EQ(program.wait(Seconds(60)), 0) << program.out() << program.err();

    json const all = json::parse(file_text(folder / "stats.json"));
    std::puts(all["headset"].dump().c_str());
    EXPECT_GT(all["report"]["counts"].value("share of pixels not rendered", 0.0), 0.01);
    EXPECT_GT(all["headset"]["left_out"][0], 0.01);
    EXPECT_EQ(all["headset"]["left_out"][0], all["headset"]["left_out"][1]);
    Outcome const again = run_well("view --replay walk.lwr", folder.path()); // fails where a bit differs
    EXPECT_NE(again.out.find(" 0 not, 0 unknown"), std::string::npos) << again.out;
    std::puts(again.out.c_str());
}

} // namespace
} // namespace viewer::test
