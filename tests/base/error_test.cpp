#include "gi/core/error.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(InputError, ReadsProblemWhySuggestion)
{
    EXPECT_STREQ(InputError("it is wrong", "because", "do this").what(), "it is wrong (because) do this");
    EXPECT_STREQ(InputError({"a.yaml", 3, 7}, "it is wrong", "because", "do this").what(),
                 "a.yaml:3:7: it is wrong (because) do this");
}

} // namespace
} // namespace gi::test
