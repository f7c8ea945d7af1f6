// Pictures on their way to the disk.

#include "gi/image_io/exr_output.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"

#include <csignal>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

TEST(ExrOutput, WritesInOrderAndWhereItIsSent)
{
    fs::path const file = fs::temp_directory_path() / ("lightwell_exr_output_" + std::to_string(getpid()));
    std::ofstream(file) << "a longer text that was there before";
    std::string const part(700'000, 'x');
    ExrOutput out(file);
    out.write("head", 4);
    for (int i = 0; i < 4; ++i) out.write(part.data(), int(part.size()));
    std::uint64_t const end = out.tellp();
    EXPECT_EQ(end, 4 + 4 * part.size());
    out.seekp(1);
    out.write("EA", 2);
    EXPECT_EQ(out.tellp(), 3u);
    out.seekp(end);
    out.write("!", 1);
    out.finish();
    std::ifstream in(file, std::ios::binary);
    std::string const text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_TRUE(text == "hEAd" + part + part + part + part + "!");
    fs::remove(file);
}
TEST(ExrOutput, TellsOfAFullDisk)
{
    if (!fs::exists("/dev/full")) GTEST_SKIP();
    ExrOutput out("/dev/full");
    out.write("a", 1);
    EXPECT_THROW(out.finish(), std::system_error);
    EXPECT_THROW(ExrOutput("/no folder/a"), std::system_error);
}

/// OpenEXR's destructor writes where the blocks are, and swallows what that throws.
TEST(ExrOutput, FirstErrorIsToldAtTheEnd)
{
    fs::path const file = fs::temp_directory_path() / ("lightwell_exr_error_" + std::to_string(getpid()));
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    auto const signal_before = std::signal(SIGXFSZ, SIG_IGN);
    rlimit const few{4096, before.rlim_max};
    ExrOutput out(file);
    std::string const part(8192, 'x');
    out.write(part.data(), int(part.size()));
    setrlimit(RLIMIT_FSIZE, &few);
    EXPECT_THROW(out.seekp(0), std::system_error);
    setrlimit(RLIMIT_FSIZE, &before); // as if others had freed some space
    std::signal(SIGXFSZ, signal_before);
    errno = 0;
    try {
        out.finish();
        ADD_FAILURE() << "it is told";
    } catch (std::system_error const& e) {
        EXPECT_EQ(e.code().value(), EFBIG);
        EXPECT_EQ(errno, EFBIG);
    }
    fs::remove(file);
}

/// The picture before stays, and no part of the new one.
TEST(ExrOutput, PictureThatTheDiskCannotHoldIsRefused)
{
    fs::path const file = fs::temp_directory_path() / ("lightwell_exr_full_" + std::to_string(getpid()) + ".exr");
    std::ofstream(file) << "the picture before";
    Picture picture;
    picture.width = picture.height = 512;
    picture.layers = {{"color", 3, std::vector<float>(512 * 512 * 3, 0.5f)}};
    Report report;
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    auto const signal_before = std::signal(SIGXFSZ, SIG_IGN);
    rlimit const few{1 << 20, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &few);
    std::string why;
    try {
        write_exr(file, picture, PixelType::single, report, {.compression = ExrCompression::none});
    } catch (InputError const& e) {
        why = e.what();
    }
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, signal_before);
    EXPECT_NE(why.find("File too large"), std::string::npos) << why;
    std::ifstream in(file);
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>(in), {}}), "the picture before");
    EXPECT_FALSE(fs::exists(file.parent_path() / ("." + file.filename().string() + ".tmp")));
    fs::remove(file);
}

} // namespace
} // namespace gi::test
