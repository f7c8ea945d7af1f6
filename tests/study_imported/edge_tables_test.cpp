// Tables at the edge of floating point and of information, from the file to the text, the JSON and the page.

#include "study/analysis/result_tables.h"
#include "study/imported/trial_table.h"
#include "study/report/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

struct Printed {
    std::string text, page;
    nlohmann::json json;

    bool says(std::string const& part) const
    {
        return text.find(part) != std::string::npos && json.dump().find(part) != std::string::npos;
    }
};

Printed analysed(std::string const& table, std::string const& columns, std::vector<std::string> factors = {},
                 std::optional<Task> task = {}, std::optional<double> lapse = {})
{
    ColumnRoles roles;
    roles.column = parse_roles(columns);
    roles.factors = std::move(factors);
    roles.task = task;
    ImportedTable const t = import_trials(read_delimited(table, "t.csv"), roles);
    Analysis const a =
        analyze(t.script, t.sessions, {.replicates = 100, .permutations = 99, .draws = 0, .lapse = lapse});
    return {to_text(a), report_page(t.script, t.sessions, a, {}), nlohmann::json::parse(to_json(a))};
}

TEST(EdgeTables, OfConstantDifferencesHaveNoTest)
{
    for (double const unit : {1e-12, 1.0, 0.1, 1e12})
        for (double const offset : {0.0, 1e9}) {
            if (offset != 0 && unit != 1) continue;
            std::string table = "participant,item,value\n";
            for (int p = 0; p < 4; ++p)
                for (int i = 0; i < 3; ++i)
                    table += fmt::format("p{},{},{}\n", p, "ABC"[i], offset + unit * (10 + p * p + 10 * i));
            Printed const r = analysed(table, "participant=participant,item=item,value=value");
            EXPECT_TRUE(r.says("there is no variation within groups")) << r.text;
            EXPECT_TRUE(r.says("no variation between observers in A - B, A - C, B - C")) << r.text;
            EXPECT_FALSE(r.json["tables"].contains("effects"));
            for (auto const& d : r.json["tables"]["differences"]) {
                EXPECT_TRUE(d["p"].is_null() && d["low"].is_null()) << d;
                EXPECT_NEAR(d["difference"].get<double>() / unit, d["a"] == "A" && d["b"] == "C" ? -20 : -10,
                            1e-9);
            }
        }
}

TEST(EdgeTables, OfNumbersFarFromZeroHaveAllDigits)
{
    std::string table = "participant,item,value\n";
    double const noise[]{0.25, 0.5, 0, 0.75};
    for (int p = 0; p < 4; ++p)
        for (int i = 0; i < 2; ++i)
            table += fmt::format("p{},{},{:.6f}\n", p, "AB"[i], 1e9 + 3 * i + noise[(p + 3 * i) % 4]);
    Printed const r = analysed(table, "participant=participant,item=item,value=value");
    auto const& scores = r.json["tables"]["scores"];
    EXPECT_NEAR(scores[0]["score"].get<double>() - 1e9, 0.375, 1e-5);
    EXPECT_NEAR(scores[1]["score"].get<double>() - 1e9, 3.375, 1e-5);
    EXPECT_NE(r.text.find("1000000000.38 ["), std::string::npos) << r.text;
    EXPECT_GT(r.json["tables"]["effects"][0]["F"].get<double>(), 10);
}

TEST(EdgeTables, OfEqualGroupsAreNotCompared)
{
    std::string table = "participant,group,item,value\n";
    for (int p = 0; p < 6; ++p)
        for (int i = 0; i < 2; ++i)
            table += fmt::format("p{},{},{},{}\n", p, p < 3 ? "x" : "y", "AB"[i], (p < 3 ? 0.1 : 0.3) + i);
    Printed const r = analysed(table, "participant=participant,item=item,value=value", {"group"});
    EXPECT_TRUE(r.says("group=x and y not compared: no variation within groups")) << r.text;
    EXPECT_FALSE(r.json["tables"].contains("group_differences"));
}

