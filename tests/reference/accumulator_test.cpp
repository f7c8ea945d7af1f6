// Running means in single precision: how far they are from sums in double precision, whole and in parts.

#include "gi/core/error.h"
#include "gi/core/report.h"
#include "gi/core/rng.h"
#include "gi/core/xxhash.h"
#include "gi/render/checkpoint.h"

#include <cstring>
#include <filesystem>
#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

/// Radiance as of paths: mostly dark, seldom bright, over twelve decades; positions far from the origin.
PathSample sample(Pcg32& random)
{
    PathSample s;
    for (vec3& part : s.radiance)
        for (int c = 0; c < 3; ++c)
            part[c] = random.uniform() < 0.7f ? 0 : std::pow(10.0f, 12 * random.uniform() - 9);
    s.hit = random.uniform() < 0.9f;
    for (int c = 0; c < 3; ++c) {
        s.albedo[c] = random.uniform();
        s.position[c] = 100 + random.uniform();
    }
    s.normal = glm::normalize(vec3{random.uniform(), random.uniform(), 1});
    s.depth = 10 + random.uniform();
    return s;
}

struct DoubleSums {
    dvec3 parts[3]{}, squared{0}, albedo{0}, normal{0}, position{0};
    double depth = 0, hits = 0;

    void add(PathSample const& s)
    {
        dvec3 const color = dvec3(s.radiance[0]) + dvec3(s.radiance[1]) + dvec3(s.radiance[2]);
        for (int k = 0; k < 3; ++k) parts[k] += dvec3(s.radiance[std::size_t(k)]);
        squared += color * color;
        if (!s.hit) return;
        albedo += dvec3(s.albedo);
        normal += dvec3(s.normal);
        position += dvec3(s.position);
        depth += double(s.depth);
        hits += 1;
    }
    dvec3 variance_of_mean(double n) const
    {
        dvec3 const m = (parts[0] + parts[1] + parts[2]) / n;
        return (squared / n - m * m) / (n - 1);
    }
};

double off(dvec3 a, dvec3 b)
{
    dvec3 const d = glm::abs(a - b) / glm::abs(b);
    return std::max({d.x, d.y, d.z});
}

/// The largest relative error of any mean, and of the variance.
std::pair<double, double> errors(Accumulator const& a, DoubleSums const& s)
{
    PixelMeans const& p = a.pixels[0];
    double const n = double(a.paths);
    double most = 0;
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, off(dvec3(p.radiance[k]), s.parts[k] / n));
    most = std::max({most, off(dvec3(p.albedo), s.albedo / s.hits), off(dvec3(p.normal), s.normal / s.hits),
                     off(dvec3(p.position), s.position / s.hits), std::abs(p.depth / (s.depth / s.hits) - 1)});
    EXPECT_EQ(double(p.hits), s.hits);
    return {most, off(a.variance_of_mean(p, a.paths), s.variance_of_mean(n))};
}

void add(Accumulator& a, PathSample const& s)
{
    a.add(0, s, a.paths);
    ++a.paths;
}

TEST(PixelMeans, AreAsSumsInDoublePrecision)
{
    for (std::uint64_t seed = 0; seed < 8; ++seed) {
        Pcg32 random = Pcg32::for_path(seed, 0, 0);
        Accumulator a(1, 1);
        DoubleSums sums;
        for (int k = 0; k < 100'000; ++k) {
            PathSample const s = sample(random);
            add(a, s);
            sums.add(s);
        }
        auto const [mean, variance] = errors(a, sums);
        double const noise = std::sqrt(sums.variance_of_mean(1e5).x) / (sums.parts[0].x / 1e5);
        EXPECT_LT(mean, 4e-5);
        EXPECT_LT(variance, 1e-4);
        EXPECT_LT(mean, 1e-2 * noise) << "of the noise that the paths leave";
        RecordProperty("mean", std::to_string(mean));
    }
}

