#include "viewer/protocol/remote/remote_server.h"

#include "gi/core/error.h"
#include "tests/support/processor_time.h"
#include "tests/viewer/run_program.h"
#include "viewer/protocol/remote/remote_client.h"

#include <atomic>
#include <fstream>
#include <random>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace viewer::test {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

/// Answers as a viewer would: "ping" at once, "screenshot" at the next turn, "quit" with an error, "stats" with
/// much, "load" with an exception that is no InputError.
class TestServer {
public:
    explicit TestServer(RemoteLimits const& limits = {}) : TestServer(with_both(limits)) {}
    explicit TestServer(RemoteOptions options)
    {
        if (!options.port || !options.open) options.socket = folder_ / "s";
        server_ = std::make_unique<RemoteServer>(
            options, [this](RemoteRequest const& r) { return handle(r); }, report);
        thread_ = std::thread([this] {
            while (!stop_) {
                server_->poll(5ms);
                for (std::uint64_t const token : std::exchange(later_, {}))
                    server_->answer(token, {{"file", "a.png"}});
                connected = server_->clients();
                unanswered = server_->waiting();
            }
        });
    }
    ~TestServer()
    {
        stop_ = true;
        thread_.join();
    }

    std::string path() const { return (folder_ / "s").string(); }
    std::string port() const { return std::to_string(server_->port()); }
    std::filesystem::path token_file() const { return server_->token_file(); }
    std::vector<std::string> files() const { return folder_.files(); }

    gi::Report report;
    std::atomic<std::size_t> handled = 0, connected = 0, unanswered = 0;
    std::atomic<bool> holds_back = false; ///< "screenshot" is never answered

private:
    static RemoteOptions with_both(RemoteLimits const& limits)
    {
        RemoteOptions options;
        options.port = 0;
        options.limits = limits;
        return options;
    }
    std::optional<json> handle(RemoteRequest const& r)
    {
        ++handled;
        if (r.what == "quit") throw gi::InputError("no", "it is a test", "stay");
        if (r.what == "load") throw std::runtime_error("broken");
        if (r.what == "stats") return json{{"text", std::string(100000, 'x')}};
        if (r.what == "set") return json{{"value", r.arguments["value"]}};
        if (r.what != "screenshot") return json::object();
        if (!holds_back) later_.push_back(r.token);
        return {};
    }

