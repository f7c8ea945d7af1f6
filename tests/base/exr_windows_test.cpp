// OpenEXR files whose data, parts, channels or colours are not simply those of the picture.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfDeepFrameBuffer.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfEnvmapAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfRgbaFile.h>
#include <ImfStandardAttributes.h>
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;
using Imath::Box2i;
using Imath::V2i;

/// Of this process alone: tests run side by side.
fs::path exr_file()
{
    return fs::path(testing::TempDir()) / ("lightwell_windows_" + std::to_string(getpid()) + ".exr");
}

/// A part whose channels, in the order of the alphabet, are 1, 2, ... more than the last.
struct Part {
    std::string name;
    std::vector<std::string> channels;
    Box2i data{V2i(0, 0), V2i(7, 3)}, display{V2i(0, 0), V2i(7, 3)};
};

/// Value of a channel at a pixel; never 0.
float value_at(int x, int y, int channel) { return 1000 + 10 * float(x) + float(y) + 500 * float(channel); }

using Change = std::function<void(Imf::Header&)>;

void write(std::vector<Part> const& parts, Change const& change = {})
{
    std::vector<Imf::Header> headers;
    for (Part const& p : parts) {
        Imf::Header h(p.display, p.data);
        h.setName(p.name);
        h.setType(Imf::SCANLINEIMAGE);
        for (std::string const& c : p.channels) h.channels().insert(c, Imf::Channel(Imf::FLOAT));
        if (change) change(h);
        headers.push_back(h);
    }
    Imf::MultiPartOutputFile file(exr_file().c_str(), headers.data(), int(headers.size()));
    for (std::size_t k = 0; k < parts.size(); ++k) {
        Imf::OutputPart out(file, int(k));
        Box2i const& window = parts[k].data;
        int const width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
        std::vector<std::vector<float>> values;
        Imf::FrameBuffer buffer;
        int number = 0;
        for (auto it = headers[k].channels().begin(); it != headers[k].channels().end(); ++it, ++number) {
            std::vector<float>& v = values.emplace_back();
            for (int y = window.min.y; y <= window.max.y; ++y)
                for (int x = window.min.x; x <= window.max.x; ++x) v.push_back(value_at(x, y, number));
            buffer.insert(it.name(), Imf::Slice::Make(Imf::FLOAT, v.data(), window.min, width, height));
        }
        out.setFrameBuffer(buffer);
        out.writePixels(height);
    }
}

bool says(Picture const& p, std::string const& text)
{
    return std::ranges::any_of(p.notes, [&](std::string const& n) { return n.find(text) != std::string::npos; });
}

std::string refusal()
{
    try {
        read_exr(exr_file());
    } catch (InputError const& e) {
        return e.what();
    }
    return "none";
}

/// The picture is the display window: openexr.com, "Technical Introduction"; its test images DisplayWindow/t01 to t14.
TEST(ExrWindows, ThePictureIsTheDisplayWindow)
{
    struct Case {
        char const* name;
        Box2i data, display;
        bool is_said;
    };
    Box2i const window(V2i(0, 0), V2i(9, 5));
    for (auto const& [name, data, display, is_said] :
         {Case{"the same", window, window, false}, Case{"within", {V2i(3, 1), V2i(6, 4)}, window, true},
          Case{"around", {V2i(-4, -3), V2i(12, 9)}, window, true},
          Case{"left", {V2i(-4, 0), V2i(3, 5)}, window, true},
          Case{"below", {V2i(2, 3), V2i(9, 20)}, window, true},
          Case{"one pixel", {V2i(9, 5), V2i(12, 9)}, window, true},
          Case{"elsewhere", {V2i(20, 0), V2i(25, 5)}, window, true},
          Case{"negative", {V2i(-30, -20), V2i(-21, -15)}, {V2i(-30, -20), V2i(-21, -15)}, false},
          Case{"moved", {V2i(102, 99), V2i(115, 103)}, {V2i(100, 100), V2i(109, 105)}, true}}) {
        SCOPED_TRACE(name);
        write({{"", {"R", "G", "B", "A"}, data, display}});
        Picture const p = read_exr(exr_file());
        ASSERT_EQ(p.width, 10);
        ASSERT_EQ(p.height, 6);
        EXPECT_EQ(p.left, display.min.x);
        EXPECT_EQ(p.top, display.min.y);
        EXPECT_EQ(!p.notes.empty(), is_said);
        Layer const& color = *p.find("color");
        ASSERT_EQ(color.channels, 4);
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 10; ++x)
                for (int c = 0; c < 4; ++c) { // R, G, B, A of A, B, G, R
                    V2i const at = V2i(x, y) + display.min;
                    float const expected = data.intersects(at) ? value_at(at.x, at.y, c == 3 ? 0 : 3 - c) : 0;
                    ASSERT_EQ(color.data[std::size_t(4 * (10 * y + x) + c)], expected) << x << ", " << y;
                }
    }
}

