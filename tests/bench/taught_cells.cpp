// Irradiance of cells of a radiance cache, taught by exact rays or by ray bundles: along an axis, neighbouring layers of a hit buffer exchange the
// light of their cells; as layers lie as densely as their projected area, the mean of what a cell meets over random axes is its irradiance over pi,
// without weights. All threads.
//   bench_taught_cells [--size WxH] [SCENE...]
//       default: 320x200; atrium, cornell
//
// Cells are those that paths meet after one scattering, as wide as a texel of a 256 x 256 grid over the window around the camera. The light that they
// exchange is direct light, known to every tool beforehand; sky and lamps are left to light samples. Bundles pay for their structures; a BVH is there already.
// relMSE: of a cell's mean, weighted by how often paths meet it; against 2,048 rays from points where they do, in cells of which there are 4,000.
// Rays are given to cells in proportion to the square root of that weight, which is the best for this error.

#include "gi/core/rng.h"
#include "gi/hit_buffers/hit_buffer.h"
#include "gi/hit_buffers/windows.h"
#include "gi/raster/cut_outs.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/ray_path.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fmt/format.h>
#include <functional>
#include <mutex>
#include <string>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <vector>

namespace {

using namespace gi;
using Clock = std::chrono::steady_clock;

struct Options {
    int width = 320, height = 200;
    std::vector<std::string> scenes;
};

/// A point on the side of a triangle to which `normal` points.
struct Place {
    vec3 position, normal;
    std::uint32_t triangle;
};

/// Open addressing; keys are added by one thread, and found by any.
class Table {
public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    std::uint32_t find(std::uint64_t key) const
    {
        for (std::size_t at = key & mask_;; at = (at + 1) & mask_) {
            if (slots_[at].key == key) return slots_[at].index;
            if (slots_[at].key == 0) return kNone;
        }
    }
    /// @return false if it is there already
    bool add(std::uint64_t key, std::uint32_t index)
    {
        if (2 * (used_ + 1) > slots_.size()) grow();
        std::size_t at = key & mask_;
        while (slots_[at].key != 0 && slots_[at].key != key) at = (at + 1) & mask_;
        if (slots_[at].key == key) return false;
        slots_[at] = {key, index};
        ++used_;
        return true;
    }

private:
    struct Slot {
        std::uint64_t key = 0;
        std::uint32_t index = 0;
    };
    void grow()
    {
        std::vector<Slot> const old = std::move(slots_);
        slots_.assign(2 * old.size(), {});
        mask_ = slots_.size() - 1;
        used_ = 0;
        for (Slot const& s : old)
            if (s.key != 0) add(s.key, s.index);
    }
    std::vector<Slot> slots_ = std::vector<Slot>(1 << 16);
    std::size_t mask_ = (1 << 16) - 1, used_ = 0;
};

/// What tools have found of the needed cells.
struct Taught {
    explicit Taught(std::size_t n) : sum(n, 0), weight(n, 0) {}
    std::vector<double> sum;
    std::vector<float> weight;
};

class Cells {
public:
    Cells(World const& world, Options const& o)
        : world_(world),
          seen_(view(world)),
          cut_outs_(world),
          exact_(world, plan_scene(world).alpha_tests, 0),
          soup_(make_soup(world))
    {
        SlhbSettings settings;
        settings.resolution = 256;
        Windows windows(settings);
        CameraRays const camera = camera_rays(world.cameras.at(0), o.width, o.height, world.origin);
        windows.follow(world.bounds, soup_, {&camera, 1});
        window_ = windows.boxes().empty() ? world.bounds : windows.boxes().back();
        width_ = make_grid(window_, vec3{0, 1, 0}, 256, vec2{0.5f}, 0).texel;
        find_requests(camera, o);
        find_truth();
        std::vector<std::pair<std::uint64_t, Place>> met; // light of all that bundles and rays will meet
        for (std::uint32_t k = 0; k < 96; ++k) bundle(1000 + k, 256, nullptr, &met);
        enter(met);
        met.clear();
        for (std::uint32_t k = 0; k < 16; ++k) rays_of(allotted_, 2000 + k, false, nullptr, &met);
        enter(met);
    }
    std::size_t needed() const { return needed_.size(); }
    std::size_t all() const { return light_.size(); }
    float width() const { return width_; }
    /// Rays that it takes to reach all cells once.
    std::size_t allotted() const { return allotted_.size(); }

