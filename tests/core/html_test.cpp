// The parts of report pages: escaping, numbers, axes, tables, plots.

#include "gi/core/html/html.h"
#include "gi/core/html/plot.h"

#include <cmath>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(Html, EscapesAllText)
{
    EXPECT_EQ(escaped("<a href=\"x\">&'\n"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39; ");
    std::string html = html_table({{"<c>", true, "<d>"}}, {{"<v>"}}) +
                       html_matrix("<m>", {"<n>"}, {{{"<s>", -0.2}}}) + html_definitions({{"<t>", "<u>"}}) +
                       html_cautions({"<w>"}) + html_code("<e>\n") + html_details("<y>", "") +
                       html_page("<p>", "");
    for (char const* tag : {"<c>", "<d>", "<v>", "<m>", "<n>", "<s>", "<t>", "<u>", "<w>", "<e>", "<y>"})
        EXPECT_EQ(html.find(tag), std::string::npos) << tag;
    EXPECT_NE(html.find("<title>&lt;p&gt;</title>"), std::string::npos);
    EXPECT_NE(html.find("--share:20%\" class=\"lost\">&lt;s&gt;"), std::string::npos);
    EXPECT_NE(html.find("<pre><code>&lt;e&gt;\n</code>"), std::string::npos) << "lines stay";
    EXPECT_EQ(html_cautions({}), "");
}

TEST(ShortNumber, HasThreeDigits)
{
    EXPECT_EQ(short_number(0), "0");
    EXPECT_EQ(short_number(0.05), "0.05");
    EXPECT_EQ(short_number(1250.4), "1250");
    EXPECT_EQ(short_number(-1.234), "−1.23");
    EXPECT_EQ(short_number(-2500), "−2500");
    EXPECT_EQ(short_number(2e-5), "2·10⁻⁵");
    EXPECT_EQ(short_number(0.0005), "5·10⁻⁴");
    EXPECT_EQ(short_number(0.001), "0.001");
    EXPECT_EQ(short_number(1e-12), "10⁻¹²");
    EXPECT_EQ(short_number(-1.5e8), "−1.5·10⁸");
    EXPECT_EQ(short_number(std::nan("")), "nan");
}

TEST(PlotAxis, HasRoundTicksWithinItsEnds)
{
    PlotAxis const linear = axis_over({-1.4, 1.05});
    EXPECT_EQ(linear.ticks(5), (std::vector<double>{-1.5, -1, -0.5, 0, 0.5, 1}));
    EXPECT_EQ(axis_over({2, 42}, true).ticks(5), (std::vector<double>{2, 5, 10, 20, 50}));
    EXPECT_EQ(axis_over({1e-6, 1e2}, true).ticks(5).size(), 9u) << "powers of ten";
    EXPECT_GE(axis_over({0.5}, true).ticks(5).size(), 2u);
    EXPECT_EQ((PlotAxis{16, 16 + 1e-14, false}.ticks(5)), (std::vector<double>{16}));
    EXPECT_EQ(axis_over({}).low, 0);
    EXPECT_GT(axis_over({3, 3}).high, 3);
    PlotAxis const log{0.02, 2, true};
    EXPECT_NEAR(log.position(0.2), 0.5, 1e-12);
    EXPECT_NEAR(log.position(0), -0.02, 1e-12);
    EXPECT_NEAR((PlotAxis{3, 1, false}.position(1.5)), 0.75, 1e-12) << "downwards";
}

TEST(Plot, DrawsSeriesWithErrorBarsAndTheirNames)
{
    Plot p(500, 300, {0, 2, false}, {0, 4, false});
    p.series(
        {{"<a>", {{0, 1, 0.5, 1.5}, {1, 2, 0, 0}}}, {"b", {{0, 3, 0, 0}, {1, std::nan(""), 0, 0}}}, {"c", {}}});
    std::string const svg = p.svg("series");
    EXPECT_EQ(svg.find("<a>"), std::string::npos);
    EXPECT_EQ(svg.find("nan,"), std::string::npos);
    auto const count = [&](std::string const& what) {
        int n = 0;
        for (auto at = svg.find(what); at != std::string::npos; at = svg.find(what, at + 1)) ++n;
        return n;
    };
    EXPECT_EQ(count("class=\"spread\""), 1);
    EXPECT_EQ(count("class=\"name c"), 2) << "a curve without points has no end";
    EXPECT_EQ(count("<polyline"), 3);
}

TEST(Plot, CurvesOfOneColourHaveOtherStrokes)
{
    Plot p(500, 300, {0, 2, false}, {0, 4, false});
    p.series(std::vector<PlotSeries>(13, {"a", {{0, 1, 0, 0}}}));
    std::string const svg = p.svg("series");
    for (char const* of_first_colour : {"<g class=\"c0\">", "<g class=\"c0 dashed\">", "<g class=\"c0 dotted\">"})
        EXPECT_NE(svg.find(of_first_colour), std::string::npos) << of_first_colour;
}

TEST(RowPlot, HasRoomForItsNames)
{
    RowPlot const p({"a name of some length", "b"}, {}, "x", 200);
    EXPECT_GE(p.left(), text_width("a name of some length"));
    EXPECT_DOUBLE_EQ(p.right() - p.left(), 200);
    EXPECT_GT(p.row(1), p.row(0));
    EXPECT_LT(p.row(1), p.bottom());
}

} // namespace
} // namespace gi::test
