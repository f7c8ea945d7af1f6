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
    out.cell_of_patch = of.geometry().patches.cell_of_patch;
    return out;
}

} // namespace

IndirectField::IndirectField(World const& world, RenderSettings const& settings, std::size_t first_moving,
                             Report& report, StopRequest const* stop)
    : world_(world),
      settings_(settings),
      first_moving_(std::min(first_moving, world.triangles.size())),
      report_(report),
      stop_(stop)
{
}

void IndirectField::changed(Changes const& c)
{
    surfaces_changed_ = surfaces_changed_ || c.geometry || c.bounds;
    materials_changed_ = materials_changed_ || c.materials;
    coverage_changed_ = coverage_changed_ || c.coverage;
    light_changed_ = light_changed_ || c.geometry || c.bounds || c.materials || c.coverage || c.lights ||
                     c.emitters || c.environment || c.light_select;
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
    Bounds const focus = focus_of(points);
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
        level.fixed.voxels = empty_voxel_grid(box, settings_.sh_grid.voxels);
        add_triangles(world_, 0, first_moving_, level.fixed.voxels, stop);
        look_around(world_, visibility, level.fixed.voxels, 0, RayWorld::what_stays, stop,
                    level.fixed.surroundings);
        if (first_moving_ == world_.triangles.size())
            level.fixed.patches = find_patches(world_, level.fixed.voxels);
    }
    if (fits) levels.push_back(std::move(levels_.back()));
    levels_ = std::move(levels);
    only_smooth_ = only_smooth();
    surfaces_changed_ = light_changed_ = update_all_ = true;
}

void IndirectField::find_moving_surfaces(ExactVisibility const& visibility, BuildStop const& stop)
{
    StageTimer const timer(report_, "voxels");
    if (first_moving_ == world_.triangles.size()) return;
    for (GridLevel& level : levels_) {
        level.moving = level.fixed;
        VoxelGrid& voxels = level.moving->voxels;
        add_triangles(world_, first_moving_, world_.triangles.size(), voxels, stop);
        look_around(world_, visibility, voxels, level.fixed.voxels.pieces.size(), RayWorld::all, stop,
                    level.moving->surroundings);
        level.moving->patches = find_patches(world_, voxels);
    }
}

void IndirectField::trace_photons(ExactVisibility const& visibility, BuildStop const& stop, PathCounts& counts)
{
    StageTimer const timer(report_, "photons");
    LightPaths paths{.count = std::uint32_t(settings_.sh_grid.photons),
                     .bounces = std::min(settings_.sh_grid.reflections, settings_.bounces),
                     .seed = settings_.seed,
                     .pass = *first_index_ + photon_sets_, // the same photons in every frame: no flicker
                     .stop = &stop};
    if (levels_.size() > 1) paths.focus = levels_[0].bounds;
    photons_.clear();
    if (photon_sets_ == 0)
        for (GridLevel& level : levels_) {
            level.reached.emplace(level.geometry().voxels.blocks.frame);
            level.lit.assign(2 * level.geometry().patches.count(), 0);
        }
    constexpr std::uint32_t kTogether = 1 << 16; // bounds the memory of vertices
    for (paths.first = 0; paths.first < paths.count; paths.first += kTogether) {
        paths.last = std::min(paths.count - paths.first, kTogether) + paths.first;
        auto const vertices = trace_light_paths(view(world_), world_.bounds, visibility, paths, counts);
        for (GridLevel& level : levels_) {
            level.reached->add(vertices);
            CellsView<BlockVoxels> const blocks = level.geometry().voxels.blocks.view();
            PatchesView const patches = level.geometry().patches.view();
            for (VirtualLight const& v : vertices) {
                std::uint32_t const patch = patch_at(blocks, patches, v.position, v.triangle);
                if (patch != kNoCell) level.lit[2 * patch + (v.front ? 0 : 1)] = 1;
            }
        }
        reflect_photons(vertices, settings_.seed + paths.pass + (std::uint64_t(paths.first) << 32), photons_);
    }
    ++photon_sets_;
}

