#include "gi/methods/sh_grid/photon_sets.h"
#include "gi/light_paths/settings.h"

#include <algorithm>

namespace gi {
namespace {

void append(std::vector<std::vector<ReflectedPhoton>> const& parts, std::vector<ReflectedPhoton>& out)
{
    for (std::vector<ReflectedPhoton> const& part : parts) out.insert(out.end(), part.begin(), part.end());
}

} // namespace

PhotonSets::PhotonSets(World const& world, RenderSettings const& settings, std::size_t first_moving)
    : world_(world), settings_(settings), first_moving_(first_moving)
{
}

void PhotonSets::restart(std::uint32_t light_paths, std::uint32_t first_index)
{
    light_paths_ = light_paths;
    first_index_ = first_index;
    sets_ = 0;
    parts_left_ = 0;
    inner_paths_.reset();
    from_lights_.assign(std::size_t(parts()), {});
    from_inside_.assign(std::size_t(parts()), {});
}

LightPaths PhotonSets::light_paths_of(int part, Trace const& trace) const
{
    std::uint64_t const all = light_paths_, n = std::uint64_t(parts());
    return {.count = light_paths_,
            .first = std::uint32_t(all * std::uint64_t(part) / n),
            .last = std::uint32_t(all * std::uint64_t(part + 1) / n),
            .bounces = std::min(settings_.of<PhotonSettings>().reflections, settings_.bounces),
            .seed = settings_.seed,
            .pass = first_index_ + sets_,
            .stop = &trace.stop};
}

/// Traces a part of a set of light paths. @param vertices  (LightPaths) -> theirs
template <class Vertices>
std::vector<ReflectedPhoton> PhotonSets::trace_part(Trace const& trace, int part, LightPaths paths,
                                                    std::uint64_t stream, Vertices const& vertices)
{
    constexpr std::uint32_t kTogether = 1 << 16; // bounds the memory of vertices
    std::vector<ReflectedPhoton> found;
    std::uint32_t const end = paths.last;
    for (; paths.first < end; paths.first += kTogether) {
        paths.last = std::min(end - paths.first, kTogether) + paths.first;
        std::vector<LightVertex> const some = vertices(paths);
        for (GridLevel& level : trace.levels) level.reached[std::size_t(part)].add(some);
        std::uint64_t const number = stream + paths.first;
        reflect_photons(view(world_), some, settings_.seed + paths.pass + (number << 32), found);
    }
    return found;
}

void PhotonSets::trace_from_lights(Trace const& trace, int part)
{
    LightPaths paths = light_paths_of(part, trace);
    if (trace.levels.size() > 1) {
        GridLevel const& fine = trace.levels[0];
        paths.focus = fine.bounds;
        paths.grid_side = [&, blocks = fine.blocks.view(), patches = fine.patches.view()](vec3 position,
                                                                                          std::uint32_t triangle) {
            if (patch_at(blocks, patches, position, triangle) == kNoCell) return GridSide::outside;
            return triangle < first_moving_ ? GridSide::inside_still : GridSide::inside_moving;
        };
    }
    from_lights_[std::size_t(part)] = trace_part(trace, part, paths, 0, [&](LightPaths const& some) {
        return trace_light_paths(view(world_), world_.bounds, trace.rays, some, trace.counts);
    });
}

/// Light that enters a fine grid, from the sky and from what the coarse one holds by now.
void PhotonSets::trace_inner(Trace const& trace, int first_part, int end_part)
{
    if (trace.levels.size() < 2) return;
    GridLevel &fine = trace.levels[0], &coarse = trace.levels[1];
    std::vector<ReflectedPhoton> outside;
    append(from_lights_, outside);
    WorldView const world = view(world_);
    move_photons(world, first_moving_, outside);
    make_radiance_grid(outside, !world.environment_radiance.empty(), RadianceBy::normal, coarse);
    InnerWorld const inner{world,
                           trace.visibility,
                           fine.blocks.view(),
                           fine.patches.view(),
                           coarse.blocks.view(),
                           coarse.patches.view(),
                           coarse.grids.patches};
    if (!inner_paths_) {
        inner_paths_.emplace(std::span(fine.samples).first(fine.fixed_samples),
                             count_shown_sides(world_, trace.visibility, trace.views, inner.fine,
                                               inner.fine_patches, 2 * fine.patches.count()));
        LightPaths first = light_paths_of(0, trace);
        first.count = first.last = std::min(light_paths_, 1u << 16);
        inner_paths_->learn(inner, first, trace.counts);
    }
    for (int part = first_part; part < end_part; ++part)
        from_inside_[std::size_t(part)] =
            trace_part(trace, part, light_paths_of(part, trace), 1u << 25, [&](LightPaths const& some) {
                return trace_from_surfaces(world, trace.rays, inner_paths_->trace(inner, some, trace.counts), some,
                                           trace.counts);
            });
}

/// Traces parts first_part to end_part - 1.
void PhotonSets::trace_parts(Trace const& trace, int first_part, int end_part)
{
    for (int part = first_part; part < end_part; ++part) {
        for (GridLevel& level : trace.levels) {
            level.reached.resize(std::size_t(parts()), ReachedSides(level.blocks.frame));
            if (sets_ == 0) level.reached[std::size_t(part)] = ReachedSides(level.blocks.frame);
        }
        trace_from_lights(trace, part);
    }
    trace_inner(trace, first_part, end_part);
}

void PhotonSets::trace_all(Trace const& trace)
{
    trace_parts(trace, 0, parts());
    parts_left_ = 0;
    ++sets_;
}

void PhotonSets::begin_parts(bool first_set)
{
    if (first_set) sets_ = 0;
    parts_left_ = parts();
}

void PhotonSets::trace_next(Trace const& trace)
{
    trace_parts(trace, next_part_, next_part_ + 1);
    next_part_ = (next_part_ + 1) % parts();
    if (--parts_left_ == 0) ++sets_;
}

std::vector<ReflectedPhoton> PhotonSets::photons() const
{
    std::vector<ReflectedPhoton> all;
    append(from_lights_, all);
    append(from_inside_, all);
    move_photons(view(world_), first_moving_, all);
    return all;
}

} // namespace gi