TEST(ExrWindows, NamesWhatIsMissingAndWhatIsCut)
{
    write({{"", {"R", "G", "B"}, {V2i(-2, 0), V2i(5, 3)}}});
    Picture const p = read_exr(exr_file());
    EXPECT_TRUE(says(p, "covers 6 x 4 of 8 x 4 pixels, the others are 0")) << fmt::format("{}", p.notes);
    EXPECT_TRUE(says(p, "8 x 4 pixels are cut to the 6 x 4")) << fmt::format("{}", p.notes);
    EXPECT_TRUE(p.has_gaps);
    write({{"", {"R", "G", "B"}, {V2i(-2, 0), V2i(7, 3)}}});
    EXPECT_FALSE(read_exr(exr_file()).has_gaps) << "cut, but whole";
}

/// ImfEnvmap.h: the poles are at the borders of the data window.
TEST(ExrWindows, OfAnEnvironmentIsTheDataWindow)
{
    for (Imf::Envmap const kind : {Imf::ENVMAP_LATLONG, Imf::ENVMAP_CUBE}) {
        write({{"", {"R", "G", "B"}, {V2i(0, 0), V2i(3, 1)}, {V2i(0, 0), V2i(99, 99)}}},
              [&](Imf::Header& h) { Imf::addEnvmap(h, kind); });
        Picture const p = read_exr(exr_file());
        EXPECT_EQ(p.width, 4);
        EXPECT_EQ(p.height, 2);
        EXPECT_EQ(p.is_cube, kind == Imf::ENVMAP_CUBE);
    }
}

TEST(ExrWindows, ADisplayWindowThatTheFileCannotFillIsRefused)
{
    write({{"", {"R", "G", "B"}, {V2i(0, 0), V2i(3, 3)}, {V2i(0, 0), V2i(59999, 29999)}}});
    EXPECT_NE(refusal().find("its display window is 60000 x 30000"), std::string::npos) << refusal();
}

TEST(ExrWindows, AreWrittenWhereTheyWere)
{
    write({{"", {"R", "G", "B"}, {V2i(-3, 5), V2i(4, 8)}, {V2i(-3, 5), V2i(4, 8)}}});
    Picture const p = read_exr(exr_file());
    Report report;
    write_exr(exr_file(), p, PixelType::single, report);
    Picture const q = read_exr(exr_file());
    EXPECT_EQ(q.left, -3);
    EXPECT_EQ(q.top, 5);
    EXPECT_EQ(q.find("color")->data, p.find("color")->data);
}

