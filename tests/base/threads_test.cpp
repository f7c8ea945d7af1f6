#include "gi/core/threads.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

namespace gi {
namespace {

TEST(OnThreads, AsManyAsAsked)
{
    int const all = tbb::this_task_arena::max_concurrency();
    int found = 0;
    for (int const threads : {1, 2, 1}) {
        on_threads(threads, [&] { found = tbb::this_task_arena::max_concurrency(); });
        EXPECT_EQ(found, threads);
    }
    on_threads(0, [&] { found = tbb::this_task_arena::max_concurrency(); });
    EXPECT_EQ(found, all);
}

TEST(OnThreads, ErrorsComeThrough)
{
    for (int const threads : {0, 2})
        EXPECT_THROW(on_threads(threads, [] { throw std::runtime_error("no"); }), std::runtime_error);
}

} // namespace
} // namespace gi
