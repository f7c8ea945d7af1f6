// OpenEXR files as other programs write them: tiles, every compression, and what is refused.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputFile.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfTiledOutputFile.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 37, kHeight = 21;
Imath::Box2i const kWindow{{-5, 11}, {-5 + kWidth - 1, 11 + kHeight - 1}};

/// Of this process alone: tests run side by side.
fs::path scratch()
{
    return fs::path(testing::TempDir()) / ("lightwell_kind_" + std::to_string(getpid()) + ".exr");
}

std::vector<float> ramp()
{
    std::vector<float> values;
    for (int i = 0; i < kWidth * kHeight; ++i) values.push_back(float(i) * 0.25f);
    return values;
}

Imf::Header header(Imf::Compression compression)
{
    Imf::Header h(Imath::Box2i({0, 0}, {99, 99}), kWindow);
    h.compression() = compression;
    for (char const* c : {"R", "G", "B"}) h.channels().insert(c, Imf::Channel(Imf::FLOAT));
    return h;
}

Imf::FrameBuffer frame(std::vector<float>& values)
{
    Imf::FrameBuffer buffer;
    for (char const* c : {"R", "G", "B"})
        buffer.insert(c, Imf::Slice::Make(Imf::FLOAT, values.data(), kWindow.min, kWidth, kHeight));
    return buffer;
}

void expect_ramp(float tolerance)
{
    Picture const p = read_exr(scratch());
    ASSERT_EQ(p.width, 100);
    ASSERT_EQ(p.height, 100);
    ASSERT_EQ(p.layers.size(), 1u);
    std::vector<float> const values = ramp();
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x) {
            int const u = x - kWindow.min.x, v = y - kWindow.min.y; // in the data window
            bool const is_there = u < kWidth && v >= 0 && v < kHeight;
            float const expected = is_there ? values[std::size_t(v * kWidth + u)] : 0;
            for (std::size_t c = 0; c < 3; ++c)
                ASSERT_NEAR(p.layers[0].data[3 * std::size_t(100 * y + x) + c], expected,
                            is_there ? tolerance * (1 + expected) : 0)
                    << x << ", " << y;
        }
}

TEST(ExrKinds, EveryCompressionWithAnOffsetWindow)
{
    for (int c = 0; c < Imf::NUM_COMPRESSION_METHODS; ++c) {
        SCOPED_TRACE(c);
        std::vector<float> values = ramp();
        {
            Imf::OutputFile out(scratch().c_str(), header(Imf::Compression(c)));
            out.setFrameBuffer(frame(values));
            out.writePixels(kHeight);
        }
        bool const lossy = c == Imf::PXR24_COMPRESSION || c >= Imf::DWAA_COMPRESSION;
        expect_ramp(lossy ? 0.02f : 0);
    }
}

/// Of files with smaller levels, which hold something else, the first is read.
TEST(ExrKinds, TilesOfOneLevelAndOfMany)
{
    for (Imf::LevelMode const mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS, Imf::RIPMAP_LEVELS}) {
        SCOPED_TRACE(int(mode));
        Imf::Header h = header(Imf::PIZ_COMPRESSION);
        h.setTileDescription({16, 8, mode});
        std::vector<float> values = ramp(), other(values.size(), 7);
        {
            Imf::TiledOutputFile out(scratch().c_str(), h);
            for (int ly = 0; ly < out.numYLevels(); ++ly)
                for (int lx = 0; lx < out.numXLevels(); ++lx) {
                    if (!out.isValidLevel(lx, ly)) continue;
                    out.setFrameBuffer(frame(lx + ly == 0 ? values : other));
                    out.writeTiles(0, out.numXTiles(lx) - 1, 0, out.numYTiles(ly) - 1, lx, ly);
                }
        }
        expect_ramp(0);
    }
}

