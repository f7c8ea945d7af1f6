#include "gi/core/text.h"

#include <cstdint>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(Text, IsANumberAsAWholeOrNotAtAll)
{
    EXPECT_EQ(parse_number<int>("-12"), -12);
    EXPECT_EQ(parse_number<std::uint64_t>("18446744073709551615"), UINT64_MAX);
    EXPECT_EQ(parse_number<double>("1e3"), 1000);
    for (char const* text : {"", " 1", "1 ", "+1", "1x", "0x10", "1,5"}) {
        EXPECT_EQ(parse_number<int>(text), std::nullopt) << text;
        EXPECT_EQ(parse_number<double>(text), std::nullopt) << text;
    }
    EXPECT_EQ(parse_number<unsigned>("-1"), std::nullopt);
    EXPECT_EQ(parse_number<int>("3000000000"), std::nullopt);
    EXPECT_EQ(parse_finite("inf"), std::nullopt);
    EXPECT_EQ(parse_finite("nan"), std::nullopt);
    EXPECT_EQ(parse_finite("-1e15", 1e15), -1e15);
    EXPECT_EQ(parse_finite("1.1e15", 1e15), std::nullopt);
}

TEST(Text, IsTakenApart)
{
    std::string_view line = " one\ttwo  three \r";
    EXPECT_EQ(trimmed(line), "one\ttwo  three");
    EXPECT_EQ(take_word(line), "one");
    EXPECT_EQ(take_word(line), "two");
    EXPECT_EQ(take_word(line), "three");
    EXPECT_EQ(take_word(line), "");
    std::string_view path = "a/b";
    EXPECT_EQ(take_until(path, '/'), "a");
    EXPECT_EQ(take_until(path, '/'), "b");
    EXPECT_EQ(take_until(path, '/'), "");
    EXPECT_EQ(split_at_commas("a, b ,,"), (std::vector<std::string_view>{"a", "b", "", ""}));
    EXPECT_EQ(split_at_commas("").size(), 1u);
}

TEST(Text, NamesThePlaceOfAnError)
{
    std::string const file = "poses.csv";
    TextLine const line{"1, x", file, 7};
    InputError const e = line.error(split_at_commas(line.text)[1], "p", "w", "s");
    EXPECT_EQ(e.where().line, 7);
    EXPECT_EQ(e.where().column, 4);
}

TEST(Text, CountsCharacters)
{
    EXPECT_EQ(characters("añ€😀"), 4u);
    EXPECT_EQ(shortened("short", 5), "short");
    EXPECT_EQ(shortened("abcdefgh", 7), "abcd...");
    EXPECT_EQ(shortened("abc€efgh", 8), "abc...") << "no character is cut";
}

TEST(Text, IsAlignedInColumns)
{
    EXPECT_EQ(aligned({{"é", "n"}, {"long", "12"}, {"", "3"}}, {false, true}), "é      n\nlong  12\n       3\n");
    EXPECT_EQ(aligned({{"a", ""}}, {true, false}, 1), "a\n");
    EXPECT_EQ(aligned({}, {}), "");
}

} // namespace
} // namespace gi::test
