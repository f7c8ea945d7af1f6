#include "gi/methods/sh_grid/indirect_field.h"

#include "gi/kernel/launch.h"
#include "gi/methods/sh_grid/field_kernels.h"
#include "gi/methods/sh_grid/field_rays.h"

#include <algorithm>
#include <bit>

namespace gi {
namespace {

constexpr double kLeastShown = 0.9; ///< share of what is shown that a fine grid holds before it is placed anew

RadianceLevels to_levels(GridLevel const& of)
{
    RadianceLevels out;
    RadianceGrids const& grids = of.grids;
    out.count = std::min(grids.levels.size(), RadianceLevels::kMost);
    for (std::size_t k = 0; k < out.count; ++k) out.level[k] = grids.levels[k].view();
    out.cells = grids.levels[0].cells;
    out.patches = grids.patches;
    out.cell_of_patch = of.patches.cell_of_patch;
    return out;
}

std::vector<Photon> all_of(std::vector<std::vector<Photon>> const& parts)
{
    std::vector<Photon> all;
    for (std::vector<Photon> const& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

} // namespace

IndirectField::IndirectField(World const& world, RenderSettings const& settings, std::size_t first_moving,
                             Report& report, StopRequest const* stop)
    : world_(world),
      settings_(settings),
      first_moving_(std::min(first_moving, world.triangles.size())),
      report_(report),
      stop_(stop),
      voxels_(settings.sh_grid.voxels),
      light_paths_(std::uint32_t(settings.sh_grid.photons))
{
}

void IndirectField::changed(Changes const& c)
{
    surfaces_changed_ = surfaces_changed_ || c.geometry || c.bounds;
    materials_changed_ = materials_changed_ || c.materials;
    coverage_changed_ = coverage_changed_ || c.coverage;
    light_changed_ = light_changed_ || c.materials || c.coverage || c.lights || c.emitters || c.environment;
}

/// Materials that only mirror and refract, as far as no texture changes them: their triangles are in no grid.
std::vector<bool> IndirectField::only_smooth() const
{
    std::vector<bool> out;
    for (Material const& m : world_.materials) out.push_back(only_delta(make_bsdf(m)));
    return out;
}

/// Places the grids, unless those that are there will do.
void IndirectField::place_levels(ExactVisibility const& visibility, std::span<FrameView const> views,
                                 BuildStop const& stop)
{
    if (coverage_changed_ || (materials_changed_ && only_smooth() != only_smooth_)) levels_.clear();
    coverage_changed_ = materials_changed_ = false;
    bool const fits = !levels_.empty() && holds(levels_.back().bounds, world_.bounds);
    bool const same_cameras = std::ranges::equal(views, cameras_, {}, &FrameView::camera);
    if (fits && same_cameras && !surfaces_changed_) return;
    cameras_.clear();
    for (FrameView const& v : views) cameras_.push_back(v.camera);
    auto const points = shown_points(world_, visibility, views);
    if (fits && points.empty()) return;
    Bounds whole = fits ? levels_.back().bounds : world_.bounds;
    if (!levels_.empty() && !fits) { // room for what moves on
        float const room = 0.25f * longest_side(whole);
        whole = {whole.low - room, whole.high + room};
    }
    Bounds const focus = focus_of(points, voxels_);
    bool const wants_two = needs_fine_grid(focus, whole);
    bool const shows =
        fits && (levels_.size() == 1 ? !wants_two
                                     : share_in(levels_[0].bounds, points) >= kLeastShown &&
                                           longest_side(levels_[0].bounds) < 3 * longest_side(focus));
    if (shows) return;
    StageTimer const timer(report_, "voxels");
    std::vector<GridLevel> levels;
    std::vector<Bounds> boxes;
    if (wants_two) boxes.push_back(focus);
    if (!fits) boxes.push_back(whole);
    for (Bounds const& box : boxes) {
        GridLevel& level = levels.emplace_back();
        level.bounds = box;
        find_fixed_surfaces(level, visibility, stop);
    }
    if (fits) levels.push_back(std::move(levels_.back()));
    levels_ = std::move(levels);
    only_smooth_ = only_smooth();
    surfaces_changed_ = light_changed_ = update_all_ = true;
}

void IndirectField::find_fixed_surfaces(GridLevel& level, ExactVisibility const& visibility, BuildStop const& stop)
{
    VoxelGrid grid = empty_voxel_grid(level.bounds, voxels_);
    add_triangles(world_, 0, first_moving_, grid, stop);
    std::vector<std::uint32_t> patch_of;
    level.patches.first_moving = std::uint32_t(first_moving_);
    level.patches.fixed = find_patches(world_, grid, level.patches, patch_of);
    choose_samples(grid.pieces, patch_of, level.samples);
    look_around(world_, visibility, grid.blocks.frame, RayWorld::what_stays, stop, level.samples);
    level.fixed_patches = level.patches.count();
    level.fixed_samples = level.samples.size();
    level.fixed_blocks = level.blocks = std::move(grid.blocks);
}

void IndirectField::find_moving_surfaces(ExactVisibility const& visibility, BuildStop const& stop)
{
    StageTimer const timer(report_, "voxels");
    if (!moves()) return;
    for (GridLevel& level : levels_) {
        VoxelGrid grid{level.fixed_blocks, {}};
        add_triangles(world_, first_moving_, world_.triangles.size(), grid, stop);
        level.patches.cell_of_patch.resize(level.fixed_patches);
        level.patches.voxels.resize(level.fixed_patches);
        level.samples.resize(level.fixed_samples);
        std::vector<std::uint32_t> patch_of;
        level.patches.moving = find_patches(world_, grid, level.patches, patch_of);
        choose_samples(grid.pieces, patch_of, level.samples);
        look_around(world_, visibility, grid.blocks.frame, RayWorld::all, stop,
                    std::span(level.samples).subspan(level.fixed_samples));
        level.blocks = std::move(grid.blocks);
    }
}

LightPaths IndirectField::light_paths_of(int part, BuildStop const& stop) const
{
    std::uint64_t const all = light_paths_, n = std::uint64_t(parts());
    return {.count = light_paths_,
            .first = std::uint32_t(all * std::uint64_t(part) / n),
            .last = std::uint32_t(all * std::uint64_t(part + 1) / n),
            .bounces = std::min(settings_.sh_grid.reflections, settings_.bounces),
            .seed = settings_.seed,
            .pass = *first_index_ + photon_sets_, // the same photons in every frame: no flicker
            .stop = &stop};
}

/// Traces a part of a set of light paths. @param part  of parts()  @param trace  (LightPaths) -> their vertices
template <class Trace>
std::vector<Photon> IndirectField::trace_part(LightPaths paths, std::uint64_t stream, Trace const& trace)
{
    constexpr std::uint32_t kTogether = 1 << 16; // bounds the memory of vertices
    std::vector<Photon> found;
    std::uint32_t const end = paths.last;
    for (; paths.first < end; paths.first += kTogether) {
        paths.last = std::min(end - paths.first, kTogether) + paths.first;
        std::vector<VirtualLight> const vertices = trace(paths);
        for (GridLevel& level : levels_) level.reached->add(vertices);
        std::uint64_t const number = stream + paths.first;
        reflect_photons(vertices, settings_.seed + paths.pass + (number << 32), found);
    }
    return found;
}

void IndirectField::trace_from_lights(ExactVisibility const& visibility, int part, BuildStop const& stop,
                                      PathCounts& counts)
{
    LightPaths paths = light_paths_of(part, stop);
    if (levels_.size() > 1) {
        paths.focus = levels_[0].bounds;
        paths.place = [&, blocks = levels_[0].blocks.view(),
                       patches = levels_[0].patches.view()](vec3 position, std::uint32_t triangle) {
            if (patch_at(blocks, patches, position, triangle) == kNoCell) return PathPlace::outside;
            return triangle < first_moving_ ? PathPlace::ends : PathPlace::inside;
        };
    }
    photons_[std::size_t(part)] = trace_part(paths, 0, [&](LightPaths const& some) {
        return trace_light_paths(view(world_), world_.bounds, visibility, some, counts);
    });
}

/// Light that enters a fine grid, from the sky and from what the coarse one holds by now.
void IndirectField::trace_inner(ExactVisibility const& visibility, int first_part, int last_part,
                                std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts)
{
    if (levels_.size() < 2) return;
    GridLevel &fine = levels_[0], &coarse = levels_[1];
    make_radiance_grid(coarse, all_of(photons_));
    InnerWorld const inner{view(world_),        visibility,           fine.blocks.view(),
                           fine.patches.view(), coarse.blocks.view(), coarse.patches.view(),
                           coarse.grids.patches};
    if (!inner_paths_) {
        inner_paths_.emplace(std::span(fine.samples).first(fine.fixed_samples),
                             count_shown_sides(world_, visibility, views, inner.fine, inner.fine_patches,
                                               2 * fine.patches.count()));
        LightPaths first = light_paths_of(0, stop);
        first.count = first.last = std::min(light_paths_, 1u << 16);
        inner_paths_->learn(inner, first, counts);
    }
    for (int part = first_part; part < last_part; ++part)
        inner_photons_[std::size_t(part)] =
            trace_part(light_paths_of(part, stop), 1u << 25, [&](LightPaths const& some) {
                return trace_from_surfaces(inner.world, visibility, inner_paths_->trace(inner, some, counts), some,
                                           counts);
            });
}

/// @param first_part, last_part  which of parts() to trace anew: all but the last
void IndirectField::trace_photons(ExactVisibility const& visibility, int first_part, int last_part,
                                  std::span<FrameView const> views, BuildStop const& stop, PathCounts& counts)
{
    StageTimer const timer(report_, "photons");
    photons_.resize(std::size_t(parts()));
    inner_photons_.resize(std::size_t(parts()));
    for (int part = first_part; part < last_part; ++part) trace_from_lights(visibility, part, stop, counts);
    trace_inner(visibility, first_part, last_part, views, stop, counts);
}

void IndirectField::trace_all_photons(ExactVisibility const& visibility, std::span<FrameView const> views,
                                      BuildStop const& stop, PathCounts& counts)
{
    if (photon_sets_ == 0) {
        for (GridLevel& level : levels_) level.reached.emplace(level.blocks.frame);
        inner_paths_.reset();
        photons_.clear();
        inner_photons_.clear();
    }
    trace_photons(visibility, 0, parts(), views, stop, counts);
    photon_parts_left_ = 0;
    ++photon_sets_;
}

/// After geometry has moved: one part per call.
void IndirectField::trace_next_photons(ExactVisibility const& visibility, std::span<FrameView const> views,
                                       BuildStop const& stop, PathCounts& counts)
{
    trace_photons(visibility, next_photon_part_, next_photon_part_ + 1, views, stop, counts);
    next_photon_part_ = (next_photon_part_ + 1) % parts();
    if (--photon_parts_left_ == 0) photon_sets_ = 1;
}

void IndirectField::make_radiance_grid(GridLevel& level, std::span<Photon const> photons)
{
    SortedPhotons const sorted = sort_photons(level.blocks, level.patches, photons);
    auto const areas = exposed_areas(level.blocks, level.patches, level.samples, *level.reached, photons, sorted,
                                     sky_shines(), by());
    level.hidden_m2 = areas.hidden_m2;
    level.grids = gi::make_radiance_grids(level.blocks, level.patches, areas, photons, sorted, by());
}

void IndirectField::make_radiance_grids()
{
    StageTimer const timer(report_, "radiance grids");
    std::vector<Photon> all = all_of(photons_);
    std::vector<Photon> const inner = all_of(inner_photons_);
    all.insert(all.end(), inner.begin(), inner.end());
    for (GridLevel& level : levels_) make_radiance_grid(level, all);
    stored_ = dvec3{0};
    for (Photon const& p : all) stored_ += dvec3(p.flux);
    photons_held_ = all.size();
}

/// Cells where surfaces are now; those that stay keep their values. Of a coarse level, those deep in the fine one
/// are not needed.
void IndirectField::place_cells(GridLevel& level)
{
    GridFrame const& frame = level.blocks.frame;
    Bounds const fine = levels_.front().bounds;
    std::vector<std::uint32_t> wanted = cells_near_surfaces(level.blocks);
    if (&level != &levels_.front())
        std::erase_if(wanted, [&](std::uint32_t cell) {
            vec3 const center = frame.center(frame.cell_of(cell)), around = vec3{3 * frame.cell};
            return holds(fine, {center - around, center + around});
        });
    constexpr std::size_t kStale = 8; // every kStale-th cell may lie where surfaces no longer are
    SparseCells<FieldCell>& cells = level.field.cells;
    level.field.degree = settings_.sh_grid.degree;
    if (cells.place.empty()) cells = SparseCells<FieldCell>(frame);
    if (cells.values.size() > wanted.size() + wanted.size() / kStale) {
        SparseCells<FieldCell> fresh(frame);
        for (std::uint32_t const cell : wanted)
            if (cells.place[cell] != kNoCell) fresh.at(frame.cell_of(cell)) = cells.values[cells.place[cell]];
        cells = std::move(fresh);
    }
    level.new_cells.clear();
    for (std::uint32_t const cell : wanted)
        if (cells.place[cell] == kNoCell) level.new_cells.push_back(cells.place_at(frame.cell_of(cell)));
}

void IndirectField::update_cells(ExactVisibility const& visibility, int part, int parts, BuildStop const& stop,
                                 PathCounts& counts)
{
    StageTimer const timer(report_, "spherical-harmonics field");
    ShGridSettings const& s = settings_.sh_grid;
    FieldDirections const directions(s.directions, s.degree, *first_index_ + updates_);
    std::size_t const n = directions.all.size();
    std::vector<FieldTarget> targets;
    for (GridLevel const& level : levels_) targets.push_back({level.blocks.view(), level.patches.view()});
    for (std::uint32_t index = 0; index < levels_.size(); ++index) {
        GridLevel& level = levels_[index];
        SparseCells<FieldCell>& cells = level.field.cells;
        std::vector<std::uint32_t> which = std::move(level.new_cells);
        level.new_cells.clear();
        std::vector<bool> listed(cells.values.size());
        for (std::uint32_t const k : which) listed[k] = true;
        // By the cell's place in the grid, which stays while cells come and go.
        for (std::uint32_t k = 0; k < cells.cells.size(); ++k)
            if (!listed[k] && int(cells.cells[k] % std::uint32_t(parts)) == part) which.push_back(k);

        auto const trace = [&](std::span<std::uint32_t const> of, std::span<FieldHit> hits) {
            if (s.field_rays == FieldRays::voxels)
                launch(Space::host, "walk voxels", of.size(),
                       WalkVoxels{targets[index].blocks,
                                  directions.all,
                                  index,
                                  {of.data(), of.size()},
                                  {hits.data(), hits.size()}});
            else
                trace_field_rays(world_, visibility, targets, cells.frame, directions.all, of, hits);
        };
        ProjectLight project{.light = {},
                             .directions = directions.all,
                             .weights = directions.weights,
                             .firsts = directions.firsts,
                             .settings = {.degree = s.degree,
                                          .multilevel = s.multilevel == Switch::on,
                                          .sky_shines = sky_shines(),
                                          .patches = s.field_rays == FieldRays::exact,
                                          .by = by(),
                                          .farthest = std::max(4.0f, s.obscurance_m / cells.frame.cell)},
                             .cell_m = cells.frame.cell,
                             .share = 1 / float(updates_ + 1),
                             .hits = {},
                             .which = {},
                             .field = cells.values};
        for (std::uint32_t k = 0; k < levels_.size(); ++k) project.light[k] = to_levels(levels_[k]);
        std::size_t const together =
            std::clamp<std::size_t>((1 << 20) / n, 16, 1024); // bounds memory, and the time to a stop
        std::vector<FieldHit> hits(std::min(together, which.size()) * n);
        std::vector<std::uint32_t> of;
        for (std::size_t first = 0; first < which.size(); first += together) {
            if (stop.given_up()) throw Interrupted();
            std::size_t const count = std::min(together, which.size() - first);
            of.clear();
            for (std::size_t k = 0; k < count; ++k) of.push_back(cells.cells[which[first + k]]);
            trace(of, {hits.data(), count * n});
            if (s.field_rays == FieldRays::exact) counts.nearest_rays += count * n;
            project.hits = hits;
            project.which = {which.data() + first, count};
            launch(Space::host, "project light", count, project);
        }
    }
}

void IndirectField::prepare(ExactVisibility const& visibility, std::uint32_t index,
                            std::span<FrameView const> views, PathCounts& counts)
{
    if (settings_.bounces < 1 || world_.light_select.empty() || world_.bounds.empty()) return levels_.clear();
    if (!first_index_) first_index_ = index;
    try {
        if (!has_field_ && settings_.budget_s > 0)
            fit_budget(visibility, views, BuildStop(stop_), counts);
        else
            update(visibility, views, BuildStop(stop_), counts);
    } catch (Interrupted const&) {
        if (!has_field_) throw;
    }
}

/// Makes coarse fields, and finer ones as long as their time, judged by that of the last, leaves half of the
/// budget to the passes.
void IndirectField::fit_budget(ExactVisibility const& visibility, std::span<FrameView const> views,
                               BuildStop const& stop, PathCounts& counts)
{
    constexpr int kFirst = 32;                      // voxels
    constexpr double kSurfaces = 1.8, kLight = 4.5; // growth of time when voxels are doubled
    ShGridSettings const& asked = settings_.sh_grid;
    double const most_s = 0.5 * settings_.budget_s;
    int doublings = 0;
    for (voxels_ = asked.voxels; voxels_ / 2 >= kFirst; voxels_ /= 2) ++doublings;
    for (;; --doublings) {
        voxels_ = asked.voxels >> doublings;
        light_paths_ = std::max(1u, std::uint32_t(asked.photons) >> 2 * doublings);
        auto const begun = Clock::now();
        update(visibility, views, stop, counts);
        double const surfaces_s = seconds_since(begun) - last_update_s_;
        // Of a moving world, most surfaces stay, and light follows in parts.
        double const next_s = moves() ? kLight * last_update_s_ / parts()
                                      : seconds_since(started_) + kSurfaces * surfaces_s + kLight * last_update_s_;
        if (doublings == 0 || next_s > most_s) return;
        levels_.clear();
        has_field_ = false;
        surfaces_changed_ = light_changed_ = update_all_ = true;
    }
}

void IndirectField::update(ExactVisibility const& visibility, std::span<FrameView const> views,
                           BuildStop const& stop, PathCounts& counts)
{
    place_levels(visibility, views, stop);
    auto const begun = Clock::now();
    if (light_changed_ || surfaces_changed_) {
        photon_sets_ = updates_ = calls_at_rest_ = 0;
        if (surfaces_changed_) find_moving_surfaces(visibility, stop);
        if (light_changed_) {
            trace_all_photons(visibility, views, stop, counts);
        } else {
            photon_parts_left_ = parts();
            trace_next_photons(visibility, views, stop, counts);
        }
        make_radiance_grids();
        if (surfaces_changed_)
            for (GridLevel& level : levels_) place_cells(level);
        parts_left_ = update_all_ ? 1 : parts();
        surfaces_changed_ = light_changed_ = false;
    } else if (photon_parts_left_ > 0) {
        trace_next_photons(visibility, views, stop, counts);
        make_radiance_grids();
        parts_left_ = parts();
    } else if (parts_left_ == 0 && ++calls_at_rest_ >= 4 && std::has_single_bit(calls_at_rest_) &&
               (moves() || !(settings_.budget_s > 0) ||
                seconds_since(started_) + last_update_s_ < settings_.budget_s)) {
        // A field costs as much as many passes.
        trace_all_photons(visibility, views, stop, counts);
        make_radiance_grids();
        parts_left_ = 1;
        update_all_ = true;
        ++updates_;
    }
    if (parts_left_ == 0) return;
    update_cells(visibility, update_all_ ? 0 : next_part_, update_all_ ? 1 : parts(), stop, counts);
    next_part_ = (next_part_ + 1) % parts();
    --parts_left_;
    if (update_all_) last_update_s_ = seconds_since(begun);
    update_all_ = false;
    has_field_ = true;
}

void IndirectField::report_counts()
{
    auto const watt = [](dvec3 v) { return double(luminance(vec3(v))); };
    for (std::size_t k = 0; k < levels_.size(); ++k) {
        GridLevel const& level = levels_[k];
        std::string const grid = levels_.size() == 1 ? "grid" : k == 0 ? "fine grid" : "coarse grid";
        report_.count(grid + ": side of a cell of the field, m", double(level.field.cells.frame.cell));
        report_.count(grid + ": voxels with surfaces", double(count_voxels(level.blocks)));
        report_.count(grid + ": cells with surfaces", double(level.blocks.values.size()));
        report_.count(grid + ": cells of the field", double(level.field.cells.values.size()));
        report_.count(grid + ": flux held, W (luminance)", watt(level.grids.flux()));
        report_.count(grid + ": flux of photons without a surface in it, W (luminance)", watt(level.grids.lost));
        report_.count(grid + ": area that no light can reach, both sides, m^2", level.hidden_m2);
    }
    if (levels_.empty()) return;
    report_.count("photons of the last set", double(photons_held_));
    report_.count("sets of photons", double(photon_sets_));
    report_.count("flux of the photons, W (luminance)", watt(stored_));
}

} // namespace gi
