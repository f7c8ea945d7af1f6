#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/filter/tone_map.h"
#include "gi/metrics/compare.h"
#include "gi/metrics/flip.h"
#include "gi/metrics/metrics.h"
#include "gi/metrics/ssim.h"
#include "gi/metrics/ztest.h"
#include "tests/support/statistics.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

float value(NamedValue const& v) { return float(v.value); }

double find(Comparison const& c, std::string const& name)
{
    for (NamedValue const& v : c.values)
        if (v.name == name) return v.value;
    ADD_FAILURE() << "no value " << name;
    return 0;
}

Picture constant(int width, int height, vec3 c, float variance = 0)
{
    Picture p;
    p.width = width;
    p.height = height;
    p.add("color", 3);
    p.add("variance", 3);
    for (std::size_t i = 0; i < 3 * p.pixels(); ++i) {
        p.layers[0].data[i] = c[int(i % 3)];
        p.layers[1].data[i] = variance;
    }
    return p;
}

TEST(Metrics, PicturesOfOtherPlacesAreRefused)
{
    Picture const a = constant(8, 4, vec3{0.5f});
    Picture moved = a, large = constant(16, 8, vec3{0.5f});
    moved.left = large.left = 2;
    EXPECT_THROW(compare(a, moved, {"rmse"}, "color"), InputError);
    EXPECT_THROW(compare(a, large, {"rmse"}, "color"), InputError);
    EXPECT_THROW(compare(large, a, {"rmse"}, "color"), InputError);
    large.left = 4; // two of its pixels are one
    EXPECT_EQ(find(compare(moved, large, {"rmse"}, "color"), "rmse"), 0);
    moved.notes = {"its data"};
    Comparison const c = compare(moved, moved, {"rmse"}, "color");
    EXPECT_EQ(c.notes, (std::vector<std::string>{"the image: its data", "the reference: its data"}));
}

TEST(Metrics, ClosedForms)
{
    Comparison const c =
        compare(constant(16, 12, {0.5f, 0.4f, 0.2f}), constant(16, 12, {0.4f, 0.4f, 0.4f}), {}, "color");
    EXPECT_NEAR(find(c, "rmse"), std::sqrt((0.01 + 0 + 0.04) / 3), 1e-6);
    EXPECT_NEAR(find(c, "relmse"), (0.01 + 0.04) / 3 / (0.16 + 0.01), 1e-6);
    EXPECT_NEAR(find(c, "bias"), 1.1 / 1.2, 1e-6);
    EXPECT_NEAR(find(c, "bias.error"), 1 - 1.1 / 1.2, 1e-6);
    EXPECT_NEAR(find(c, "bias.r"), 1.25, 1e-6);
    EXPECT_NEAR(find(c, "bias.b"), 0.5, 1e-6);
    double mse = 0;
    for (auto const& [x, r] : {std::pair{0.5f, 0.4f}, std::pair{0.2f, 0.4f}})
        mse += std::pow(double(encode_srgb(x)) - double(encode_srgb(r)), 2) / 3;
    EXPECT_NEAR(find(c, "psnr"), -10 * std::log10(mse), 1e-4);
    EXPECT_GT(find(c, "flip"), 0.05);
}

TEST(Metrics, EqualPicturesHaveNoError)
{
    Picture const p = constant(20, 20, {0.3f, 0.6f, 0.1f});
    Comparison const c = compare(p, p, {"rmse", "relmse", "bias", "psnr", "ssim", "flip", "hdrflip"}, "color");
    EXPECT_EQ(find(c, "rmse"), 0);
    EXPECT_EQ(find(c, "relmse"), 0);
    EXPECT_EQ(find(c, "bias"), 1);
    EXPECT_TRUE(std::isinf(find(c, "psnr")));
    EXPECT_NEAR(find(c, "ssim"), 1, 1e-9);
    EXPECT_EQ(find(c, "flip"), 0);
    EXPECT_EQ(find(c, "hdrflip"), 0);
}

