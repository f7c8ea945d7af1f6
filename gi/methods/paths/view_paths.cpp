#include "gi/methods/paths/view_paths.h"

#include "gi/render/path_random.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/pass_samples.h"
#include "gi/render/ray_path.h"

#include <algorithm>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Pixels whose paths advance together on one thread.
constexpr std::size_t kBlock = 4096;
/// The same for few paths, and with exact rays, where only paths and no buffers have to stay in the cache.
constexpr std::size_t kSmallBlock = kPixelsOfTurn;

/// First surfaces of pixels first..last - 1 by exact rays, each path through its
/// own sample point on pixel and lens.
void exact_hits(PathsTracer::Pass const& pass, SeenView const& view, RenderSettings const& s, std::size_t first,
                std::size_t last, std::vector<PathStart>& out)
{
    constexpr std::uint32_t kLens = 0x1e450000; // first dimension of the lens, beyond those of vertices
    std::uint32_t const width = std::uint32_t(view.width);
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<Hit> hits;
    rays.clear();
    out.clear();
    for (std::size_t p = first; p < last; ++p) {
        RqmcStream const stream = pixel_stream(random_key(s.seed), std::uint32_t(p), width, pass.index);
        vec2 const place =
            vec2{float(p % width) + 0.5f, float(p / width) + 0.5f} + filter_offset(view.filter, stream.sample2(0));
        Ray const ray = camera_ray(view.rays, place, [&] { return stream.sample2(kLens); });
        out.push_back({std::uint32_t(p), kNoPrimitive, ray});
        rays.push_back(
            {.ray = ray, .seed = stream.own_seed() + pass.index, .start = camera_clearance(ray.origin)});
    }
    hits.resize(rays.size());
    pass.exact->nearest(rays, hits);
    for (std::size_t k = 0; k < hits.size(); ++k) out[k].triangle = hits[k].triangle;
}

} // namespace

/// Counts of one thread.
struct ViewPaths::Counts {
    PathCounts paths;
    PathsWork work;
    std::uint64_t taken = 0;
};

struct ViewPaths::Work {
    tbb::combinable<Counts> counts;

    /// Leaves blocks out once `stop` is given up.
    template <class F>
    void in_blocks(std::size_t n, PassStop const& stop, F const& work, std::size_t block = kBlock)
    {
        tbb::parallel_for(std::size_t(0), (n + block - 1) / block, [&](std::size_t k) {
            if (stop.given_up()) return;
            FlushDenormals const guard;
            work(k * block, std::min(n, (k + 1) * block), counts.local());
        });
    }
};

ViewPaths::ViewPaths(World const& world, RenderSettings const& settings, Report& report)
    : world_(world), settings_(settings), report_(report)
{
}

/// Chooses the block size: larger with interleaving, as fewer paths continue.
void ViewPaths::choose_block()
{
    std::size_t const n = std::size_t(std::max(1, settings_.of<PathsSettings>().interleave));
    block_ = settings_.of<PathAlgorithm>().surfaces == SurfacesBy::rays ? kSmallBlock * std::min(n * n, std::size_t(4)) : kBlock;
}

LayeredLens::View lens_view(SeenView const& view, std::uint64_t seed, std::uint32_t pass)
{
    return {view.rays, view.during, view.width, view.height, view.filter, view.hidden, seed, pass};
}

PathsTracer ViewPaths::tracer_of(SeenView const& view) const
{
    return {world_, view.rays, view.width, settings_};
}

/// Traces the paths of a block of pixels.
void ViewPaths::trace_all(PathsTracer::Pass const& pass, PathsTracer const& tracer, std::size_t first, bool sharing,
                          std::span<PathStart const> starts, std::vector<CacheNote>& notes, Counts& counts)
{
    std::span const samples(&samples_[first], starts.size());
    std::span const ends =
        sharing ? std::span(&shared_vertices_[first], starts.size()) : std::span<SharedVertex>();
    tracer.trace(pass, starts, samples, ends, notes, counts.paths, counts.work);
    for (std::size_t k = 0; k < ends.size(); ++k) shared_.note(std::uint32_t(first + k), ends[k]);
}

