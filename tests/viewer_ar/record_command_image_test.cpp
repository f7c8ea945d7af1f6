// lightwell ar cameras, record, replay, board: what they write, say and refuse.

#include "ar/capture/counter_source.h"
#include "ar/capture/session_reader.h"
#include "ar/markers/marker_map_file.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

nlohmann::json json_of(Outcome const& o) { return nlohmann::json::parse(o.out); }

TEST(ArCameras, AreListedOrThereAreNone)
{
    TemporaryFolder const folder;
    Outcome const o = run_well("ar cameras", folder.path());
    EXPECT_EQ(std::count(o.out.begin(), o.out.end(), '\n'),
              std::max<std::ptrdiff_t>(
                  1, std::ptrdiff_t(json_of(run_well("ar cameras --json", folder.path())).at("cameras").size())));
}

TEST(ArRecord, WritesWhatReplayPlays)
{
    TemporaryFolder const folder;
    auto const made = json_of(
        run_well("ar record counter --out walk --seconds 1 --rate 10 --size 320x240 --json", folder.path()));
    EXPECT_GE(made.at("frames"), 1);
    EXPECT_EQ(made.at("lost_by_queue"), 0);
    // A busy machine may ask too late for a frame: then it is dropped, and both have to say so.
    std::uint64_t const dropped = made.at("dropped");
    Outcome const o = run("ar replay walk --check --json", folder.path());
    EXPECT_EQ(o.code, dropped == 0 ? 0 : 1) << o.out << o.err;
    auto const played = json_of(o);
    EXPECT_EQ(played.at("frames"), made.at("frames"));
    EXPECT_EQ(played.at("dropped"), dropped);
    EXPECT_EQ(played.at("damaged"), 0);
    EXPECT_EQ(played.at("losses").size(), dropped == 0 ? 0u : 1u);
    if (dropped == 0) {
        EXPECT_NEAR(played.at("rate_hz").get<double>(), 10, 1e-6);
    }
    EXPECT_GE(played.at("age_ms").at("median").get<double>(), 0);
    ar::SessionReader reader(folder / "walk");
    while (auto const frame = reader.next())
        EXPECT_EQ(ar::read_counter(frame->planes[0]), std::optional(std::uint32_t(frame->sequence)));
    EXPECT_EQ(reader.end().kind, ar::SourceState::Kind::ended);
}

TEST(ArRecord, EndsAtInterruptWithAllThatCame)
{
    TemporaryFolder const folder;
    for (std::string const limit : {"", " --seconds 100"}) {
        std::string const name = limit.empty() ? "free" : "limited";
        Program program(words("ar record counter --rate 100 --size 320x240 --out " + name + limit), folder.path());
        while (program.runs() && !std::filesystem::exists(folder / name / "session.json"))
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        ASSERT_TRUE(program.wait_until_catches(SIGINT, true));
        while (program.runs() && file_text(folder / name / "index.jsonl").empty())
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        program.send(SIGINT);
        Outcome const o = program.wait();
        EXPECT_EQ(o.code, limit.empty() ? 0 : 130) << "without a limit it is how recordings end; " << o.err;
        ar::SessionReader reader(folder / name);
        EXPECT_TRUE(reader.header().finished);
        std::uint64_t frames = 0;
        while (reader.next()) ++frames;
        EXPECT_GE(frames, 1u);
        EXPECT_EQ(reader.end().kind, ar::SourceState::Kind::ended) << reader.end().reason;
    }
}

TEST(ArReplay, TellsOfARecordingThatWasCut)
{
    TemporaryFolder const folder;
    run_well("ar record counter --out walk --frames 6 --rate 20 --size 320x240", folder.path());
    auto const frames = folder / "walk/frames.bin";
    std::filesystem::resize_file(frames, std::filesystem::file_size(frames) - 1000);
    EXPECT_EQ(run("ar replay walk --fast", folder.path()).code, 0) << "only --check is a verdict";
    Outcome const o = run("ar replay walk --fast --check", folder.path());
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.out.find("1 damaged or missing"), std::string::npos) << o.out;
    auto const index = folder / "walk/index.jsonl";
    std::filesystem::resize_file(index, std::filesystem::file_size(index) - 10);
    Outcome const torn = run("ar replay walk --fast --check", folder.path());
    EXPECT_EQ(torn.code, 1);
    EXPECT_EQ(torn.out.find("lost: nothing"), std::string::npos) << torn.out;
}

