#include "gi/render/accumulator.h"

#include "gi/render/add_samples.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <limits>
#include <memory>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace gi {

using means_detail::root;

void PixelMeans::add(PathSample const& s, std::uint32_t paths) { add_path(*this, s, paths); }

void PixelMeans::add(PixelMeans const& s, std::uint32_t mine, std::uint32_t theirs)
{
    auto const join = [](auto& mean, auto const& other, double share) {
        mean = std::remove_reference_t<decltype(mean)>(dvec3(mean) + (dvec3(other) - dvec3(mean)) * share);
    };
    double const n = double(mine) + double(theirs), share = double(theirs) / n;
    dvec3 const apart = s.color() - color(), a(deviation), b(s.deviation);
    for (int c = 0; c < 3; ++c)
        deviation[c] = float(root(a[c] * a[c] + b[c] * b[c] + apart[c] * apart[c] * double(mine) * share));
    for (std::size_t i = 0; i < 3; ++i) join(radiance[i], s.radiance[i], share);
    if (s.hits == 0) return;
    double const of_hits = double(s.hits) / (double(hits) + double(s.hits));
    join(albedo, s.albedo, of_hits);
    join(normal, s.normal, of_hits);
    join(position, s.position, of_hits);
    depth = float(depth + (double(s.depth) - depth) * of_hits);
    hits += s.hits;
}

PictureShape picture_shape(World const& world, PictureLayers layers)
{
    return {world.origin, world.scene->background.kind == BackgroundKind::transparent, layers};
}

void Accumulator::add(Accumulator const& other)
{
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, other.paths > 0 ? pixels.size() : 0, 4096),
                      [&](auto const& range) {
                          for (std::size_t i = range.begin(); i != range.end(); ++i)
                              if (paths == 0)
                                  pixels[i] = other.pixels[i];
                              else
                                  pixels[i].add(other.pixels[i], paths, other.paths);
                      });
    paths += other.paths;
    counts += other.counts;
    seconds = std::max(seconds, other.seconds); // the two were rendered in parallel
}

dvec3 Accumulator::variance_of_mean(PixelMeans const& p, std::uint32_t paths)
{
    if (paths < 2) return dvec3{0};
    dvec3 const d(p.deviation);
    return d * d / (double(paths) * (double(paths) - 1));
}

namespace {

/// Means over windows of (2 reach + 1)^2 pixels, fewer at the picture's border, of one row after the other.
class WindowMeans {
public:
    WindowMeans(Accumulator const& sums, int reach) : sums_(sums), reach_(reach), rows_(std::size_t(2 * reach + 1))
    {
    }

    /// @param row  the next one after the row of the last call, or any
    std::vector<vec3> const& of_row(int row)
    {
        int const first = std::max(0, row - reach_), last = std::min(sums_.height - 1, row + reach_);
        for (int y = first; y <= last; ++y)
            if (Row& kept = rows_[std::size_t(y % int(rows_.size()))]; kept.y != y) read(kept, y);
        means_.assign(std::size_t(sums_.width), vec3{0});
        for (int y = first; y <= last; ++y)
            for (std::size_t x = 0; x < means_.size(); ++x)
                means_[x] += rows_[std::size_t(y % int(rows_.size()))].means[x];
        for (vec3& m : means_) m /= float(last - first + 1);
        return means_;
    }

private:
    struct Row {
        int y = -1;
        std::vector<vec3> means; ///< over 2 reach + 1 pixels of the row
    };
    void read(Row& row, int y)
    {
        row.y = y;
        row.means.resize(std::size_t(sums_.width));
        PixelMeans const* const pixels = &sums_.pixels[std::size_t(y) * std::size_t(sums_.width)];
        for (int x = 0; x < sums_.width; ++x) {
            int const first = std::max(0, x - reach_), last = std::min(sums_.width - 1, x + reach_);
            vec3 sum{0};
            for (int k = first; k <= last; ++k) sum += vec3(pixels[k].color());
            row.means[std::size_t(x)] = sum / float(last - first + 1);
        }
    }

