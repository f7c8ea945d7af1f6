// How layers of a column may lie in memory: nanoseconds for the next layer after one's own, of random columns along random axes, as paths ask. One thread.
// Columns are asked in groups whose memory is prefetched step by step, as look-ups do (gi/hit_buffers/query_columns.h).
//   bench_column_layout [--directions N] [--hit-buffer N] [SCENE...]
//       default: 320 directions, 128 texels; atrium, cornell
//
// now: an offset per texel, then layers of 8 bytes. inline N: N bytes per texel with the number of layers and the first of them, further ones elsewhere.
// packed: layers of 4 bytes (12 bits of depth). lines: cache lines of 64 bytes that a question touches, on average.

#include "gi/core/rng.h"
#include "gi/hit_buffers/axis_pool.h"
#include "gi/hit_buffers/directions/directions.h"
#include "gi/hit_buffers/hit_buffer.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <tbb/parallel_for.h>
#include <vector>

namespace {

using namespace gi;

struct Options {
    int directions = 320, texels = 128;
    std::vector<std::string> scenes;
};

struct Question {
    std::uint32_t texel; ///< of all axes
    std::uint32_t own;   ///< primitive of the layer
    bool up;
};

struct Now {
    std::vector<std::uint32_t> offset;
    std::vector<HitLayer> layers;

    void prefetch_first(Question const& q) const { __builtin_prefetch(&offset[q.texel]); }
    void prefetch_second(Question const& q) const { __builtin_prefetch(&layers[offset[q.texel]]); }
    std::uint32_t answer(Question const& q) const
    {
        std::uint32_t const first = offset[q.texel], end = offset[q.texel + 1];
        std::uint32_t k = first;
        while (layers[k].primitive != q.own) ++k;
        if (q.up) return k + 1 < end ? layers[k + 1].primitive : kNoLayerHit;
        return k > first ? layers[k - 1].primitive : kNoLayerHit;
    }
    std::size_t bytes() const { return offset.size() * sizeof(offset[0]) + layers.size() * sizeof(HitLayer); }
    double lines(Question const& q) const
    {
        auto const line = [](auto const* p) { return reinterpret_cast<std::uintptr_t>(p) / 64; };
        std::uint32_t k = offset[q.texel];
        std::uint32_t const first = k;
        while (layers[k].primitive != q.own) ++k;
        if (q.up && k + 1 < offset[q.texel + 1]) ++k;
        return 1 + double(line(&offset[q.texel + 1]) != line(&offset[q.texel])) +
               double(line(&layers[k]) - line(&layers[first]) + 1);
    }
};

/// As Now, with layers of 4 bytes: the low bits name the primitive among those of its column.
struct Packed {
    std::vector<std::uint32_t> offset, layers;

    static std::uint32_t pack(std::uint32_t primitive)
    {
        return (primitive & 0x7ffffu) | ((primitive >> 31) << 19);
    }
    void prefetch_first(Question const& q) const { __builtin_prefetch(&offset[q.texel]); }
    void prefetch_second(Question const& q) const { __builtin_prefetch(&layers[offset[q.texel]]); }
    std::uint32_t answer(Question const& q) const
    {
        std::uint32_t const first = offset[q.texel], end = offset[q.texel + 1], own = pack(q.own);
        std::uint32_t k = first;
        while ((layers[k] & 0xfffffu) != own) ++k;
        if (q.up) return k + 1 < end ? layers[k + 1] & 0xfffffu : kNoLayerHit;
        return k > first ? layers[k - 1] & 0xfffffu : kNoLayerHit;
    }
    std::size_t bytes() const { return (offset.size() + layers.size()) * sizeof(offset[0]); }
    double lines(Question const& q) const
    {
        auto const line = [](auto const* p) { return reinterpret_cast<std::uintptr_t>(p) / 64; };
        std::uint32_t k = offset[q.texel];
        std::uint32_t const first = k, own = pack(q.own);
        while ((layers[k] & 0xfffffu) != own) ++k;
        if (q.up && k + 1 < offset[q.texel + 1]) ++k;
        return 1 + double(line(&offset[q.texel + 1]) != line(&offset[q.texel])) +
               double(line(&layers[k]) - line(&layers[first]) + 1);
    }
};

/// A block of `Bytes` per texel: where further layers lie, how many there are, the first ones.
template <class Layer, int Bytes>
struct Inline {
    static constexpr std::uint32_t kFirst = (Bytes - 8) / sizeof(Layer);
    struct alignas(Bytes) Block {
        std::uint32_t further, count;
        Layer layers[kFirst];
    };
    std::vector<Block> blocks;
    std::vector<Layer> further;