void IndirectField::make_radiance_grids()
{
    StageTimer const timer(report_, "radiance grids");
    for (GridLevel& level : levels_) {
        GridLevel::Geometry const& g = level.geometry();
        auto const areas =
            exposed_areas(g.voxels, g.patches, g.surroundings, *level.reached, level.lit, sky_shines(), by());
        level.hidden_m2 = areas.hidden_m2;
        level.grids = gi::make_radiance_grids(g.voxels.blocks, g.patches, areas, photons_, by());
    }
    stored_ = dvec3{0};
    for (Photon const& p : photons_) stored_ += dvec3(p.flux);
}

/// Cells where surfaces are now; those that stay keep their values. Of a coarse level, those deep in the fine one
/// are not needed.
void IndirectField::place_cells(GridLevel& level)
{
    SparseCells<BlockVoxels> const& blocks = level.geometry().voxels.blocks;
    GridFrame const& frame = blocks.frame;
    Field old = std::move(level.field);
    level.field = {SparseCells<FieldCell>(frame), settings_.sh_grid.degree};
    level.new_cells.clear();
    Bounds const fine = levels_.front().bounds;
    for (std::uint32_t const cell : cells_near_surfaces(blocks)) {
        vec3 const center = frame.center(frame.cell_of(cell)), around = vec3{3 * frame.cell};
        if (&level != &levels_.front() && holds(fine, {center - around, center + around})) continue;
        std::uint32_t const place = level.field.cells.place_at(frame.cell_of(cell)),
                            before = old.cells.place.empty() ? kNoCell : old.cells.place[cell];
        if (before == kNoCell)
            level.new_cells.push_back(place);
        else
            level.field.cells.values[place] = old.cells.values[before];
    }
}

void IndirectField::update_cells(ExactVisibility const& visibility, int part, int parts, BuildStop const& stop,
                                 PathCounts& counts)
{
    StageTimer const timer(report_, "spherical-harmonics field");
    ShGridSettings const& s = settings_.sh_grid;
    FieldDirections const directions(s.directions, s.degree, *first_index_ + updates_);
    std::size_t const n = directions.all.size();
    std::vector<FieldTarget> targets;
    for (GridLevel const& level : levels_)
        targets.push_back({level.geometry().voxels.blocks.view(), level.geometry().patches.view()});
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
        update(visibility, views, BuildStop(stop_), counts);
    } catch (Interrupted const&) {
        if (!has_field_) throw;
    }
}

void IndirectField::update(ExactVisibility const& visibility, std::span<FrameView const> views,
                           BuildStop const& stop, PathCounts& counts)
{
    place_levels(visibility, views, stop);
    int const parts = settings_.sh_grid.field_passes;
    if (surfaces_changed_ || light_changed_) {
        photon_sets_ = updates_ = calls_at_rest_ = 0;
        if (surfaces_changed_) find_moving_surfaces(visibility, stop);
        trace_photons(visibility, stop, counts);
        make_radiance_grids();
        if (surfaces_changed_)
            for (GridLevel& level : levels_) place_cells(level);
        parts_left_ = update_all_ ? 1 : parts;
        surfaces_changed_ = light_changed_ = false;
    } else if (parts_left_ == 0 && ++calls_at_rest_ >= 4 && std::has_single_bit(calls_at_rest_)) {
        // A field costs as much as many passes.
        trace_photons(visibility, stop, counts);
        make_radiance_grids();
        parts_left_ = 1;
        update_all_ = true;
        ++updates_;
    }
    if (parts_left_ == 0) return;
    update_cells(visibility, update_all_ ? 0 : next_part_, update_all_ ? 1 : parts, stop, counts);
    next_part_ = (next_part_ + 1) % parts;
    --parts_left_;
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
        report_.count(grid + ": voxels with surfaces", double(level.geometry().voxels.voxels()));
        report_.count(grid + ": cells with surfaces", double(level.geometry().voxels.blocks.values.size()));
        report_.count(grid + ": cells of the field", double(level.field.cells.values.size()));
        report_.count(grid + ": flux held, W (luminance)", watt(level.grids.flux()));
        report_.count(grid + ": flux of photons without a surface in it, W (luminance)", watt(level.grids.lost));
        report_.count(grid + ": area that no light can reach, both sides, m^2", level.hidden_m2);
    }
    if (levels_.empty()) return;
    report_.count("photons of the last set", double(photons_.size()));
    report_.count("sets of photons", double(photon_sets_));
    report_.count("flux of the photons, W (luminance)", watt(stored_));
}

} // namespace gi
