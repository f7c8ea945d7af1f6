#include "gi/transport/accumulator.h"

#include "gi/base/error.h"
#include "gi/base/file.h"

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
    seconds = std::max(seconds, other.seconds); // side by side
}

dvec3 Accumulator::variance_of_mean(PixelSums const& p) const
{
    if (paths < 2) return dvec3{0};
    double const n = double(paths);
    dvec3 const m = mean(p);
    return glm::max(dvec3{0}, (p.color_squared / n - m * m) / (n - 1));
}

double Accumulator::relative_mse() const
{
    if (paths < 2) return 0;
    auto const sum_of = [&](tbb::blocked_range<std::size_t> const& range, double sum) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            dvec3 const m = mean(pixels[i]), v = variance_of_mean(pixels[i]) / (m * m + 0.01);
            sum += v.x + v.y + v.z;
        }
        return sum;
    };
    double const sum = tbb::parallel_deterministic_reduce(tbb::blocked_range<std::size_t>(0, pixels.size(), 4096),
                                                          0.0, sum_of, std::plus<>());
    return sum / (3.0 * double(pixels.size()));
}

Picture Accumulator::picture(World const& world) const
{
    Picture out;
    out.width = width;
    out.height = height;
    auto const layer = [&](char const* name, int channels) { return out.add(name, channels).data.data(); };
    float* const color = layer("color", 3);
    float* const parts[] = {layer("L0", 3), layer("L1", 3), layer("L2", 3)};
    bool const transparent = world.scene->background.kind == BackgroundKind::transparent;
    float* const alpha = transparent ? layer("alpha", 1) : nullptr;
    float *const variance = layer("variance", 3), *const albedo = layer("albedo", 3),
                 *const normal = layer("normal", 3), *const depth = layer("depth", 1),
                 *const position = layer("position", 3);
    if (paths == 0) return out;
    double const n = double(paths);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels.size(), 4096), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            PixelSums const& p = pixels[i];
            auto const put = [i](float* to, dvec3 v) {
                for (int c = 0; c < 3; ++c) to[3 * i + std::size_t(c)] = float(v[c]);
            };
            put(color, (p.radiance[0] + p.radiance[1] + p.radiance[2]) / n);
            for (std::size_t k = 0; k < 3; ++k) put(parts[k], p.radiance[k] / n);
            if (alpha != nullptr) alpha[i] = float(p.hits / n);
            put(variance, variance_of_mean(p));
            // Surface layers average over the paths that met a surface; where none did they are 0.
            if (!(p.hits > 0)) continue;
            double const length = glm::length(p.normal);
            put(albedo, p.albedo / p.hits);
            put(normal, length > 0 ? p.normal / length : dvec3{0});
            depth[i] = float(p.depth / p.hits);
            put(position, p.position / p.hits + world.origin);
        }
    });
    return out;
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
