#include "gi/render/accumulator.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace gi {

void Accumulator::add(Accumulator const& other)
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, other.paths > 0 ? pixels.size() : 0, 4096),
                      [&](auto const& range) {
                          for (std::size_t i = range.begin(); i != range.end(); ++i) {
                              if (paths == 0) pixels[i] = PixelSums{};
                              pixels[i].add(other.pixels[i]);
                          }
                      });
    paths += other.paths;
    counts += other.counts;
    seconds = std::max(seconds, other.seconds); // the two were rendered in parallel
}

dvec3 Accumulator::variance_of_mean(PixelSums const& p) const
{
    if (paths < 2) return dvec3{0};
    double const n = double(paths);
    dvec3 const m = mean(p);
    return glm::max(dvec3{0}, (p.color_squared / n - m * m) / (n - 1));
}

namespace {

/// Means over windows of (2 r + 1)^2 values, fewer at the picture's border.
std::vector<vec3> window_means(std::vector<vec3> values, int width, int height, int r)
{
    std::vector<vec3> rows(values.size());
    auto const along = [](std::vector<vec3> const& from, std::vector<vec3>& to, int lines, int n, int step,
                          int line_step, int reach) {
        tbb::parallel_for(0, lines, [&](int line) {
            for (int k = 0; k < n; ++k) {
                int const first = std::max(0, k - reach), last = std::min(n - 1, k + reach);
                vec3 sum{0};
                for (int j = first; j <= last; ++j) sum += from[std::size_t(line * line_step + j * step)];
                to[std::size_t(line * line_step + k * step)] = sum / float(last - first + 1);
            }
        });
    };
    along(values, rows, height, width, 1, width, r);
    along(rows, values, width, height, width, 1, r);
    return values;
}

} // namespace

double Accumulator::relative_mse() const
{
    if (paths < 2) return 0;
    std::vector<vec3> means(pixels.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 4096), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) means[i] = vec3(mean(pixels[i]));
    });
    constexpr int kReach = 2;
    means = window_means(std::move(means), width, height, kReach);
    auto const sum_of = [&](tbb::blocked_range<std::size_t> const& range, double sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            dvec3 const m(means[i]), v = variance_of_mean(pixels[i]) / (m * m + 0.01);
            sum += v.x + v.y + v.z;
        }
        return sum;
    };
    double const sum = tbb::parallel_deterministic_reduce(tbb::blocked_range<std::size_t>(0, pixels.size(), 4096),
                                                          0.0, sum_of, std::plus<>());
    return sum / (3.0 * double(pixels.size()));
}

namespace {

/// Pointers to the layers of a picture; null = the picture lacks that layer.
struct Targets {
    float *color, *parts[3], *alpha, *variance, *albedo, *normal, *depth, *position;

    explicit Targets(Picture& picture)
    {
        auto const of = [&](char const* name) {
            Layer* const layer = picture.find(name);
            return layer != nullptr ? layer->data.data() : nullptr;
        };
        color = of("color");
        parts[0] = of("L0");
        parts[1] = of("L1");
        parts[2] = of("L2");
        alpha = of("alpha");
        variance = of("variance");
        albedo = of("albedo");
        normal = of("normal");
        depth = of("depth");
        position = of("position");
    }
};

/// Writes pixel i. Surface layers are averages over the paths that hit a surface, and 0 if none did.
void put_pixel(Accumulator const& a, World const& world, PixelSums const& p, std::size_t i, Targets const& to)
{
    double const n = double(a.paths);
    auto const put = [i](float* layer, dvec3 v) {
        for (int c = 0; c < 3; ++c) layer[3 * i + std::size_t(c)] = float(v[c]);
    };
    bool const hit = p.hits > 0;
    put(to.color, (p.radiance[0] + p.radiance[1] + p.radiance[2]) / n);
    if (to.alpha != nullptr) to.alpha[i] = float(p.hits / n);
    to.depth[i] = hit ? float(p.depth / p.hits) : 0.0f;
    if (to.variance == nullptr) return;
    for (std::size_t k = 0; k < 3; ++k) put(to.parts[k], p.radiance[k] / n);
    put(to.variance, a.variance_of_mean(p));
    double const length = glm::length(p.normal);
    put(to.albedo, hit ? p.albedo / p.hits : dvec3{0});
    put(to.normal, hit && length > 0 ? p.normal / length : dvec3{0});
    put(to.position, hit ? p.position / p.hits + world.origin : dvec3{0});
}

} // namespace

