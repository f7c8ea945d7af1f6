// `lightwell view --remote-port`: only who can read the token's file may use the port.

#include "tests/viewer_show/live_view.h"
#include "viewer/protocol/remote/remote_token.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

class RemotePort : public OnScreen {};

int free_tcp_port()
{
    int port = 0;
    Socket const probe = listen_on_loopback(port);
    return port;
}

TEST_F(RemotePort, NeedsTheTokenOfItsFile)
{
    int const port = free_tcp_port();
    LiveView view(fmt::format("cornell --size 64x64 --remote-port {} --remote-token t --stats s.json", port) +
                  kStill);
    std::filesystem::path const file = view.folder() / "t";
    EXPECT_NE(view.program().errors().find(fmt::format("remote control at 127.0.0.1:{}, token in {}", port,
                                                       std::filesystem::canonical(file).string())),
              std::string::npos)
        << view.program().errors();
    Json const ping{{"do", "ping"}};
    EXPECT_TRUE(RemoteClient(std::to_string(port), file).ask(ping).contains("result"));
    EXPECT_TRUE(RemoteClient::without_token(std::to_string(port)).ask(ping).contains("error"));
    EXPECT_THROW(RemoteClient(std::to_string(port), view.folder() / "other"), gi::InputError);
    std::string const remote = fmt::format("remote {} {{\"do\":\"ping\"}}", port);
    EXPECT_EQ(run(remote, view.folder().path()).code, 2) << "the file is not where it is looked for";
    EXPECT_EQ(run(remote + " --token " + file.string(), view.folder().path()).code, 0);
    view.settle();
    view.quit();
    EXPECT_FALSE(std::filesystem::exists(file));
    Json const stats = Json::parse(file_text(view.folder() / "s.json"));
    EXPECT_EQ(stats["report"]["losses"]["remote clients without the port's token"]["count"], 2) << stats;
    EXPECT_GT(stats["frames"]["frames"], 0) << "without --frame-log";
}

TEST_F(RemotePort, IsOpenOnlyWhenAsked)
{
    int const port = free_tcp_port();
    LiveView view(fmt::format("cornell --size 64x64 --remote-port {} --remote-open", port) + kStill);
    EXPECT_TRUE(RemoteClient::without_token(std::to_string(port)).ask({{"do", "ping"}}).contains("result"));
    for (char const* wrong : {"view cornell --remote-open", "view cornell --remote-token t",
                              "view cornell --remote-port 0 --remote-open --remote-token t"})
        EXPECT_EQ(run(wrong, view.folder().path()).code, 2) << wrong;
    view.quit();
}

} // namespace
} // namespace viewer::test