    TemporaryFolder folder_;
    std::unique_ptr<RemoteServer> server_;
    std::vector<std::uint64_t> later_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

template <class Condition>
bool comes_true(Condition const& condition)
{
    for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(5ms);
    return condition();
}

TEST(RemoteServer, AnswersOverSocketAndPort)
{
    TestServer server;
    for (std::string const& where : {server.path(), server.port()}) {
        RemoteClient client(where);
        EXPECT_EQ(client.ask({{"do", "ping"}}), (json{{"id", 1}, {"result", json::object()}}));
        EXPECT_EQ(client.ask({{"id", "mine"}, {"do", "ping"}})["id"], "mine");
        json const value{1.5, {{"a", "ä"}}, nullptr};
        EXPECT_EQ(client.ask({{"do", "set"}, {"key", "k"}, {"value", value}})["result"]["value"], value);
        EXPECT_EQ(client.ask({{"do", "screenshot"}, {"file", "a.png"}})["result"]["file"], "a.png");
        EXPECT_EQ(client.ask({{"do", "quit"}})["error"], "no (it is a test) stay");
        EXPECT_EQ(client.ask({{"do", "load"}, {"scene", "s"}})["error"], "internal error: broken");
        EXPECT_NE(client.ask({{"do", "fly"}})["error"].get<std::string>().find("no request"), std::string::npos);
        client.send("rubbish\n\n  \r\n\xff\xfe\n");
        EXPECT_EQ(json::parse(client.receive())["id"], nullptr);
        EXPECT_EQ(json::parse(client.receive())["id"], nullptr);
        EXPECT_EQ(client.ask({{"do", "ping"}}).count("result"), 1u);
    }
    EXPECT_TRUE(server.report.losses().empty());
}

TEST(RemoteServer, ManyRequestsInOneWriteAreAnsweredInOrder)
{
    TestServer server;
    RemoteClient client(server.path());
    std::string all;
    for (int i = 0; i < 1000; ++i) all += json{{"id", i}, {"do", "ping"}}.dump() + "\r\n";
    std::thread writer([&] { client.send(all); });
    for (int i = 0; i < 1000; ++i) EXPECT_EQ(json::parse(client.receive())["id"], i);
    writer.join();
}

TEST(RemoteServer, LinesMayComeByteByByteAndWithoutTheirWriter)
{
    TestServer server;
    RemoteClient client(server.path());
    for (char const c : std::string("{\"id\":4,\"do\":\"ping\"}\n")) {
        client.send({&c, 1});
        std::this_thread::sleep_for(1ms);
    }
    EXPECT_EQ(json::parse(client.receive())["id"], 4);
    Socket const other = connect_to(server.path()); // sends, ends its side, and still gets its answers
    std::string const text =
        "{\"id\":5,\"do\":\"screenshot\",\"file\":\"f\"}\n{\"id\":6,\"do\":\"ping\"}\n{\"half";
    ASSERT_EQ(::send(other.fd(), text.data(), text.size(), 0), ssize_t(text.size()));
    ::shutdown(other.fd(), SHUT_WR);
    std::string got;
    char chunk[4096];
    for (ssize_t n; (n = ::recv(other.fd(), chunk, sizeof chunk, 0)) > 0;) got.append(chunk, std::size_t(n));
    EXPECT_NE(got.find("\"id\":5"), std::string::npos) << got;
    EXPECT_NE(got.find("\"id\":6"), std::string::npos) << got;
    EXPECT_EQ(server.report.losses().at("remote requests that end within their line").count, 1u);
}

TEST(RemoteServer, TheLastLineMayLackItsEnd)
{
    TestServer server;
    Socket const other = connect_to(server.path());
    std::string const text = "{\"id\":7,\"do\":\"ping\"}";
    ASSERT_EQ(::send(other.fd(), text.data(), text.size(), 0), ssize_t(text.size()));
    ::shutdown(other.fd(), SHUT_WR);
    std::string got;
    char chunk[4096];
    for (ssize_t n; (n = ::recv(other.fd(), chunk, sizeof chunk, 0)) > 0;) got.append(chunk, std::size_t(n));
    EXPECT_NE(got.find("\"id\":7"), std::string::npos) << got;
    EXPECT_TRUE(server.report.losses().empty());
}

TEST(RemoteServer, WebPagesCannotSpeakToIt)
{
    TestServer server;
    RemoteClient client = RemoteClient::without_token(server.port());
    client.send("POST / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n{\"do\":\"ping\"}\n");
    EXPECT_NE(client.receive().find("no request"), std::string::npos);
    EXPECT_THROW(client.receive(), gi::InputError);
    EXPECT_EQ(server.handled, 0u);
}

TEST(RemoteToken, IsNeededOnThePortOnly)
{
    TestServer server;
    RemoteClient without = RemoteClient::without_token(server.port());
    EXPECT_EQ(
        without.ask({{"do", "ping"}})["error"],
        "the first line is no token (only who can read it may use this port) begin with {\"token\": ...} from the "
        "file that the viewer printed");
    EXPECT_THROW(without.ask({{"do", "ping"}}), gi::InputError) << "it is closed";
    RemoteClient wrong = RemoteClient::without_token(server.port());
    EXPECT_NE(wrong.ask({{"token", std::string(64, '0')}})["error"].get<std::string>().find("the token is wrong"),
              std::string::npos);
    RemoteClient number = RemoteClient::without_token(server.port());
    EXPECT_EQ(number.ask({{"token", 7}}).count("error"), 1u);
    RemoteClient both = RemoteClient::without_token(server.port());
    EXPECT_EQ(both.ask({{"token", *read_token(server.token_file())}, {"do", "ping"}}).count("error"), 1u)
        << "the token has a line of its own";
    EXPECT_EQ(server.report.losses().at("remote clients without the port's token").count, 4u);
    EXPECT_EQ(server.handled, 0u);
    RemoteClient right = RemoteClient::without_token(server.port());
    EXPECT_EQ(right.ask({{"id", 5}, {"token", *read_token(server.token_file())}}),
              (json{{"id", 5}, {"result", json::object()}}));
    EXPECT_EQ(right.ask({{"do", "ping"}}).count("result"), 1u);
    RemoteClient at_path(server.path());
    EXPECT_EQ(at_path.ask({{"token", "any"}}).count("result"), 1u) << "not needed there";
}

TEST(RemoteToken, FileIsTheOwnersAlone)
{
    std::filesystem::path file;
    {
        TestServer server;
        file = server.token_file();
        EXPECT_EQ(file, default_token_file(std::stoi(server.port())));
        struct stat about {};
        ASSERT_EQ(::stat(file.c_str(), &about), 0);
        EXPECT_EQ(about.st_mode & 0777, 0600u);
        ASSERT_EQ(::stat(file.parent_path().c_str(), &about), 0);
        EXPECT_EQ(about.st_mode & 0777, 0700u);
    }
    EXPECT_FALSE(std::filesystem::exists(file)) << "left behind";
    TemporaryFolder folder;
    auto const mine = folder / "t";
    std::string first;
    {
        TokenFile const a(mine);
        first = a.token();
        EXPECT_EQ(read_token(mine), first);
        TokenFile const b(mine); // as after a crash: the older token is replaced
        EXPECT_NE(b.token(), first);
        EXPECT_EQ(read_token(mine), b.token());
    }
    std::ofstream(mine) << "my thesis";
    EXPECT_THROW(TokenFile{mine}, gi::InputError) << "a file with something else is kept";
    EXPECT_THROW(read_token(mine), gi::InputError);
    EXPECT_THROW(TokenFile{folder / "none" / "t"}, gi::InputError);
    EXPECT_FALSE(read_token(folder / "nothing"));
    EXPECT_TRUE(is_token(first, first));
    EXPECT_FALSE(is_token(first.substr(1), first));
    EXPECT_FALSE(is_token(first + "0", first));
    EXPECT_FALSE(is_token("", first));
}

TEST(RemoteToken, OpenPortsNeedNone)
{
    RemoteOptions options;
    options.port = 0;
    options.open = true;
    TestServer server(options);
    EXPECT_TRUE(server.token_file().empty());
    EXPECT_FALSE(std::filesystem::exists(default_token_file(std::stoi(server.port()))));
    EXPECT_EQ(RemoteClient(server.port()).ask({{"do", "ping"}}).count("result"), 1u);
}

TEST(RemoteToken, StrangersDoNotKeepAPlace)
{
    RemoteOptions options;
    options.port = 0;
    options.limits.without_token = 100ms;
    TestServer server(options);
    RemoteClient silent = RemoteClient::without_token(server.port());
    EXPECT_NE(silent.receive().find("no token came in time"), std::string::npos);
    RemoteClient chatty = RemoteClient::without_token(server.port());
    chatty.send(std::string(10000, 'x'));
    EXPECT_NE(chatty.receive().find("error"), std::string::npos);
    EXPECT_TRUE(comes_true([&] { return server.connected == 0; }));
}

TEST(RemoteServer, LongLinesAreRefusedAndPassed)
{
    TestServer server;
    RemoteClient client(server.path());
    EXPECT_EQ(client.ask({{"do", "ping"}}).count("result"), 1u);
    std::string const large(1000000, 'a');
    EXPECT_EQ(client.ask({{"do", "set"}, {"key", "k"}, {"value", large}})["result"]["value"], large);
    client.send(std::string(3000000, 'a'));
    EXPECT_NE(client.receive().find("too long"), std::string::npos);
    client.send("end of it\n");
    EXPECT_EQ(client.ask({{"do", "ping"}}).count("result"), 1u);
}

TEST(RemoteServer, SlowReadersAreDroppedAndOthersServed)
{
    TestServer server;
    RemoteClient slow(server.path()), other(server.path());
    EXPECT_THROW( // 100 kB of answers for every 15 bytes
        for (int i = 0; i < 1000; ++i) {
            slow.send("{\"do\":\"stats\"}\n", 2s);
            std::this_thread::sleep_for(1ms);
        },
        gi::InputError);
    EXPECT_EQ(other.ask({{"do", "ping"}}).count("result"), 1u);
    auto const losses = server.report.losses();
    ASSERT_EQ(losses.count("remote clients dropped"), 1u);
    EXPECT_NE(losses.at("remote clients dropped").first.find("unread"), std::string::npos);
    EXPECT_TRUE(comes_true([&] { return server.connected == 1; }));
}

TEST(RemoteServer, TenThousandClientsComeAndGo)
{
    TestServer server;
    RemoteClient steady(server.path());
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i) {
        try {
            Socket const s = connect_to(i % 2 == 0 ? server.path() : server.port());
            std::string text = "{\"do\":\"screenshot\",\"file\":\"f\"}\n{\"do\":\"stats\"}\n";
            if (random() % 3 == 0)
                for (char& c : text) c = char(random());
            text.resize(random() % (text.size() + 1));
            ::send(s.fd(), text.data(), text.size(), MSG_NOSIGNAL);
        } catch (gi::InputError const&) { // faster than the server accepts
        }
        if (i % 1000 == 0) {
            EXPECT_EQ(steady.ask({{"do", "ping"}}).count("result"), 1u) << i;
        }
    }
    EXPECT_TRUE(comes_true([&] { return server.connected == 1 && server.unanswered == 0; }))
        << server.connected << " " << server.unanswered;
    EXPECT_EQ(steady.ask({{"do", "ping"}}).count("result"), 1u);
}