    /// One ray for each cell that is allotted one. @return rays
    std::size_t by_rays(std::uint32_t round, bool along_axis, Taught& to)
    {
        return rays_of(allotted_, round, along_axis, &to, nullptr);
    }
    /// Eight axes. @return exchanges
    std::size_t by_bundles(std::uint32_t round, std::uint32_t texels, std::vector<Taught>& of_threads)
    {
        std::atomic<std::size_t> n = 0;
        tbb::parallel_for(std::uint32_t(0), std::uint32_t(of_threads.size()), [&](std::uint32_t k) {
            n += bundle(round * std::uint32_t(of_threads.size()) + k, texels, &of_threads[k], nullptr);
        });
        return n;
    }
    double relmse(Taught const& found) const
    {
        double error = 0, weights = 0;
        for (Truth const& t : truth_) {
            double const w = double(needed_[t.cell].points.size());
            double const has = found.weight[t.cell] > 0 ? found.sum[t.cell] / double(found.weight[t.cell]) : 0,
                         off = has - t.light;
            error += w * off * off / (t.light * t.light + 0.01 * mean_ * mean_);
            weights += w;
        }
        return error / weights;
    }
    double ratio(Taught const& found) const
    {
        double has = 0, wants = 0;
        for (Truth const& t : truth_) {
            double const w = double(needed_[t.cell].points.size());
            has += w * (found.weight[t.cell] > 0 ? found.sum[t.cell] / double(found.weight[t.cell]) : 0);
            wants += w * t.light;
        }
        return has / wants;
    }
    std::size_t missed() const { return missed_; }

private:
    struct Needed {
        std::vector<Place> points;
    };
    struct Truth {
        std::uint32_t cell;
        double light;
    };

    /// Never 0.
    std::uint64_t key_of(Place const& p) const
    {
        vec3 const beside = glm::max(glm::max(window_.low - p.position, p.position - window_.high), vec3{0});
        float const far = max_component(beside) / max_component(window_.high - window_.low);
        int const level = far > 0 ? int(std::ceil(std::log2(1 + 4 * far))) : 0;
        vec3 const at = glm::floor(p.position / (width_ * std::exp2(float(level))) + vec3{0.37f, 0.61f, 0.23f});
        vec3 const n = glm::abs(p.normal);
        int const axis = n.x > n.y ? (n.x > n.z ? 0 : 2) : (n.y > n.z ? 1 : 2);
        std::uint64_t const side = std::uint64_t(2 * axis + (p.normal[axis] < 0 ? 1 : 0) + 8 * level);
        auto const word = [](float v) { return std::uint64_t(std::uint32_t(std::int32_t(v))); };
        return (mix_bits(word(at.x) | word(at.y) << 32) ^ mix_bits(word(at.z) | side << 32)) | 1;
    }
    /// Adds cells with their light.
    void enter(std::vector<std::pair<std::uint64_t, Place>> const& met)
    {
        std::vector<Place> fresh;
        for (auto const& [key, place] : met)
            if (table_.add(key, std::uint32_t(light_.size() + fresh.size()))) fresh.push_back(place);
        std::size_t const first = light_.size();
        light_.resize(first + fresh.size());
        slot_.resize(light_.size(), Table::kNone);
        tbb::parallel_for(std::size_t(0), fresh.size(),
                          [&](std::size_t k) { light_[first + k] = light_of(fresh[k], first + k); });
    }
    /// Outgoing, as of a matt surface: of what 16 light samples bring.
    float light_of(Place const& p, std::size_t seed) const
    {
        constexpr int kSamples = 16;
        Surface const& s = world_.surfaces[p.triangle];
        ShadingPoint const at = shading_point(seen_, p.triangle, barycentric_at(s, p.position), -p.normal);
        vec3 sum{0};
        Pcg32 rng(seed, 3);
        std::vector<RayQuery> rays;
        std::vector<vec3> lights, left;
        for (int k = 0; k < kSamples && !world_.light_select.empty(); ++k) {
            LightChoice const choice = choose_light(seen_, (k + rng.uniform_double()) / kSamples);
            LightSample const l = sample_light(seen_, choice, p.position, rng.uniform2());
            float const cosine = glm::dot(l.direction, p.normal);
            if (!(l.pdf > 0) || !(cosine > 0)) continue;
            rays.push_back(shadow_ray(p.position, p.normal, s.clearance, l));
            lights.push_back(l.radiance * (cosine / l.pdf / float(kSamples)));
        }
        left.resize(rays.size());
        exact_.transmittance(rays, left);
        for (std::size_t k = 0; k < rays.size(); ++k) sum += lights[k] * left[k];
        return luminance(albedo(at.bsdf) * sum * kInvPi);
    }
    Place place_of(Hit const& hit, vec3 direction) const
    {
        Surface const& s = world_.surfaces[hit.triangle];
        vec3 n = glm::normalize(glm::cross(s.edge1, s.edge2));
        if (glm::dot(n, direction) > 0) n = -n;
        return {s.corner + hit.barycentric.x * s.edge1 + hit.barycentric.y * s.edge2, n, hit.triangle};
    }
    Ray leave(Place const& p, vec3 direction) const
    {
        return {p.position + world_.surfaces[p.triangle].clearance * p.normal, direction};
    }