TEST(ExrParts, TheColoursAreThoseOfThePartThatHasThem)
{
    struct Case {
        char const* name;
        std::vector<Part> parts;
        std::string taken; ///< named in a note; empty = there was no choice
        std::vector<std::string> layers;
    };
    Box2i const small(V2i(2, 1), V2i(5, 2));
    for (auto const& [name, parts, taken, layers] : std::vector<Case>{
             {"alpha first", {{"alpha_only", {"A"}}, {"beauty", {"R", "G", "B"}}}, "beauty", {"A", "color"}},
             {"depth first", {{"deep", {"Z"}}, {"rgba", {"R", "G", "B", "A"}}}, "rgba", {"Z", "color"}},
             {"luminance first", {{"y", {"Y"}}, {"rgb", {"R", "G", "B"}}}, "rgb", {"y.color", "color"}},
             {"vectors first", {{"n", {"X", "Y", "Z"}}, {"rgb", {"R", "G", "B"}}}, "rgb", {"XYZ", "color"}},
             {"two", {{"left", {"R", "G", "B"}}, {"right", {"R", "G", "B"}}}, "left", {"color", "right.color"}},
             {"layers", {{"c", {"R", "G", "B"}}, {"d", {"depth.Z"}}}, "", {"color", "depth"}},
             {"a layer named color",
              {{"a", {"color.R", "color.G", "color.B"}}, {"b", {"R", "G", "B"}}},
              "",
              {"a.color", "color"}},
             {"of other windows", {{"c", {"R", "G", "B"}}, {"d", {"depth.Z"}, small}}, "", {"color", "depth"}},
             {"only alpha", {{"a", {"A"}}, {"b", {"Z"}}}, "", {"A", "Z"}}}) {
        SCOPED_TRACE(name);
        write(parts);
        Picture const p = read_exr(exr_file());
        std::vector<std::string> names;
        for (Layer const& l : p.layers) names.push_back(l.name);
        EXPECT_EQ(names, layers);
        EXPECT_EQ(says(p, "its colours are those of its part '" + taken + "'"), !taken.empty())
            << fmt::format("{}", p.notes);
        if (Layer const* const color = p.find("color"); color != nullptr && color->channels == 3) {
            EXPECT_EQ(rgb(*color, 9),
                      (vec3{value_at(1, 1, 2), value_at(1, 1, 1), value_at(1, 1, 0)})); // of B, G, R
        }
        if (Layer const* const depth = p.find("depth")) {
            EXPECT_EQ(depth->data[0], parts[1].data.min.x == 0 ? value_at(0, 0, 0) : 0);
            EXPECT_EQ(depth->data[10], value_at(2, 1, 0));
        }
    }
}

TEST(ExrParts, DeepOnesBesideOthersAreLeftOutAndNamed)
{
    std::vector<Imf::Header> headers(2, Imf::Header(2, 1));
    headers[0].setName("samples");
    headers[0].setType(Imf::DEEPSCANLINE);
    headers[0].compression() = Imf::ZIPS_COMPRESSION;
    headers[0].channels().insert("Z", Imf::Channel(Imf::FLOAT));
    headers[1].setName("flat");
    headers[1].setType(Imf::SCANLINEIMAGE);
    headers[1].channels().insert("Y", Imf::Channel(Imf::FLOAT));
    unsigned counts[2] = {1, 1};
    float depth = 3, y[2] = {4, 5};
    float* samples[2] = {&depth, &depth};
    {
        Imf::MultiPartOutputFile file(exr_file().c_str(), headers.data(), 2);
        Imf::DeepScanLineOutputPart deep(file, 0);
        Imf::DeepFrameBuffer of_samples;
        of_samples.insertSampleCountSlice(Imf::Slice::Make(Imf::UINT, counts, V2i(0), 2, 1));
        of_samples.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples), sizeof(float*),
                                              2 * sizeof(float*), sizeof(float)));
        deep.setFrameBuffer(of_samples);
        deep.writePixels(1);
        Imf::OutputPart flat(file, 1);
        Imf::FrameBuffer buffer;
        buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, y, V2i(0), 2, 1));
        flat.setFrameBuffer(buffer);
        flat.writePixels(1);
    }
    Picture const p = read_exr(exr_file());
    ASSERT_EQ(p.layers.size(), 1u);
    EXPECT_EQ(p.layers[0].data, (std::vector<float>{4, 5}));
    EXPECT_TRUE(says(p, "its part 'samples' holds deep data")) << fmt::format("{}", p.notes);
}

