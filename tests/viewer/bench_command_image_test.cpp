// `lightwell bench sweep` and `lightwell bench report`: rows, pictures, the page, wrong calls, Ctrl-C.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"
#include "viewer/report/folder.h"
#include "viewer/report/table_file.h"

#include <set>

namespace viewer::test {
namespace {

constexpr char const* kTiny = "bench sweep --scene cornell --methods reference --budgets 20ms,40ms --repeats 2 "
                              "--size 16x16 --reference-paths 16 --out d";

/// Every opening tag has its closing one, in the right order; names of elements that were seen.
std::set<std::string> check_tags(std::string const& html)
{
    static std::set<std::string> const kVoid{"meta", "img", "br", "input"};
    std::set<std::string> seen;
    std::vector<std::string> open;
    for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
        std::size_t const end = html.find('>', at);
        EXPECT_NE(end, std::string::npos);
        std::string const tag = html.substr(at + 1, end - at - 1);
        if (tag.starts_with('!') || kVoid.contains(words(tag)[0])) continue;
        std::string const name = tag.substr(0, tag.find_first_of(" /\n", 1));
        seen.insert(name);
        if (tag.starts_with('/')) {
            EXPECT_FALSE(open.empty());
            EXPECT_EQ(open.back(), tag.substr(1));
            if (!open.empty()) open.pop_back();
        } else if (!tag.ends_with('/')) {
            open.push_back(name);
        }
    }
    EXPECT_TRUE(open.empty()) << testing::PrintToString(open);
    return seen;
}

TEST(BenchCommand, SweepsAndReports)
{
    TemporaryFolder const folder;
    Outcome const sweep = run_well(kTiny, folder.path());
    EXPECT_NE(sweep.out.find("relmse"), std::string::npos) << sweep.out;
    std::vector<BenchTable> const tables = read_bench_folder(folder / "d").tables;
    ASSERT_EQ(tables.size(), 1u);
    BenchTable const& t = tables[0];
    EXPECT_EQ(t.command, std::string("lightwell ") + kTiny);
    EXPECT_FALSE(t.program.empty());
    ASSERT_EQ(t.rows.size(), 2u);
    double const budgets[] = {0.02, 0.04};
    for (std::size_t r = 0; r < 2; ++r) {
        auto const value = [&](char const* column) { return number(cell(t, t.rows[r], column)); };
        EXPECT_EQ(value("budget_s"), budgets[r]);
        EXPECT_EQ(value("repeats"), 2);
        EXPECT_GE(value("frame_s"), value("trace_s"));
        EXPECT_GE(value("paths"), 1);
        EXPECT_GT(value("Mrays_per_s"), 0);
        EXPECT_GT(value("relmse"), 0);
        EXPECT_GT(value("flip"), 0);
        EXPECT_NEAR(value("bias"), 1, 0.5);
        EXPECT_GT(value("reference_relmse"), 0);
        for (char const* column : {"picture_file", "flip_file", "reference_file"}) {
            gi::Picture const p = gi::read_picture(folder / "d" / to_text(cell(t, t.rows[r], column)));
            EXPECT_EQ(p.width, 16) << column;
        }
    }
    std::string const csv = file_text(folder / "d" / "sweep.csv");
    EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
    gi::Picture const kept = gi::read_exr(folder / "d" / "cornell_reference_20ms.exr");
    EXPECT_NE(kept.find("variance"), nullptr);
    EXPECT_TRUE(kept.metadata.contains("command"));

    EXPECT_EQ(run_well("bench report d", folder.path()).out, "d/report.html\n");
    std::string const html = file_text(folder / "d" / "report.html");
    std::set<std::string> const seen = check_tags(html);
    for (char const* element : {"svg", "table", "pre", "dl", "polyline"})
        EXPECT_TRUE(seen.contains(element)) << element;
    EXPECT_FALSE(seen.contains("script"));
    EXPECT_FALSE(seen.contains("link"));
    EXPECT_EQ(html.find("http"), std::string::npos);
    EXPECT_EQ(html.find("class=\"missing\""), std::string::npos);
    std::size_t pictures = 0;
    for (std::size_t at = html.find("<img"); at != std::string::npos; at = html.find("<img", at + 1)) ++pictures;
    EXPECT_EQ(pictures, 5u) << "reference, two pictures, two FLIP maps";
    std::size_t sources = 0;
    for (std::size_t at = html.find("src=\""); at != std::string::npos;
         at = html.find("src=\"", at + 1), ++sources)
        EXPECT_EQ(html.compare(at, 27, "src=\"data:image/png;base64,"), 0);
    EXPECT_EQ(sources, pictures);
}

TEST(BenchCommand, ReportsWhatWasRendered)
{
    TemporaryFolder const folder;
    std::filesystem::create_directory(folder / "d");
    for (std::string const eye : {"left", "right"})
        run_well("render cornell --paths 2 --size 16x12 --eye " + eye + " --screen-distance 1 --png d/" + eye +
                     ".png --stats d/" + eye + ".json",
                 folder.path());
    run_well(
        "render cornell --paths 2 --size 16x12 --frames 0:3@10 --turntable --video d/turn.mp4 --stats d/turn.json",
        folder.path());
    EXPECT_EQ(
        run_well("bench report d --out page.html --title A&B --lead <i> --next one --next two", folder.path()).out,
        "page.html\n");
    std::string const html = file_text(folder / "page.html");
    std::set<std::string> const seen = check_tags(html);
    EXPECT_TRUE(seen.contains("video"));
    EXPECT_FALSE(seen.contains("script"));
    EXPECT_EQ(html.find("class=\"missing\""), std::string::npos);
    for (char const* words : {"A&amp;B", "&lt;i&gt;", "<code>one</code>", "<code>two</code>", "63 mm apart",
                              "1 m away", "3 frames", "data:video/mp4;base64,", "--eye left", "--eye right"})
        EXPECT_NE(html.find(words), std::string::npos) << words;

    auto const color = [&](char const* file) {
        gi::Picture const p = gi::read_picture(folder / "d" / file);
        EXPECT_EQ(p.width, 16) << file;
        return gi::rgb(*p.find("color"), 6 * 16 + 8);
    };
    gi::vec3 const left = color("left.png"), right = color("right.png"), both = color("left_anaglyph.png");
    EXPECT_GT(both.x, 0.2f * left.x);
    EXPECT_GT(both.y, 0.2f * right.y);

    run_well("render cornell --paths 2 --size 16x12 --eye right --screen-distance 2 --png d/right.png --stats "
             "d/right.json",
             folder.path());
    std::filesystem::remove(folder / "d" / "left_anaglyph.png");
    run_well("bench report d", folder.path());
    EXPECT_FALSE(std::filesystem::exists(folder / "d" / "left_anaglyph.png")) << "no pair: their screens differ";
}

TEST(BenchCommand, TakesTheReferenceFromItsFolder)
{
    TemporaryFolder const folder;
    run_well(kTiny, folder.path());
    auto const references = [&] {
        std::set<std::filesystem::path> found;
        for (auto const& entry : std::filesystem::directory_iterator(folder / "d"))
            if (entry.path().filename().string().starts_with("reference_") && entry.path().extension() == ".exr")
                found.insert(entry.path());
        return found;
    };
    ASSERT_EQ(references().size(), 1u);
    auto const written = std::filesystem::last_write_time(*references().begin());
    run_well(kTiny, folder.path());
    ASSERT_EQ(references().size(), 1u);
    EXPECT_EQ(std::filesystem::last_write_time(*references().begin()), written);
    run_well(std::string(kTiny) + " --bounces 1", folder.path());
    EXPECT_EQ(references().size(), 2u) << "another picture";
}

TEST(BenchCommand, AGivenReference)
{
    TemporaryFolder const folder;
    run_well("render cornell --size 16x16 --paths 16 --seed 9 --out r.exr", folder.path());
    std::string const call =
        "bench sweep --scene cornell --methods reference --budgets 20ms --repeats 1 --out d --reference r.exr ";
    BenchTable const t = parse_table(run_well(call + "--size 16x16 --json", folder.path()).out, "stdout");
    EXPECT_GT(number(cell(t, t.rows.at(0), "reference_relmse")), 0);
    Outcome const o = run(call + "--size 32x32", folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("--size 16x16"), std::string::npos) << o.err;
    Outcome const same = run("bench sweep --scene cornell --methods reference --budgets 20ms --out d --size 16x16 "
                             "--reference d/cornell_reference_20ms.exr",
                             folder.path());
    EXPECT_EQ(same.code, 2) << "would be replaced";
    EXPECT_NE(same.err.find("it is also an input"), std::string::npos) << same.err;
}

/// Within a budget the frames have as many paths as it allows, else one.
TEST(BenchCommand, FramesWithinABudget)
{
    TemporaryFolder const folder;
    std::string const call = "bench dynamic --triangles 2000 --frames 2 --size 16x16 --structures streamed "
                             "--reference-paths 0 --json --out d ";
    auto const paths = [&](std::string const& options) {
        BenchTable const t = parse_table(run_well(call + options, folder.path()).out, "stdout");
        EXPECT_EQ(t.rows.size(), 2u);
        return t.rows.empty() ? 0.0 : number(cell(t, t.rows.back(), "paths"));
    };
    EXPECT_EQ(paths(""), 1);
    EXPECT_GT(paths("--budget 200ms"), 1);
}

TEST(BenchCommand, WrongCallsLeaveNothing)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "file") << "x";
    std::filesystem::create_directory(folder / "empty");
    std::filesystem::create_directory(folder / "damaged");
    std::ofstream(folder / "damaged" / "sweep.json") << "{\"lightwell_table\": 1, ";
    std::filesystem::create_directory(folder / "statistics");
    std::ofstream(folder / "statistics" / "render.json") << "{\"settings\": {}, \"outputs\": {}}";
    struct WrongCall {
        char const *arguments, *mentions;
    };
    for (WrongCall const call : {
             WrongCall{"bench", "subcommand"},
             {"bench sweep --out d", "--scene"},
             {"bench sweep --scene cornell", "--out"},
             {"bench sweep --scene nowhere.glb --out d", "nowhere.glb"},
             {"bench sweep --scene cornell,nowhere.glb --out d", "nowhere.glb"},
             {"bench sweep --scene cornell,cornell --out d", "twice"},
             {"bench sweep --scene cornell --methods magic --out d", "magic"},
             {"bench sweep --scene cornell --methods reference,reference --out d", "twice"},
             {"bench sweep --scene cornell --budgets soon --out d", "--budgets"},
             {"bench sweep --scene cornell --budgets 1s,1000ms --out d", "twice"},
             {"bench sweep --scene cornell --size 0x5 --out d", "--size"},
             {"bench sweep --scene cornell --repeats 0 --out d", "--repeats"},
             {"bench sweep --scene cornell --camera nobody --out d", "nobody"},
             {"bench sweep --scene cornell --reference nowhere.exr --out d", "nowhere.exr"},
             {"bench sweep --scene cornell --reference a.exr --reference-paths 4 --out d", "--reference"},
             {"bench sweep --scene cornell,atrium --reference a.exr --out d", "several"},
             {"bench sweep --scene cornell --out file", "file"},
             {"bench sweep --scene cornell --out file/d", "file"},
             {"bench sweep --scene cornell --methods slhb:streamed --directions icosahedron:80 --out d",
              "--directions with --methods slhb:streamed"},
             {"bench sweep --scene cornell --methods reference,slhb:stored --axes 8 --out d",
              "--axes with --methods slhb:stored"},
             {"bench sweep --scene cornell --methods slhb --schedule stored --axes 8 --out d",
              "--axes with --schedule stored"},
             {"bench sweep --scene cornell --methods reference --axes 8 --out d",
              "--axes with --method reference"},
             {"bench sweep --scene cornell --methods slhb:stored --schedule streamed --out d",
              "--schedule with --methods slhb:stored"},
             {"bench sweep --scene cornell --methods vpl_imperfect:many --out d", "vpl_imperfect:many"},
             {"bench sweep --scene cornell --methods vpl_ao:-1 --out d", "vpl_ao:-1"},
             {"bench sweep --scene cornell --methods vpl_slhb:cube:6 --out d", "cube:6"},
             {"bench sweep --scene cornell --methods vpl_none:3 --out d", "vpl_none:3"},
             {"bench sweep --scene cornell --methods reference --points 64 --out d", "--points with --method"},
             {"bench dynamic --triangles 2000 --schedule stored --out d", "--schedule"},
             {"bench dynamic --triangles 2000 --structures static,appended --axes 8 --out d",
              "--axes with --structures static"},
             {"bench report", "DIR"},
             {"bench report nowhere", "nowhere"},
             {"bench report file", "folder"},
             {"bench report empty", "json"},
             {"bench report damaged", "sweep.json"},
             {"bench report statistics", "render.json"},
             {"bench report damaged empty", "--out"},
             {"bench report damaged --out page.txt", ".html"},
         }) {
        Outcome const o = run(call.arguments, folder.path());
        EXPECT_EQ(o.code, 2) << call.arguments << "\nsignal " << o.signal << "\n" << o.err;
        EXPECT_TRUE(o.out.empty()) << call.arguments << "\n" << o.out;
        EXPECT_TRUE(o.err.starts_with("lightwell: ")) << call.arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << call.arguments << "\n" << o.err;
        EXPECT_NE(o.err.find(call.mentions), std::string::npos) << call.arguments << "\n" << o.err;
    }
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"damaged", "empty", "file", "statistics"}));
}

