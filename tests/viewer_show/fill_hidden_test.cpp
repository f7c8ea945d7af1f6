#include "viewer/app/fill_hidden.h"

#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace viewer::test {
namespace {

/// Letters are visible pixels, dots hidden ones.
std::string filled(std::vector<std::string> const& rows)
{
    std::vector<std::uint8_t> hidden;
    std::vector<float> values;
    for (std::string const& row : rows)
        for (char const c : row) {
            hidden.push_back(c == '.');
            values.insert(values.end(), {c == '.' ? 0.0f : float(c), c == '.' ? 0.0f : float(c + 1)});
        }
    fill_hidden(hidden, int(rows[0].size()), values, 2);
    std::string out;
    for (std::size_t i = 0; i < hidden.size(); ++i) {
        EXPECT_EQ(values[2 * i + 1], values[2 * i] == 0 ? 0 : values[2 * i] + 1);
        if (i > 0 && i % rows[0].size() == 0) out += '|';
        out += values[2 * i] == 0 ? '.' : char(values[2 * i]);
    }
    return out;
}

TEST(FillHidden, TakesTheNearestOfTheRow)
{
    EXPECT_EQ(filled({"..ab.", "c...d", ".e..."}), "aaabb|ccddd|eeeee");
    EXPECT_EQ(filled({"c..d"}), "ccdd");
    EXPECT_EQ(filled({"abc"}), "abc");
}

TEST(FillHidden, AndTheNearestRow)
{
    EXPECT_EQ(filled({"...", ".a.", "...", "...", "...", "b..", "..."}), "aaa|aaa|aaa|bbb|bbb|bbb|bbb");
    EXPECT_EQ(filled({"...", "..."}), "...|...");
}

} // namespace
} // namespace viewer::test