TEST(RemoteServer, TooManyAtOnceAreToldSo)
{
    RemoteLimits limits;
    limits.clients = 3;
    limits.waiting = 2;
    TestServer server(limits);
    server.holds_back = true;
    std::vector<RemoteClient> clients;
    for (int i = 0; i < 3; ++i) {
        clients.emplace_back(server.path());
        EXPECT_EQ(clients.back().ask({{"do", "ping"}}).count("result"), 1u);
    }
    RemoteClient fourth(server.path());
    EXPECT_NE(fourth.receive().find("no place is left"), std::string::npos);
    EXPECT_THROW(fourth.receive(), gi::InputError);
    for (int i = 0; i < 2; ++i) clients[0].send("{\"do\":\"screenshot\",\"file\":\"f\"}\n");
    EXPECT_NE(clients[0].ask({{"do", "screenshot"}, {"file", "f"}})["error"].get<std::string>().find("too many"),
              std::string::npos);
    EXPECT_EQ(clients[1].ask({{"do", "ping"}}).count("result"), 1u);
    clients.erase(clients.begin()); // with two requests unanswered
    EXPECT_TRUE(comes_true([&] { return server.connected == 2 && server.unanswered == 0; }));
    EXPECT_EQ(RemoteClient(server.path()).ask({{"do", "ping"}}).count("result"), 1u);
}

