// Products are rounded before they are added: otherwise the last bit of a sum depends on where its function is
// inlined (TBB inlines a loop's body several times), and so on which thread runs it.

#include <gtest/gtest.h>

namespace gi::test {
namespace {

template <class T>
T rest_of_square(T value, T rounded_square)
{
    T const volatile v = value, minus = -rounded_square; // not known when this is compiled
    return v * v + minus;
}

TEST(Rounding, OfProductsComesBeforeTheSum)
{
    float const f = 1 + 0x1p-20f; // f * f = 1 + 2^-19 + 2^-40, of which a float keeps all but the last term
    EXPECT_EQ(rest_of_square(f, 1 + 0x1p-19f), 0);
    double const d = 1 + 0x1p-40;
    EXPECT_EQ(rest_of_square(d, 1 + 0x1p-39), 0);
}

} // namespace
} // namespace gi::test
