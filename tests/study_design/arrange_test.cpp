// Orders that keep rules: by chance, exactly, or not at all.

#include "study/plan/arrange.h"

#include <gtest/gtest.h>
#include <map>
#include <numeric>

namespace study::test {
namespace {

std::vector<ArrangeItem> items_of(std::string const& letters)
{
    std::vector<ArrangeItem> items;
    for (char const c : letters) items.push_back({{{int(c)}}, 0});
    return items;
}

std::string run(std::string const& letters, ArrangeRule const& rule, Random& random)
{
    auto const items = items_of(letters);
    std::vector<ArrangeRule> const rules{rule};
    std::vector<int> const groups(items.size(), 0);
    std::string out;
    std::vector<int> const order = arrange(items, rules, groups, random);
    EXPECT_FALSE(find_broken(items, rules, order));
    for (int const i : order) out += letters[std::size_t(i)];
    return out;
}

TEST(Arrange, DrawsAllOrdersThatKeepTheRuleEquallyOften)
{
    // aabb without two of the same: abab and baba; aabbc: 12 orders of letters.
    Random random(1);
    std::map<std::string, int> count;
    for (int i = 0; i < 12000; ++i) ++count[run("aabbc", {RuleKind::max_run, 1, -1, -1}, random)];
    ASSERT_EQ(count.size(), 12u);
    double chi2 = 0;
    for (auto const& [unused, n] : count) chi2 += (n - 1000.0) * (n - 1000.0) / 1000.0;
    EXPECT_LT(chi2, 31.3); // 11 degrees of freedom, p = 0.001
}

TEST(Arrange, FindsTheOnlyOrdersThereAre)
{
    Random random(2);
    std::string const many = std::string(60, 'a') + std::string(59, 'b');
    std::string const found = run(many, {RuleKind::max_run, 1, -1, -1}, random);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i], i % 2 ? 'b' : 'a');
    EXPECT_EQ(run("aaaabbb", {RuleKind::max_run, 1, -1, -1}, random), "abababa");
    EXPECT_EQ(run("abcabcabc", {RuleKind::min_gap, 2, -1, -1}, random).size(), 9u);
    EXPECT_EQ(run("aaab", {RuleKind::never_after, 1, 'b', 'a'}, random), "aaab");
    EXPECT_EQ(run("ab", {RuleKind::not_first, 1, -1, 'a'}, random), "ba");
}

TEST(Arrange, RefusesWhatCannotBe)
{
    Random random(3);
    EXPECT_THROW(run("aaab", {RuleKind::max_run, 1, -1, -1}, random), NoOrder);
    EXPECT_THROW(run("aaaaaaab", {RuleKind::max_run, 3, -1, -1}, random), NoOrder);
    EXPECT_THROW(run("aabc", {RuleKind::min_gap, 3, -1, -1}, random), NoOrder);
    EXPECT_THROW(run("aa", {RuleKind::not_first, 1, -1, 'a'}, random), NoOrder);
    EXPECT_THROW(run(std::string(61, 'a') + std::string(59, 'b'), {RuleKind::max_run, 1, -1, -1}, random),
                 NoOrder);
}

TEST(Arrange, FindsBrokenRules)
{
    auto const items = items_of("aab");
    std::vector<ArrangeRule> const rules{{RuleKind::max_run, 1, -1, -1}};
    auto const broken = find_broken(items, rules, std::vector<int>{2, 0, 1});
    ASSERT_TRUE(broken);
    EXPECT_EQ(broken->place, 2u);
    EXPECT_FALSE(find_broken(items, rules, std::vector<int>{0, 2, 1}));
}

TEST(Arrange, KeepsGroupsInTheirPlaces)
{
    Random random(4);
    std::vector<ArrangeItem> items = items_of("aabbab");
    for (std::size_t i = 0; i < items.size(); ++i) items[i].group = int(i) / 3;
    std::vector<int> const groups{0, 1, 0, 1, 0, 1};
    std::vector<ArrangeRule> const rules{{RuleKind::max_run, 2, -1, -1}};
    for (int k = 0; k < 100; ++k) {
        auto const order = arrange(items, rules, groups, random);
        for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(items[std::size_t(order[i])].group, groups[i]);
    }
}

TEST(Arrange, TakesManyItemsWithTwoTokensEach)
{
    // All pairs of 9, twice: neighbours must not share one.
    std::vector<ArrangeItem> items;
    for (int repeat = 0; repeat < 2; ++repeat)
        for (int i = 0; i < 9; ++i)
            for (int j = i + 1; j < 9; ++j) items.push_back({{{i, j}}, 0});
    std::vector<ArrangeRule> const rules{{RuleKind::max_run, 1, -1, -1}};
    Random random(5);
    auto const order = arrange(items, rules, std::vector<int>(items.size(), 0), random);
    EXPECT_FALSE(find_broken(items, rules, order));
}

} // namespace
} // namespace study::test