TEST(Metrics, ValuesThatAreNotFiniteAreLeftOutAndSaid)
{
    Picture a = constant(8, 8, vec3{0.5f});
    a.layers[0].data[5] = std::nanf("");
    Comparison const c = compare(a, constant(8, 8, vec3{0.5f}), {"rmse"}, "color");
    EXPECT_EQ(find(c, "rmse"), 0);
    ASSERT_EQ(c.notes.size(), 1u);
    EXPECT_NE(c.notes[0].find("1 of 192 values that are not finite"), std::string::npos);

    Comparison const left_out = compare(a, constant(8, 8, vec3{0.3f}), {"rmse"}, "color");
    EXPECT_NEAR(find(left_out, "rmse"), 0.2, 1e-6); // of the 191 others, not diluted by the one
    // Pixels that are not finite are no agreement: half of them change no figure of the others.
    Picture const dark = constant(8, 8, vec3{0.3f}), bright = constant(8, 8, vec3{0.5f});
    Picture half = bright;
    for (std::size_t i = 0; i < half.layers[0].data.size() / 2; ++i) half.layers[0].data[i] = std::nanf("");
    EXPECT_NEAR(find(compare(half, dark, {"psnr"}, "color"), "psnr"),
                find(compare(bright, dark, {"psnr"}, "color"), "psnr"), 1e-6);
    EXPECT_GT(find(compare(half, dark, {"flip"}, "color"), "flip"),
              0.9 * find(compare(bright, dark, {"flip"}, "color"), "flip"));
    for (float& v : a.layers[0].data) v = std::nanf("");
    EXPECT_THROW(compare(a, constant(8, 8, vec3{0.5f}), {"flip"}, "color"), InputError);
    EXPECT_TRUE(std::isnan(measure_errors(a.layers[0].data, a.layers[0].data, 3).rmse));
}

TEST(Metrics, DoubtComparisonsByWhatThePicturesSayOfThemselves)
{
    std::map<std::string, std::string> const facts{
        {"command", "lightwell render a.glb --seed 1 --camera left --paths 64"},
        {"scene", "a.glb"},
        {"method", "paths"},
        {"seed", "1"},
        {"paths", "64"},
        {"denoise", "none"},
        {"estimated_relmse", "0.004"}};
    auto const notes = [&](std::map<std::string, std::string> const& of_image,
                           std::vector<std::string> const& metrics = {"relmse"}) {
        Picture image = constant(8, 8, vec3{0.5f}, 0.1f), reference = constant(8, 8, vec3{0.45f}, 0.1f);
        image.metadata = reference.metadata = facts;
        for (auto const& [key, value] : of_image) image.metadata[key] = value;
        return compare(image, reference, metrics, "color").notes;
    };
    EXPECT_TRUE(notes({}).empty()) << "one command: nothing may have changed";
    std::map<std::string, std::string> other{
        {"command", "lightwell render a.glb --seed 2 --camera left --paths 16"}, {"seed", "2"}, {"paths", "16"}};
    auto const only = [&](char const* part, std::map<std::string, std::string> const& change,
                          std::vector<std::string> const& metrics = {"rmse"}) {
        std::map<std::string, std::string> all = other;
        for (auto const& [key, value] : change) all[key] = value;
        auto const said = notes(all, metrics);
        ASSERT_EQ(said.size(), 1u) << part << (said.empty() ? "" : " " + said[0]);
        EXPECT_NE(said[0].find(part), std::string::npos) << said[0];
    };
    EXPECT_TRUE(notes(other, {"rmse"}).empty());
    only("both have seed 1", {{"seed", "1"}});
    only("fewer than the image (128)", {{"paths", "128"}});
    only("differ in --camera", {{"command", "lightwell render a.glb --seed 2 --camera right --paths 16"}});
    only("differ in --camera, --look-from",
         {{"command", "lightwell render a.glb --seed 2 --look-from 1,2,3 --paths 16"}});
    only("'b.glb' and 'a.glb'", {{"scene", "b.glb"}});
    only("own noise, an estimated relMSE of 0.004", {}, {"relmse"});
    only("filtered (atrous)", {{"denoise", "atrous"}}, {"ztest"});
    Picture file = constant(8, 8, vec3{0.5f}), whole = constant(8, 8, vec3{2});
    file.ends_at_one = true;
    EXPECT_NE(compare(file, whole, {"rmse"}, "color").notes.at(0).find("100 % of the reference's values"),
              std::string::npos);
    EXPECT_TRUE(compare(file, file, {"rmse"}, "color").notes.empty());
}

