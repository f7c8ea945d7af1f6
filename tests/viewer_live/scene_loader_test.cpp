// Loads on a thread of their own: what they say, replace and leave.

#include "viewer/engine/live/scene_loader.h"

#include <atomic>
#include <chrono>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

template <class Condition>
bool comes_soon(Condition const& condition)
{
    auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!condition() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    return condition();
}

/// Works step by step until it may end.
void work_until(std::atomic<bool> const& may_end)
{
    while (!may_end) gi::at_step("textures decoded", 3, 24);
}

bool is_interrupted(std::exception_ptr const& e)
{
    try {
        std::rethrow_exception(e);
    } catch (gi::Interrupted const&) {
        return true;
    } catch (...) {
        return false;
    }
}

TEST(SceneLoader, SaysWhereItIs)
{
    std::atomic<bool> may_end{false}, done{false};
    SceneLoader loader;
    EXPECT_FALSE(loader.progress());
    loader.begin(
        "room", [&] { work_until(may_end); }, [&](std::exception_ptr const& e) { done = e == nullptr; });
    EXPECT_TRUE(comes_soon([&] { return loader.progress() && loader.progress()->step.of == 24; }));
    LoadProgress p = *loader.progress();
    EXPECT_EQ(p.scene, "room");
    EXPECT_EQ(p.step, (gi::Step{"textures decoded", 3, 24}));
    EXPECT_GT(p.fraction, 0);
    EXPECT_LT(p.fraction, 1);
    p.elapsed_s = 3.21;
    EXPECT_EQ(text_of(p), "loading room: textures decoded 3 of 24, 3.2 s");
    may_end = true;
    EXPECT_TRUE(comes_soon([&] { return done.load(); }));
    EXPECT_TRUE(comes_soon([&] { return !loader.progress(); }));
}

TEST(SceneLoader, TheNextReplacesIt)
{
    std::atomic<bool> never{false}, at_once{true}, second{false};
    std::exception_ptr first;
    std::atomic<bool> ended{false};
    {
        SceneLoader loader;
        loader.begin(
            "a", [&] { work_until(never); }, [&](std::exception_ptr const& e) { first = e, ended = true; });
        loader.begin(
            "b", [&] { work_until(at_once); }, [&](std::exception_ptr const& e) { second = e == nullptr; });
        EXPECT_TRUE(comes_soon([&] {
            loader.progress(); // begins the next one
            return ended && second;
        }));
    }
    EXPECT_TRUE(is_interrupted(first));
}

TEST(SceneLoader, LoadsOneAtATime)
{
    std::atomic<bool> may_end{false}, replaced_ran{false}, last{false};
    std::atomic<int> at_once{0}, most{0};
    auto const work = [&] {
        most = std::max(most.load(), ++at_once);
        while (!may_end) std::this_thread::sleep_for(std::chrono::milliseconds(1)); // without a step
        --at_once;
    };
    std::exception_ptr why;
    SceneLoader loader;
    loader.begin("a", work, [](std::exception_ptr const&) {});
    loader.begin(
        "b", [&] { replaced_ran = true; }, [&](std::exception_ptr const& e) { why = e; });
    loader.begin("c", work, [&](std::exception_ptr const& e) { last = e == nullptr; });
    EXPECT_TRUE(is_interrupted(why)); // at once
    EXPECT_EQ(loader.progress()->scene, "c");
    may_end = true;
    EXPECT_TRUE(comes_soon([&] {
        loader.progress();
        return last.load();
    }));
    EXPECT_FALSE(replaced_ran);
    EXPECT_EQ(most, 1);
}

TEST(SceneLoader, EndsWithItsOwner)
{
    std::atomic<bool> never{false};
    std::exception_ptr why;
    {
        SceneLoader loader;
        loader.begin(
            "a", [&] { work_until(never); }, [&](std::exception_ptr const& e) { why = e; });
    }
    EXPECT_TRUE(is_interrupted(why));
}

TEST(SceneLoader, FractionsGrowInTheOrderOfWork)
{
    double before = -1;
    for (gi::Step const& s :
         {gi::Step{"reading"}, gi::Step{"textures decoded", 1, 2}, gi::Step{"meshes read", 1, 2},
          gi::Step{"world", 1, 2}, gi::Step{"start of the method"}, gi::Step{"hit buffers", 1, 2}}) {
        EXPECT_GT(fraction_of(s), before) << s.what;
        before = fraction_of(s);
    }
    EXPECT_LT(before, 1);
}

} // namespace
} // namespace viewer::test