    void find_requests(CameraRays const& camera, Options const& o)
    {
        std::vector<RayQuery> rays;
        for (int y = 0; y < o.height; ++y)
            for (int x = 0; x < o.width; ++x) rays.push_back({camera.through({float(x) + 0.5f, float(y) + 0.5f})});
        std::vector<Hit> hits(rays.size());
        exact_.nearest(rays, hits);
        std::vector<Place> first;
        for (std::size_t k = 0; k < hits.size(); ++k)
            if (hits[k].triangle != kNoTriangle) first.push_back(place_of(hits[k], rays[k].ray.direction));
        Pcg32 rng(1, 1);
        Table index;
        std::vector<std::pair<std::uint64_t, Place>> met;
        for (int round = 0; round < 8; ++round) {
            rays.clear();
            for (Place const& p : first)
                rays.push_back(
                    {leave(p, Frame::about(p.normal).to_world(square_to_cosine_hemisphere(rng.uniform2())))});
            hits.resize(rays.size());
            exact_.nearest(rays, hits);
            for (std::size_t k = 0; k < hits.size(); ++k) {
                if (hits[k].triangle == kNoTriangle) continue;
                Place const p = place_of(hits[k], rays[k].ray.direction);
                std::uint64_t const key = key_of(p);
                if (index.add(key, std::uint32_t(needed_.size()))) {
                    needed_.emplace_back();
                    met.emplace_back(key, p);
                }
                needed_[index.find(key)].points.push_back(p);
            }
        }
        enter(met); // in the same order, so that cell k of those needed is k of all
        for (std::uint32_t k = 0; k < needed_.size(); ++k) {
            slot_[k] = k;
            for (float n = 0; n < std::sqrt(float(needed_[k].points.size())); ++n) allotted_.push_back(k);
        }
    }
    /// One ray from each of these cells.
    std::size_t rays_of(std::vector<std::uint32_t> const& cells, std::uint32_t round, bool along_axis, Taught* to,
                        std::vector<std::pair<std::uint64_t, Place>>* met)
    {
        vec3 const axis = axis_of(round);
        constexpr std::size_t kPart = 2048;
        std::mutex lock;
        // A cell's rays are neighbours in the list: parts that would share one begin behind it.
        tbb::parallel_for(std::size_t(0), (cells.size() + kPart - 1) / kPart, [&](std::size_t part) {
            thread_local std::vector<RayQuery> rays;
            thread_local std::vector<Hit> hits;
            thread_local std::vector<float> weights;
            std::size_t first = part * kPart, last = std::min(cells.size(), first + kPart);
            while (first > 0 && first < last && cells[first] == cells[first - 1]) ++first;
            while (last < cells.size() && cells[last] == cells[last - 1]) ++last;
            if (first >= last) return;
            rays.clear();
            weights.clear();
            Pcg32 rng(round, part);
            for (std::size_t k = first; k < last; ++k) {
                std::vector<Place> const& points = needed_[cells[k]].points;
                Place const& p = points[rng.next() % points.size()];
                float const cosine = glm::dot(p.normal, axis);
                vec3 const direction =
                    !along_axis  ? Frame::about(p.normal).to_world(square_to_cosine_hemisphere(rng.uniform2()))
                    : cosine > 0 ? axis
                                 : -axis;
                rays.push_back({leave(p, direction)});
                weights.push_back(along_axis ? 2 * std::abs(cosine) : 1);
            }
            hits.resize(rays.size());
            exact_.nearest(rays, hits);
            for (std::size_t k = 0; k < rays.size(); ++k) {
                vec3 const direction = rays[k].ray.direction;
                float light = 0;
                if (hits[k].triangle != kNoTriangle) {
                    Place const p = place_of(hits[k], direction);
                    std::uint64_t const key = key_of(p);
                    std::uint32_t const cell = table_.find(key);
                    if (cell != Table::kNone) {
                        light = light_[cell];
                    } else if (met != nullptr) {
                        std::scoped_lock const held(lock);
                        met->emplace_back(key, p);
                    } else {
                        ++missed_;
                    }
                }
                if (to == nullptr) continue;
                to->sum[cells[first + k]] += double(weights[k] * light);
                to->weight[cells[first + k]] += 1;
            }
        });
        return cells.size();
    }
    static vec3 axis_of(std::uint32_t k)
    {
        float const z = std::fmod(0.5f + float(k % 100000) * 0.7548777f, 1.0f),
                    phi = 2 * kPi * std::fmod(float(k % 100000) * 0.5698403f, 1.0f),
                    r = std::sqrt(std::max(0.0f, 1 - z * z));
        return {r * std::cos(phi), r * std::sin(phi), z};
    }
    /// All layers along one axis give their light to the next. @return exchanges
    std::size_t bundle(std::uint32_t k, std::uint32_t texels, Taught* to,
                       std::vector<std::pair<std::uint64_t, Place>>* met)
    {
        thread_local HitBuffer buffer;
        Pcg32 rng(k, 9);
        vec3 const axis = axis_of(k);
        RasterGrid const grid =
            make_window(window_, world_.bounds, axis, texels, rng.uniform2(), 2 * kPi * rng.uniform());
        {
            BorrowedFragments fragments;
            rasterize(soup_, 0, soup_.count, grid, MacroPath::edge_table, *fragments);
            cut_outs_.remove(*fragments, grid, 0);
            fill_hit_buffer(*fragments, grid, 0, buffer);
        }
        std::size_t exchanges = 0;
        struct Side {
            std::uint32_t cell;
            float light;
        };
        auto const side_of = [&](HitLayer const& layer, std::uint32_t x, std::uint32_t y, float towards) -> Side {
            std::uint32_t const triangle = layer.primitive & kPrimitiveMask;
            vec3 const n = shading_detail::triangle_normal(world_.surfaces[triangle]);
            bool const up = (layer.primitive & kAlongAxis) != 0;
            Place const p{grid.point(x, y, layer.depth), up == (towards > 0) ? n : -n, triangle};
            std::uint64_t const key = key_of(p);
            std::uint32_t const cell = table_.find(key);
            if (cell != Table::kNone) return {slot_[cell], light_[cell]};
            if (met != nullptr)
                met->emplace_back(key, p);
            else
                ++missed_;
            return {Table::kNone, 0};
        };
        auto const give = [&](std::uint32_t cell, float light) {
            ++exchanges;
            if (cell == Table::kNone || to == nullptr) return;
            to->sum[cell] += double(light);
            to->weight[cell] += 1;
        };
        for (std::uint32_t y = 0, t = 0; y < grid.height; ++y)
            for (std::uint32_t x = 0; x < grid.width; ++x, ++t) {
                Side last{Table::kNone, 0};
                for (std::uint32_t l = buffer.offset[t]; l < buffer.offset[t + 1]; ++l) {
                    Side const faces = side_of(buffer.layers[l], x, y, -1);
                    give(faces.cell, last.light);
                    give(last.cell, faces.light);
                    last = side_of(buffer.layers[l], x, y, 1);
                }
                give(last.cell, 0);
            }
        return exchanges;
    }
    void find_truth()
    {
        constexpr std::size_t kMost = 4000;
        constexpr int kRays = 2048;
        std::vector<std::uint32_t> chosen(needed_.size());
        for (std::uint32_t k = 0; k < chosen.size(); ++k) chosen[k] = k;
        Pcg32 rng(5, 5);
        for (std::size_t k = 0; k + 1 < chosen.size(); ++k)
            std::swap(chosen[k], chosen[k + rng.next() % (chosen.size() - k)]);
        chosen.resize(std::min(chosen.size(), kMost));
        std::ranges::sort(chosen);
        std::vector<std::pair<std::uint64_t, Place>> met;
        for (std::uint32_t n = 0; n < kRays; ++n) {
            rays_of(chosen, 5000 + n, false, nullptr, &met);
            if (n % 64 < 63) continue;
            enter(met);
            met.clear();
        }
        Taught found(needed_.size());
        for (std::uint32_t n = 0; n < kRays; ++n) rays_of(chosen, 5000 + n, false, &found, nullptr);
        double sum = 0, weights = 0;
        for (std::uint32_t const cell : chosen) {
            truth_.push_back({cell, found.sum[cell] / double(found.weight[cell])});
            sum += double(needed_[cell].points.size()) * truth_.back().light;
            weights += double(needed_[cell].points.size());
        }
        mean_ = sum / weights;
        missed_ = 0;
    }

