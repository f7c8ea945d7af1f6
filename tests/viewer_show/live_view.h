#pragma once
// A running `lightwell view`: its process, its remote control and a folder for its files.

#include "gi/core/error.h"
#include "tests/support/xvfb.h"
#include "tests/viewer/run_program.h"
#include "viewer/protocol/remote/remote_client.h"

#include <memory>
#include <optional>
#include <stdexcept>

namespace viewer::test {

using Json = nlohmann::json;

/// An X server for the tests of one suite, or a visible skip where there is none.
class OnScreen : public ::testing::Test {
protected:
    static void SetUpTestSuite() { server = std::make_unique<gi::test::Xvfb>(1000, 700); }
    static void TearDownTestSuite() { server.reset(); }
    void SetUp() override
    {
        if (!server->problem().empty()) GTEST_SKIP() << "SKIPPED: " << server->problem();
    }

    static inline std::unique_ptr<gi::test::Xvfb> server;
};

inline double ms_since(std::chrono::steady_clock::time_point t)
{
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - t).count();
}
inline void sleep_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

/// Waits until it is so; false after a minute, in which a machine with more to do gets there too.
template <class Condition>
bool is_soon(Condition const& condition)
{
    auto const end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > end) return false;
        sleep_ms(10);
    }
    return true;
}

/// A picture that depends on nothing but what is set: all of the window's pixels, no panel, no refinement.
inline std::string const kStill =
    " --set panel=false --set refine=false --set reproject=false --set paths=1 --set scale=1";

class LiveView {
public:
    /// `lightwell view ARGUMENTS --remote ...`, split at blanks; waits until it listens. Throws std::runtime_error
    /// with what it said if it ends, or does not listen within the limit.
    explicit LiveView(std::string const& arguments, std::chrono::seconds limit = std::chrono::seconds(60))
        : program_(words("view " + arguments + " --remote " + socket()), folder_.path())
    {
        auto const end = std::chrono::steady_clock::now() + limit;
        while (!client_) {
            try {
                client_.emplace(socket());
            } catch (gi::InputError const&) {
                if (!program_.runs() || std::chrono::steady_clock::now() > end)
                    throw std::runtime_error("lightwell view " + arguments +
                                             " does not listen: " + program_.errors());
                sleep_ms(10);
            }
        }
    }

    TemporaryFolder const& folder() const { return folder_; }
    Program& program() { return program_; }
    std::string socket() const { return folder_ / "remote"; }

    /// The whole answer, with "result" or "error". Throws InputError if none comes.
    Json answer(Json const& request, std::chrono::seconds limit = std::chrono::seconds(60))
    {
        return client_->ask(request, limit);
    }
    /// The result; an error fails the test.
    Json ask(Json const& request)
    {
        Json const a = answer(request);
        EXPECT_TRUE(a.contains("result")) << request << " -> " << a;
        return a.value("result", Json::object());
    }
    void set(std::string const& key, Json const& value) { ask({{"do", "set"}, {"key", key}, {"value", value}}); }
    /// Waits until it has been at rest for a while (with refine=false); stats of the last frame.
    Json settle(int quiet_ms = 200)
    {
        Json stats = ask({{"do", "stats"}});
        auto since = std::chrono::steady_clock::now();
        auto const end = since + std::chrono::seconds(60);
        while (true) {
            sleep_ms(25);
            Json const now = ask({{"do", "stats"}});
            auto const t = std::chrono::steady_clock::now();
            if (!now.value("at_rest", false) || now.value("frame", -1) != stats.value("frame", -1)) since = t;
            stats = now;
            if (t - since > std::chrono::milliseconds(quiet_ms)) return stats;
            if (t > end) {
                ADD_FAILURE() << "the picture does not come to rest: " << stats;
                return stats;
            }
        }
    }
    /// Saves it; the number of the frame.
    int screenshot(std::string const& file, std::optional<int> view = {})
    {
        Json request{{"do", "screenshot"}, {"file", folder_ / file}};
        if (view) request["view"] = *view;
        return ask(request).value("frame", -1);
    }
    /// By the remote control, in order.
    Outcome quit()
    {
        ask({{"do", "quit"}});
        Outcome const o = program_.wait();
        EXPECT_EQ(o.code, 0) << "signal " << o.signal << "\n" << o.err;
        return o;
    }

private:
    TemporaryFolder folder_;
    Program program_;
    std::optional<RemoteClient> client_;
};

} // namespace viewer::test
