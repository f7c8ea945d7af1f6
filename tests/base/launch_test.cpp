#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"

#include <cmath>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

struct Square {
    View<float const> in;
    View<float> out;
    GI_FN void operator()(std::size_t i) const { out[i] = in[i] * in[i]; }
};

TEST(Launch, RunsEveryItemOnce)
{
    std::vector<float> values;
    for (int i = 0; i < 100000; ++i) values.push_back(float(i % 1000));
    Buffer<float, Space::host> const in = upload<Space::host>(values);
    Buffer<float, Space::host> out(values.size());
    launch_host(values.size(), Square{in.view(), out.view()});
    std::vector<float> const result = download(out);
    for (std::size_t i = 0; i < values.size(); ++i) ASSERT_EQ(result[i], values[i] * values[i]);
    launch_host(0, Square{in.view(), out.view()});
}

TEST(Buffer, OwnsMovesAndCopies)
{
    Buffer<float, Space::host> a = upload<Space::host>(std::vector<float>{1, 2, 3});
    float const* const items = a.view().data;
    Buffer<float, Space::host> b(std::move(a));
    EXPECT_EQ(b.view().data, items);
    Buffer<float, Space::host> c(3);
    copy(b, c);
    EXPECT_EQ(download(c), (std::vector<float>{1, 2, 3}));
    Buffer<float, Space::host> short_one(2);
    EXPECT_THROW(copy(b, short_one), std::logic_error);
    EXPECT_THROW((Buffer<double, Space::host>(std::size_t(-1) / 4)), std::bad_alloc);
    EXPECT_EQ((Buffer<float, Space::host>().size()), 0u);
}

#ifndef NDEBUG
TEST(Buffer, IsPoisonedInDebugBuilds)
{
    Buffer<float, Space::host> const fresh(4);
    for (float const v : fresh.view()) EXPECT_TRUE(std::isnan(v));
}
#endif

TEST(Buffer, OnADeviceSaysWhatIsMissingWithoutCuda)
{
    if constexpr (kCudaBuild) GTEST_SKIP() << "SKIPPED: this build has CUDA";
    EXPECT_FALSE(device_present());
    EXPECT_THROW((Buffer<float, Space::device>(1)), std::runtime_error);
}

} // namespace
} // namespace gi::test