    World const& world_;
    WorldView seen_;
    CutOuts cut_outs_;
    ExactVisibility exact_;
    TriangleSoup soup_;
    Bounds window_;
    float width_ = 0;
    Table table_;
    std::vector<float> light_;        ///< of all cells: outgoing luminance
    std::vector<std::uint32_t> slot_; ///< of all cells: which of the needed ones it is
    std::vector<Needed> needed_;
    std::vector<std::uint32_t> allotted_;
    std::vector<Truth> truth_;
    double mean_ = 0;
    std::atomic<std::size_t> missed_ = 0;
};

void run(Options const& o, std::string const& name)
{
    Report report;
    World const world = build_world(std::make_shared<Scene const>(load_scene(name, report)), std::nullopt, report);
    Cells cells(world, o);
    fmt::print("{}, {} triangles, cells of {:.3g} m, {} needed of {}\n  {:<28}{:>10}{:>14}{:>10}{:>10}{:>12}\n",
               name, world.triangles.size(), cells.width(), cells.needed(), cells.all(), "", "ms", "M rays per s",
               "relMSE", "mean", "1/(error s)");
    auto const measure = [&](char const* tool, std::size_t parts,
                             std::function<std::size_t(std::uint32_t, std::vector<Taught>&)> const& work) {
        std::vector<Taught> found(parts, Taught(cells.needed()));
        auto const begun = Clock::now();
        auto const seconds = [&] { return std::chrono::duration<double>(Clock::now() - begun).count(); };
        std::uint32_t round = 0;
        std::size_t rays = 0;
        double judging = 0;
        for (double const until : {0.1, 0.4, 1.6}) {
            while (seconds() - judging < until) rays += work(round++, found);
            double const took = seconds() - judging;
            Taught all(cells.needed());
            for (Taught const& t : found)
                for (std::size_t k = 0; k < t.sum.size(); ++k) {
                    all.sum[k] += t.sum[k];
                    all.weight[k] += t.weight[k];
                }
            double const error = cells.relmse(all);
            fmt::print("  {:<28}{:>10.0f}{:>14.2f}{:>10.4f}{:>10.4f}{:>12.2f}\n", tool, 1000 * took,
                       double(rays) * 1e-6 / took, error, cells.ratio(all), 1 / error / took);
            judging = seconds() - took;
        }
        std::fflush(stdout);
    };
    measure("rays, own directions", 1,
            [&](std::uint32_t round, std::vector<Taught>& to) { return cells.by_rays(round, false, to[0]); });
    measure("rays along shared axes", 1,
            [&](std::uint32_t round, std::vector<Taught>& to) { return cells.by_rays(round, true, to[0]); });
    for (std::uint32_t const texels : {128u, 256u, 512u})
        measure(fmt::format("bundles, {}", texels).c_str(), 8,
                [&](std::uint32_t round, std::vector<Taught>& to) { return cells.by_bundles(round, texels, to); });
    fmt::print("  exchanges with cells of unknown light: {}\n", cells.missed());
}

} // namespace

int main(int argc, char** argv)
{
    Options o;
    for (int k = 1; k < argc; ++k) {
        std::string const word = argv[k];
        if (word == "--size" && k + 1 < argc)
            std::sscanf(argv[++k], "%dx%d", &o.width, &o.height);
        else
            o.scenes.push_back(word);
    }
    if (o.scenes.empty()) o.scenes = {"atrium", "cornell"};
    for (std::string const& name : o.scenes) run(o, name);
}