TEST(EdgeTables, OfOneOrNothingSayWhatIsMissing)
{
    std::string const ratings = "participant=p,item=i,value=v";
    EXPECT_TRUE(analysed("p,i,v\na,A,3\n", ratings).says("one observer: no interval"));
    EXPECT_TRUE(analysed("p,i,v\na,A,3\nb,A,3\nc,A,3\n", ratings)
                    .says("no variation between observers in A: no interval"));
    EXPECT_TRUE(analysed("p,i,v\na,A,3\na,B,3\nb,A,4\nb,B,4\nc,A,3\nc,B,3\n", ratings)
                    .says("no observer ranks any two items differently"));
    Printed const level =
        analysed("p,l,k,n\na,3,15,20\nb,3,16,20\n", "participant=p,level=l,correct_count=k,trials=n");
    EXPECT_TRUE(level.says("trials at one level, 3 (a threshold is searched between two levels)")) << level.text;
    // d' of chance is 0, not where the search for it ended.
    std::string chance = "p,signal,yes\n";
    for (char const* p : {"a", "b", "c"})
        for (int i = 0; i < 40; ++i) chance += fmt::format("{},{},{}\n", p, i % 2, i / 2 % 2);
    auto const row = analysed(chance, "participant=p,signal=signal,yes=yes").json["tables"]["detection"][0];
    EXPECT_EQ(row["dprime"], 0);
    EXPECT_EQ(row["criterion"], 0);
    EXPECT_EQ(row["sd"], 0);
}

TEST(EdgeTables, OfPerfectStepsNameTheGap)
{
    std::string const roles = "participant=obs,level=level,correct_count=k,trials=n";
    for (double const unit : {1e-12, 1.0, 1e6})
        for (auto const& [task, below] : {std::pair(Task::yes_no, 0), std::pair(Task::two_interval, 10)}) {
            std::string table = "obs,level,k,n\n";
            for (char const* obs : {"o1", "o2"})
                for (int i = 1; i <= 5; ++i)
                    table += fmt::format("{},{:.9g},{},20\n", obs, unit * i, i < 3 ? below : 20);
            Printed const r =
                analysed(table, task == Task::yes_no ? "participant=obs,level=level,yes_count=k,trials=n" : roles,
                         {}, task);
            EXPECT_TRUE(r.says(fmt::format("any threshold between {:.9g} and {:.9g} fits", 2 * unit, 3 * unit)))
                << r.text;
            auto const t = r.json["tables"]["thresholds"][0]; // null: an open end
            EXPECT_TRUE(t["low"].is_null() || t["low"].get<double>() <= 2.000001 * unit) << t;
            EXPECT_TRUE(t["high"].is_null() || t["high"].get<double>() >= 2.999999 * unit) << t;
        }
    Printed const differ =
        analysed("obs,level,k,n\no1,1,10,20\no1,2,20,20\no1,3,20,20\no2,1,10,20\no2,2,10,20\no2,3,20,20\n", roles);
    EXPECT_TRUE(differ.says("the answers of each observer change from guessing to knowing")) << differ.text;
    EXPECT_FALSE(analysed("obs,level,k,n\no1,1,10,20\no1,2,15,20\no1,3,20,20\n", roles).says("any threshold"));
}

TEST(EdgeTables, OfSmallLevelsAreShownInTheDigitsOfTheirError)
{
    std::string table = "obs,level,k,n\n";
    int const right[]{45, 50, 44, 44, 52, 53, 62, 64, 76, 79, 88, 90, 90};
    double const levels[]{1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 7, 8, 10};
    for (int i = 0; i < 13; ++i) table += fmt::format("o1,{:.6g},{},90\n", 0.001 * levels[i], right[i]);
    Printed const r = analysed(table, "participant=obs,level=level,correct_count=k,trials=n", {}, {}, 0);
    EXPECT_NE(r.text.find("0.00465 [0.00433, 0.00498]"), std::string::npos) << r.text;
    EXPECT_NE(r.page.find("0.00465 [0.00433, 0.00498]"), std::string::npos);
    EXPECT_NE(r.text.find("level 0.0015"), std::string::npos);
    double const level = r.json["tables"]["thresholds"][0]["level"];
    EXPECT_NEAR(level, 0.00465, 5e-6);
    EXPECT_NE(level, 0.00465) << "all digits";
}

TEST(EdgeTables, OfLevelsThatAreCloseKeepThemApart)
{
    std::string table = "obs,level,k,n\n";
    for (char const* obs : {"o1", "o2", "o3"})
        for (int i = 1; i <= 4; ++i)
            table += fmt::format("{},{:.9f},{},20\n", obs, 1e9 + i, 9 + 2 * i + (obs[1] - '1') * (i % 2));
    Printed const r = analysed(table, "participant=obs,level=level,correct_count=k,trials=n");
    EXPECT_NE(r.text.find("level 1000000003"), std::string::npos) << r.text;
    EXPECT_EQ(r.json["tables"]["effects"][0]["df1"], 3) << "four levels";
}

} // namespace
} // namespace study::test