/// A head that steps aside for two seconds, then stands. A slow machine shows few pictures.
TEST(BenchCommand, ShownMeasuresWhatAHeadSees)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "aside.csv")
        << "time_s,x_m,y_m,z_m,yaw_deg,pitch_deg\n0,0,0,0,0,0\n1,0,0,0,0,0\n3,0.2,0,0,10,0\n";
    std::ofstream(folder / "moves.txt") << "# A block is lifted.\n\n0:object.short block.scale=1\n"
                                           "2:object.short block.position=[0.1, 0.3, 0.1]\n";
    run_well("bench shown cornell --head aside.csv --size 96x64 --eyes 2 --moments 2 --truth-paths 4 "
             "--at 1.2:material.light.emission_scale=2 --changes moves.txt --out d",
             folder.path());
    std::vector<BenchTable> const tables = read_bench_folder(folder / "d").tables;
    ASSERT_EQ(tables.size(), 1u);
    BenchTable const& t = tables[0];
    ASSERT_EQ(t.rows.size(), 1u);
    auto const value = [&](char const* column) { return number(cell(t, t.rows[0], column)); };
    EXPECT_GT(value("interval_ms"), 0);
    EXPECT_GE(value("longest_interval_ms"), value("interval_99_ms"));
    EXPECT_GE(value("longest_light_age_ms"), value("light_age_ms"));
    EXPECT_GT(value("response_ms"), 0);
    EXPECT_GT(value("flip"), 0);
    EXPECT_LT(value("flip"), 0.6);
    EXPECT_GE(value("most_flip"), value("flip"));
    EXPECT_GE(value("rivalry"), 0);
    EXPECT_LT(value("still_flicker"), 20);
    for (char const* file : {"shown_1_0.png", "truth_1_1.png", "error_0_1.png"}) {
        gi::Picture const p = gi::read_picture(folder / "d" / file);
        EXPECT_EQ(p.width, 96) << file;
        EXPECT_EQ(p.height, 64) << file;
    }
    Outcome const wrong = run("bench shown cornell --head nowhere --out e", folder.path());
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("nowhere"), std::string::npos) << wrong.err;
    for (auto const& [change, mentioned] : {std::pair{"soon:light.0.scale=0", "no time"},
                                            {"1:light.0.scale", "light.0.scale"},
                                            {"1:rate=5", "--set"},
                                            {"0.1:light.7.scale=0", "light.7"}}) {
        EXPECT_FALSE(std::filesystem::exists(folder / "e")) << "before " << change;
        std::string const call = "bench shown cornell --size 32x32 --moments 0 --head aside.csv --out e --at ";
        Outcome const refused = run(call + change, folder.path());
        EXPECT_EQ(refused.code, 2) << change;
        EXPECT_NE(refused.err.find(mentioned), std::string::npos) << refused.err;
    }
    std::ofstream(folder / "moves.txt") << "1:light.0.scale=0\n# now\nlight.0.scale=1\n";
    Outcome const in_file = run("bench shown cornell --head aside.csv --out f --changes moves.txt", folder.path());
    EXPECT_EQ(in_file.code, 2);
    EXPECT_NE(in_file.err.find("moves.txt:3"), std::string::npos) << in_file.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "e" / "shown.csv"))
        << "the last is known to be wrong by the scene";
}