/// Layers, and the numbers of their channels in the order of the alphabet.
TEST(ExrChannels, AreGroupedByTheirMeaning)
{
    struct Case {
        std::vector<std::string> channels;
        std::string layers;
    };
    for (auto const& [channels, layers] :
         std::vector<Case>{{{"R", "G", "B"}, "color 210"},
                           {{"R", "G", "B", "A"}, "color 3210"},
                           {{"R", "G", "B", "A", "Z"}, "color 3210, Z 4"},
                           {{"r", "g", "b", "a"}, "color 3210"},
                           {{"red", "green", "blue", "alpha"}, "color 3210"},
                           {{"diffuse.red", "diffuse.green", "diffuse.blue"}, "diffuse 210"},
                           {{"Y"}, "color 0"},
                           {{"Y", "A"}, "color 1110"}, // grey, in three channels
                           {{"Y", "Z"}, "color 0, Z 1"},
                           {{"A"}, "A 0"},
                           {{"Z"}, "Z 0"},
                           {{"R"}, "R 0"},
                           {{"R", "G"}, "RG 10"},
                           {{"R", "G", "A"}, "RG 21, A 0"}, // as STMaps with an alpha or a mask
                           {{"r", "g"}, "RG 10"},
                           {{"red", "green"}, "RG 10"},
                           {{"red", "green", "mask"}, "RG 20, mask 1"},
                           {{"R", "G", "Z"}, "RG 10, Z 2"},
                           {{"R", "G", "Y"}, "color 2, RG 10"},
                           {{"U", "V", "Z"}, "UV 01, Z 2"},
                           {{"X", "Y", "Z"}, "XYZ 012"},
                           {{"R", "A"}, "R 1, A 0"},
                           {{"u", "v"}, "uv 01"},
                           {{"depth", "id"}, "depth 0, id 1"},
                           {{"N.X", "N.Y", "N.Z"}, "N 012"},
                           {{"N.x", "N.y", "N.z"}, "N 012"},
                           {{"motion.X", "motion.Y"}, "motion 01"},
                           {{"a.b.R", "a.b.G", "a.b.B", "a.b.A"}, "a.b 3210"},
                           {{"spec.R", "spec.G", "spec.B", "spec.Z"}, "spec 210, spec.Z 3"},
                           {{"R", "G", "B", "right.R", "right.G", "right.B"}, "color 210, right 543"}}) {
        SCOPED_TRACE(fmt::format("{}", channels));
        write({{"p", channels}});
        Picture const p = read_exr(exr_file());
        std::vector<std::string> found;
        for (Layer const& l : p.layers) {
            std::string& text = found.emplace_back(l.name + " ");
            for (int c = 0; c < l.channels; ++c)
                text += std::to_string(int(l.data[std::size_t(c)] - value_at(0, 0, 0)) / 500);
        }
        std::ranges::sort(found, {}, [&](std::string const& s) { return layers.find(s); });
        EXPECT_EQ(fmt::format("{}", fmt::join(found, ", ")), layers);
    }
}

TEST(ExrChannels, RedAloneIsNoColour)
{
    write({{"p", {"R"}}});
    try {
        color_of(read_exr(exr_file()), "x.exr");
        FAIL();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("no channels R, G and B, or Y, without a layer"), std::string::npos)
            << e.what();
        EXPECT_NE(std::string(e.what()).find("its layers: R"), std::string::npos) << e.what();
    }
}

