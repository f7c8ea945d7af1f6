#include "gi/slhb/renderer.h"

#include "gi/scene/plan.h"
#include "gi/slhb/settings.h"
#include "gi/transport/flush_denormals.h"
#include "gi/transport/pass_samples.h"
#include "gi/transport/sampling.h"

#include <algorithm>
#include <chrono>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Pixels whose paths advance together on one thread.
constexpr std::size_t kBlock = 4096;
/// Where they are few: something for every thread.
constexpr std::size_t kSmallBlock = 512;

/// Primary hits through exact rays, for the cameras that have no raster.
void exact_hits(ExactVisibility const& exact, CameraRays const& camera, int width, RenderSettings const& s,
                std::uint32_t pass, std::size_t first, std::size_t last, std::vector<PathStart>& out)
{
    std::vector<RayQuery> rays;
    out.clear();
    for (std::size_t p = first; p < last; ++p) {
        RqmcStream const stream{std::uint32_t(mix_bits(s.seed + p)), pass};
        vec2 const place{float(p % std::size_t(width)) + 0.5f, float(p / std::size_t(width)) + 0.5f};
        Ray const ray = camera.through(place + filter_offset(s.filter, stream.sample2(0)));
        out.push_back({std::uint32_t(p), kNoPrimitive, ray});
        rays.push_back({.ray = ray, .seed = stream.seed + pass});
    }
    std::vector<Hit> hits(rays.size());
    exact.nearest(rays, hits);
    for (std::size_t k = 0; k < hits.size(); ++k) out[k].triangle = hits[k].triangle;
}

bool contains(Bounds const& outer, Bounds const& inner)
{
    return inner.empty() || (glm::all(glm::lessThanEqual(outer.low, inner.low)) &&
                             glm::all(glm::greaterThanEqual(outer.high, inner.high)));
}

/// Everything, and room around what moves, so that an arm that swings is no reason to build all anew.
Bounds with_room(World const& world, TriangleSoup const& soup, std::size_t first_moving)
{
    constexpr float kRoom = 0.25f; // of the size of what moves
    Bounds moving;
    for (std::size_t t = first_moving; t < soup.count; ++t)
        for (std::size_t c = 0; c < 3; ++c)
            if (vec3 const p = soup.vertex(t, c); all_finite(p)) moving = joined(moving, {p, p});
    if (moving.empty()) return world.bounds;
    vec3 const room{kRoom * max_component(moving.high - moving.low)};
    return joined(world.bounds, {moving.low - room, moving.high + room});
}

/// Choosing among axes and lamps takes their grids alone.
std::uint32_t texels(bool unused, int n) { return std::uint32_t(unused ? 2 : n); }

} // namespace

SlhbRenderer::SlhbRenderer(World const& world, std::span<FrameView const> views, RenderSettings const& settings,
                           TriangleSoup soup, std::size_t first_moving, Report& report)
    : world_(world),
      settings_(settings),
      first_moving_(first_moving),
      report_(report),
      soup_(std::move(soup)),
      cut_outs_(world),
      grid_bounds_(with_room(world, soup_, first_moving))
{
    see(views);
    build_exact();
    end_frame();
    make_axes();
    make_lamps();
}

bool SlhbRenderer::orthographic() const
{
    return std::any_of(views_.begin(), views_.end(), [](View const& v) { return v.rays.orthographic; });
}

void SlhbRenderer::build_exact()
{
    bool const alpha_tests = plan_scene(world_).alpha_tests;
    auto const build = [&] {
        return std::make_unique<ExactVisibility>(world_, alpha_tests, settings_.threads, first_moving_);
    };
    if (!exact_ && needs_exact_rays(world_, orthographic())) {
        StageTimer const timer(report_, "build (Embree BVH)");
        exact_ = build();
    }
    if (!judge_ && slhb_.exact.any()) judge_ = build();
}

/// Also the last surface sends paths along axes: only where the sky or exact rays count there.
bool SlhbRenderer::to_the_end() const { return exact_ != nullptr || !view(world_).environment_radiance.empty(); }

bool SlhbRenderer::walks() const { return settings_.bounces > 0 || to_the_end(); }