/// The same, except for hidden pixels and pixels that reuse a partner's light.
void ViewPaths::trace_some(PathsTracer::Pass const& pass, PathsTracer const& tracer, SeenView const& view,
                           PartnerLight const* partner, bool sharing, std::vector<PathStart>& starts,
                           std::vector<CacheNote>& notes, Counts& counts)
{
    std::size_t left = 0;
    for (PathStart const& start : starts) {
        std::size_t const at = view.first + start.stream;
        if (!view.hidden.empty() && view.hidden[start.stream] != 0) {
            samples_[at] = {};
            if (sharing) shared_.note_none(std::uint32_t(at));
            continue;
        }
        std::uint32_t const from = partner != nullptr ? partner->find(start, samples_[at]) : kOwnLight;
        if (from == kOwnLight) {
            starts[left++] = start;
        } else {
            taken_from_[at] = from;
            if (sharing) shared_.note_none(std::uint32_t(at));
            ++counts.taken;
        }
    }
    starts.resize(left);
    thread_local std::vector<PathSample> samples;
    thread_local std::vector<SharedVertex> ends;
    samples.resize(left);
    ends.resize(sharing ? left : 0);
    tracer.trace(pass, starts, samples, ends, notes, counts.paths, counts.work);
    for (std::size_t k = 0; k < left; ++k) {
        std::size_t const at = view.first + starts[k].stream;
        samples_[at] = samples[k];
        if (!sharing) continue;
        shared_vertices_[at] = ends[k];
        shared_.note(std::uint32_t(at), ends[k]);
    }
}

void ViewPaths::trace_view(PathsTracer::Pass const& pass_of_all, SeenViews const& views, SeenView const& view,
                           bool sharing, Work& work)
{
    PathsTracer::Pass pass = pass_of_all;
    if (view.screen) pass.screen = &*view.screen;
    PathsTracer const tracer = tracer_of(view);
    std::optional<PartnerLight> partner;
    if (view.partner >= 0 && view.primary && views[std::size_t(view.partner)].primary) {
        SeenView const& other = views[std::size_t(view.partner)];
        partner.emplace(world_, *other.primary, samples(other), other.rays, view.rays);
    }
    auto const trace_block = [&](std::size_t first, std::size_t last, Counts& local) {
        thread_local std::vector<PathStart> starts;
        std::vector<CacheNote>& notes = notes_[first / block_];
        if (view.primary)
            view.primary->hits(first, last, starts);
        else
            exact_hits(pass, view, settings_, first, last, starts);
        if (partner || !view.hidden.empty())
            trace_some(pass, tracer, view, partner ? &*partner : nullptr, sharing, starts, notes, local);
        else
            trace_all(pass, tracer, view.first + first, sharing, starts, notes, local);
        if (pass.first_watched == kNoPrimitive) return;
        std::vector<std::uint32_t>& near = near_moving_[first / block_];
        near.clear();
        for (std::size_t p = first; p < last; ++p)
            if (samples_[p].near_moving) near.push_back(std::uint32_t(p));
    };
    in_turns(pass, view.pixels(), trace_block, work);
}

/// Traces blocks of paths, and teaches the cache, if there is one. @param trace_block  of paths first to last - 1, with notes_[first / block_]
template <class Trace>
void ViewPaths::in_turns(PathsTracer::Pass const& pass, std::size_t paths, Trace const& trace_block, Work& work)
{
    notes_.resize(paths / block_ + 1);
    // With an empty cache, trace some blocks first, so that others can read what those taught.
    constexpr std::uint32_t kTurns = 5;
    bool const by_turns = pass.cache != nullptr && pass.cache->empty();
    for (std::uint32_t turn = 0; turn < (by_turns ? kTurns : 1); ++turn) {
        work.in_blocks(
            paths, pass.stop,
            [&](std::size_t first, std::size_t last, Counts& local) {
                if (!by_turns || turn_of(first / block_) == turn) trace_block(first, last, local);
            },
            block_);
        if (pass.stop.given_up()) {
            for (std::vector<CacheNote>& notes : notes_) notes.clear();
            throw Interrupted();
        }
        if (pass.cache == nullptr) continue;
        pass.cache->learn(notes_);
        for (std::vector<CacheNote>& notes : notes_) notes.clear();
    }
}

