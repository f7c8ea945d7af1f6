// lightwell recording and lightwell remote, with a recording and a server that the test makes.

#include "tests/viewer/run_program.h"
#include "tests/viewer_recording/walk.h"
#include "viewer/protocol/remote/remote_server.h"

#include <stop_token>

namespace viewer::test {
namespace {

using nlohmann::json;

void record_walk(std::filesystem::path const& file)
{
    gi::Report report;
    Recorder recorder(file, walk_header(), report);
    for (std::uint64_t n = 0; n < 61; ++n) recorder.append(walk_frame(n));
}

TEST(RecordingCommand, TellsWhatARecordingHolds)
{
    TemporaryFolder const folder;
    record_walk(folder / "walk.lwr");
    json const j = json::parse(run_well("recording info walk.lwr --json", folder.path()).out);
    EXPECT_EQ(j["frames"], 61);
    EXPECT_EQ(j["last_frame"], 60);
    EXPECT_EQ(j["duration_s"], 1.0);
    EXPECT_EQ(j["changes"], 14);
    EXPECT_EQ(j["ended"], "in order");
    EXPECT_EQ(j["scene"], "atrium");
    EXPECT_EQ(j["views"], (json{"wall, 0 640x480", "wall, 1 640x480"}));
    Outcome const plain = run_well("recording info walk.lwr", folder.path());
    EXPECT_NE(plain.out.find("\nframes "), std::string::npos) << plain.out;
    EXPECT_EQ(plain.err, "");
}

TEST(RecordingCommand, ExportsWhatIsLeftOfADamagedOne)
{
    TemporaryFolder const folder;
    record_walk(folder / "walk.lwr");
    std::filesystem::resize_file(folder / "walk.lwr", std::filesystem::file_size(folder / "walk.lwr") - 100);
    Outcome const o = run_well("recording export walk.lwr --csv walk.csv", folder.path());
    EXPECT_EQ(o.out, "walk.csv: 60 frames\n");
    EXPECT_NE(o.err.find("frame 59 is the last"), std::string::npos) << o.err;
    std::string const table = text_of(folder / "walk.csv");
    EXPECT_NE(table.find("\n59,"), std::string::npos);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"walk.csv", "walk.lwr"}));
}

TEST(RecordingCommand, RecordingsOfEarlierVersionsAreReplayed)
{
    TemporaryFolder const folder;
    for (std::string const commit : {"7d477989"}) {
        Outcome const o =
            run("view --replay " LIGHTWELL_SOURCE_DIR "/tests/data/old/" + commit + "/cornell.lwr", folder.path());
        EXPECT_LT(o.code, 2) << o.err; // 1: other pixels than those of that version
        EXPECT_NE(o.out.find(" frames replayed"), std::string::npos) << o.out;
    }
}

TEST(RecordingCommand, UnknownSettingsOfARecordingAreCountedAndRefusedOnesHaveAWayOut)
{
    TemporaryFolder const folder;
    auto const record = [&](char const* key, nlohmann::json const& value) {
        std::filesystem::remove(folder / "one.lwr");
        RecordingHeader header;
        header.scene = "cornell";
        header.settings = {{"settings", {{"method", "reference"}, {key, value}}}};
        RecordedFrame f;
        ViewCommand& view = f.command.views.emplace_back();
        view.width = view.height = 8;
        gi::Report report;
        Recorder(folder / "one.lwr", header, report).append(f);
    };
    record("wings", 2);
    Outcome const unknown = run_well("view --replay one.lwr", folder.path());
    EXPECT_NE(unknown.err.find("recorded settings that this version does not know: pixels may differ"),
              std::string::npos)
        << unknown.err;
    record("tone", "sepia");
    Outcome const refused = run("view --replay one.lwr", folder.path());
    EXPECT_EQ(refused.code, 2);
    EXPECT_NE(refused.err.find("the recorded setting 'tone' is refused"), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("choose another value with --set tone=VALUE"), std::string::npos) << refused.err;
    EXPECT_EQ(run("view --replay one.lwr --set tone=srgb", folder.path()).code, 0);
}

/// On a walk that the test makes: view, which makes theirs, needs a display.
TEST(RecordingCommand, RunsTheExamplesOfItsHelp)
{
    for (char const* command : {"recording", "recording info", "recording export"}) {
        TemporaryFolder const folder;
        record_walk(folder / "walk.lwr");
        std::istringstream help(run_well(std::string(command) + " --help", folder.path()).out);
        std::string const start = std::string("  lightwell ") + command;
        int count = 0;
        for (std::string line; std::getline(help, line);) {
            if (!line.starts_with(start)) continue;
            run_well(line.substr(std::string("  lightwell ").size()), folder.path());
            ++count;
        }
        EXPECT_GT(count, 0) << help.str();
    }
}

TEST(RecordingCommand, RefusesWhatItCannotRead)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "text.lwr") << "some text";
    record_walk(folder / "walk.lwr");
    for (char const* call :
         {"recording", "recording info", "recording info nowhere.lwr", "recording info text.lwr",
          "recording export walk.lwr", "recording export walk.lwr --csv walk.lwr",
          "recording export walk.lwr --csv none/walk.csv", "recording export text.lwr --csv a.csv"}) {
        Outcome const o = run(call, folder.path());
        EXPECT_EQ(o.code, 2) << call << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << call << "\n" << o.err;
    }
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"text.lwr", "walk.lwr"}));
}

TEST(RemoteCommand, AsksAndPrints)
{
    TemporaryFolder const folder;
    gi::Report report;
    RemoteServer server(
        {folder / "s", {}, {}},
        [](RemoteRequest const& r) -> std::optional<json> {
            if (r.what == "quit") throw std::runtime_error("broken");
            return json{{"asked", r.what}};
        },
        report);
    std::jthread const thread([&](std::stop_token const& stop) {
        while (!stop.stop_requested()) server.poll(std::chrono::milliseconds(5));
    });
    Outcome const good = run_well(R"(remote s {"do":"stats"} {"do":"ping"})", folder.path());
    EXPECT_EQ(good.out, "{\"asked\":\"stats\"}\n{\"asked\":\"ping\"}\n");
    Outcome const bad = run(R"(remote s {"do":"quit"})", folder.path());
    EXPECT_EQ(bad.code, 2);
    EXPECT_NE(bad.err.find("broken"), std::string::npos) << bad.err;
    for (char const* call :
         {R"(remote s {"do":"fly"})", "remote s rubbish", R"(remote nowhere {"do":"ping"})",
          R"(remote 1 {"do":"ping"})", "remote s", R"(remote s {"do":"ping"} --timeout never)"}) {
        Outcome const o = run(call, folder.path());
        EXPECT_EQ(o.code, 2) << call << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << call << "\n" << o.err;
    }
}

} // namespace
} // namespace viewer::test