TEST(ArRecord, SaysWhatTheCameraCannotSet)
{
    TemporaryFolder const folder;
    Outcome const o =
        run_well("ar record counter --out walk --frames 2 --exposure 5 --gain 2 --size 320x240", folder.path());
    EXPECT_NE(o.err.find("exposure time cannot be set"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("gain cannot be set"), std::string::npos) << o.err;
}

TEST(ArBoard, IsDrawnAtItsSizeAndDescribed)
{
    TemporaryFolder const folder;
    run_well("ar board --squares 7x5 --square 0.04 --marker 0.03 --out board.svg --markers m.yaml", folder.path());
    EXPECT_NE(file_text(folder / "board.svg").find("mm\""), std::string::npos);
    ar::MarkerMap const map = ar::read_marker_map(folder / "m.yaml");
    ASSERT_EQ(map.boards.size(), 1u);
    EXPECT_EQ(map.boards[0].squares_x, 7);
    glm::dvec3 const up = map.boards[0].world_from_board * glm::dvec3(0, 0, 1);
    EXPECT_NEAR(up.y, 1, 1e-12) << "it lies on a table";
    run_well("ar board --squares 7x5 --square 0.04 --marker 0.03 --out board.png --dpi 254", folder.path());
    cv::Mat const drawing = cv::imread((folder / "board.png").string(), cv::IMREAD_GRAYSCALE);
    EXPECT_EQ(drawing.cols, 2900) << "0.28 m and a cell of 0.005 m at both sides, 10 dots per mm";
}

TEST(ArCommands, RefuseInOneLine)
{
    TemporaryFolder const folder;
    run_well("ar record counter --out walk --frames 2 --size 320x240", folder.path());
    run_well("ar board --squares 7x5 --out b.svg --markers m.yaml", folder.path());
    std::ofstream(folder / "file") << "x";
    std::ofstream(folder / "single.yaml") << "markers:\n  - {dictionary: DICT_4X4_50, id: 7, side_m: 0.08}\n";
    auto const before = folder.files();
    for (auto const& [arguments, mentions] :
         {std::pair{"ar record nosuch --out x", "nosuch"},
          {"ar record counter --out x --size 0x0", "--size '0x0'"},
          {"ar record counter --out x --size 20x20", "20 x 20"},
          {"ar record counter --out walk", "it exists"},
          {"ar record counter --out x --calibration none.yaml", "none.yaml"},
          {"ar record camera:nosuch --out x", "camera"},
          {"ar replay none", "none"},
          {"ar replay file", "file"},
          {"ar board --squares 7 --out a.svg", "--squares '7'"},
          {"ar board --squares 7x5 --dictionary DICT_X --out a.svg", "DICT_X"},
          {"ar board --squares 7x5 --marker 0.05 --out a.svg", "0.05"},
          {"ar board --squares 7x5 --out a.gif", "a.gif"},
          {"ar calibrate walk --out c.yaml", "--markers FILE"},
          {"ar calibrate walk --markers single.yaml --out c.yaml", "no board"},
          {"ar calibrate walk --chessboard 2x6 --out c.yaml", "--chessboard 2x6"},
          {"ar response file --exposures 1/30 --calibration none.yaml", "none.yaml"},
          {"ar probe file --calibration none.yaml --markers m.yaml --ball-radius 0.1 --out p.exr", "none.yaml"},
          {"ar probe file --calibration c.yaml --markers m.yaml --ball-radius -1 --out p.exr", "--ball-radius"}}) {
        Outcome const o = run(arguments, folder.path());
        EXPECT_EQ(o.code, 2) << arguments << o.out;
        EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << arguments << "\n" << o.err;
    }
    EXPECT_EQ(folder.files(), before);
}

} // namespace
} // namespace viewer::test