void SlhbRenderer::make_axes()
{
    if (axes_) {
        earlier_sets_.axes += axes_->built();
        earlier_sets_.layers += axes_->layers();
        earlier_sets_.lost += axes_->lost();
    }
    walks_ = walks();
    bool const apart = slhb_.schedule != Schedule::streamed; // else all is built in every pass anyway
    axes_.emplace(AxisSet::Source{.bounds = grid_bounds_,
                                  .soup = soup_,
                                  .cut_outs = cut_outs_,
                                  .resolution = texels(slhb_.exact.queries, slhb_.resolution),
                                  .most_layers = std::uint32_t(slhb_.most_layers),
                                  .packed = slhb_.packed,
                                  .seed = settings_.seed,
                                  .first_moving = apart ? first_moving_ : soup_.count});
    if (slhb_.schedule != Schedule::stored || !walks_) return;
    StageTimer const timer(report_, "build (hit buffers)");
    axes_->store(make_directions(slhb_.directions));
}

void SlhbRenderer::make_lamps()
{
    if (lamps_) earlier_sets_.maps += lamps_->maps_built();
    lamps_.emplace(world_, grid_bounds_, soup_, cut_outs_,
                   LampSettings{.count = std::uint32_t(slhb_.lamps),
                                .fresh = std::uint32_t(slhb_.fresh_lamps),
                                .resolution = texels(slhb_.exact.shadows, slhb_.shadow_resolution),
                                .seed = settings_.seed,
                                .first_moving = first_moving_});
}

void SlhbRenderer::world_moved(bool geometry, bool lights)
{
    if (geometry) {
        {
            StageTimer const timer(report_, "triangles that moved");
            if (earlier_.corners.empty()) earlier_.corners = corners_of(soup_, first_moving_);
            update_soup(world_, first_moving_, soup_);
        }
        {
            StageTimer const timer(report_, "BVH of what moves (Embree)");
            if (exact_) exact_->moved(world_);
            if (judge_) judge_->moved(world_);
        }
        if (contains(grid_bounds_, world_.bounds)) {
            axes_->moved();
        } else {
            // Some room, so that it does not happen in every frame.
            Bounds const b = world_.bounds;
            vec3 const room = 0.1f * (b.high - b.low);
            grid_bounds_ = joined(grid_bounds_, {b.low - room, b.high + room});
            if (slhb_.schedule != Schedule::streamed) // which is built anew in every pass
                report_.lose("frames that left the bounds of the hit buffers, which were built anew");
            make_axes();
            lights = true; // the maps of parallel light hold the same bounds
        }
        lamps_->moved();
    }
    if (lights) make_lamps();
}

void SlhbRenderer::materials_changed()
{
    if ((exact_ != nullptr) != needs_exact_rays(world_, orthographic())) {
        exact_.reset();
        build_exact();
    }
    if (walks_ != walks()) make_axes();
}

void SlhbRenderer::end_frame()
{
    follows_ = false;
    ++frames_;
    earlier_ = {first_moving_, {}};
    for (View& v : views_) v.earlier = v.rays;
}

void SlhbRenderer::add_motion(std::size_t view, Picture& picture) const
{
    View const& v = views_[view];
    if (v.primary) gi::add_motion(*v.primary, soup_, v.rays, v.earlier, earlier_, picture);
}

void SlhbRenderer::see(std::span<FrameView const> views)
{
    std::size_t first = 0;
    while (views_.size() > views.size()) views_.pop_back();
    for (std::size_t k = 0; k < views.size(); ++k) {
        FrameView const& now = views[k];
        bool const known = k < views_.size() && views_[k].width == now.width && views_[k].height == now.height;
        if (k == views_.size()) views_.emplace_back();
        View& v = views_[k];
        v.width = now.width;
        v.height = now.height;
        v.partner = now.partner;
        v.hidden = now.hidden;
        v.hidden_pixels = now.hidden.size() - std::size_t(std::ranges::count(now.hidden, 0));
        v.rays = camera_rays(now.camera, now.width, now.height, world_.origin);
        v.first = first;
        first += v.pixels();
        if (!known) v.earlier = v.rays;
        if (v.rays.orthographic)
            v.primary.reset();
        else if (!known || !v.primary)
            v.primary.emplace(soup_, cut_outs_, settings_, v.width, v.height);
    }
    if (!exact_ && orthographic()) build_exact(); // they have no raster
}