/// True if paths of this pass end on the first diffuse layer and share the light from there.
bool ViewPaths::start_sharing(PathsTracer::Pass const& pass, VertexSharing sharing)
{
    SlhbSettings const& slhb = settings_.of<SlhbSettings>();
    std::size_t const paths = samples_.size(), layers = pass.axes.first_bounce_layers();
    bool const shares = sharing != VertexSharing::none && pass.cache == nullptr && pass.look_ups && layers > 0 &&
                        layers < paths && settings_.bounces > 0 && slhb.cone == 0;
    shared_.start(paths, shares ? layers : 0, pass.index);
    shared_vertices_.resize(shares ? paths : 0);
    return shares;
}

/// Traces on from the shared vertices.
void ViewPaths::send_on(PathsTracer::Pass const& pass, SeenView const& view, Work& work)
{
    shared_.collect(shared_vertices_);
    PathsTracer const tracer = tracer_of(view);
    work.in_blocks(shared_.starts().size(), pass.stop, [&](std::size_t first, std::size_t last, Counts& local) {
        thread_local std::vector<PathSample> sent;
        sent.resize(last - first);
        std::vector<CacheNote> none;
        tracer.trace(pass, std::span(shared_.starts()).subspan(first, last - first), sent, {}, none, local.paths,
                     local.work);
        shared_.keep(first, sent);
    });
}

void ViewPaths::add(SeenViews const& views, std::size_t index, bool sharing, std::span<Accumulator> all,
                    Work& work)
{
    SeenView const& v = views[index];
    SeenView const* const partner = v.partner >= 0 ? &views[std::size_t(v.partner)] : nullptr;
    Accumulator& sums = all[index];
    auto const shows_same = [&](std::size_t pixel, std::uint32_t from) {
        PixelMeans const& here = sums.pixels[pixel];
        double const pixel_m = double(here.depth) * double(glm::length(v.rays.step_x));
        return same_surface(here, all[std::size_t(v.partner)].pixels[from], pixel_m);
    };
    work.in_blocks(v.pixels(), PassStop(nullptr), [&](std::size_t first, std::size_t last, Counts&) {
        for (std::size_t p = first; p < last; ++p) {
            PathSample& sample = samples_[v.first + p];
            if (sharing && shared_.has(v.first + p))
                sample.radiance[2] += shared_vertices_[v.first + p].throughput * shared_.radiance(v.first + p);
            std::uint32_t const from = partner != nullptr ? taken_from_[v.first + p] : kOwnLight;
            if (from != kOwnLight) take_light(samples_[partner->first + from], sample);
            sums.add(p, sample, sums.paths);
            if (partner == nullptr) continue;
            std::uint32_t& of_all = light_from_[v.first + p]; // over all paths of this frame
            bool const taken =
                from != kOwnLight && (sums.paths == 0 || (of_all != kOwnLight && shows_same(p, from)));
            of_all = taken ? from : kOwnLight;
        }
    });
    if (partner != nullptr) taking_ += v.pixels() - v.hidden_pixels;
    hidden_ += v.hidden_pixels;
    pixels_ += v.pixels();
}

void ViewPaths::trace(PathsTracer::Pass const& pass, SeenViews const& views, VertexSharing sharing,
                      std::span<Accumulator> sums)
{
    std::size_t const pixels = views.back().first + views.back().pixels();
    samples_.resize(pixels);
    taken_from_.assign(views.size() > 1 ? pixels : 0, kOwnLight);
    light_from_.resize(taken_from_.size());
    bool const shares = start_sharing(pass, sharing);
    choose_block();
    Work work;
    for (SeenView const& v : views) trace_view(pass, views, v, shares, work);
    send_on(pass, views[0], work);
    pass.stop.check();
    if (pass.spread && settings_.of<PathsSettings>().interleave > 1)
        for (SeenView const& v : views)
            spread_indirect(std::span(samples_).subspan(v.first, v.pixels()), v.width,
                            {std::uint32_t(settings_.of<PathsSettings>().interleave)}, pass.index);
    for (std::size_t k = 0; k < views.size(); ++k) add(views, k, shares, sums, work);
    add_work(work, sums[0].counts);
}