    static std::uint32_t name(HitLayer const& l) { return l.primitive; }
    static std::uint32_t name(std::uint32_t l) { return l & 0xfffffu; }
    static std::uint32_t own_name(Question const& q)
    {
        if constexpr (sizeof(Layer) == 4) return Packed::pack(q.own);
        return q.own;
    }
    void prefetch_first(Question const& q) const { __builtin_prefetch(&blocks[q.texel]); }
    void prefetch_second(Question const&) const {}
    std::uint32_t at(Block const& b, std::uint32_t k) const
    {
        return name(k < kFirst ? b.layers[k] : further[b.further + k - kFirst]);
    }
    std::uint32_t answer(Question const& q) const
    {
        Block const& b = blocks[q.texel];
        std::uint32_t const own = own_name(q);
        std::uint32_t k = 0;
        while (at(b, k) != own) ++k;
        if (q.up) return k + 1 < b.count ? at(b, k + 1) : kNoLayerHit;
        return k > 0 ? at(b, k - 1) : kNoLayerHit;
    }
    std::size_t bytes() const { return blocks.size() * sizeof(Block) + further.size() * sizeof(Layer); }
    double lines(Question const& q) const
    {
        Block const& b = blocks[q.texel];
        std::uint32_t const own = own_name(q);
        std::uint32_t k = 0;
        while (at(b, k) != own) ++k;
        if (q.up && k + 1 < b.count) ++k;
        return 1 + (k < kFirst ? 0
                               : double(((b.further + k - kFirst) * sizeof(Layer)) / 64 -
                                        b.further * sizeof(Layer) / 64 + 1));
    }
};

template <class Layout>
void measure(char const* name, Layout const& layout, std::vector<Question> const& questions,
             std::uint64_t& expected)
{
    constexpr std::size_t kGroup = 64;
    double best = 1e9;
    std::uint64_t sum = 0;
    for (int repeat = 0; repeat < 5; ++repeat) {
        sum = 0;
        auto const begun = std::chrono::steady_clock::now();
        for (std::size_t first = 0; first + kGroup <= questions.size(); first += kGroup) {
            for (std::size_t k = first; k < first + kGroup; ++k) layout.prefetch_first(questions[k]);
            for (std::size_t k = first; k < first + kGroup; ++k) layout.prefetch_second(questions[k]);
            for (std::size_t k = first; k < first + kGroup; ++k) {
                std::uint32_t const found = layout.answer(questions[k]);
                sum += found == kNoLayerHit ? 1 : found & 0x7ffffu;
            }
        }
        best = std::min(
            best, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begun).count());
    }
    double lines = 0;
    for (std::size_t k = 0; k < questions.size(); k += 16) lines += layout.lines(questions[k]);
    if (expected == 0) expected = sum;
    fmt::print("  {:<22}{:>10.1f}{:>10.2f}{:>10.0f}{}\n", name, best / double(questions.size()),
               lines / double((questions.size() + 15) / 16), double(layout.bytes()) / (1 << 20),
               sum == expected ? "" : "  OTHER ANSWERS");
    std::fflush(stdout);
}

