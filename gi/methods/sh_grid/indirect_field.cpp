#include "gi/methods/sh_grid/indirect_field.h"

#include "gi/kernel/launch.h"
#include "gi/methods/sh_grid/field_kernels.h"
#include "gi/methods/sh_grid/field_rays.h"

#include <algorithm>
#include <bit>

namespace gi {
namespace {

/// A fine grid that holds less than this share of what is shown is placed again.
constexpr double kLeastShown = 0.9;

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

} // namespace

IndirectField::IndirectField(World const& world, RenderSettings const& settings, std::size_t first_moving,
                             Report& report, StopRequest const* stop)
    : world_(world),
      settings_(settings),
      first_moving_(std::min(first_moving, world.triangles.size())),
      report_(report),
      frames_(stop == nullptr),
      voxels_(settings.of<ShGridSettings>().voxels),
      light_paths_(std::uint32_t(settings.of<PhotonSettings>().paths)),
      photons_(world, settings, first_moving_),
      light_rays_(world, settings, first_moving_, report, stop)
{
}

void IndirectField::changed(Changes const& c)
{
    light_rays_.changed(c);
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
    for (Bounds const& box : boxes)
        levels.push_back(make_grid_level(world_, first_moving_, box, voxels_, visibility, stop));
    if (fits) levels.push_back(std::move(levels_.back()));
    levels_ = std::move(levels);
    only_smooth_ = only_smooth();
    surfaces_changed_ = light_changed_ = update_all_ = true;
}

void IndirectField::make_radiance_grids()
{
    StageTimer const timer(report_, "radiance grids");
    std::vector<ReflectedPhoton> const photons = photons_.photons();
    for (GridLevel& level : levels_) make_radiance_grid(photons, sky_shines(), by(), level);
    stored_ = dvec3{0};
    for (ReflectedPhoton const& p : photons) stored_ += dvec3(p.flux);
    photon_count_ = photons.size();
}

/// Cells where surfaces are now; those that stay keep their values. Of a coarse level,
/// those deep in the fine one are not needed.
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
    level.field.degree = settings_.of<ShGridSettings>().degree;
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
    ShGridSettings const& s = settings_.of<ShGridSettings>();
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
        // Bounds memory, and the time to a stop.
        std::size_t const together = std::clamp<std::size_t>((1 << 20) / n, 16, 1024);
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
                            std::span<FrameView const> views, StopRequest const* stop, PathCounts& counts)
{
    if (settings_.bounces < 1 || world_.light_select.empty() || world_.bounds.empty()) return levels_.clear();
    if (!first_index_) first_index_ = index;
    BuildStop const given_up(stop);
    Now const now{visibility, views, given_up, counts};
    try {
        if (!has_field_ && settings_.budget_s > 0)
            fit_budget(now);
        else
            update(now);
    } catch (Interrupted const&) {
        if (!has_field_ || frames()) throw;
    }
}

/// Makes coarse fields, and finer ones as long as their time, judged by that of the last, leaves half of the
/// budget to the passes.
void IndirectField::fit_budget(Now const& now)
{
    constexpr int kFirst = 32;                      // voxels
    constexpr double kSurfaces = 1.8, kLight = 4.5; // growth of time when voxels are doubled
    ShGridSettings const& asked = settings_.of<ShGridSettings>();
    double const most_s = 0.5 * settings_.budget_s;
    int doublings = 0;
    for (int v = asked.voxels; v / 2 >= kFirst; v /= 2) ++doublings;
    for (;; --doublings) {
        std::vector<GridLevel> coarser = std::move(levels_);
        auto const voxels = voxels_;
        auto const light_paths = light_paths_;
        levels_.clear();
        surfaces_changed_ = light_changed_ = update_all_ = true;
        voxels_ = asked.voxels >> doublings;
        light_paths_ = std::max(1u, std::uint32_t(settings_.of<PhotonSettings>().paths) >> 2 * doublings);
        auto const begun = Clock::now();
        try {
            update(now);
        } catch (Interrupted const&) {
            levels_ = std::move(coarser);
            voxels_ = voxels;
            light_paths_ = light_paths;
            throw;
        }
        double const surfaces_s = seconds_since(begun) - last_update_s_;
        // From frame to frame surfaces stay, and light follows in parts.
        double const next_s = frames()
                                  ? kLight * last_update_s_ / parts()
                                  : seconds_since(started_) + kSurfaces * surfaces_s + kLight * last_update_s_;
        if (doublings == 0 || next_s > most_s) return;
    }
}

/// True if the fields shall become means over more photons and directions, which takes as long as many passes.
bool IndirectField::refines_at_rest()
{
    ++calls_at_rest_;
    if (calls_at_rest_ < 4 || !std::has_single_bit(calls_at_rest_)) return false;
    return frames() || !(settings_.budget_s > 0) || seconds_since(started_) + last_update_s_ < settings_.budget_s;
}

void IndirectField::update(Now const& now)
{
    place_levels(now.visibility, now.views, now.stop);
    auto const begun = Clock::now();
    auto const trace_photons = [&](bool whole) {
        PathRays const& rays = light_rays_.of(settings_.of<PhotonSettings>().rays, now.visibility);
        StageTimer const timer(report_, "photons");
        PhotonSets::Trace const trace{levels_, now.visibility, rays, now.views, now.stop, now.counts};
        whole ? photons_.trace_all(trace) : photons_.trace_next(trace);
    };
    if (light_changed_ || surfaces_changed_) {
        updates_ = calls_at_rest_ = 0;
        if (surfaces_changed_ && moves()) {
            StageTimer const timer(report_, "voxels");
            for (GridLevel& level : levels_) find_moving_surfaces(world_, now.visibility, now.stop, level);
        }
        if (light_changed_)
            photons_.restart(light_paths_, *first_index_);
        else
            photons_.begin_parts(true);
        trace_photons(light_changed_);
        make_radiance_grids();
        if (surfaces_changed_)
            for (GridLevel& level : levels_) place_cells(level);
        parts_left_ = update_all_ ? 1 : parts();
        surfaces_changed_ = light_changed_ = false;
    } else if (photons_.parts_left() > 0) {
        trace_photons(false);
        if (updates_ == 0 || photons_.parts_left() == 0) { // means take whole sets
            make_radiance_grids();
            parts_left_ = parts();
        }
    } else if (parts_left_ == 0 && refines_at_rest()) {
        ++updates_;
        if (frames()) {
            photons_.begin_parts(false);
        } else {
            trace_photons(true);
            make_radiance_grids();
            parts_left_ = 1;
            update_all_ = true;
        }
    }
    if (parts_left_ == 0) return;
    update_cells(now.visibility, update_all_ ? 0 : next_part_, update_all_ ? 1 : parts(), now.stop, now.counts);
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
    light_rays_.report_counts();
    report_.count("photons of the last set", double(photon_count_));
    report_.count("sets of photons", double(photons_.sets()));
    report_.count("flux of the photons, W (luminance)", watt(stored_));
}

} // namespace gi
