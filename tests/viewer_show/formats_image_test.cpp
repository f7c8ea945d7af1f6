// Files that the running viewer writes, and those that it refuses before a window opens.

#include "tests/viewer_show/live_view.h"
#include "tests/viewer_show/x/x_window.h"

#include <csignal>
#include <set>
#include <sys/resource.h>

namespace viewer::test {
namespace {

struct FormatsOfView : OnScreen {};

std::vector<std::string> lines_of(std::string const& text)
{
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

std::vector<std::string> cells_of(std::string const& line)
{
    std::vector<std::string> cells;
    std::istringstream in(line);
    for (std::string cell; std::getline(in, cell, ',');) cells.push_back(cell);
    if (line.ends_with(',')) cells.emplace_back();
    return cells;
}

struct Table {
    std::vector<std::string> about;   ///< lines "# ..."
    std::vector<std::string> columns; ///< in order
    std::vector<std::map<std::string, std::string>> rows;
};

Table read_table(std::filesystem::path const& file)
{
    Table t;
    for (std::string const& line : lines_of(file_text(file))) {
        if (line.starts_with("#")) {
            t.about.push_back(line);
        } else if (t.columns.empty()) {
            t.columns = cells_of(line);
        } else {
            std::vector<std::string> const cells = cells_of(line);
            EXPECT_EQ(cells.size(), t.columns.size()) << line;
            std::map<std::string, std::string>& row = t.rows.emplace_back();
            for (std::size_t i = 0; i < std::min(cells.size(), t.columns.size()); ++i)
                row[t.columns[i]] = cells[i];
        }
    }
    return t;
}

void expect_refused(std::string const& arguments, std::filesystem::path const& folder)
{
    Outcome const o = Program(words("view " + arguments), folder).wait(std::chrono::seconds(30));
    EXPECT_EQ(o.code, 2) << "lightwell view " << arguments << ": signal " << o.signal << "\n" << o.err;
    EXPECT_EQ(lines_of(o.err).size(), 1u) << arguments << "\n" << o.err;
    EXPECT_TRUE(o.err.starts_with("lightwell: ")) << o.err;
    EXPECT_EQ(o.out, "") << arguments;
}

TEST_F(FormatsOfView, FrameLogAndRecording)
{
    LiveView view("cornell --size 160x120 --frame-log frames.csv --record walk.lwr --stats stats.json");
    auto const frame = [&] { return view.ask({{"do", "stats"}}).value("frame", -1); };
    auto const wait_for_frames = [&](int count) {
        int const now = frame();
        EXPECT_TRUE(is_soon([&] { return frame() >= now + count; }));
    };
    for (char const* const key : {"w", "s"}) {
        view.ask({{"do", "key"}, {"key", key}, {"action", "press"}});
        wait_for_frames(5);
        view.ask({{"do", "key"}, {"key", key}, {"action", "release"}});
    }
    view.set("exposure", 0.5);
    wait_for_frames(2); // one that has seen it
    Outcome const o = view.quit();

    Table const log = read_table(view.folder() / "frames.csv");
    ASSERT_FALSE(log.columns.empty());
    std::string about;
    for (std::string const& line : log.about) about += line + "\n";
    for (std::string const& column : log.columns)
        EXPECT_NE(about.find("# " + column + ": "), std::string::npos) << column << " is not explained\n" << about;
    for (char const* const column :
         {"frame", "pose_s", "display_s", "swap_s", "swap_method", "swap_uncertainty_ms", "render_ms", "paths",
          "width_px", "height_px", "dropped"})
        EXPECT_EQ(std::count(log.columns.begin(), log.columns.end(), column), 1) << column;
    ASSERT_GT(log.rows.size(), 5u);
    for (std::size_t i = 0; i < log.rows.size(); ++i) {
        auto const value = [&](char const* column, std::size_t row) {
            return std::stod(log.rows[row].at(column));
        };
        EXPECT_TRUE((std::set<std::string>{"fence", "oml"}.contains(log.rows[i].at("swap_method"))));
        EXPECT_GE(value("swap_s", i), value("pose_s", i)) << "shown before it was known, frame " << i;
        EXPECT_GE(value("render_ms", i), 0);
        EXPECT_GE(value("width_px", i), 1);
        if (i == 0) continue;
        for (char const* const column : {"frame", "swap_s"})
            EXPECT_GT(value(column, i), value(column, i - 1)) << column << " in row " << i;
        EXPECT_GE(value("pose_s", i), value("pose_s", i - 1)) << "row " << i; // two frames may be of one pose
    }

    Json const info = Json::parse(run_well("recording info walk.lwr --json", view.folder().path()).out);
    EXPECT_EQ(info.at("ended"), "in order");
    EXPECT_EQ(info.at("scene"), "cornell");
    EXPECT_GE(info.at("frames").get<std::size_t>(), log.rows.size()) << "frames that were shown were not recorded";
    EXPECT_EQ(info.at("frames_with_pixel_hash"), info.at("frames"));
    EXPECT_EQ(info.at("changes"), 1) << "the exposure";
    Json const stats = Json::parse(file_text(view.folder() / "stats.json"));
    EXPECT_EQ(stats.at("recorded"), info.at("frames"));
    EXPECT_NE(o.out.find("recorded to walk.lwr"), std::string::npos) << o.out;
}

/// While it exists, started programs find the disk full after this number of bytes of a file.
class FullDisk {
public:
    explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN))
    {
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit const limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FullDisk()
    {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FullDisk(FullDisk const&) = delete;
    FullDisk& operator=(FullDisk const&) = delete;

private:
    void (*handler_)(int);
    rlimit before_{};
};

TEST_F(FormatsOfView, AFullDiskIsToldAtOnceAndCounted)
{
    TemporaryFolder const folder;
    std::optional<FullDisk> full(16 << 10);
    Program program(words("view cornell --size 64x48 --record full.lwr --stats stats.json"), folder.path());
    full.reset();
    std::string const alarm = "lightwell: 'full.lwr' cannot be written any further (File too large)";
    auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (program.runs() && program.errors().find(alarm) == std::string::npos) {
        ASSERT_LT(std::chrono::steady_clock::now(), end) << program.errors();
        sleep_ms(20);
    }
    EXPECT_TRUE(program.runs()) << "the walk goes on";
    sleep_ms(300); // some more that are lost
    program.send(SIGINT);
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 1) << o.err;
    EXPECT_EQ(o.err.find(alarm), o.err.rfind(alarm)) << "told once\n" << o.err;
    Json const info = Json::parse(run_well("recording info full.lwr --json", folder.path()).out);
    Json const stats = Json::parse(file_text(folder / "stats.json"));
    EXPECT_GT(info.at("frames"), 0);
    EXPECT_EQ(stats.at("recorded"), info.at("frames"));
    EXPECT_GT(stats.at("frames_rendered"), info.at("frames"));
    EXPECT_NE(o.out.find(std::to_string(info.at("frames").get<int>()) + " recorded to full.lwr"),
              std::string::npos)
        << o.out;
}

TEST_F(FormatsOfView, WhatIsThereIsNotOverwritten)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "there.lwr") << "mine";
    std::ofstream(folder / "there.csv") << "mine";
    expect_refused("cornell --record there.lwr", folder.path());
    expect_refused("cornell --frame-log there.csv", folder.path());
    expect_refused("cornell --record new.lwr --frame-log there.csv", folder.path());
    EXPECT_EQ(file_text(folder / "there.lwr"), "mine");
    EXPECT_EQ(file_text(folder / "there.csv"), "mine");
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"there.csv", "there.lwr"}))
        << "of a call that was refused";
}