TEST(ExrChannels, LongNamesAreReadAndWritten)
{
    std::string const name(100, 'n');
    Picture p;
    p.width = 2;
    p.height = 1;
    p.add("color", 3).data = {1, 2, 3, 4, 5, 6};
    p.add(name, 1).data = {7, 8};
    Report report;
    write_exr(exr_file(), p, PixelType::single, report);
    Picture const q = read_exr(exr_file());
    ASSERT_NE(q.find(name), nullptr);
    EXPECT_EQ(q.find(name)->data, (std::vector<float>{7, 8}));
}

/// Smooth colours, whose chroma survives being sub-sampled.
std::vector<Imf::Rgba> smooth(int width, int height)
{
    std::vector<Imf::Rgba> pixels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            float const u = float(x) / float(width), v = float(y) / float(height);
            pixels.emplace_back(0.3f + 0.6f * u, 0.7f - 0.4f * v, 0.2f + 0.3f * u * v, 0.5f + 0.5f * v);
        }
    return pixels;
}

/// As OpenEXR's own reader has it.
TEST(ExrLuminanceChroma, IsReadAsOpenExrDoes)
{
    int const width = 40, height = 24;
    Imf::Chromaticities const wide({0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f});
    for (bool const is_wide : {false, true})
        for (Imf::RgbaChannels const channels :
             {Imf::WRITE_YC, Imf::WRITE_YCA, Imf::WRITE_Y, Imf::WRITE_YA, Imf::WRITE_RGB}) {
            SCOPED_TRACE(int(channels));
            std::vector<Imf::Rgba> const pixels = smooth(width, height);
            Imf::Header h({V2i(0, 0), V2i(47, 31)}, Box2i(V2i(4, 2), V2i(4 + width - 1, 2 + height - 1)));
            if (is_wide) Imf::addChromaticities(h, wide);
            if (is_wide) h.compression() = Imf::NO_COMPRESSION; // fewer bytes than pixels times channels
            {
                Imf::RgbaOutputFile out(exr_file().c_str(), h, channels);
                out.setFrameBuffer(pixels.data() - 4 - 2 * width, 1, std::size_t(width));
                out.writePixels(height);
            }
            std::vector<Imf::Rgba> theirs(pixels.size());
            {
                Imf::RgbaInputFile in(exr_file().c_str());
                in.setFrameBuffer(theirs.data() - 4 - 2 * width, 1, std::size_t(width));
                in.readPixels(2, 2 + height - 1);
            }
            Picture const p = read_exr(exr_file());
            ASSERT_EQ(p.width, 48);
            Layer const& color = *p.find("color");
            bool const has_alpha = (channels & Imf::WRITE_A) != 0;
            EXPECT_EQ(color.channels, channels == Imf::WRITE_Y ? 1 : has_alpha ? 4 : 3);
            EXPECT_EQ(rgb(color, 0), vec3{0});
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    Imf::Rgba const& t = theirs[std::size_t(y * width + x)];
                    std::size_t const at = std::size_t(48 * (y + 2) + x + 4);
                    vec3 const ours = rgb(color, at);
                    ASSERT_NEAR(ours.x, float(t.r), 3e-3) << x << ", " << y;
                    ASSERT_NEAR(ours.y, float(t.g), 3e-3) << x << ", " << y;
                    ASSERT_NEAR(ours.z, float(t.b), 3e-3) << x << ", " << y;
                    if (has_alpha) {
                        ASSERT_NEAR(color.data[4 * at + 3], float(t.a), 1e-3);
                    }
                }
        }
}

TEST(ExrLuminanceChroma, OtherSubSampledChannelsAreRefusedByName)
{
    for (auto const& [channels, name] :
         {std::pair<std::vector<std::string>, std::string>{{"R", "G", "B"}, "B"}, {{"Y", "RY"}, "RY"}}) {
        Imf::Header h(4, 4);
        for (std::string const& c : channels)
            h.channels().insert(c, Imf::Channel(Imf::HALF, c == name ? 2 : 1, c == name ? 2 : 1));
        std::vector<half> values(16, half(0.5f));
        {
            Imf::OutputFile out(exr_file().c_str(), h);
            Imf::FrameBuffer buffer;
            for (std::string const& c : channels) {
                int const step = c == name ? 2 : 1;
                buffer.insert(c,
                              Imf::Slice::Make(Imf::HALF, values.data(), Box2i(V2i(0), V2i(3)), 2, 8, step, step));
            }
            out.setFrameBuffer(buffer);
            out.writePixels(4);
        }
        EXPECT_NE(refusal().find("channel '" + name + "' is sub-sampled 2 x 2"), std::string::npos) << refusal();
    }
}

