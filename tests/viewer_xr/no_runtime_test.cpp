// A machine without a runtime: one clear message, nothing on stderr from the loader,
// nothing that ends the program.

#include "gi/core/error.h"
#include "viewer/devices/xr/session.h"

#include <cstdlib>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

class NoRuntime : public ::testing::Test {
protected:
    void SetUp() override { setenv("XR_RUNTIME_JSON", "/nonexistent/runtime.json", 1); }

    static void expect_refused(void (*work)(), std::string const& mentions)
    {
        testing::internal::CaptureStderr();
        try {
            work();
            ADD_FAILURE() << "no error";
        } catch (gi::InputError const& e) {
            EXPECT_NE(std::string(e.what()).find(mentions), std::string::npos) << e.what();
        }
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    }
};

TEST_F(NoRuntime, IsSaidByInfo)
{
    expect_refused([] { ask_runtime(); }, "there is no OpenXR runtime");
}

TEST_F(NoRuntime, IsSaidByASessionAgainAndAgain)
{
    for (int i = 0; i < 3; ++i) expect_refused([] { HmdSession const tracker({}); }, "there is no OpenXR runtime");
}

TEST_F(NoRuntime, OptionsAreCheckedFirst)
{
    expect_refused([] { HmdSession const tracker({.eye_height_m = 17}); }, "eye height");
    expect_refused([] { HmdSession const tracker({.eye_height_m = std::nan("")}); }, "eye height");
}

} // namespace
} // namespace viewer::test