void SlhbRenderer::prepare(std::uint32_t index, Sides sides)
{
    // Surfaces that a path may leave along an axis.
    auto const sequences =
        std::uint32_t(std::clamp(settings_.bounces + (to_the_end() ? 1 : 0), 1, int(AxisSet::kSequences)));
    if (walks_ && slhb_.schedule == Schedule::stored && first_moving_ < soup_.count) {
        StageTimer const timer(report_, "layers that moved");
        auto const begun = std::chrono::steady_clock::now();
        std::size_t const axes = axes_->follow_some(sequences, slhb_.gather ? 0 : followed_, frames_);
        double const s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        if (!std::exchange(follows_, true)) following_ = {0, int(axes), int(sequences), 0};
        following_.seconds += s;
    } else {
        StageTimer const timer(report_, "hit buffers of a pass");
        if (walks_ && slhb_.schedule != Schedule::stored) {
            axes_->refresh(sequences, std::uint32_t(slhb_.axes), std::uint32_t(slhb_.fresh_axes), index);
            axes_->follow();
        }
    }
    {
        StageTimer const timer(report_, "shadow maps");
        lamps_->refresh(index);
    }
    StageTimer const timer(report_, "G-buffer");
    for (View& v : views_) {
        if (!v.primary) continue;
        CameraRays const eye = eye_of_pass(v.rays, settings_.seed, index);
        float const near_m = near_plane(world_.bounds);
        if (sides == Sides::pair)
            v.primary->refresh_pair(eye, near_m, index, first_moving_);
        else
            v.primary->refresh(eye, near_m, index);
    }
}

void SlhbRenderer::pass(std::uint32_t index, std::span<Accumulator> sums, Endings endings)
{
    prepare(index, Sides::one);
    StageTimer const timer(report_, "paths");
    trace(index, sums, endings);
    for (Accumulator& s : sums) ++s.paths;
}

/// Of the threads that share the work of a pass.
struct SlhbRenderer::Work {
    struct Counts {
        PathCounts paths;
        SlhbCounts slhb;
        std::uint64_t taken = 0;
    };
    tbb::combinable<Counts> counts;

    template <class F>
    void in_blocks(std::size_t n, F const& work, std::size_t block = kBlock)
    {
        tbb::parallel_for(std::size_t(0), (n + block - 1) / block, [&](std::size_t k) {
            FlushDenormals const guard;
            work(k * block, std::min(n, (k + 1) * block), counts.local());
        });
    }
};

/// Traces the paths that start at what a view sees, but for hidden pixels and those that take their light from its
/// partner.
void SlhbRenderer::trace_view(View const& view, SlhbTracer::Pass const& pass, bool sharing, Work& work)
{
    SlhbTracer const tracer(world_, view.rays, view.width, settings_, slhb_);
    std::optional<PartnerLight> partner;
    if (view.partner >= 0 && view.primary && views_[std::size_t(view.partner)].primary) {
        View const& other = views_[std::size_t(view.partner)];
        partner.emplace(world_, *other.primary, std::span(samples_).subspan(other.first, other.pixels()),
                        other.rays, view.rays);
    }
    work.in_blocks(view.pixels(), [&](std::size_t first, std::size_t last, Work::Counts& local) {
        thread_local std::vector<PathStart> starts;
        if (view.primary)
            view.primary->hits(first, last, starts);
        else
            exact_hits(*exact_, view.rays, view.width, settings_, pass.index, first, last, starts);
        std::span const samples(&samples_[view.first + first], last - first);
        std::span const ends =
            sharing ? std::span(&endings_[view.first + first], last - first) : std::span<Ending>();
        if (!partner && view.hidden.empty()) {
            tracer.trace(pass, starts, samples, ends, local.paths, local.slhb);
        } else {
            thread_local std::vector<PathSample> traced;
            thread_local std::vector<Ending> traced_ends;
            std::size_t left = 0;
            for (std::size_t k = 0; k < starts.size(); ++k) {
                if (!view.hidden.empty() && view.hidden[first + k] != 0) {
                    samples[k] = {};
                    continue;
                }
                std::uint32_t const from = partner ? partner->find(starts[k], samples[k]) : kOwnLight;
                if (from == kOwnLight)
                    starts[left++] = starts[k];
                else
                    taken_from_[view.first + first + k] = from;
                local.taken += from != kOwnLight;
            }
            starts.resize(left);
            traced.resize(left);
            traced_ends.resize(sharing ? left : 0);
            tracer.trace(pass, starts, traced, traced_ends, local.paths, local.slhb);
            for (Ending& e : ends) e.layer = kNoLayerHit;
            for (std::size_t k = 0; k < left; ++k) {
                std::size_t const at = starts[k].stream - first;
                samples[at] = traced[k];
                if (sharing) ends[at] = traced_ends[k];
            }
        }
        if (sharing) shared_.note(ends, std::uint32_t(view.first + first), pass.axes.pool());
        if (pass.first_watched == kNoPrimitive) return;
        std::vector<std::uint32_t>& near = near_moving_[first / kBlock];
        near.clear();
        for (std::size_t p = first; p < last; ++p)
            if (samples_[p].near_moving) near.push_back(std::uint32_t(p));
    });
}