TEST(BenchCommand, ControlCKeepsTheRowsSoFar)
{
    TemporaryFolder const folder;
    Program program(
        words("bench sweep --scene cornell --methods reference --budgets 20ms,100s --repeats 1 --size 16x16 "
              "--reference-paths 16 --out d"),
        folder.path());
    while (!std::filesystem::exists(folder / "d" / "sweep.csv") && program.wait_until_catches(SIGINT, true))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    program.send(SIGINT);
    Outcome const o = program.wait(std::chrono::seconds(30));
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_NE(o.err.find("interrupted"), std::string::npos) << o.err;
    std::vector<BenchTable> const tables = read_bench_folder(folder / "d").tables;
    ASSERT_EQ(tables.size(), 1u);
    ASSERT_EQ(tables[0].rows.size(), 1u);
    EXPECT_EQ(number(cell(tables[0], tables[0].rows[0], "budget_s")), 0.02);
    EXPECT_EQ(tables[0].facts.back().first, "interrupted");
}

TEST(BenchCommand, AnInterruptedReferenceGoesOn)
{
    TemporaryFolder const folder;
    std::string const call =
        "bench sweep --scene cornell --methods reference --budgets 20ms --repeats 1 --size 32x32 "
        "--reference-paths 200 --threads 1 --out d";
    Program program(words(call), folder.path());
    ASSERT_TRUE(program.wait_until_catches(SIGINT, true));
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 130);
    auto const count = [&](char const* extension) {
        auto const all = std::filesystem::directory_iterator(folder / "d");
        return std::count_if(begin(all), end(all),
                             [&](auto const& e) { return e.path().extension() == extension; });
    };
    EXPECT_EQ(count(".state"), 1);
    EXPECT_EQ(count(".exr"), 0);
    run_well(call, folder.path());
    EXPECT_EQ(count(".state"), 0);
    EXPECT_EQ(count(".exr"), 2);
}

} // namespace
} // namespace viewer::test
