#include "gi/filter/tone_map.h"
#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

TEST(ToneMap, CurvesAndOddValues)
{
    Layer const layer{"color", 3, {0, 0.18f, 1, 5, -1, std::nanf("")}};
    auto const out = tone_map(layer, {});
    EXPECT_EQ(out[0], 0);
    EXPECT_NEAR(out[1], 0.4613561, 1e-5);
    EXPECT_FLOAT_EQ(out[2], 1);
    EXPECT_FLOAT_EQ(out[3], 1);
    EXPECT_EQ(out[4], 0);
    EXPECT_EQ(out[5], 0);
    EXPECT_NEAR(tone_map(layer, {1, ToneCurve::srgb})[1], encode_srgb(0.36f), 1e-6);
    auto const filmic = tone_map(layer, {0, ToneCurve::filmic});
    EXPECT_NEAR(filmic[2], encode_srgb(2.54f / 3.16f), 1e-6);
    EXPECT_GT(filmic[3], filmic[2]);
    EXPECT_LE(filmic[3], 1);
    EXPECT_EQ(tone_map_bytes({"depth", 1, {1.0f}}, {}), (std::vector<unsigned char>{255, 255, 255}));
}

/// The same kernel in any space.
template <Space S>
std::vector<float> run(std::vector<float> const& values, ToneCurve curve)
{
    Buffer<float, S> const in = upload<S>(values);
    Buffer<float, S> out(values.size());
    launch(S, "tone map", values.size(), ToneMap{in.view(), out.view(), 0.7f, curve});
    return download(out);
}

TEST(ToneMap, TheDeviceAgreesWithTheHost)
{
    std::vector<float> values{-1, 0, 1e-30f, 1e30f, std::nanf(""), std::numeric_limits<float>::infinity()};
    for (int i = 0; i < 5000; ++i) values.push_back(1e-4f * float(i) * float(i) / 100);
    for (ToneCurve const curve : {ToneCurve::srgb, ToneCurve::filmic}) {
        std::vector<float> const host = run<Space::host>(values, curve);
        for (float const v : host) ASSERT_TRUE(v >= 0 && v <= 1) << v;
        if (!device_present()) continue;
        std::vector<float> const device = run<Space::device>(values, curve);
        for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(device[i], host[i], 1e-6) << values[i];
    }
    if (!device_present()) GTEST_SKIP() << "SKIPPED: no CUDA device (only the host side was checked)";
}

TEST(ToneMap, OnADeviceSaysWhatIsMissingWithoutCuda)
{
    if constexpr (kCudaBuild) GTEST_SKIP() << "SKIPPED: this build has CUDA";
    try {
        launch(Space::device, "tone map", 1, ToneMap{{}, {}, 1, ToneCurve::srgb});
        FAIL();
    } catch (std::runtime_error const& e) {
        EXPECT_STREQ(e.what(), "tone map: built without CUDA (configure with the cuda preset)");
    }
}

} // namespace
} // namespace gi::test
