// What a crowd costs in every frame: ten figures of 10,880 triangles each walk on the spot before the camera, and the first
// surfaces of a picture ask along shared axes how much of the sky they see. Exact rays with a BVH that is refitted, against
// static hit buffers that are kept and to which what moves is added. All threads.
//   bench_crowds [--size WxH] [--figures N] [--frames N] [SCENE...]      default: 1280x800, 10, 8; atrium, cornell
//
// update: refitting, or adding to all axes; queries: all points along all axes; ms a frame, medians of all but the first
// frame. rms: error of the visible share over every 61st pixel, against 2,048 directions each. doubtful: share of the
// look-ups that an exact ray decides; their update has both structures.

#include "gi/core/quantile.h"
#include "gi/hit_buffers/moving_layers.h"
#include "gi/hit_buffers/query_batch.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/motion/moving_world.h"
#include "tests/bench/first_surfaces.h"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <tbb/task_arena.h>

namespace {

using namespace gi;

struct Options {
    int width = 1280, height = 800, figures = 10, frames = 8;
    std::vector<std::string> scenes;
};

/// Where figures stand: on what points upwards before the first camera, an arm's length apart.
std::vector<dvec3> places(World const& world, int figures)
{
    constexpr float kApart = 0.7f, kNear = 1.5f;
    constexpr int kSide = 64;
    ExactVisibility const exact(world, plan_scene(world).alpha_tests, 0);
    vec3 const eye{dvec3(world.cameras.at(0).world_from_camera[3]) - world.origin};
    std::vector<SeenPoint> const seen = first_surfaces(world, exact, world.cameras.at(0), kSide, kSide);
    std::vector<vec3> chosen;
    for (std::size_t k = 0; k < seen.size() && chosen.size() < std::size_t(figures); ++k) {
        SeenPoint const& p = seen[k * 2654435761u % seen.size()]; // scattered over the picture
        if (p.normal.y < 0.9f || glm::length(p.position - eye) < kNear) continue;
        if (std::ranges::any_of(chosen, [&](vec3 c) { return glm::length(c - p.position) < kApart; })) continue;
        chosen.push_back(p.position);
    }
    std::vector<dvec3> all;
    for (vec3 const c : chosen) all.push_back(dvec3(c) + world.origin);
    return all;
}

std::shared_ptr<Scene const> with_crowd(std::string const& name, int figures)
{
    Report report;
    auto scene = std::make_shared<Scene>(load_scene(name, report));
    int turn = 0;
    for (dvec3 const place : places(build_world(scene, std::nullopt, report), figures))
        add_figure(*scene, glm::rotate(glm::translate(dmat4(1), place), 1.7 * turn++, dvec3{0, 1, 0}), 1);
    return scene;
}

class Frames {
public:
    Frames(std::shared_ptr<Scene const> const& scene, Options const& o, int axes, std::uint32_t texels)
        : o_(o),
          axes_(half_sphere_axes(axes)),
          moving_(scene, 0, report_),
          exact_(world(), plan_scene(world()).alpha_tests, 0, world().static_triangles),
          cut_outs_(world()),
          soup_(make_soup(world()))
    {
        std::vector<HitBuffer> buffers(axes_.size());
        tbb::parallel_for(std::size_t(0), axes_.size(), [&](std::size_t a) {
            RasterGrid const grid = make_grid(world().bounds, axes_[a], texels, vec2{0.4f}, 0.3f);
            BorrowedFragments fragments;
            rasterize(soup_, 0, world().static_triangles, grid, MacroPath::edge_table, *fragments);
            cut_outs_.remove(*fragments, grid, 0);
            fill_hit_buffer(*fragments, grid, 0, buffers[a]);
        });
        fill_pool(buffers, pool_);
    }
    World const& world() const { return moving_.world(); }

    void advance(int frame)
    {
        moving_.advance(frame / 30.0);
        refit_ms_ = ms_of([&] { exact_.moved(world()); });
        layers_.moved();
        append_ms_ = ms_of([&] {
            layers_.append({soup_, world().static_triangles, cut_outs_, 0},
                           std::vector<std::uint32_t>(axes_.size(), 0), std::vector<std::uint8_t>(axes_.size(), 1),
                           pool_);
        });
        points_ = first_surfaces(world(), exact_, world().cameras.at(0), o_.width, o_.height);
        truth_ = true_shares(world(), exact_, points_, RayQuery::kFar);
    }
    double refit_ms() const { return refit_ms_; }
    double append_ms() const { return append_ms_; }

