// lightwell xr info: with a runtime and without.

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "tests/viewer_xr/monado.h"
#include "viewer/protocol/remote/remote_client.h"

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

TEST_F(Monado, ScreenshotsHaveBothEyes)
{
    start_service();
    std::string const socket = folder / "remote";
    Child view({kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM, "view", "mirror", "--hmd",
                "--set", "paths=1", "--remote", socket, "--screenshots", folder / "key_"},
               folder.path(), "view");
    std::optional<RemoteClient> client;
    ASSERT_TRUE(wait_for(
        [&] {
            try {
                client.emplace(socket);
            } catch (gi::InputError const&) {
            }
            return client.has_value();
        },
        Seconds(60)))
        << view.err();
    std::string const shown = folder / "shown.png", light = folder / "light.exr";
    for (std::string const& file : {shown, light}) {
        auto const answer = client->ask({{"do", "screenshot"}, {"file", file}}, std::chrono::seconds(60));
        EXPECT_TRUE(answer.contains("result")) << answer;
    }
    gi::Picture const png = gi::read_picture(shown), exr = gi::read_picture(light);
    EXPECT_EQ(png.width, 2 * 320);
    EXPECT_EQ(png.height, 240);
    EXPECT_GT(exr.width, 0);
    std::vector<float> const& color = png.find("color")->data;
    double halves[2] = {};
    for (std::size_t i = 0; i < color.size(); ++i) halves[i / 3 % 640 / 320] += double(color[i]);
    EXPECT_GT(halves[0], 0.01 * double(color.size()));
    EXPECT_NEAR(halves[1] / halves[0], 1, 0.3) << "the eyes see the same room";
    client->ask({{"do", "key"}, {"key", "F2"}}, std::chrono::seconds(60));
    auto const saved = [&] {
        nlohmann::json const stats = client->ask({{"do", "stats"}}, std::chrono::seconds(60));
        return stats.at("result").value("message", std::string()).starts_with("saved ");
    };
    EXPECT_TRUE(wait_for(saved, Seconds(60)));
    std::size_t files = 0;
    for (auto const& f : std::filesystem::directory_iterator(folder.path()))
        files += f.path().filename().string().starts_with("key_");
    EXPECT_EQ(files, 3u) << "what is shown, and all layers of each eye";
    client->ask({{"do", "quit"}}, std::chrono::seconds(60));
    EXPECT_EQ(view.wait(Seconds(60)), 0) << view.err();
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
