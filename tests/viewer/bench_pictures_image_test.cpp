// `lightwell bench pictures`: tables, pictures, the page, reuse of references and rows, wrong calls.

#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"
#include "viewer/report/folder.h"

#include <cmath>

namespace viewer::test {
namespace {

constexpr char const* kSmall = "bench pictures --scenes cornell --size 32x32 --repeats 2 --methods reference,paths "
                               "--denoise none,atrous --reference-paths 32 --out d --budgets ";

BenchTable const& table_of(BenchFolder const& folder, std::string const& name)
{
    return *std::ranges::find(folder.tables, name, &BenchTable::name);
}

TEST(BenchPictures, JudgesMethodsBudgetsAndFilters)
{
    TemporaryFolder const folder;
    Outcome const o = run_well(std::string(kSmall) + "1path,20ms", folder.path());
    EXPECT_NE(o.out.find("rows that paths loses to reference: "), std::string::npos) << o.out;
    BenchFolder const found = read_bench_folder(folder / "d");
    ASSERT_EQ(found.tables.size(), 2u);
    BenchTable const &t = table_of(found, "pictures"), &summary = table_of(found, "pictures_summary");
    ASSERT_EQ(t.rows.size(), 8u);
    EXPECT_EQ(summary.rows.size(), 4u);
    for (auto const& row : t.rows) {
        auto const value = [&](char const* column) { return number(cell(t, row, column)); };
        std::string const budget = to_text(cell(t, row, "budget")), filter = to_text(cell(t, row, "filter"));
        EXPECT_GE(value("paths"), 1);
        EXPECT_LE(value("paths"), budget == "1path" ? 1 : 1e6);
        EXPECT_GT(value("render_s"), 0);
        EXPECT_GE(value("render_s") * 1.01, value("structures_s") + value("paths_s"));
        EXPECT_GE(value("total_s"), value("render_s"));
        EXPECT_EQ(value("filter_s") > 0, filter != "none");
        EXPECT_GT(value("relmse"), 0);
        EXPECT_GT(value("relmse_of_reference"), 0);
        EXPECT_EQ(std::isfinite(value("relmse_estimated")), value("paths") > 1);
        EXPECT_GT(value("flip"), 0);
        for (std::string const part : {"bias", "bias_direct", "bias_indirect"}) {
            EXPECT_NEAR(value(part.c_str()), 1, 0.8) << part;
            EXPECT_GT(value((part + "_error").c_str()), 0) << part;
        }
        EXPECT_LE(std::abs(value("neighbour_correlation")), 1);
        for (char const* column : {"picture_file", "flip_file", "reference_file"})
            EXPECT_EQ(gi::read_picture(folder / "d" / to_text(cell(t, row, column))).width, 32) << column;
    }
    std::string const html = file_text(folder / "d" / "pictures.html");
    EXPECT_NE(html.find("src=\"cornell_paths_20ms_atrous_flip.png\""), std::string::npos);
    EXPECT_EQ(html.find("http"), std::string::npos);
    EXPECT_LT(html.find("Against reference, worst first"), html.find("Methods by their pictures"));
    EXPECT_EQ(file_text(folder / "d" / "pictures.csv").substr(0, 20), "scene,budget,method,");

    // More budgets: references and rows are kept.
    std::string const before = file_text(folder / "d" / "pictures.json");
    run_well(std::string(kSmall) + "1path,20ms,30ms --resume", folder.path());
    std::string const after = file_text(folder / "d" / "pictures.json");
    std::size_t const row = before.find("[\"cornell\""), end = before.find('\n', row);
    EXPECT_NE(after.find(before.substr(row, end - row)), std::string::npos) << "rows are as they were";
    EXPECT_EQ(table_of(read_bench_folder(folder / "d"), "pictures").rows.size(), 12u);
    Outcome const other = run(std::string(kSmall) + "1path --resume --bounces 1", folder.path());
    EXPECT_EQ(other.code, 2);
    EXPECT_NE(other.err.find("its bounces differs"), std::string::npos) << other.err;
}

TEST(BenchPictures, SkipsWhatIsMissingAndSaysSo)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "list.yaml")
        << "scenes: [{name: gone, file: gone.glb}, {name: broken, file: broken.glb}, "
           "{name: box, built_in: cornell}]";
    std::ofstream(folder / "broken.glb") << "glTF";
    Outcome const o =
        run_well("bench pictures --list list.yaml --size 16x16 --budgets 1path --repeats 1 --methods "
                 "reference --denoise none --reference-paths 4 --references kept --out d",
                 folder.path());
    for (char const* words :
         {"note: skipped: scene gone: there is no file 'gone.glb'", "note: skipped: scene broken: "})
        EXPECT_NE(o.err.find(words), std::string::npos) << o.err;
    std::string const json = file_text(folder / "d" / "pictures.json");
    EXPECT_NE(json.find("\"skipped: scene gone\": \"there is no file 'gone.glb'\""), std::string::npos) << json;
    EXPECT_NE(json.find("\"skipped: scene broken\""), std::string::npos) << json;
    EXPECT_FALSE(std::filesystem::is_empty(folder / "kept"));
}

