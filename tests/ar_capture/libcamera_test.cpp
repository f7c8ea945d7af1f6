// Tests with the libcamera that this program was built with, on any machine.
#include "ar/capture/libcamera_source.h"
#include "gi/core/error.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

using namespace std::chrono_literals;

std::string message(LibcameraOptions const& options)
{
    try {
        open_libcamera(options);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "none";
}

TEST(Libcamera, WithoutACameraSaysSo)
{
    EXPECT_FALSE(libcamera_version().empty());
    if (!list_cameras().empty()) GTEST_SKIP() << "SKIPPED: this machine has a camera";
    std::string const expected = "no camera (libcamera " + libcamera_version() +
                                 " finds none) plug one in, or name a "
                                 "video, pictures or a recorded session";
    EXPECT_EQ(message({}), expected);
    EXPECT_EQ(message({.id = "front"}), expected);
    EXPECT_TRUE(list_cameras().empty()); // it can be asked again
}

TEST(Libcamera, AnUnknownCameraIsAnInputError)
{
    EXPECT_NE(message({.id = "no such camera"}), "none");
    EXPECT_NE(message({.size_px = {0, 480}}), "none");
    EXPECT_NE(message({.controls = {.gain = -1.0}}), "none");
}

TEST(Libcamera, ARealCameraDelivers)
{
    if (list_cameras().empty()) GTEST_SKIP() << "SKIPPED: no camera here";
    auto const source = open_libcamera();
    auto const f = source->next(5s);
    ASSERT_TRUE(f) << source->state().reason;
    EXPECT_EQ(f->size_px, source->description().size_px);
    EXPECT_EQ(rgb_of(*f).cols, f->size_px.x);
    EXPECT_GE(f->arrived_s, f->captured_s);
}

} // namespace
} // namespace ar::test