TEST(PixelMeans, EqualPathsAreExact)
{
    Pcg32 random = Pcg32::for_path(5, 0, 0);
    PathSample const s = sample(random);
    Accumulator a(1, 1);
    for (int k = 0; k < 70'000; ++k) add(a, s);
    EXPECT_EQ(a.pixels[0].radiance, s.radiance);
    EXPECT_EQ(a.pixels[0].position, s.hit ? s.position : vec3{0});
    EXPECT_EQ(a.variance_of_mean(a.pixels[0], a.paths), dvec3{0});
}

TEST(PixelMeans, PartsMakeTheWhole)
{
    Pcg32 random = Pcg32::for_path(9, 0, 0);
    DoubleSums sums;
    Accumulator whole(1, 1);
    for (int const count : {1, 500, 0, 3, 20'000}) {
        Accumulator part(1, 1);
        for (int k = 0; k < count; ++k) {
            PathSample const s = sample(random);
            add(part, s);
            sums.add(s);
        }
        whole.add(part);
    }
    EXPECT_EQ(whole.paths, 20'504u);
    auto const [mean, variance] = errors(whole, sums);
    EXPECT_LT(mean, 1e-5);
    EXPECT_LT(variance, 5e-5);
}

TEST(PixelMeans, HugeRadianceStaysFinite)
{
    Accumulator a(1, 1);
    PathSample s;
    for (float const v : {3e38f, 0.0f, 3e38f, 1e-38f}) {
        s.radiance[2] = vec3{v};
        add(a, s);
    }
    EXPECT_TRUE(all_finite(a.pixels[0].radiance[2]));
    EXPECT_TRUE(std::isfinite(a.relative_mse()));
}

Accumulator noise(int width, int height, int paths)
{
    Accumulator a(width, height);
    Pcg32 random = Pcg32::for_path(2, 0, 0);
    for (int k = 0; k < paths; ++k, ++a.paths)
        for (std::size_t p = 0; p < a.pixels.size(); ++p) a.add(p, sample(random), a.paths);
    return a;
}

TEST(Accumulator, RelativeErrorIsThatOfWindows)
{
    Accumulator const a = noise(37, 53, 4);
    double sum = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            dvec3 mean{0};
            double count = 0;
            for (int v = std::max(0, y - 2); v <= std::min(a.height - 1, y + 2); ++v)
                for (int u = std::max(0, x - 2); u <= std::min(a.width - 1, x + 2); ++u, ++count)
                    mean += a.pixels[std::size_t(v * a.width + u)].color();
            mean /= count;
            dvec3 const e =
                a.variance_of_mean(a.pixels[std::size_t(y * a.width + x)], a.paths) / (mean * mean + 0.01);
            sum += e.x + e.y + e.z;
        }
    double const expected = sum / (3.0 * double(a.pixels.size()));
    EXPECT_NEAR(a.relative_mse(), expected, 1e-6 * expected);
}

TEST(Accumulator, RowsMakeThePicture)
{
    Accumulator a = noise(21, 130, 2);
    PictureShape const shape{{1, 2, 3}, true, PictureLayers::all};
    Picture const whole = a.rows(shape, 0, a.height);
    PictureRows const rows = picture_rows(std::make_shared<Accumulator const>(std::move(a)), shape);
    for (int y = 0; y < rows.height; y += 50) {
        Picture const some = rows.read(y, std::min(50, rows.height - y));
        ASSERT_EQ(some.layers.size(), whole.layers.size());
        for (std::size_t l = 0; l < some.layers.size(); ++l)
            EXPECT_TRUE(
                std::equal(some.layers[l].data.begin(), some.layers[l].data.end(),
                           whole.layers[l].data.begin() + std::ptrdiff_t(21 * y * some.layers[l].channels)));
    }
}

TEST(Accumulator, ACheckpointHoldsAll)
{
    std::filesystem::path const file =
        std::filesystem::temp_directory_path() / ("lightwell_sums_" + std::to_string(getpid()) + ".state");
    Accumulator a = noise(16, 8, 3), b(16, 8);
    a.counts.shadow_rays = 7;
    a.seconds = 1.5;
    save_checkpoint(file, a, 99);
    EXPECT_EQ(std::filesystem::file_size(file), checkpoint_bytes(16, 8));
    ASSERT_TRUE(load_checkpoint(file, b, 99));
    EXPECT_EQ(b.paths, 3u);
    EXPECT_EQ(b.counts.shadow_rays, 7u);
    EXPECT_EQ(b.seconds, 1.5);
    EXPECT_EQ(std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(PixelMeans)), 0);
    StopRequest stop;
    Accumulator c(16, 8);
    ASSERT_TRUE(load_checkpoint(file, c, 99, &stop));
    stop.request();
    EXPECT_THROW(load_checkpoint(file, c, 99, &stop), Interrupted);
    std::filesystem::resize_file(file, checkpoint_bytes(16, 8) - 1);
    EXPECT_THROW(load_checkpoint(file, b, 99), InputError);
    std::filesystem::remove(file);
    EXPECT_FALSE(load_checkpoint(file, b, 99));
}

/// Paths of another level of processors are kept, and it is said that they are.
TEST(Accumulator, ACheckpointOfAnotherLevelOfProcessorsIsTold)
{
    std::filesystem::path const file = std::filesystem::path(testing::TempDir()) / "level.state";
    Accumulator const a = noise(4, 2, 3);
    save_checkpoint(file, a, 99);
    std::size_t const header = checkpoint_bytes(0, 0), level = header - 12;
    std::vector<std::byte> bytes(std::filesystem::file_size(file));
    std::ifstream(file, std::ios::binary)
        .read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    auto const told = [&] {
        Accumulator b(4, 2);
        Report report;
        EXPECT_TRUE(load_checkpoint(file, b, 99, nullptr, &report));
        EXPECT_EQ(b.paths, 3u);
        return report.losses();
    };
    EXPECT_TRUE(told().empty());
    bytes[level] = std::byte(bytes[level] == std::byte{1} ? 2 : 1);
    std::fill(bytes.begin() + std::ptrdiff_t(header) - 8, bytes.begin() + std::ptrdiff_t(header), std::byte{0});
    std::span<std::byte const> const all(bytes);
    std::uint64_t const hash = xxh64({}, xxh64(all.subspan(header), xxh64(all.first(header))));
    std::memcpy(&bytes[header - 8], &hash, 8);
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(bytes.data()), std::streamsize(bytes.size()));
    auto const losses = told();
    ASSERT_EQ(losses.size(), 1u);
    EXPECT_EQ(losses.begin()->second.count, 3u);
    std::filesystem::remove(file);
}

