#include "ar/capture/counter_source.h"
#include "ar/capture/open_source.h"
#include "ar/capture/session_writer.h"
#include "gi/core/error.h"
#include "tests/ar_capture/temporary_folder.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace ar::test {
namespace {

using namespace std::chrono_literals;

TEST(OpenSource, FindsOutWhatAFolderIs)
{
    TemporaryFolder folder;
    CounterSource counter({.pace = Pace::fastest});
    Frame const f = *counter.next(0ms);
    std::filesystem::create_directory(folder / "pictures");
    cv::imwrite(folder / "pictures/7.png", f.planes[0]);
    {
        SessionHeader header;
        header.camera = counter.description();
        SessionWriter writer(folder / "session", header);
        writer.append(f);
    }
    auto const name = [&](std::string const& what) { return open_source(what)->description().name; };
    EXPECT_EQ(name("counter"), "generated counter");
    EXPECT_EQ(name(folder / "session"), "generated counter (recorded)");
    EXPECT_EQ(name(folder / "pictures"), folder / "pictures");
    auto const numbered = open_source(folder / "pictures/%d.png");
    EXPECT_EQ(numbered->next(0ms)->sequence, 7u);
    // Only pictures are numbered: of others the first has the time 0.
    EXPECT_EQ(open_source(folder / "pictures", {.first_number = 5})->description().first, 5u);
    EXPECT_EQ(open_source(folder / "session", {.first_number = 0})->description().first, std::nullopt);
    EXPECT_THROW(open_source(folder / "session", {.first_number = 5}), gi::InputError);
    EXPECT_THROW(open_source("counter", {.first_number = 5}), gi::InputError);
}

TEST(OpenSource, SaysWhatIsNotThere)
{
    for (char const* name : {"device:x", "device:-1", "device:1234", "gstreamer:nothing", "/missing",
                             "/missing/%d.png", "", "camera:no such camera"})
        EXPECT_THROW(open_source(name), gi::InputError) << name;
}

/// What a recording costs in order and latency: the numbers in the pictures are those of the frames.
TEST(OpenSource, ACounterThroughARecordingIsTheSameCounter)
{
    TemporaryFolder folder;
    auto const live = open_source("counter", {.frames_per_s = 100, .format = PixelFormat::mjpeg});
    {
        SessionHeader header;
        header.camera = live->description();
        SessionWriter writer(folder / "s", header);
        for (int i = 0; i < 20; ++i) writer.append(*live->next(1000ms));
    }
    auto const replayed = open_source(folder / "s", {.pace = Pace::fastest});
    while (auto const f = replayed->next(0ms)) {
        EXPECT_EQ(read_counter(rgb_of(*f)), f->sequence);
        EXPECT_GE(f->arrived_s, f->captured_s);
    }
    EXPECT_EQ(replayed->counts(), live->counts());
}

} // namespace
} // namespace ar::test
