// Tables of measurements: medians, files, the page.

#include "gi/core/error.h"
#include "gi/core/shell.h"
#include "tests/viewer/run_program.h"
#include "viewer/report/chart.h"
#include "viewer/report/html.h"
#include "viewer/report/page.h"
#include "viewer/report/table_file.h"

#include <cmath>
#include <limits>

namespace viewer::test {
namespace {

BenchTable example()
{
    BenchTable t{"rays", {"scene", "triangles", "build_s"}};
    t.title = "Rays & <others>";
    t.command = "lightwell bench rays --scene 'a b.glb'";
    t.machine = {"A CPU", 2, 24};
    t.facts = {{"rays", "1000"}};
    t.add({std::string("a \"b\", c"), 32.0, Measured{0.5, 0.25, 1, 3}});
    t.add({std::string("empty"), Cell(), 0.125});
    return t;
}

TEST(Measure, Summarises)
{
    Measured const odd = summarise(std::vector<double>{3, 1, 10});
    EXPECT_EQ(odd.median, 3);
    EXPECT_EQ(odd.min, 1);
    EXPECT_EQ(odd.max, 10);
    EXPECT_EQ(odd.repeats, 3);
    EXPECT_EQ(summarise(std::vector<double>{4, 1, 2, 10}).median, 3);
    EXPECT_THROW(summarise({}), std::logic_error);
    EXPECT_EQ(ratio(std::vector<double>{2, 9, 8}, std::vector<double>{1, 3, 2}).median, 3);
}

TEST(Measure, CompetitorsTakeTurns)
{
    std::string order;
    auto const seconds = measure_interleaved(3, {[&] { order += 'A'; }, [&] { order += 'B'; }});
    EXPECT_EQ(order, "AB" // not counted
                     "ABBAAB");
    ASSERT_EQ(seconds.size(), 2u);
    EXPECT_EQ(seconds[0].size(), 3u);
    EXPECT_EQ(seconds[1].size(), 3u);
    Measured const m = measure(2, [] { std::this_thread::sleep_for(std::chrono::milliseconds(5)); });
    EXPECT_GE(m.min, 0.005);
    EXPECT_EQ(m.repeats, 2);
}

TEST(BenchTable, WantsACellPerColumn)
{
    BenchTable t = example();
    EXPECT_THROW(t.add({1.0}), std::logic_error);
    EXPECT_EQ(t.column("triangles"), 1);
    EXPECT_EQ(t.column("nobody"), -1);
    EXPECT_EQ(number(cell(t, t.rows[0], "build_s")), 0.5);
    EXPECT_TRUE(std::isnan(number(cell(t, t.rows[0], "nobody"))));
}

TEST(BenchTable, IsAlignedText)
{
    EXPECT_EQ(to_text(example()), "scene     triangles   build_s\n"
                                  "a \"b\", c         32  0.5 ±75%\n"
                                  "empty                   0.125\n");
}

TEST(BenchTable, JsonComesBack)
{
    BenchTable const t = example(), back = parse_table(to_json(t), "rays.json");
    EXPECT_EQ(to_json(back), to_json(t));
    EXPECT_EQ(back.columns, t.columns);
    EXPECT_EQ(back.facts, t.facts);
    ASSERT_EQ(back.rows.size(), 2u);
    EXPECT_EQ(std::get<Measured>(back.rows[0][2]).max, 1);
    EXPECT_TRUE(std::holds_alternative<std::monostate>(back.rows[1][1]));
}

TEST(BenchTable, NumbersThatAreNotFiniteAreNothing)
{
    BenchTable t{"t", {"x"}};
    t.add({std::numeric_limits<double>::infinity()});
    t.add({std::nan("")});
    BenchTable const back = parse_table(to_json(t), "t.json");
    EXPECT_TRUE(std::holds_alternative<std::monostate>(back.rows[0][0]));
    EXPECT_EQ(to_csv(t), "x\r\n\r\n\r\n");
}

TEST(BenchTable, CsvQuotesAndSpreads)
{
    EXPECT_EQ(to_csv(example()), "scene,triangles,build_s,build_s_min,build_s_max,build_s_repeats\r\n"
                                 "\"a \"\"b\"\", c\",32,0.5,0.25,1,3\r\n"
                                 "empty,,0.125,,,\r\n");
}

TEST(BenchTable, DamagedJsonIsRefused)
{
    std::string const whole = to_json(example());
    for (std::size_t const length : {std::size_t(0), whole.size() / 4, whole.size() / 2, whole.size() - 3})
        EXPECT_THROW(parse_table(whole.substr(0, length), "t.json"), gi::InputError) << length;
    auto const with = [&](std::string const& from, std::string const& to) {
        std::string text = whole;
        text.replace(text.find(from), from.size(), to);
        return text;
    };
    for (std::string const& text :
         {std::string("[]"), std::string("{}"), with("\"lightwell_table\": 1", "\"lightwell_table\": 99"),
          with("\"title\": ", "\"title\": 5, \"was\": "), with("\"empty\",", ""),
          with("\"repeats\":3", "\"repeats\":1e300"), with("\"median\":0.5", "\"median\":\"x\""),
          with("\"columns\"", "\"collumns\"")})
        EXPECT_THROW(parse_table(text, "t.json"), gi::InputError) << text;
}

TEST(Machine, IsKnown)
{
    MachineFacts const machine = this_machine();
    EXPECT_FALSE(machine.cpu.empty());
    EXPECT_GE(machine.cores, 1);
    EXPECT_GT(machine.memory_gib, 0);
    EXPECT_EQ(gi::shell_quoted("a-b_c/d.exr"), "a-b_c/d.exr");
    EXPECT_EQ(gi::shell_quoted("it's $5"), "'it'\\''s $5'");
    EXPECT_EQ(gi::shell_quoted(""), "''");
}

TEST(Chart, SaysWhatItLeavesOut)
{
    Chart const chart{"t", "x", "y", {{"a", {{0.1, 0}, {1, 2}, {std::nan(""), 1}}}}, 0, ""};
    std::string const svg = to_figure(chart);
    EXPECT_NE(svg.find("2 points without a logarithm left out"), std::string::npos);
    EXPECT_EQ(svg.find("nan"), std::string::npos) << svg;
    EXPECT_EQ(to_figure(Chart{}).find("nan"), std::string::npos);
}

TEST(Page, EscapesAllText)
{
    EXPECT_EQ(readable("frame_s"), "frame, s");
    EXPECT_EQ(readable("Mrays_per_s"), "Mrays per s");
    BenchTable t{"<t>", {"<c>", "scene", "method", "budget_s", "frame_s", "relmse", "picture_file"}};
    t.title = t.program = t.command = t.date = t.machine.cpu = "<x>";
    t.facts = {{"<f>", "<v>"}};
    t.add({std::string("<r>"), std::string("<s>"), std::string("<m>"), 1.0, 1.0, 1.0, std::string("../<p>.png")});
    Page page;
    page.folders = {{"/nowhere", {t}, {}}};
    page.title = page.lead = "<w>";
    page.next = {"<n>"};
    std::string const html = make_page(page);
    for (char const* tag : {"<t>", "<c>", "<x>", "<f>", "<v>", "<r>", "<s>", "<m>", "<p>.", "<w>", "<n>"})
        EXPECT_EQ(html.find(tag), std::string::npos) << tag;
    EXPECT_NE(html.find("/nowhere/&lt;p&gt;.png"), std::string::npos) << "only names within the folder";
}

/// Rows of one table may lie in several folders, as a batch leaves them.
TEST(BenchPage, ShowsHowTablesOfTheThesisGrow)
{
    BenchTable t{
        "thesis",
        {"table", "triangles", "bounces", "frame_ms", "published_ms", "l2_flip", "paths_ms", "paths_l2_flip"}};
    Page page;
    for (double const triangles : {1000.0, 4000.0, 16000.0}) {
        t.rows = {{std::string("6.1"), triangles, 1.0, std::sqrt(triangles), 10.0, 0.1, 5.0, 0.05}};
        page.folders.push_back({"/nowhere", {t}, {}});
    }
    std::string const html = make_page(page);
    EXPECT_NE(html.find("slhb, 1 bounce: 0.50; published, 1 bounce: 0.00."), std::string::npos);
    EXPECT_NE(html.find("table 6.1: error against time"), std::string::npos);
    EXPECT_EQ(html.find("table 6.2"), std::string::npos);
    t.rows = {{std::string("6.4"), 1e6, 5.0, 10.0, 10.0, 0.1, 5.0, 0.05}};
    EXPECT_NE(thesis_figures({{"/nowhere", {t}, {}}}).find("1000K triangles"), std::string::npos);
    EXPECT_EQ(thesis_figures({}), "");
}

} // namespace
} // namespace viewer::test