    Accumulator const& sums_;
    int reach_;
    std::vector<Row> rows_; ///< row y in element y mod their number
    std::vector<vec3> means_;
};

} // namespace

double Accumulator::relative_mse() const
{
    constexpr int kReach = 2, kRows = 16;
    if (paths < 2) return 0;
    auto const variance_at = [&](std::size_t p) { return variance_of_mean(pixels[p], paths_of(p)); };
    auto const sum_of = [&](tbb::blocked_range<int> const& range, double sum) {
        WindowMeans windows(*this, kReach);
        for (int y = range.begin(); y != range.end(); ++y) {
            std::vector<vec3> const& means = windows.of_row(y);
            for (std::size_t x = 0; x < means.size(); ++x) {
                dvec3 const m(means[x]), v = variance_at(std::size_t(y) * means.size() + x) / (m * m + 0.01);
                sum += v.x + v.y + v.z;
            }
        }
        return sum;
    };
    double const sum =
        tbb::parallel_deterministic_reduce(tbb::blocked_range<int>(0, height, kRows), 0.0, sum_of, std::plus<>());
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
void put_pixel(std::uint32_t paths, dvec3 origin, PixelMeans const& p, std::size_t i, Targets const& to)
{
    auto const put = [i](float* layer, dvec3 v) {
        for (int c = 0; c < 3; ++c) layer[3 * i + std::size_t(c)] = float(v[c]);
    };
    bool const hit = p.hits > 0;
    put(to.color, p.color());
    if (to.alpha != nullptr) to.alpha[i] = float(double(p.hits) / double(std::max(1u, paths)));
    to.depth[i] = hit ? p.depth : 0.0f;
    if (to.variance == nullptr) return;
    for (std::size_t k = 0; k < 3; ++k) put(to.parts[k], p.radiance[k]);
    put(to.variance, Accumulator::variance_of_mean(p, paths));
    double const length = glm::length(dvec3(p.normal));
    put(to.albedo, hit ? dvec3(p.albedo) : dvec3{0});
    put(to.normal, hit && length > 0 ? dvec3(p.normal) / length : dvec3{0});
    put(to.position, hit ? dvec3(p.position) + origin : dvec3{0});
}

} // namespace

Picture Accumulator::picture(World const& world, PictureLayers layers) const
{
    return rows(picture_shape(world, layers), 0, height);
}

Picture Accumulator::rows(PictureShape const& shape, int first, int count) const
{
    Picture out;
    out.width = width;
    out.height = count;
    auto const add = [&](char const* name, int channels) { out.layers.push_back({name, channels, {}}); };
    add("color", 3);
    bool const all = shape.layers == PictureLayers::all;
    if (all)
        for (char const* const name : {"L0", "L1", "L2"}) add(name, 3);
    if (shape.has_alpha) add("alpha", 1);
    if (all)
        for (char const* const name : {"variance", "albedo", "normal"}) add(name, 3);
    add("depth", 1);
    if (all) add("position", 3);
    tbb::parallel_for(std::size_t(0), out.layers.size(), [&](std::size_t k) { // first touch of new memory
        Layer& layer = out.layers[k];
        layer.data.resize(out.pixels() * std::size_t(layer.channels));
    });
    if (!has_paths()) return out;
    Targets const to(out);
    std::size_t const from = std::size_t(first) * std::size_t(width);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, out.pixels(), 4096), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
            put_pixel(paths_of(from + i), shape.origin, pixels[from + i], i, to);
    });
    return out;
}

void Accumulator::put(World const& world, std::span<std::uint32_t const> at, std::span<PixelMeans const> means,
                      Picture& picture) const
{
    Targets const to(picture);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, at.size(), 4096), [&](auto const& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i)
            put_pixel(paths, world.origin, means[i], at[i], to);
    });
}

PictureRows picture_rows(std::shared_ptr<Accumulator const> const& sums, PictureShape const& shape)
{
    return {sums->width, sums->height,
            [sums, shape](int first, int count) { return sums->rows(shape, first, count); }};
}

} // namespace gi