void ViewPaths::trace_lenses(PathsTracer::Pass const& pass, SeenViews const& views, std::span<Accumulator> all)
{
    std::size_t const pixels = views.back().first + views.back().pixels();
    samples_.resize(pixels);
    light_from_.assign(views.size() > 1 ? pixels : 0, kOwnLight);
    choose_block();
    Work work;
    for (SeenView const& view : views) {
        std::span<PathStart const> const starts = view.lens->starts();
        PathsTracer const tracer = tracer_of(view);
        of_layers_.resize(starts.size());
        auto const trace_block = [&](std::size_t first, std::size_t last, Counts& local) {
            tracer.trace(pass, starts.subspan(first, last - first),
                         std::span(of_layers_).subspan(first, last - first), {}, notes_[first / block_],
                         local.paths, local.work);
        };
        in_turns(pass, starts.size(), trace_block, work);
        LayeredLens::View const through = lens_view(view, settings_.seed, pass.index);
        WorldView const world = gi::view(world_);
        work.in_blocks(view.pixels(), pass.stop, [&](std::size_t first, std::size_t last, Counts&) {
            for (std::size_t p = first; p < last; ++p)
                samples_[view.first + p] = view.lens->gather(through, world, p, of_layers_);
        });
        lens_rays_ += view.lens->rays();
        lens_paths_ += starts.size();
        lens_alone_ += view.lens->alone();
    }
    pass.stop.check();
    for (std::size_t v = 0; v < views.size(); ++v) {
        work.in_blocks(views[v].pixels(), PassStop(nullptr), [&](std::size_t first, std::size_t last, Counts&) {
            for (std::size_t p = first; p < last; ++p) all[v].add(p, samples_[views[v].first + p], all[v].paths);
        });
        hidden_ += views[v].hidden_pixels;
        pixels_ += views[v].pixels();
    }
    add_work(work, all[0].counts);
}

void ViewPaths::trace_pair(PathsTracer::Pass const& pass, SeenViews const& views, ShowMoving const& show_moving,
                           PairSums& sums, PathCounts& counts)
{
    SeenView const& view = views[0];
    samples_.resize(view.pixels());
    choose_block();
    near_moving_.resize((view.pixels() + block_ - 1) / block_);
    Work work;
    trace_view(pass, views, view, false, work);
    without_pixels_.clear();
    for (auto const& some : near_moving_) without_pixels_.insert(without_pixels_.end(), some.begin(), some.end());
    without_.resize(without_pixels_.size());
    show_moving(false);
    PathsTracer::Pass without = pass;
    without.first_watched = kNoPrimitive;
    without.exact_world = RayWorld::what_stays;
    if (view.screen_behind) without.screen = &*view.screen_behind;
    PathsTracer const tracer = tracer_of(view);
    auto const trace_some = [&](std::size_t first, std::size_t last, Counts& local) {
        thread_local std::vector<PathStart> starts;
        view.primary->hits_behind(std::span(without_pixels_).subspan(first, last - first), starts);
        std::vector<CacheNote> none;
        tracer.trace(without, starts, std::span(without_).subspan(first, last - first), {}, none, local.paths,
                     local.work);
    };
    work.in_blocks(without_.size(), pass.stop, trace_some, kSmallBlock);
    show_moving(true);
    pair_paths_ += view.pixels();
    without_paths_ += without_.size();
    sums.add(samples_, without_pixels_, without_);
    add_work(work, counts);
}