TEST(RemoteServer, AnswersComeOnceAndOnlyToThoseWhoAreThere)
{
    gi::Report report;
    std::vector<std::uint64_t> tokens;
    RemoteServer server(
        {},
        [&](RemoteRequest const& r) {
            tokens.push_back(r.token);
            return std::optional<json>();
        },
        report);
    int ends[2];
    ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    server.adopt(Socket(ends[0]));
    Socket mine(ends[1]);
    std::string const two = "{\"do\":\"ping\"}\n{\"do\":\"ping\"}\n";
    ASSERT_EQ(::send(mine.fd(), two.data(), two.size(), 0), ssize_t(two.size()));
    server.poll();
    ASSERT_EQ(tokens.size(), 2u);
    EXPECT_TRUE(server.answer(tokens[0], 1));
    EXPECT_FALSE(server.answer(tokens[0], 1));
    EXPECT_FALSE(server.refuse(999, "no"));
    mine = Socket();
    for (int i = 0; i < 5; ++i) server.poll();
    EXPECT_EQ(server.clients(), 0u);
    EXPECT_FALSE(server.answer(tokens[1], 1));
}

TEST(RemoteServer, PollsWithoutATimeWaitForNobody)
{
    TemporaryFolder const folder;
    gi::Report report;
    RemoteServer server(
        {folder / "s", {}, {}}, [](RemoteRequest const&) { return json(); }, report);
    long const before = gi::test::waits();
    for (int i = 0; i < 1000; ++i) server.poll();
    EXPECT_LT(gi::test::waits() - before, 100);
}