/// BT.2087 (Rec. 2020 to Rec. 709), and the published matrix of AP0 to Rec. 709 with Bradford's adaptation (AMPAS,
/// ACESproxy transforms; the numbers of colour-science.org).
TEST(ExrPrimaries, AreConvertedToRec709AndNamed)
{
    struct Case {
        char const* name;
        Imf::Chromaticities primaries;
        vec3 rows[3]; ///< of the matrix
    };
    for (auto const& [name, primaries, rows] :
         {Case{"Rec. 2020",
               {{0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}},
               {{1.6605f, -0.5876f, -0.0728f}, {-0.1246f, 1.1329f, -0.0083f}, {-0.0182f, -0.1006f, 1.1187f}}},
          Case{"AP0",
               {{0.7347f, 0.2653f}, {0, 1}, {0.0001f, -0.077f}, {0.32168f, 0.33767f}},
               {{2.5217f, -1.1341f, -0.3876f}, {-0.2765f, 1.3727f, -0.0962f}, {-0.0154f, -0.1530f, 1.1684f}}}}) {
        SCOPED_TRACE(name);
        write({{"", {"R", "G", "B"}}}, [&, p = primaries](Imf::Header& h) { Imf::addChromaticities(h, p); });
        EXPECT_TRUE(read_exr(exr_file()).primaries);
        Picture const raw = read_exr(exr_file()), p = read_picture(exr_file());
        EXPECT_FALSE(p.primaries);
        EXPECT_TRUE(says(p, "converted to Rec. 709")) << fmt::format("{}", p.notes);
        for (std::size_t i = 0; i < p.pixels(); ++i) {
            vec3 const from = rgb(*raw.find("color"), i), to = rgb(*p.find("color"), i);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(to[k], glm::dot(rows[k], from), 2e-4 * glm::length(from));
        }
    }
    // R, G, B of a layer may be normals.
    write({{"", {"a.R", "a.G", "a.B"}}}, [](Imf::Header& h) {
        Imf::addChromaticities(h, {{0.708f, 0.292f}, {0.17f, 0.797f}, {0.131f, 0.046f}});
    });
    Picture const layer = read_picture(exr_file());
    EXPECT_EQ(rgb(layer.layers[0], 0), (vec3{value_at(0, 0, 2), value_at(0, 0, 1), value_at(0, 0, 0)}));
    EXPECT_TRUE(says(layer, "its layers are as they were")) << fmt::format("{}", layer.notes);
    write({{"", {"R", "G", "B"}}}, [](Imf::Header& h) { Imf::addChromaticities(h, Imf::Chromaticities()); });
    EXPECT_TRUE(read_picture(exr_file()).notes.empty());
    write({{"", {"R", "G", "B"}}}, [](Imf::Header& h) {
        Imf::addChromaticities(h, {{0.3f, 0.3f}, {0.3f, 0.3f}, {0.3f, 0.3f}});
    });
    EXPECT_NE(refusal().find("its chromaticities span no colours"), std::string::npos) << refusal();
}

TEST(ExrPrimaries, PixelsThatAreNotSquareAreNamed)
{
    write({{"", {"R", "G", "B"}}}, [](Imf::Header& h) { h.pixelAspectRatio() = 2; });
    EXPECT_TRUE(says(read_exr(exr_file()), "its pixels, 2 times as wide as high, are taken as square"));
}

} // namespace
} // namespace gi::test