void ViewPaths::control(PathsTracer::Pass const& pass, SeenView const& view, BiasControl& sums)
{
    std::size_t const stride = BiasControl::stride(view.pixels()), n = view.pixels() / stride;
    PathsTracer::Pass looking = pass, exact = pass;
    looking.cache = exact.cache = nullptr;
    exact.look_ups = exact.confirms = false;
    exact.exact_shadows = true;
    PathsTracer const tracer = tracer_of(view);
    std::vector<BiasControl::PassLight> of_blocks((n + kSmallBlock - 1) / kSmallBlock);
    Work none;
    auto const trace_twice = [&](std::size_t first, std::size_t last, Counts&) {
        thread_local std::vector<PathStart> starts, one;
        thread_local std::vector<PathSample> samples;
        std::vector<CacheNote> notes;
        PathCounts paths;
        PathsWork work;
        starts.clear();
        for (std::size_t k = first; k < last; ++k) {
            std::size_t const p = k * stride + hash_words(std::uint32_t(k), pass.index) % stride;
            if (view.primary)
                view.primary->hits(p, p + 1, one);
            else
                exact_hits(pass, view, settings_, p, p + 1, one);
            starts.push_back(one[0]);
        }
        samples.resize(starts.size());
        BiasControl::PassLight& light = of_blocks[first / kSmallBlock];
        light.paths = starts.size();
        auto const add = [&](PathsTracer::Pass const& by, std::array<double, 2>& to) {
            tracer.trace(by, starts, samples, {}, notes, paths, work);
            for (PathSample const& s : samples)
                for (std::size_t part = 0; part < to.size(); ++part)
                    for (int c = 0; c < 3; ++c) to[part] += double(s.radiance[part + 1][c]);
        };
        add(looking, light.looked_up);
        add(exact, light.exact);
    };
    none.in_blocks(n, pass.stop, trace_twice, kSmallBlock);
    if (pass.stop.given_up()) return;
    BiasControl::PassLight all;
    for (BiasControl::PassLight const& b : of_blocks) {
        all.paths += b.paths;
        for (std::size_t part = 0; part < all.exact.size(); ++part) {
            all.looked_up[part] += b.looked_up[part];
            all.exact[part] += b.exact[part];
        }
    }
    sums.add(all);
}

void ViewPaths::add_work(Work& work, PathCounts& paths)
{
    double direct_s = 0, indirect_s = 0;
    work.counts.combine_each([&](Counts const& c) {
        direct_s += c.work.direct_s;
        indirect_s += c.work.indirect_s;
        paths += c.paths;
        done_.queries += c.work.queries;
        done_.exact_rays += c.work.exact_rays;
        done_.shadow_lookups += c.work.shadow_lookups;
        done_.shadow_rays += c.work.shadow_rays;
        done_.doubtful_queries += c.work.doubtful_queries;
        done_.doubtful_shadows += c.work.doubtful_shadows;
        done_.cache_reads += c.work.cache_reads;
        taken_ += c.taken;
    });
    indirect_share_ = direct_s + indirect_s > 0 ? indirect_s / (direct_s + indirect_s) : 0;
    report_.add_time("direct light, thread seconds", direct_s);
    report_.add_time("indirect light, thread seconds", indirect_s);
}

double ViewPaths::rays() const
{
    return double(done_.queries + done_.shadow_lookups + done_.exact_rays + done_.shadow_rays) +
           double(done_.doubtful_shadows);
}

void ViewPaths::report_work() const
{
    report_.count("hit-buffer queries", double(done_.queries));
    report_.count("shadow-map look-ups", double(done_.shadow_lookups));
    report_.count("exact rays", double(done_.exact_rays));
    report_.count("shadow rays", double(done_.shadow_rays + done_.doubtful_shadows));
    if (done_.doubtful_queries + done_.doubtful_shadows > 0) {
        report_.count("doubtful look-ups decided by exact rays", double(done_.doubtful_queries));
        report_.count("doubtful shadow-map look-ups decided by exact rays", double(done_.doubtful_shadows));
    }
    report_.count("paths that ended in the radiance cache", double(done_.cache_reads));
    report_.count("shared vertices shaded for several paths", double(shared_.shaded()));
    if (taking_ > 0) report_.count("share of pixels lit by a partner view", double(taken_) / double(taking_));
    if (hidden_ > 0) {
        report_.count("pixels not rendered, as nobody sees them", double(hidden_));
        report_.count("share of pixels not rendered", double(hidden_) / double(pixels_));
    }
    if (lens_rays_ > 0) {
        report_.count("lens rays", double(lens_rays_));
        report_.count("paths of what lens rays met", double(lens_paths_));
        report_.count("of these, of what no layer in sight shows", double(lens_alone_));
    }
    if (pair_paths_ > 0)
        report_.count("share of a pair's paths traced on both sides",
                      double(without_paths_) / double(pair_paths_));
}

} // namespace gi