TEST(Accumulator, ACheckpointOfAnEarlierVersionIsReadOrRefusedWithTheWayOut)
{
    std::filesystem::path const old =
        std::filesystem::path(LIGHTWELL_SOURCE_DIR) / "tests/data/old/7d477989/cornell.exr.state";
    auto const refusal = [](std::filesystem::path const& file, std::uint64_t print) -> std::string {
        Accumulator a(8, 6);
        try {
            EXPECT_TRUE(load_checkpoint(file, a, print)) << "there is no " << file;
        } catch (InputError const& e) {
            return e.what();
        }
        return {};
    };
    std::uint64_t print = 0; // after the 8 bytes of the format
    std::ifstream(old, std::ios::binary).ignore(8).read(reinterpret_cast<char*>(&print), sizeof print);
    EXPECT_EQ(refusal(old, print), "");
    std::string const foreign = refusal(old, print + 1);
    EXPECT_NE(foreign.find("belongs to another render"), std::string::npos) << foreign;
    EXPECT_NE(foreign.find("the version that wrote it can finish it"), std::string::npos) << foreign;

    std::filesystem::path const earlier = std::filesystem::path(testing::TempDir()) / "earlier.state";
    std::filesystem::copy_file(old, earlier, std::filesystem::copy_options::overwrite_existing);
    std::fstream(earlier, std::ios::binary | std::ios::in | std::ios::out).seekp(7).put('2');
    std::string const format_2 = refusal(earlier, print);
    EXPECT_NE(format_2.find("is a checkpoint of another version (its format is 2, this version reads 5) finish the "
                            "picture with the version that began it, or delete the file to start afresh"),
              std::string::npos)
        << format_2;
    std::filesystem::remove(earlier);
}

TEST(Accumulator, AnyDamagedByteOfACheckpointIsNoticed)
{
    std::filesystem::path const file =
        std::filesystem::temp_directory_path() / ("lightwell_damaged_" + std::to_string(getpid()) + ".state");
    Accumulator a = noise(16, 2, 3), b(16, 2);
    a.further.assign(a.pixels.size(), 1);
    save_checkpoint(file, a, 99);
    ASSERT_TRUE(load_checkpoint(file, b, 99));
    EXPECT_EQ(b.further, a.further);
    std::fstream bytes(file, std::ios::in | std::ios::out | std::ios::binary);
    std::vector<std::streamoff> unnoticed;
    for (std::streamoff at = 0; at < std::streamoff(std::filesystem::file_size(file)); ++at) {
        char const right = char(bytes.seekg(at).get());
        bytes.seekp(at).put(char(right ^ 0x40)).flush();
        try {
            load_checkpoint(file, b, 99);
            unnoticed.push_back(at);
        } catch (InputError const&) {
        }
        bytes.seekp(at).put(right).flush();
    }
    EXPECT_TRUE(unnoticed.empty()) << unnoticed.size() << " bytes, the first one " << unnoticed.front();
    EXPECT_TRUE(load_checkpoint(file, b, 99));
    std::filesystem::remove(file);
}

} // namespace
} // namespace gi::test