TEST(Metrics, AveragesALargerPictureDown)
{
    Picture large = constant(16, 8, vec3{0});
    for (std::size_t i = 0; i < large.pixels(); ++i)
        for (std::size_t k = 0; k < 3; ++k) large.layers[0].data[3 * i + k] = i % 2 == 0 ? 0.2f : 0.6f;
    EXPECT_NEAR(find(compare(constant(8, 4, vec3{0.4f}), large, {"rmse"}, "color"), "rmse"), 0, 1e-6);
    EXPECT_THROW(compare(constant(5, 4, vec3{0}), large, {"rmse"}, "color"), InputError);
    EXPECT_THROW(compare(large, large, {"nonsense"}, "color"), InputError);
    EXPECT_THROW(compare(large, large, {"rmse"}, "no layer"), InputError);
    EXPECT_EQ(value(compare(large, large, {"rmse"}, "color").values[0]), 0);
    Picture red = large; // as of an OpenEXR file with a channel R alone
    red.layers[0].name = "R";
    try {
        compare(red, red, {"rmse"}, "color");
        ADD_FAILURE();
    } catch (InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("R, G and B together, or Y, without a layer"), std::string::npos)
            << e.what();
        EXPECT_NE(std::string(e.what()).find("it has: R"), std::string::npos) << e.what();
    }
}

TEST(Ssim, AgreesWithTheDefinitionTakenLiterally)
{
    int const w = 17, h = 14;
    Pcg32 rng(2, 2);
    std::vector<float> a, b;
    for (int i = 0; i < w * h; ++i) {
        a.push_back(rng.uniform());
        b.push_back(0.7f * a.back() + 0.3f * rng.uniform());
    }
    double sum = 0;
    int count = 0;
    for (int y = 5; y < h - 5; ++y)
        for (int x = 5; x < w - 5; ++x) {
            double n = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
            for (int j = -5; j <= 5; ++j)
                for (int i = -5; i <= 5; ++i) {
                    double const g = std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5));
                    double const p = double(a[std::size_t((y + j) * w + x + i)]),
                                 q = double(b[std::size_t((y + j) * w + x + i)]);
                    n += g, ma += g * p, mb += g * q, aa += g * p * p, bb += g * q * q, ab += g * p * q;
                }
            ma /= n, mb /= n;
            double const va = aa / n - ma * ma, vb = bb / n - mb * mb, cov = ab / n - ma * mb;
            sum += (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
            ++count;
        }
    EXPECT_NEAR(ssim(a, b, w, h), sum / count, 1e-9);
}

double normal(Pcg32& rng)
{
    double const u = std::max(1e-12, rng.uniform_double()), v = rng.uniform_double();
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * glm::pi<double>() * v);
}