TEST(ExrKinds, FlatPicturesOfTheStrongestCompressionAreNoAttack)
{
    int const side = 1024;
    std::vector<float> values(std::size_t(side) * side, 0.5f);
    Imf::Header h(side, side);
    h.compression() = Imf::DWAB_COMPRESSION;
    h.channels().insert("Y", Imf::Channel(Imf::HALF));
    h.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    std::vector<half> halves(values.size(), half(0.5f));
    {
        Imf::OutputFile out(scratch().c_str(), h);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::HALF, halves.data(), Imath::V2i(0), side, side));
        buffer.insert("Z", Imf::Slice::Make(Imf::FLOAT, values.data(), Imath::V2i(0), side, side));
        out.setFrameBuffer(buffer);
        out.writePixels(side);
    }
    EXPECT_EQ(read_exr(scratch()).width, side);
}

/// 9 channels of 16384 x 16384 pixels are 2.4e9 values: too many although the file has much data.
TEST(ExrKinds, TooManyChannelsAreRefusedByTheirSum)
{
    Imf::Header h(Imath::Box2i({0, 0}, {16383, 16383}), Imath::Box2i({0, 0}, {2047, 2111}));
    h.compression() = Imf::ZIP_COMPRESSION;
    std::vector<half> values(std::size_t(2048) * 2112, half(0.5f));
    Imf::FrameBuffer buffer;
    for (char const* c : {"R", "G", "B", "a.R", "a.G", "a.B", "b.R", "b.G", "b.B"}) {
        h.channels().insert(c, Imf::Channel(Imf::HALF));
        buffer.insert(c, Imf::Slice::Make(Imf::HALF, values.data(), Imath::V2i(0), 2048, 2112));
    }
    {
        Imf::OutputFile out(scratch().c_str(), h);
        out.setFrameBuffer(buffer);
        out.writePixels(2112);
    }
    try {
        read_exr(scratch());
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("9 channels (of all parts) of 16384 x 16384 pixels"),
                  std::string::npos)
            << e.what();
    }
}

TEST(ExrKinds, SubSampledAndDeepAreRefusedByName)
{
    Imf::Header h(4, 4);
    h.channels().insert("BY", Imf::Channel(Imf::HALF, 2, 2));
    std::vector<half> chroma(4, half(0.5f));
    {
        Imf::OutputFile out(scratch().c_str(), h);
        Imf::FrameBuffer buffer;
        buffer.insert("BY", Imf::Slice(Imf::HALF, reinterpret_cast<char*>(chroma.data()), 2, 4, 2, 2));
        out.setFrameBuffer(buffer);
        out.writePixels(4);
    }
    try {
        read_exr(scratch());
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("'BY' is sub-sampled"), std::string::npos) << e.what();
    }

    Imf::Header deep(2, 1);
    deep.channels().insert("Z", Imf::Channel(Imf::FLOAT));
    deep.setType(Imf::DEEPSCANLINE);
    deep.compression() = Imf::ZIPS_COMPRESSION;
    unsigned counts[2] = {1, 1};
    float depth = 3;
    float* samples[2] = {&depth, &depth};
    {
        Imf::DeepScanLineOutputFile out(scratch().c_str(), deep);
        Imf::DeepFrameBuffer buffer;
        buffer.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts, Imath::V2i(0), 2, 1));
        buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples), sizeof(float*),
                                          2 * sizeof(float*), sizeof(float)));
        out.setFrameBuffer(buffer);
        out.writePixels(1);
    }
    try {
        read_exr(scratch());
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("deep data"), std::string::npos) << e.what();
    }
}

TEST(ExrKinds, AnAttributeLongerThanTheFileIsRefusedBeforeMemoryIsTaken)
{
    std::vector<float> values = ramp();
    Imf::Header h = header(Imf::ZIP_COMPRESSION);
    h.insert("note", Imf::StringAttribute("0123456789"));
    {
        Imf::OutputFile out(scratch().c_str(), h);
        out.setFrameBuffer(frame(values));
        out.writePixels(kHeight);
    }
    std::vector<unsigned char> bytes = read_bytes(scratch());
    std::string const text(bytes.begin(), bytes.end());
    std::size_t const size_at = text.find(std::string("note\0string", 11)) + 12;
    bytes[size_at + 3] = 0x70; // 1.9 GB
    try {
        decode_exr(bytes, "x");
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("attribute 'note'"), std::string::npos) << e.what();
    }
}

} // namespace
} // namespace gi::test