/// Of the paths of the only view that what moves may count in. The world stays as it is: look-ups pass it by.
void SlhbRenderer::trace_without(SlhbTracer::Pass pass, Work& work)
{
    View const& view = views_[0];
    without_pixels_.clear();
    for (auto const& some : near_moving_) without_pixels_.insert(without_pixels_.end(), some.begin(), some.end());
    without_.resize(without_pixels_.size());
    axes_->show_moving(false);
    lamps_->show_moving(false);
    pass.first_watched = kNoPrimitive;
    pass.exact_world = RayWorld::what_stays;
    SlhbTracer const tracer(world_, view.rays, view.width, settings_, slhb_);
    auto const trace_some = [&](std::size_t first, std::size_t last, Work::Counts& local) {
        thread_local std::vector<PathStart> starts;
        view.primary->hits_behind(std::span(without_pixels_).subspan(first, last - first), starts);
        tracer.trace(pass, starts, std::span(without_).subspan(first, last - first), {}, local.paths, local.slhb);
    };
    work.in_blocks(without_.size(), trace_some, kSmallBlock);
    axes_->show_moving(true);
    lamps_->show_moving(true);
}

void SlhbRenderer::pair_pass(std::uint32_t index, PairSums& sums, PathCounts& counts)
{
    prepare(index, Sides::pair);
    StageTimer const timer(report_, "paths");
    View const& view = views_[0];
    SlhbTracer::Pass now = tracing(index);
    now.first_watched = std::uint32_t(first_moving_);
    samples_.resize(view.pixels());
    near_moving_.resize((view.pixels() + kBlock - 1) / kBlock);
    Work work;
    trace_view(view, now, false, work);
    trace_without(now, work);
    pair_paths_ += view.pixels();
    without_paths_ += without_.size();
    sums.add(samples_, without_pixels_, without_);
    add_work(work, counts);
}

/// Whether paths of this pass end on the first matt layer and share what is sent on there.
bool SlhbRenderer::start_sharing(std::uint32_t index, std::size_t pixels, Endings endings)
{
    bool const possible =
        endings != Endings::own && settings_.bounces > 0 && slhb_.cone == 0 && !slhb_.exact.queries;
    std::size_t const layers = axes_->first_bounce_layers();
    bool const in_cells = possible && endings == Endings::in_cells && !orthographic(),
               on_layers = possible && layers < pixels;
    if (in_cells)
        shared_.start_cells(pixels, EndingCells(world_, views_[0].rays.origin, index), index);
    else
        shared_.start_layers(pixels, on_layers ? layers : 0, index);
    return in_cells || on_layers;
}

SlhbTracer::Pass SlhbRenderer::tracing(std::uint32_t index)
{
    std::uint32_t const gathered = slhb_.gather && walks_
                                       ? index / std::uint32_t(slhb_.interleave * slhb_.interleave) %
                                             std::uint32_t(axes_->first_bounce_axes())
                                       : kNoPrimitive;
    sky_.clear();
    if (walks_ && !slhb_.exact.directions) sky_ = sky_along(*axes_, world_);
    return {.axes = *axes_,
            .lamps = *lamps_,
            .exact = exact_.get(),
            .index = index,
            .gather_axis = gathered,
            .judge = judge_.get(),
            .sky = sky_};
}