TEST(Sockets, AreForTheirOwnerAndAreRemoved)
{
    TemporaryFolder const folder;
    gi::Report report;
    auto const nothing = [](RemoteRequest const&) { return std::optional<json>(); };
    {
        RemoteServer const server({folder / "s", {}, {}}, nothing, report);
        struct stat about {};
        ASSERT_EQ(::stat((folder / "s").c_str(), &about), 0);
        EXPECT_EQ(about.st_mode & 0777, 0600u);
        EXPECT_THROW(RemoteServer({folder / "s", {}, {}}, nothing, report), gi::InputError); // it is live
        EXPECT_EQ(folder.files(), std::vector<std::string>{"s"});
    }
    EXPECT_TRUE(folder.files().empty());
}

TEST(Sockets, StaleOnesAreReplacedOthersAreNot)
{
    TemporaryFolder const folder;
    gi::Report report;
    auto const nothing = [](RemoteRequest const&) { return std::optional<json>(); };
    {
        Socket const left = listen_at(folder / "s"); // nobody removes its file
    }
    EXPECT_EQ(folder.files().size(), 1u);
    EXPECT_THROW(RemoteClient((folder / "s").string()), gi::InputError);
    RemoteServer const server({folder / "s", {}, {}}, nothing, report);
    RemoteClient const client((folder / "s").string());
    std::ofstream(folder / "f") << "precious";
    EXPECT_THROW(RemoteServer({folder / "f", {}, {}}, nothing, report), gi::InputError);
    EXPECT_EQ(file_text(folder / "f"), "precious");
    EXPECT_THROW(RemoteServer({folder / std::string(200, 'a'), {}, {}}, nothing, report), gi::InputError);
    EXPECT_THROW(RemoteServer({folder / "none" / "s", {}, {}}, nothing, report), gi::InputError);
}

TEST(Sockets, PortsAreOfLoopbackAndTakenOnce)
{
    int port = 0;
    Socket const first = listen_on_loopback(port);
    EXPECT_GT(port, 0);
    EXPECT_THROW(listen_on_loopback(port), gi::InputError);
    for (int bad : {-1, 65536}) EXPECT_THROW(listen_on_loopback(bad), gi::InputError);
    EXPECT_THROW(connect_to("65536"), gi::InputError);
    EXPECT_THROW(connect_to("0"), gi::InputError);
}

TEST(RemoteClient, WaitsNoLongerThanAsked)
{
    TestServer server;
    server.holds_back = true;
    RemoteClient client(server.path());
    EXPECT_THROW(client.ask({{"do", "screenshot"}, {"file", "f"}}, 50ms),
                 gi::InputError); // else it waits for ever
    EXPECT_EQ(client.ask({{"do", "ping"}})["id"], 2);
}

} // namespace
} // namespace viewer::test