Picture Accumulator::picture(World const& world, PictureLayers layers) const
{
    Picture out;
    out.width = width;
    out.height = height;
    auto const add = [&](char const* name, int channels) { out.layers.push_back({name, channels, {}}); };
    add("color", 3);
    bool const all = layers == PictureLayers::all;
    if (all)
        for (char const* const name : {"L0", "L1", "L2"}) add(name, 3);
    if (world.scene->background.kind == BackgroundKind::transparent) add("alpha", 1);
    if (all)
        for (char const* const name : {"variance", "albedo", "normal"}) add(name, 3);
    add("depth", 1);
    if (all) add("position", 3);
    tbb::parallel_for(std::size_t(0), out.layers.size(), [&](std::size_t k) { // first touch of new memory
        Layer& layer = out.layers[k];
        layer.data.resize(out.pixels() * std::size_t(layer.channels));
    });
    if (paths == 0) return out;
    Targets const to(out);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 4096), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) put_pixel(*this, world, pixels[i], i, to);
    });
    return out;
}

void Accumulator::put(World const& world, std::span<std::uint32_t const> at, std::span<PixelSums const> sums,
                      Picture& picture) const
{
    Targets const to(picture);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, at.size(), 4096), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) put_pixel(*this, world, sums[i], at[i], to);
    });
}

namespace {

struct CheckpointHeader {
    char magic[8] = {'L', 'W', 'S', 'T', 'A', 'T', 'E', '2'};
    std::uint64_t fingerprint = 0;
    std::int32_t width = 0, height = 0;
    std::uint32_t paths = 0, pixel_bytes = sizeof(PixelSums);
    PathCounts counts;
    double seconds = 0;
};
static_assert(std::is_trivially_copyable_v<CheckpointHeader> && std::is_trivially_copyable_v<PixelSums>);

} // namespace

void save_checkpoint(std::filesystem::path const& file, Accumulator const& a, std::uint64_t fingerprint)
{
    CheckpointHeader header;
    header.fingerprint = fingerprint;
    header.width = a.width;
    header.height = a.height;
    header.paths = a.paths;
    header.counts = a.counts;
    header.seconds = a.seconds;
    write_by_rename(file, [&](std::filesystem::path const& temporary) {
        std::ofstream out(temporary, std::ios::binary);
        out.exceptions(std::ios::failbit | std::ios::badbit);
        out.write(reinterpret_cast<char const*>(&header), sizeof header);
        out.write(reinterpret_cast<char const*>(a.pixels.data()),
                  std::streamsize(a.pixels.size() * sizeof(PixelSums)));
        out.flush();
    });
}

bool load_checkpoint(std::filesystem::path const& file, Accumulator& a, std::uint64_t fingerprint)
{
    if (file.empty() || !std::filesystem::exists(file)) return false;
    auto const bytes = read_bytes(file);
    CheckpointHeader header, expected;
    if (bytes.size() < sizeof header || std::memcmp(bytes.data(), expected.magic, sizeof expected.magic) != 0)
        throw InputError("'" + file.string() + "' is not a checkpoint", "it does not start like one",
                         "delete it to start afresh");
    std::memcpy(&header, bytes.data(), sizeof header);
    if (header.fingerprint != fingerprint || header.width != a.width || header.height != a.height)
        throw InputError("'" + file.string() + "' belongs to another render",
                         "scene, camera or settings differ from when it was written",
                         "delete it or drop --resume to start afresh");
    if (header.pixel_bytes != sizeof(PixelSums) ||
        bytes.size() != sizeof header + a.pixels.size() * sizeof(PixelSums))
        throw InputError("'" + file.string() + "' is damaged", "its size does not fit its header",
                         "delete it to start afresh");
    std::memcpy(a.pixels.data(), bytes.data() + sizeof header, a.pixels.size() * sizeof(PixelSums));
    a.paths = header.paths;
    a.counts = header.counts;
    a.seconds = header.seconds;
    return true;
}

} // namespace gi