TEST(ZTest, IsCalibratedOnGaussianNoise)
{
    Pcg32 rng(4, 4);
    std::vector<float> x, var, r, none;
    for (int i = 0; i < 200000; ++i) {
        double const sigma = 0.1 + rng.uniform_double();
        r.push_back(float(rng.uniform_double()));
        x.push_back(float(double(r.back()) + sigma * normal(rng)));
        var.push_back(float(sigma * sigma));
    }
    ZTest const z = z_test(x, var, r, none);
    EXPECT_NEAR(z.mean_z, 0, 3 / std::sqrt(2e5));
    EXPECT_NEAR(z.beyond_2, 0.0455, 0.0015);
    EXPECT_NEAR(z.beyond_3, 0.0027, 0.0004);
    EXPECT_GT(z.sidak_p, 0.001);
    for (float& v : x) v += 0.02f;
    EXPECT_LT(z_test(x, var, r, none).mean_p, 1e-6);
    x[0] += 20;
    EXPECT_LT(z_test(x, var, r, none).sidak_p, 1e-6);
}

TEST(ZTest, PValuesAreUniformOverManyPictures)
{
    constexpr int kPictures = 2000, kBins = 20;
    std::vector<double> sidak(kBins, 0.0), of_mean(kBins, 0.0), of_squares(kBins, 0.0);
    std::vector<float> const zero(300, 0.0f), var(300, 0.25f);
    Pcg32 rng(6, 6);
    for (int i = 0; i < kPictures; ++i) {
        std::vector<float> x;
        for (std::size_t k = 0; k < zero.size(); ++k) x.push_back(float(std::sqrt(0.5) * normal(rng)));
        ZTest const z = z_test(x, var, zero, var);
        ++sidak[std::min<std::size_t>(kBins - 1, std::size_t(z.sidak_p * kBins))];
        ++of_mean[std::min<std::size_t>(kBins - 1, std::size_t(z.mean_p * kBins))];
        ++of_squares[std::min<std::size_t>(kBins - 1, std::size_t(z.chi2_p * kBins))];
    }
    std::vector<double> const expected(kBins, double(kPictures) / kBins);
    EXPECT_GT(chi_square_p(sidak, expected), 0.001);
    EXPECT_GT(chi_square_p(of_mean, expected), 0.001);
    EXPECT_GT(chi_square_p(of_squares, expected), 0.001);
}

TEST(ZTest, AWrongValueWithoutVarianceIsCertain)
{
    std::vector<float> const x{1, 2, 3}, r{1, 2, 4}, none(3, 0.0f);
    ZTest const z = z_test(x, none, r, {});
    EXPECT_EQ(z.count, 1u); // those that agree are left out
    EXPECT_GT(z.largest, 1e6);
    EXPECT_LT(z.sidak_p, 1e-12);
    EXPECT_EQ(z.chi2_p, 0);
}

TEST(ZTest, RoundingIsNoDifference)
{
    float const next = std::nextafter(1.8f, 2.0f);
    std::vector<float> const x(1000, 1.8f), r(1000, next), none(1000, 0.0f), tiny(1000, 1e-17f);
    EXPECT_EQ(z_test(x, none, r, none).count, 0u);
    EXPECT_GT(z_test(x, none, std::vector<float>(1000, std::nextafter(next, 2.0f)), none).sidak_p, 0.001);
    EXPECT_GT(z_test(x, tiny, r, tiny).sidak_p, 0.001);
    EXPECT_LT(z_test(x, tiny, std::vector<float>(1000, 1.80001f), tiny).sidak_p, 1e-12);
}

TEST(DifferenceImage, IsBlackWhereThePicturesAgree)
{
    Picture const a = constant(32, 16, vec3{0.4f});
    Picture b = a;
    for (std::size_t k = 0; k < 3; ++k) b.layers[0].data[3 * (8 * 32 + 2) + k] = 1;
    int width = 0, height = 0;
    std::vector<unsigned char> const map = difference_image(a, b, "color", width, height);
    ASSERT_EQ(map.size(), 3u * 32 * 16);
    EXPECT_EQ(map[3 * (8 * 32 + 30)], 0); // far away
    EXPECT_GT(map[3 * (8 * 32 + 2)], 20);
}

} // namespace
} // namespace gi::test