TEST(BenchPictures, JudgesFramesThatFollowEachOther)
{
    TemporaryFolder const folder;
    run_well("bench pictures --list " LIGHTWELL_SOURCE_DIR
             "/data/pictures.yaml --interactive --scenes walk,flight --frames 4 --scored-frames "
             "1,4 --size 24x16 --frame-budget 20ms --reference-paths 4 --denoise none,wide --out d",
             folder.path());
    BenchFolder const found = read_bench_folder(folder / "d");
    BenchTable const &t = table_of(found, "interactive"), &summary = table_of(found, "interactive_summary");
    ASSERT_EQ(t.rows.size(), 24u) << "2 sequences, 2 methods, 2 filters, 2 frames and their mean";
    EXPECT_EQ(summary.rows.size(), 12u);
    for (auto const& row : t.rows) {
        EXPECT_GE(number(cell(t, row, "paths")), 1);
        EXPECT_GT(number(cell(t, row, "flip")), 0);
    }
    EXPECT_NE(file_text(folder / "d" / "interactive.html").find("walk_paths_frame4_wide.png"), std::string::npos);
}

TEST(BenchPictures, ControlCKeepsTheRowsSoFar)
{
    TemporaryFolder const folder;
    std::string const call =
        "bench pictures --scenes cornell --methods reference --repeats 1 --denoise none --size 16x16 "
        "--reference-paths 16 --out d --budgets ";
    Program program(words(call + "20ms,100s"), folder.path());
    while (!std::filesystem::exists(folder / "d" / "pictures.csv") && program.wait_until_catches(SIGINT, true))
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    program.send(SIGINT);
    Outcome const o = program.wait(std::chrono::seconds(30));
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_NE(o.err.find("add --resume to continue"), std::string::npos) << o.err;
    BenchTable const t = table_of(read_bench_folder(folder / "d"), "pictures");
    ASSERT_EQ(t.rows.size(), 1u);
    EXPECT_EQ(to_text(cell(t, t.rows[0], "budget")), "20ms");
    EXPECT_EQ(t.facts.back().first, "interrupted");
    run_well(call + "20ms,30ms --resume", folder.path());
    BenchTable const whole = table_of(read_bench_folder(folder / "d"), "pictures");
    EXPECT_EQ(whole.rows.size(), 2u);
    EXPECT_NE(whole.facts.back().first, "interrupted");
}

TEST(BenchPictures, WrongCallsAreRefused)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "bad.yaml") << "scenes: [{name: a, built_in: palace}]";
    struct {
        char const *arguments, *mentions;
    } const calls[] = {{"", "data/pictures.yaml"},
                       {"--scenes cellar", "--scenes 'cellar'"},
                       {"--list nowhere.yaml", "nowhere.yaml"},
                       {"--list bad.yaml", "bad.yaml:1:"},
                       {"--scenes cornell --methods magic", "magic"},
                       {"--scenes cornell --methods paths,paths", "twice"},
                       {"--scenes cornell --budgets 0path", "0path"},
                       {"--scenes cornell --denoise soap", "soap"},
                       {"--scenes cornell --size 0x8", "0x8"},
                       {"--scenes atrium --interactive --frames 4 --scored-frames 5", "--scored-frames 5"},
                       {"--scenes atrium --interactive --resume", "--resume with --interactive"},
                       {"--scenes atrium --interactive --budgets 1s", "--budgets"},
                       {"--scenes atrium --frames 4", "--interactive"}};
    for (auto const& call : calls) {
        Outcome const o = run(std::string("bench pictures --out d ") + call.arguments, folder.path());
        EXPECT_EQ(o.code, 2) << call.arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
        EXPECT_NE(o.err.find(call.mentions), std::string::npos) << o.err;
        EXPECT_NE(o.err.find('('), std::string::npos) << o.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "d"));
}

TEST(BenchPictures, ShowsMethodsWithLayersOfTheView)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "lens.yaml")
        << "models: [{name: box, generate: {kind: cornell}}]\n"
           "cameras: [{name: lens, from: [0.28, 0.27, -0.6], at: [0.28, 0.25, 0.28], "
           "aperture_radius: 0.03, focus_distance: 0.75}]\n";
    run_well("bench pictures --scenes lens.yaml --size 24x24 --repeats 1 --methods paths_layered_lens,screen_lhb "
             "--denoise none --reference-paths 64 --out d --budgets 16paths",
             folder.path());
    BenchFolder const found = read_bench_folder(folder / "d");
    BenchTable const& t = table_of(found, "pictures");
    ASSERT_EQ(t.rows.size(), 2u);
    for (auto const& row : t.rows) {
        EXPECT_EQ(number(cell(t, row, "paths")), 16);
        EXPECT_NEAR(number(cell(t, row, "bias")), 1, 0.1) << to_text(cell(t, row, "method"));
    }
}

} // namespace
} // namespace viewer::test