void SlhbRenderer::trace(std::uint32_t index, std::span<Accumulator> sums, Endings endings)
{
    SlhbTracer::Pass const now = tracing(index);
    std::size_t const pixels = views_.back().first + views_.back().pixels();
    bool const sharing = start_sharing(index, pixels, endings);
    samples_.resize(pixels);
    endings_.resize(sharing ? pixels : 0);
    taken_from_.assign(views_.size() > 1 ? pixels : 0, kOwnLight);
    light_from_.resize(taken_from_.size());
    Work work;
    for (View const& v : views_) trace_view(v, now, sharing, work);
    shared_.collect(endings_, axes_->pool());
    SlhbTracer const onwards(world_, views_[0].rays, views_[0].width, settings_, slhb_);
    work.in_blocks(shared_.starts().size(), [&](std::size_t first, std::size_t last, Work::Counts& local) {
        thread_local std::vector<PathSample> sent;
        sent.resize(last - first);
        onwards.trace(now, std::span(shared_.starts()).subspan(first, last - first), sent, {}, local.paths,
                      local.slhb);
        shared_.keep(first, sent);
    });
    for (std::size_t k = 0; k < views_.size(); ++k) {
        View const& v = views_[k];
        PathSample* const samples = samples_.data() + v.first;
        PathSample const* const partner =
            v.partner >= 0 ? samples_.data() + views_[std::size_t(v.partner)].first : nullptr;
        auto const shows_same = [&](std::size_t pixel, std::uint32_t from) {
            PixelSums const& here = sums[k].pixels[pixel];
            double const pixel_m = here.depth / here.hits * double(glm::length(v.rays.step_x));
            return same_surface(here, sums[std::size_t(v.partner)].pixels[from], pixel_m);
        };
        work.in_blocks(v.pixels(), [&](std::size_t first, std::size_t last, Work::Counts&) {
            for (std::size_t p = first; p < last; ++p) {
                if (sharing && endings_[v.first + p].layer != kNoLayerHit)
                    samples[p].radiance[2] += endings_[v.first + p].throughput * shared_.radiance(v.first + p);
                std::uint32_t const from = partner ? taken_from_[v.first + p] : kOwnLight;
                if (from != kOwnLight) take_light(partner[from], samples[p]);
                sums[k].add(p, samples[p], sums[k].paths);
                if (!partner) continue;
                std::uint32_t& all = light_from_[v.first + p]; // the paths of this frame
                bool const taken =
                    from != kOwnLight && (sums[k].paths == 0 || (all != kOwnLight && shows_same(p, from)));
                all = taken ? from : kOwnLight;
            }
        });
        if (partner) taking_ += v.pixels() - v.hidden_pixels;
        hidden_ += v.hidden_pixels;
        pixels_ += v.pixels();
    }
    add_work(work, sums[0].counts);
}

void SlhbRenderer::add_work(Work& work, PathCounts& paths)
{
    double direct_s = 0, indirect_s = 0;
    work.counts.combine_each([&](Work::Counts const& c) {
        direct_s += c.slhb.direct_s;
        indirect_s += c.slhb.indirect_s;
        paths += c.paths;
        done_.queries += c.slhb.queries;
        done_.exact_rays += c.slhb.exact_rays;
        done_.shadow_lookups += c.slhb.shadow_lookups;
        taken_ += c.taken;
    });
    report_.add_time("direct light, thread seconds", direct_s);
    report_.add_time("indirect light, thread seconds", indirect_s);
}

void SlhbRenderer::add_coverage(std::size_t view, std::span<float> counts, std::span<vec3> radiance) const
{
    View const& v = views_[view];
    if (!v.primary) return;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, counts.size(), kBlock), [&](auto const& range) {
        for (std::size_t p = range.begin(); p != range.end(); ++p) {
            std::uint32_t const t = v.primary->triangle(p);
            if (t == kNoPrimitive || t < first_moving_) continue;
            counts[p] += 1;
            for (vec3 const part : samples_[v.first + p].radiance) radiance[p] += part;
        }
    });
}

std::span<std::uint32_t const> SlhbRenderer::light_from(std::size_t view) const
{
    View const& v = views_[view];
    if (v.partner < 0) return {};
    return std::span(light_from_).subspan(v.first, v.pixels());
}

Following SlhbRenderer::following() const
{
    Following f = following_;
    if (walks_ && slhb_.schedule == Schedule::stored) f.stored = int(axes_->pool().size());
    return f;
}

double SlhbRenderer::rays() const { return double(done_.queries + done_.shadow_lookups + done_.exact_rays); }

void SlhbRenderer::report_work() const
{
    report_.count("hit-buffer queries", double(done_.queries));
    report_.count("shadow-map look-ups", double(done_.shadow_lookups));
    report_.count("exact rays", double(done_.exact_rays));
    report_.count("endings shaded for several paths", double(shared_.shaded()));
    if (taking_ > 0) report_.count("share of pixels lit by a partner view", double(taken_) / double(taking_));
    if (hidden_ > 0) {
        report_.count("pixels not rendered, as nobody sees them", double(hidden_));
        report_.count("share of pixels not rendered", double(hidden_) / double(pixels_));
    }
    if (pair_paths_ > 0)
        report_.count("share of a pair's paths traced on both sides",
                      double(without_paths_) / double(pair_paths_));
    double const axes = double(earlier_sets_.axes + axes_->built()),
                 layers = double(earlier_sets_.layers + axes_->layers());
    report_.count("axes built", axes);
    report_.count("layers per texel, mean",
                  axes > 0 ? layers / axes / (double(slhb_.resolution) * slhb_.resolution) : 0);
    report_.count("shadow maps built", double(earlier_sets_.maps + lamps_->maps_built()));
}

} // namespace gi