TEST_F(FormatsOfView, WrongCalls)
{
    TemporaryFolder const folder;
    for (char const* const wrong :
         {"exposure", "exposure=bright", "exposure=1e9", "nothing=1", "stereo=sideways", "paths=1.5",
          "panel=perhaps", "=", "object.nobody.position=[0,0,0]", "exposure=[1,2]", "method="})
        expect_refused("cornell --set " + std::string(wrong), folder.path());
    for (char const* const wrong :
         {"missing.glb", "cornell --size 0x0", "cornell --size wide", "cornell --navigate swim",
          "cornell --fullscreen 77", "cornell --fullscreen 0,0", "cornell --fullscreen 0 --set stereo=two-windows",
          "cornell --remote /nowhere/socket", "cornell --record /nowhere/walk.lwr",
          "cornell --frame-log /nowhere/frames.csv", "cornell --threads -1", "cornell --camera nobody",
          "cornell --remote-port 99999", "cornell --size 1000000x1000000"})
        expect_refused(wrong, folder.path());
    EXPECT_EQ(folder.files(), std::vector<std::string>{});
}

TEST_F(FormatsOfView, OptionsThatWouldNotBeRead)
{
    TemporaryFolder const folder;
    for (char const* const wrong :
         {"cornell --seated", "cornell --display walls.yaml --size 100x100",
          "cornell --display walls.yaml --fullscreen 0", "cornell --hmd --size 100x100",
          "cornell --fullscreen 0 --size 100x100",
          "cornell --display walls.yaml --set exposure=1 --set stereo=rows", "cornell --paths 4"}) {
        Outcome const o =
            Program(words("view " + std::string(wrong)), folder.path()).wait(std::chrono::seconds(30));
        EXPECT_EQ(o.code, 2) << wrong;
        EXPECT_NE(o.err.find("it would have no effect"), std::string::npos) << wrong << "\n" << o.err;
    }
}

TEST_F(FormatsOfView, NoDisplay)
{
    TemporaryFolder const folder;
    std::string const display = std::getenv("DISPLAY");
    unsetenv("DISPLAY");
    expect_refused("cornell --record walk.lwr --frame-log frames.csv", folder.path());
    setenv("DISPLAY", ":987", 1);
    expect_refused("cornell", folder.path());
    setenv("DISPLAY", display.c_str(), 1);
    EXPECT_EQ(folder.files(), std::vector<std::string>{});
}

/// A killed viewer leaves all but the last second.
TEST_F(FormatsOfView, KilledWhileItRecords)
{
    LiveView view("cornell --size 160x120 --record walk.lwr --frame-log frames.csv --set rate=10");
    view.ask({{"do", "key"}, {"key", "w"}, {"action", "press"}});
    auto const frame = [&] { return view.ask({{"do", "stats"}}).value("frame", -1); };
    EXPECT_TRUE(is_soon([&] { return frame() > 10; }));
    int const a_second_before = frame();
    sleep_ms(1000);
    int const last = frame();
    view.program().send(SIGKILL);
    EXPECT_EQ(view.program().wait().signal, SIGKILL);
    ASSERT_GT(last, a_second_before);

    Outcome const o = run_well("recording info walk.lwr --json", view.folder().path());
    Json const info = Json::parse(o.out);
    EXPECT_NE(info.at("ended"), "in order");
    EXPECT_GE(info.at("last_frame").get<int>(), a_second_before) << "of " << last;
    EXPECT_NE(o.err.find("note: "), std::string::npos) << o.err;
    std::string const log = file_text(view.folder() / "frames.csv");
    std::string const whole = log.substr(0, log.rfind('\n') + 1);
    EXPECT_GE(std::stoi(lines_of(whole).back()), a_second_before) << "the frame log ends too early";
}

} // namespace
} // namespace viewer::test