    struct Answer {
        double ms = 0, rms = 0, doubtful = 0;
    };
    Answer by_rays() const
    {
        return asked([&](std::vector<float>& share, std::atomic<std::size_t>&) {
            for (vec3 const axis : axes_)
                each_part(points_.size(), [&](std::size_t first, std::size_t end) {
                    std::vector<RayQuery> rays;
                    rays.reserve(end - first);
                    for (std::size_t p = first; p < end; ++p) rays.push_back(ray_along(world(), points_[p], axis));
                    std::vector<std::uint8_t> blocked(rays.size());
                    exact_.occluded(rays, blocked);
                    for (std::size_t p = first; p < end; ++p) add(share, p, axis, blocked[p - first] == 0);
                });
        });
    }
    /// @param confirm  exact rays decide what is doubtful
    Answer by_look_ups(bool confirm) const
    {
        return asked([&](std::vector<float>& share, std::atomic<std::size_t>& doubtful) {
            each_part(points_.size(), [&](std::size_t first, std::size_t end) {
                QueryBatch batch;
                std::vector<RayQuery> rays;
                std::vector<std::size_t> of;
                batch.checked = confirm;
                batch.resize(end - first);
                for (std::size_t a = 0; a < axes_.size(); ++a) {
                    for (std::size_t p = first; p < end; ++p)
                        batch.set(p - first, walk_along(world(), points_[p], axes_[a]), 0);
                    nearest_layers(pool_, a, world().surfaces, batch);
                    rays.clear();
                    of.clear();
                    for (std::size_t p = first; p < end; ++p)
                        if (confirm && batch.doubtful[p - first] != 0) {
                            rays.push_back(ray_along(world(), points_[p], axes_[a]));
                            of.push_back(p);
                        } else {
                            add(share, p, axes_[a], batch.hit[p - first] == kNoLayerHit);
                        }
                    std::vector<std::uint8_t> blocked(rays.size());
                    exact_.occluded(rays, blocked);
                    for (std::size_t k = 0; k < rays.size(); ++k) add(share, of[k], axes_[a], blocked[k] == 0);
                    doubtful += rays.size();
                }
            });
        });
    }

private:
    static double ms_of(std::function<void()> const& work)
    {
        auto const begun = std::chrono::steady_clock::now();
        work();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begun).count();
    }
    Answer asked(std::function<void(std::vector<float>&, std::atomic<std::size_t>&)> const& work) const
    {
        std::vector<float> share(points_.size());
        std::atomic<std::size_t> doubtful = 0;
        double const ms = ms_of([&] { work(share, doubtful); });
        return {ms, rms_error(share, truth_), double(doubtful) / double(points_.size() * axes_.size())};
    }
    void add(std::vector<float>& share, std::size_t p, vec3 axis, bool free) const
    {
        add_axis(share[p], points_[p], axis, int(axes_.size()), free);
    }

    Options const& o_;
    std::vector<vec3> axes_;
    Report report_;
    MovingWorld moving_;
    ExactVisibility exact_;
    CutOuts cut_outs_;
    TriangleSoup soup_;
    AxisPool pool_;
    MovingLayers layers_;
    std::vector<SeenPoint> points_;
    std::vector<float> truth_;
    double refit_ms_ = 0, append_ms_ = 0;
};

void run(Options const& o, std::string const& name)
{
    std::shared_ptr<Scene const> const scene = with_crowd(name, o.figures);
    bool first = true;
    for (auto const& [axes, texels] : {std::pair{16, 256u}, {64, 256u}, {16, 1024u}, {64, 1024u}}) {
        Frames frames(scene, o, axes, texels);
        if (first)
            fmt::print("{}, {} triangles, of which {} move, {} x {} pixels, {} threads\n  "
                       "{:<34}{:>6}{:>8}{:>10}{:>10}{:>10}{:>10}{:>10}\n",
                       name, frames.world().triangles.size(),
                       frames.world().triangles.size() - frames.world().static_triangles, o.width, o.height,
                       tbb::this_task_arena::max_concurrency(), "", "axes", "texels", "update", "queries", "both",
                       "rms", "doubtful");
        first = false;
        struct Tool {
            char const* name;
            std::vector<double> update{}, queries{}, both{}, rms{}, doubtful{};
        };
        std::vector<Tool> tools{{"rays along shared axes"}, {"look-ups"}, {"  and rays where doubtful"}};
        for (int f = 0; f < o.frames; ++f) {
            frames.advance(f);
            auto const note = [&](Tool& t, double update, Frames::Answer const& a) {
                if (f == 0) return;
                t.update.push_back(update);
                t.queries.push_back(a.ms);
                t.both.push_back(update + a.ms);
                t.rms.push_back(a.rms);
                t.doubtful.push_back(a.doubtful);
            };
            note(tools[0], frames.refit_ms(), frames.by_rays());
            note(tools[1], frames.append_ms(), frames.by_look_ups(false));
            note(tools[2], frames.refit_ms() + frames.append_ms(), frames.by_look_ups(true));
        }
        for (Tool const& t : tools)
            fmt::print("  {:<34}{:>6}{:>8}{:>10.1f}{:>10.1f}{:>10.1f}{:>10.4f}{:>10.3f}\n", t.name, axes, texels,
                       quantile(t.update, 0.5), quantile(t.queries, 0.5), quantile(t.both, 0.5),
                       quantile(t.rms, 0.5), quantile(t.doubtful, 0.5));
        std::fflush(stdout);
    }
}

} // namespace

int main(int argc, char** argv)
{
    Options o;
    for (int k = 1; k < argc; ++k) {
        std::string const word = argv[k];
        if (word == "--size" && k + 1 < argc)
            std::sscanf(argv[++k], "%dx%d", &o.width, &o.height);
        else if (word == "--figures" && k + 1 < argc)
            o.figures = std::atoi(argv[++k]);
        else if (word == "--frames" && k + 1 < argc)
            o.frames = std::atoi(argv[++k]);
        else
            o.scenes.push_back(word);
    }
    if (o.scenes.empty()) o.scenes = {"atrium", "cornell"};
    for (std::string const& name : o.scenes) run(o, name);
}
