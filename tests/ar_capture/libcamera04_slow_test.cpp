// The same source against libcamera 0.4: compiled with its headers, run with its library and its virtual camera,
// which shows generated counters. What cannot be had is skipped visibly.
#include "ar/capture/counter_source.h"
#include "tests/ar_capture/temporary_folder.h"

#include <fmt/format.h>
#include <map>
#include <sys/wait.h>

namespace ar::test {
namespace {

using namespace std::chrono_literals;

constexpr char const* kScript = LIGHTWELL_SOURCE_DIR "/scripts/with-libcamera04";

struct Outcome {
    int code = -1;
    std::string out;
};

/// stderr goes into the same text.
Outcome run(std::string const& command)
{
    Outcome o;
    std::FILE* const pipe = popen((command + " 2>&1").c_str(), "r");
    char chunk[4096];
    for (std::size_t n = 0; (n = std::fread(chunk, 1, sizeof chunk, pipe)) > 0;) o.out.append(chunk, n);
    int const status = pclose(pipe);
    if (WIFEXITED(status)) o.code = WEXITSTATUS(status);
    return o;
}

class Libcamera04 : public ::testing::Test {
protected:
    /// Compiles once for all tests.
    static void SetUpTestSuite()
    {
#ifdef HAS_SANITIZERS
        skip = "sanitizers do not start through another loader";
        return;
#endif
        folder = std::make_unique<TemporaryFolder>();
        Outcome const fetched = run(fmt::format("timeout 300 '{}' fetch", kScript));
        if (fetched.code != 0) {
            skip = fetched.out;
            return;
        }
        std::filesystem::create_directory(*folder / "pictures");
        CounterSource counter({.format = PixelFormat::mjpeg, .frames = 20, .pace = Pace::fastest});
        while (auto const f = counter.next(0ms))
            write_file(*folder / fmt::format("pictures/{}.jpg", f->sequence),
                       {f->planes[0].ptr<char>(), f->planes[0].total()});
        Outcome const compiled = run(fmt::format(
            "{} -std=c++20 -O1 -Wall -Wextra -Werror {} '{}/tests/ar_capture/libcamera04/camera_client.cpp' "
            "'{}' '{}' '{}' '{}' $('{}' flags) -lopencv_imgcodecs -lopencv_imgproc -lopencv_core -lOpenEXR "
            "-lIlmThread "
            "-lIex -lImath -lyaml-cpp -ltbb -lfmt -lpng -lnettle -lz -ldl -o "
            "'{}'",
            CXX_COMPILER,
            "-DGLM_FORCE_SILENT_WARNINGS -DGLM_FORCE_XYZW_ONLY -DFMT_SHARED -isystem "
            "/usr/include/opencv4 -I'" LIGHTWELL_SOURCE_DIR "'",
            LIGHTWELL_SOURCE_DIR, CAPTURE_LIBRARY, BASE_LIBRARY, IMAGE_LIBRARY, CORE_LIBRARY, kScript,
            *folder / "client"));
        ASSERT_EQ(compiled.code, 0) << compiled.out;
    }
    static void TearDownTestSuite() { folder.reset(); }
    void SetUp() override
    {
        if (!skip.empty()) GTEST_SKIP() << "SKIPPED: no libcamera 0.4: " << skip;
    }

    /// What the client prints for the actions, by name.
    static std::map<std::string, std::string> client(std::string const& actions)
    {
        Outcome const o = run(fmt::format("timeout 90 '{}' run '{}' 640 480 -- '{}' {}", kScript,
                                          *folder / "pictures", *folder / "client", actions));
        if (o.code == 77) return {{"skip", o.out}};
        EXPECT_EQ(o.code, 0) << o.out;
        std::map<std::string, std::string> values;
        std::istringstream in(o.out);
        for (std::string line; std::getline(in, line);) {
            std::size_t const blank = line.find(' ');
            values[line.substr(0, blank)] += blank == std::string::npos ? "" : line.substr(blank + 1);
        }
        return values;
    }

    static inline std::unique_ptr<TemporaryFolder> folder;
    static inline std::string skip;
};

#define SKIP_WITHOUT_NAMESPACES(values)                                                                           \
    if ((values).contains("skip")) GTEST_SKIP() << "SKIPPED: " << (values).at("skip")

TEST_F(Libcamera04, AThousandFramesInOrderWithoutALeak)
{
    auto v = client("capture");
    SKIP_WITHOUT_NAMESPACES(v);
    EXPECT_EQ(v["version"].substr(0, 4), "v0.4");
    EXPECT_EQ(v["camera"], "Virtual0 Virtual Video Device");
    EXPECT_EQ(v["width"] + "x" + v["height"], "640x480");
    EXPECT_EQ(v["is_nv12"], "1");
    EXPECT_EQ(v["delivered"], "1000");
    EXPECT_EQ(v["dropped"], "0");
    EXPECT_EQ(v["refused"], "0");
    EXPECT_EQ(v["disordered"], "0");
    EXPECT_EQ(v["from_sensor_clock"], "1000");
    EXPECT_EQ(v["unowned"], "0");
    EXPECT_EQ(v["unread"], "0"); // the pixels are those of the pictures
    EXPECT_EQ(v["planes"], "4"); // the camera's four buffers: nothing was copied
    EXPECT_LT(std::stod(v["grown_mib"]), 4);
    RecordProperty("grown_mib", v["grown_mib"]);
    fmt::print("{} frames/s, mean age {} ms, oldest {} ms, {} MiB resident, grown by {} MiB\n", v["frames_per_s"],
               v["mean_age_ms"], v["oldest_ms"], v["resident_mib"], v["grown_mib"]);
}

TEST_F(Libcamera04, BuffersGoBackWithTheLastCopyOfTheirFrame)
{
    auto v = client("keep");
    SKIP_WITHOUT_NAMESPACES(v);
    EXPECT_EQ(v["kept"], "4");
    EXPECT_EQ(v["runs_while_kept"], "1");
    EXPECT_EQ(v["came_while_a_copy_lives"], "0");
    EXPECT_EQ(v["kept_again"], "4");
    EXPECT_EQ(v["read_after_the_source"], "4");
}

TEST_F(Libcamera04, TheNewestComesFirst)
{
    auto v = client("newest");
    SKIP_WITHOUT_NAMESPACES(v);
    EXPECT_EQ(v["given_up"], "3"); // of four buffers
}

TEST_F(Libcamera04, ThatIsUnpluggedIsLost)
{
    auto v = client("unplug");
    SKIP_WITHOUT_NAMESPACES(v);
    EXPECT_EQ(v["before"], "1");
    EXPECT_EQ(v["is_lost"], "1");
    EXPECT_EQ(v["reason"], "camera 'Virtual0' was unplugged");
}

TEST_F(Libcamera04, WhatCannotBeIsSaid)
{
    auto v = client("refusals");
    SKIP_WITHOUT_NAMESPACES(v);
    EXPECT_EQ(v["unknown_id"], "no camera 'nobody' (libcamera finds 'Virtual0') name one of them by its id");
    EXPECT_EQ(v["wrong_format"],
              "camera 'Virtual0' cannot be used (its formats are NV12, none of them mjpeg) choose "
              "another format or camera");
    EXPECT_EQ(v["nearest_width"], "640");
    EXPECT_EQ(v["cannot"], "the exposure time cannot be set: this camera has no such control"
                           "white balance cannot be set: this camera has no such control");
    EXPECT_EQ(v["in_use"].substr(0, 34), "camera 'Virtual0' cannot be opened");
}

} // namespace
} // namespace ar::test