template <class Layer, int Bytes>
Inline<Layer, Bytes> inline_of(std::vector<std::uint32_t> const& offset, std::vector<Layer> const& layers)
{
    Inline<Layer, Bytes> in;
    in.blocks.resize(offset.size() - 1);
    for (std::size_t t = 0; t + 1 < offset.size(); ++t) {
        auto& b = in.blocks[t];
        b.further = std::uint32_t(in.further.size());
        b.count = offset[t + 1] - offset[t];
        for (std::uint32_t k = 0; k < b.count; ++k) {
            if (k < in.kFirst)
                b.layers[k] = layers[offset[t] + k];
            else
                in.further.push_back(layers[offset[t] + k]);
        }
    }
    return in;
}

void run(Options const& o, std::string const& name)
{
    Report report;
    World const world = build_world(std::make_shared<Scene const>(load_scene(name, report)), std::nullopt, report);
    TriangleSoup const soup = make_soup(world);
    DirectionSet const set = make_directions(fmt::format("icosahedron:{}", o.directions));
    std::vector<HitBuffer> buffers(set.axes.size());
    tbb::parallel_for(std::size_t(0), buffers.size(), [&](std::size_t a) {
        Pcg32 rng(a, 1);
        vec2 const jitter = rng.uniform2();
        buffers[a] = make_hit_buffer(soup, make_grid(world.bounds, vec3(set.axes[a]), std::uint32_t(o.texels),
                                                     jitter, 2 * kPi * rng.uniform()));
    });
    Now now;
    now.offset.push_back(0);
    for (HitBuffer& b : buffers) {
        auto const base = std::uint32_t(now.layers.size());
        for (std::size_t t = 1; t < b.offset.size(); ++t) now.offset.push_back(base + b.offset[t]);
        now.layers.insert(now.layers.end(), b.layers.begin(), b.layers.end());
        b = {};
    }
    if (now.layers.empty()) return;
    Packed packed{now.offset, {}};
    for (HitLayer const& l : now.layers) packed.layers.push_back(Packed::pack(l.primitive));
    // Columns drawn as layers are met, and of columns with two layers of one name, the first.
    Pcg32 rng(3, 3);
    std::vector<Question> questions;
    while (questions.size() < (1u << 21)) {
        auto const layer = std::uint32_t(rng.uniform_double() * double(now.layers.size()));
        auto const texel =
            std::uint32_t(std::upper_bound(now.offset.begin(), now.offset.end(), layer) - now.offset.begin() - 1);
        questions.push_back({texel, now.layers[layer].primitive, (rng.next() & 1) != 0});
    }
    fmt::print("{}, {} triangles, {} axes, {:.1f} layers a texel\n  {:<22}{:>10}{:>10}{:>10}\n", name,
               world.triangles.size(), set.axes.size(), double(now.layers.size()) / double(now.offset.size() - 1),
               "", "ns", "lines", "MiB");
    std::uint64_t expected = 0;
    measure("now", now, questions, expected);
    measure("packed", packed, questions, expected);
    measure("inline 32", inline_of<HitLayer, 32>(now.offset, now.layers), questions, expected);
    measure("inline 64", inline_of<HitLayer, 64>(now.offset, now.layers), questions, expected);
    measure("inline 32, packed", inline_of<std::uint32_t, 32>(now.offset, packed.layers), questions, expected);
    measure("inline 64, packed", inline_of<std::uint32_t, 64>(now.offset, packed.layers), questions, expected);
}

} // namespace

int main(int argc, char** argv)
{
    Options o;
    for (int k = 1; k < argc; ++k) {
        std::string const word = argv[k];
        if (word == "--directions" && k + 1 < argc)
            o.directions = std::atoi(argv[++k]);
        else if (word == "--hit-buffer" && k + 1 < argc)
            o.texels = std::atoi(argv[++k]);
        else
            o.scenes.push_back(word);
    }
    if (o.scenes.empty()) o.scenes = {"atrium", "cornell"};
    for (std::string const& name : o.scenes) run(o, name);
}
