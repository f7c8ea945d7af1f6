// A machine's cores, GPUs and memory, as they are shared by processes and given to tasks.

#include "viewer/batch/machine.h"

#include <gtest/gtest.h>

namespace viewer::batch {
namespace {

TEST(MachineParts, ProcessesOnOneMachineShareIt)
{
    Machine const all{{0, 1, 2, 3, 4}, {0, 1}, 9000};
    Machine const first = part_of(all, 0, 3), last = part_of(all, 2, 3);
    EXPECT_EQ(first.cores, (std::vector<int>{0, 3}));
    EXPECT_EQ(first.gpus, std::vector<int>{0});
    EXPECT_EQ(last.cores, std::vector<int>{2});
    EXPECT_TRUE(last.gpus.empty());
    EXPECT_EQ(last.memory_bytes, 3000u);
    EXPECT_EQ(part_of({{7}, {}, 1}, 2, 3).cores, std::vector<int>{7});
    Machine more = all;
    set_cores(more, 7);
    EXPECT_EQ(more.cores, (std::vector<int>{0, 1, 2, 3, 4, 0, 1}));
    set_cores(more, 1);
    EXPECT_EQ(more.cores, std::vector<int>{0});
}

TEST(MachineParts, AreGivenOnceAndComeBack)
{
    Allocator a({{0, 1, 2, 3}, {0, 1}, 8000});
    EXPECT_EQ(a.refusal({99, 0, 0}), "") << "it gets the whole machine";
    EXPECT_NE(a.refusal({1, 3, 0}), "");
    EXPECT_NE(a.refusal({1, 0, 8001}), "");
    auto const one = a.take({3, 1, 5000});
    ASSERT_TRUE(one);
    EXPECT_EQ(one->cores, (std::vector<int>{0, 1, 2}));
    EXPECT_FALSE(a.take({2, 0, 0}));
    EXPECT_FALSE(a.take({Resources::kAllCores, 0, 0}));
    EXPECT_FALSE(a.take({1, 0, 4000}));
    auto const two = a.take({1, 1, 0});
    ASSERT_TRUE(two);
    EXPECT_EQ(two->gpus, std::vector<int>{1});
    a.give_back(*one);
    a.give_back(*two);
    EXPECT_EQ(a.take({99, 0, 0})->cores.size(), 4u);
}

} // namespace
} // namespace viewer::batch
