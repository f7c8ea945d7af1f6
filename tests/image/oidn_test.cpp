// The filter oidn. All but the first test are skipped, visibly, where Open Image Denoise is not installed.

#include "gi/core/error.h"
#include "gi/filter/filter_names.h"
#include "gi/methods/reference/reference.h"
#include "gi/metrics/metrics.h"
#include "gi/scene/load/load.h"

#include <cstdlib>
#include <gtest/gtest.h>
#include <numeric>

namespace gi::test {
namespace {

TEST(OidnMissing, IsSaidBeforeRendering)
{
    testing::FLAGS_gtest_death_test_style = "threadsafe"; // a process of its own, which has not loaded it
    auto const ask = [] {
        setenv("LIGHTWELL_OIDN", "/nowhere/libOpenImageDenoise.so.2", 1);
        try {
            check_filter(find_filter("oidn"));
        } catch (InputError const& e) {
            std::fputs(e.what(), stderr);
            std::exit(2);
        }
        std::exit(0);
    };
    EXPECT_EXIT(ask(), testing::ExitedWithCode(2),
                "the filter oidn cannot be used \\(.*/nowhere/.*\\) .*scripts/setup --oidn");
}

class Oidn : public testing::Test {
protected:
    void SetUp() override
    {
        try {
            check_filter(kOidn);
        } catch (InputError const& e) {
            GTEST_SKIP() << "SKIPPED: " << e.what();
        }
    }
    static inline DenoiseSettings const kOidn = find_filter("oidn");
};

/// A grey wall that faces the eye under even light.
Picture even_wall(int width, int height)
{
    Picture p;
    p.width = width;
    p.height = height;
    for (auto const& [name, value] : {std::pair<char const*, vec3>{"color", vec3{0.75f}},
                                      {"L0", vec3{0}},
                                      {"L1", vec3{0.5f}},
                                      {"L2", vec3{0.25f}},
                                      {"albedo", vec3{0.5f}},
                                      {"normal", {0, 0, 1}}}) {
        Layer& layer = p.add(name, 3);
        for (std::size_t k = 0; k < layer.data.size(); ++k) layer.data[k] = value[int(k % 3)];
    }
    return p;
}

Picture noisy_cornell(std::uint32_t paths, std::uint64_t seed)
{
    Report report;
    World const world =
        build_world(std::make_shared<Scene const>(load_scene("cornell", report)), std::nullopt, report);
    RenderSettings s;
    s.width = s.height = 128;
    s.paths = paths;
    s.seed = seed;
    return render_reference(world, world.cameras.at(0), s, {}, {}, report).picture;
}

/// L1 + L2: no filter touches the edges of the lamp.
std::vector<float> lit(Picture const& p)
{
    std::vector<float> sum = p.find("L1")->data;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += p.find("L2")->data[i];
    return sum;
}

void expect_layers_add_up(Picture const& p)
{
    for (std::size_t k = 0; k < p.find("color")->data.size(); ++k)
        ASSERT_FLOAT_EQ(p.find("color")->data[k],
                        p.find("L0")->data[k] + p.find("L1")->data[k] + p.find("L2")->data[k]);
}

TEST_F(Oidn, EndsWhereAStopIsRequestedAndWorksAgain)
{
    Picture const noisy = even_wall(64, 48);
    Picture first = noisy, again = noisy, stopped = noisy;
    denoise(first, kOidn);
    StopRequest stop;
    stop.request();
    DenoiseSettings settings = kOidn;
    settings.stop = &stop;
    EXPECT_THROW(denoise(stopped, settings), Interrupted);
    denoise(again, kOidn);
    EXPECT_EQ(first.find("color")->data, again.find("color")->data);
}

TEST_F(Oidn, KeepsAnEvenWall)
{
    for (auto const& [width, height] : {std::pair{64, 48}, {1, 1}, {3, 2}, {1, 9}, {17, 1}}) {
        Picture p = even_wall(width, height);
        DenoiseReport const report = denoise(p, kOidn);
        EXPECT_EQ(report.not_finite + report.without_surface, 0u);
        for (float const v : p.find("color")->data) ASSERT_NEAR(v, 0.75f, 0.015f) << width << " x " << height;
    }
    Picture none = even_wall(0, 0);
    denoise(none, kOidn);
}

TEST_F(Oidn, DoesNotSpreadWhatIsNotFinite)
{
    constexpr std::size_t kBad = 40 * 20 + 20;
    for (char const* const layer : {"L1", "L2", "albedo", "normal"})
        for (float const bad : {std::nanf(""), HUGE_VALF, -HUGE_VALF}) {
            Picture p = even_wall(40, 40);
            p.find(layer)->data[3 * kBad + 1] = bad;
            EXPECT_EQ(denoise(p, kOidn).not_finite, 1u) << layer << " " << bad;
            for (std::size_t i = 0; i < p.pixels(); ++i) ASSERT_NEAR(rgb(*p.find("color"), i).y, 0.75f, 0.015f);
            float const kept = p.find(layer)->data[3 * kBad + 1];
            EXPECT_TRUE(std::isnan(bad) ? std::isnan(kept) : kept == bad);
        }
}

TEST_F(Oidn, LeavesPixelsWithoutASurface)
{
    Picture p = even_wall(30, 30);
    for (std::size_t i = 0; i < p.pixels() / 2; ++i)
        for (int c = 0; c < 3; ++c)
            for (char const* const layer : {"normal", "albedo", "L1", "L2"})
                p.find(layer)->data[3 * i + std::size_t(c)] = 0;
    Picture const before = p;
    EXPECT_EQ(denoise(p, kOidn).without_surface, p.pixels() / 2);
    for (std::size_t i = 0; i < p.pixels() / 2; ++i)
        ASSERT_EQ(rgb(*p.find("color"), i), rgb(*before.find("color"), i));
}

TEST_F(Oidn, TheErrorOfACornellBoxFallsByMoreThanByAtrous)
{
    Picture const reference = noisy_cornell(160, 1), noisy = noisy_cornell(8, 2);
    auto const errors = [&](char const* filter) {
        Picture p = noisy;
        denoise(p, find_filter(filter));
        expect_layers_add_up(p);
        return measure_errors(lit(p), lit(reference), 3);
    };
    ErrorSums const none = measure_errors(lit(noisy), lit(reference), 3);
    for (char const* const filter : {"oidn", "oidn-high"}) {
        ErrorSums const with = errors(filter);
        EXPECT_LT(with.relmse, errors("atrous").relmse) << filter << "; unfiltered " << none.relmse;
        EXPECT_NEAR(with.mean_bias, 1, 0.02) << filter;
    }
}

TEST_F(Oidn, TheResultDoesNotDependOnThreads)
{
    Picture const noisy = noisy_cornell(2, 3);
    DenoiseSettings one = kOidn, two = kOidn;
    one.threads = 1;
    two.threads = 2;
    Picture a = noisy, b = noisy, again = noisy;
    denoise(a, one);
    denoise(b, two);
    denoise(again, two);
    EXPECT_EQ(a.find("color")->data, b.find("color")->data);
    EXPECT_EQ(again.find("color")->data, b.find("color")->data);
}

TEST_F(Oidn, SaysWhatIsMissing)
{
    for (char const* const name : {"color", "L0", "L1", "L2", "albedo", "normal"}) {
        Picture p = even_wall(4, 4);
        std::erase_if(p.layers, [&](Layer const& l) { return l.name == name; });
        EXPECT_THROW(denoise(p, kOidn), InputError) << name;
    }
}

TEST(FilterNames, AreFoundAndRefused)
{
    for (std::string const& name : filter_names()) find_filter(name);
    EXPECT_EQ(find_filter("wide").reach, 2);
    EXPECT_THROW(find_filter("median"), InputError);
}

} // namespace
} // namespace gi::test
