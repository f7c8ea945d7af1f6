// Files that are written by rows are those of the whole picture.

#include "gi/core/file.h"
#include "gi/core/rng.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

class RowFiles : public testing::Test {
protected:
    RowFiles() : folder_(fs::temp_directory_path() / ("lightwell_rows_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_);
    }
    ~RowFiles() override { fs::remove_all(folder_); }
    fs::path folder_;
    Report report_;
};

Picture noise(int width, int height)
{
    Picture p;
    p.width = width;
    p.height = height;
    Pcg32 random = Pcg32::for_path(1, 0, 0);
    for (auto const& [name, channels] : {std::pair{"color", 4}, {"L1", 3}, {"depth", 1}})
        for (float& v : p.add(name, channels).data) v = 1e5f * random.uniform();
    p.metadata["seed"] = "1";
    return p;
}

TEST_F(RowFiles, ExrKeepsEveryBit)
{
    for (int const height : {1, 63, 64, 65, 200}) {
        Picture const p = noise(33, height);
        write_exr(folder_ / "a.exr", p, PixelType::single, report_);
        int most_rows = 0;
        PictureRows const rows{p.width, p.height,
                               [&](int first, int count) {
                                   most_rows = std::max(most_rows, count);
                                   return rows_of(p).read(first, count);
                               },
                               p.metadata};
        write_exr(folder_ / "b.exr", rows, PixelType::single, report_);
        EXPECT_LE(most_rows, kRowsAtOnce);
        EXPECT_EQ(read_bytes(folder_ / "a.exr"), read_bytes(folder_ / "b.exr"));
        Picture const back = read_exr(folder_ / "b.exr");
        EXPECT_EQ(back.metadata.at("seed"), "1");
        for (Layer const& layer : p.layers) {
            ASSERT_NE(back.find(layer.name), nullptr) << layer.name;
            EXPECT_EQ(back.find(layer.name)->data, layer.data) << layer.name << height;
        }
    }
}

TEST_F(RowFiles, HalfFloatsThatAreClampedAreCountedOnce)
{
    Picture const p = noise(20, 150);
    std::uint64_t large = 0;
    for (float const v : p.layers[0].data) large += v > 65504;
    write_exr(folder_ / "a.exr", p, PixelType::half, report_);
    std::uint64_t const of_l1 = std::uint64_t(
        std::count_if(p.layers[1].data.begin(), p.layers[1].data.end(), [](float v) { return v > 65504; }));
    EXPECT_EQ(report_.losses().at("values clamped to half float").count, large + of_l1);
}

TEST_F(RowFiles, PngsOfThreeAndFourChannels)
{
    for (int const channels : {3, 4})
        for (int const height : {1, 64, 131}) {
            std::vector<unsigned char> bytes(std::size_t(17 * height * channels));
            Pcg32 random = Pcg32::for_path(3, 0, 0);
            for (unsigned char& b : bytes) b = static_cast<unsigned char>(256 * random.uniform());
            write_png(folder_ / "a.png", 17, height, bytes);
            Picture const back = read_picture(folder_ / "a.png");
            EXPECT_EQ(back.width, 17);
            EXPECT_EQ(back.height, height);
            for (std::size_t p = 0; p < back.pixels(); ++p) {
                float const v = float(bytes[p * std::size_t(channels)]) / 255;
                float const linear = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
                ASSERT_NEAR(back.layers[0].data[3 * p], linear, 1e-6f) << p;
            }
        }
}

} // namespace
} // namespace gi::test
