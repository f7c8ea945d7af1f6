#include "gi/methods/photons/photon_lattice.h"

#include "gi/core/error.h"
#include "gi/kernel/stoppable_launch.h"
#include "gi/methods/photons/lattice_kernels.h"
#include "gi/methods/photons/photon_cell_kernels.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

void find_pieces(World const& world, std::size_t begin, std::size_t last, GridFrame const& exposure,
                 BuildStop const& stop, PhotonLattices::Cascade& cascade)
{
    constexpr std::size_t kTogether = std::size_t(1)
                                      << 18; // of triangles, which bounds the memory of their pieces
    // A cell is a block of 4 x 4 x 4 voxels if it is larger than those of the exposure, else a voxel.
    bool const large = cascade.frame.cell > exposure.cell;
    GridFrame blocks = cascade.frame;
    if (!large) {
        blocks.cell *= 4;
        blocks.size = (blocks.size + 3) / 4;
    }
    for (std::size_t first = begin; first < last; first += kTogether) {
        VoxelGrid grid{SparseCells<BlockVoxels>(blocks), {}};
        add_triangles(world, first, std::min(last, first + kTogether), grid, stop);
        for (SurfacePiece const& p : grid.pieces) {
            glm::ivec3 c = blocks.cell_of(grid.blocks.cells[p.block]);
            if (!large) c = 4 * c + glm::ivec3{p.voxel % 4, p.voxel / 4 % 4, p.voxel / 16};
            if (!cascade.frame.holds(c)) continue;
            glm::ivec3 const e = glm::clamp(exposure.at(p.point), glm::ivec3{0}, exposure.size - 1);
            cascade.pieces.push_back({cascade.cells.place_at(c), exposure.index(e), p.area * p.normal});
        }
    }
}

void forget_moving(PhotonLattices::Cascade& cascade)
{
    cascade.pieces.resize(cascade.still_pieces);
    for (std::size_t i = cascade.still_cells; i < cascade.cells.cells.size(); ++i)
        cascade.cells.place[cascade.cells.cells[i]] = kNoCell;
    cascade.cells.cells.resize(cascade.still_cells);
    cascade.cells.values.resize(cascade.still_cells);
    cascade.areas.clear();
}

} // namespace

double surface_area(World const& world)
{
    double sum = 0;
    for (Surface const& s : world.surfaces) {
        double const area = 0.5 * double(glm::length(glm::cross(s.edge1, s.edge2)));
        sum += std::isfinite(area) ? area : 0;
    }
    return sum;
}

PhotonLattices::PhotonLattices(PhotonLatticeSettings const& settings) : settings_(settings)
{
    for (int const cells : settings.cells)
        if (cells < 4 || cells > PhotonLatticeSettings::kMostCells || settings.cascades < 0 ||
            settings.cascades > PhotonLatticeSettings::kMostCascades)
            throw InputError(fmt::format("{} nested lattices of {} cells a side", settings.cascades, cells),
                             fmt::format("0 (by what is shown) to {} of 4 to {} are supported",
                                         PhotonLatticeSettings::kMostCascades, PhotonLatticeSettings::kMostCells),
                             "choose others");
}

std::uint64_t PhotonLattices::bytes(PhotonLatticeSettings const& s, Bounds const& bounds, double area_m2)
{
    if (bounds.empty()) return 0;
    std::uint64_t sum = 0;
    for (int const cells : s.cells)
        for (GridFrame const& f : frames_off_walls(bounds, bounds.center(), cells, std::max(s.cascades, 1)))
            sum += sparse_bytes(f, area_m2, 2 * sizeof(PhotonCell) + 2 * sizeof(Cascade::Piece));
    return sum;
}

PhotonLatticeSettings PhotonLattices::placed(PhotonLatticeSettings s, World const& world, Bounds const& focus)
{
    if (s.cascades > 0) return s;
    s.cascades = nested_cascades(world.bounds, focus, s.kMostCascades);
    while (s.cascades > 1 && bytes(s, world.bounds, surface_area(world)) > kMostBytes) --s.cascades;
    return s;
}

void PhotonLattices::place(World const& world, ExactVisibility const& visibility, LatticePlace const& where,
                           BuildStop const& stop)
{
    if (world.bounds.empty()) {
        for (auto& cascades : cascades_) cascades.clear();
        return;
    }
    sky_shines_ = world.environment != nullptr;
    PhotonLatticeSettings const s = placed(settings_, world, where.focus);
    vec3 const center = settings_.cascades > 0 ? where.camera : center_of(where.focus, world.bounds.center());
    std::array<std::vector<GridFrame>, 3> frames;
    bool stays = where.only_moved;
    for (std::size_t k = 0; k < 3; ++k) {
        frames[k] = frames_off_walls(world.bounds, center, s.cells[k], s.cascades);
        stays = stays && std::ranges::equal(frames[k], cascades_[k], same, {}, &Cascade::frame);
    }
    if (!stays) {
        exposed_.clear();
        for (GridFrame const& f : exposure_frames(world.bounds, center, s.cascades))
            exposed_.emplace_back(world, f, where.first_moving, visibility, stop);
        return place_anew(world, where.first_moving, frames, stop);
    }
    for (ExposedSides& e : exposed_) e.moved(world, where.first_moving, visibility, stop);
    std::size_t const triangles = world.triangles.size();
    for (auto& cascades : cascades_)
        for (std::size_t i = 0; i < cascades.size(); ++i) {
            forget_moving(cascades[i]);
            find_pieces(world, std::min(where.first_moving, triangles), triangles, exposed_[i].frame(), stop,
                        cascades[i]);
        }
}

void PhotonLattices::place_anew(World const& world, std::size_t first_moving,
                                std::array<std::vector<GridFrame>, 3> const& frames, BuildStop const& stop)
{
    std::size_t const triangles = world.triangles.size();
    first_moving = std::min(first_moving, triangles);
    for (std::size_t k = 0; k < 3; ++k) {
        cascades_[k].clear();
        for (std::size_t i = 0; i < frames[k].size(); ++i) {
            Cascade& cascade = cascades_[k].emplace_back();
            cascade.frame = frames[k][i];
            cascade.cells = SparseCells<PhotonCell>(cascade.frame);
            find_pieces(world, 0, first_moving, exposed_[i].frame(), stop, cascade);
            cascade.still_pieces = cascade.pieces.size();
            cascade.still_cells = cascade.cells.cells.size();
            find_pieces(world, first_moving, triangles, exposed_[i].frame(), stop, cascade);
        }
    }
}

void PhotonLattices::inject(Cascade& cascade, ExposedSides const& exposed, std::span<Photon const* const> photons,
                            bool last, Flux& sums, BuildStop const& stop)
{
    std::size_t const n = photons.size(), cells = cascade.cells.values.size();
    if (cascade.areas.empty()) {
        std::vector<vec4> areas(cells, vec4{0});
        for (Cascade::Piece const& p : cascade.pieces) {
            if (stop.given_up()) throw Interrupted();
            float const area = glm::length(p.area);
            if (!(area > 0)) continue;
            vec3 const normal = p.area / area;
            for (float const side : {1.0f, -1.0f}) {
                std::uint32_t const k = ReachedSides::side_index(side * normal, side > 0);
                float const lit = area * exposed.share(p.exposure_cell, k);
                areas[p.place] += lit * vec4(1, side * normal.x, side * normal.y, side * normal.z);
            }
        }
        cascade.areas = std::move(areas);
    }
    std::ranges::fill(cascade.cells.values, PhotonCell{});
    for (std::size_t i = 0; i < cells; ++i) cascade.cells.values[i].area = cascade.areas[i];
    std::vector<LatticePhoton> items(n);
    std::vector<vec3> positions(n);
    for (std::size_t i = 0; i < n; ++i) {
        items[i] = {photons[i]->flux, photons[i]->from, photons[i]->normal, 0};
        positions[i] = photons[i]->position;
    }
    std::vector<std::uint64_t> keys(n);
    launch_host(n, FindPhotonCells{cascade.cells.view(), positions, items, keys, last}, stop);
    for (std::size_t i = 0; last && i < n; ++i) {
        double const flux = double(glm::dot(items[i].flux, vec3{1}));
        (keys[i] < cells ? sums.injected_w : sums.lost_w) += flux;
    }
    if (stop.given_up()) throw Interrupted();
    ItemsByCell const sorted = sort_by_cell(keys, cells);
    launch_host(cells,
                SumItems<LatticePhoton, PhotonCell>{items, sorted.order, sorted.firsts, cascade.cells.values},
                stop);
}

void PhotonLattices::spread(Cascade& cascade, Frequency f, BuildStop const& stop)
{
    std::vector<PhotonCell> next(cascade.cells.values.size());
    if (settings_.smooth[std::size_t(f)]) {
        launch_host(next.size(), SmoothCells<PhotonCell>{cascade.cells.view(), cascade.cells.cells, next}, stop);
        std::swap(cascade.cells.values, next);
    }
    for (int step = 0; f != Frequency::high && step < settings_.gathers; ++step) {
        launch_host(next.size(), GatherCells<PhotonCell>{cascade.cells.view(), cascade.cells.cells, next}, stop);
        std::swap(cascade.cells.values, next);
    }
}

void PhotonLattices::dim_small_areas(Cascade& cascade, bool last, Flux& sums)
{
    float const least = PhotonLatticeSettings::kLeastArea * square(cascade.frame.cell);
    for (PhotonCell& c : cascade.cells.values) {
        if (!(c.area.x > 0) || !(c.area.x < least)) continue;
        float const by = c.area.x / least;
        if (last) sums.dimmed_w += double(1 - by) * double(glm::dot(c.received.integral(), vec3{1}));
        c.arrived *= vec3{by};
        c.received *= vec3{by};
    }
}

void PhotonLattices::see_photons(std::span<Photon const> photons, BuildStop const& stop)
{
    for (std::size_t i = 0; i < exposed_.size(); ++i)
        if (exposed_[i].add(photons, sky_shines_, stop))
            for (auto& cascades : cascades_) cascades[i].areas.clear();
}

void PhotonLattices::update(std::span<Photon const> photons, BuildStop const& stop)
{
    diffuse_ = {};
    if (cascades_[0].empty()) return;
    see_photons(photons, stop);
    std::vector<Photon const*> once, more;
    for (Photon const& p : photons)
        if (p.scatterings > 0 && all_finite(p.flux)) (p.scatterings == 1 ? once : more).push_back(&p);
    inject(Frequency::low, more, diffuse_, stop);
    inject(Frequency::middle, once, diffuse_, stop);
}

void PhotonLattices::update_caustics(std::span<Photon const> photons, BuildStop const& stop)
{
    caustics_ = {};
    if (cascades_[0].empty()) return;
    std::vector<Photon const*> caustics;
    for (Photon const& p : photons)
        if (p.scatterings == 0 && p.by_delta && all_finite(p.flux)) caustics.push_back(&p);
    if (!caustics.empty()) see_photons(photons, stop);
    inject(Frequency::high, caustics, caustics_, stop);
}

void PhotonLattices::inject(Frequency f, std::span<Photon const* const> photons, Flux& sums, BuildStop const& stop)
{
    std::vector<Cascade>& cascades = cascades_[std::size_t(f)];
    for (std::size_t i = 0; i < cascades.size(); ++i) {
        bool const last = i + 1 == cascades.size();
        inject(cascades[i], exposed_[i], photons, last, sums, stop);
        spread(cascades[i], f, stop);
        dim_small_areas(cascades[i], last, sums);
    }
}

/// Number of cells whose photons count together in one: the reciprocal of the sum of the squares of their weights.
float PhotonLattices::cells_together(Frequency f) const
{
    // Of a random walk of n steps over a surface with a variance of 2/7 per step and axis: 4 pi 2/7 n.
    float const gathered = f == Frequency::high ? 1 : 1 + 3.6f * float(settings_.gathers);
    return settings_.smooth[std::size_t(f)] ? 27 : gathered;
}

template <class Function>
void PhotonLattices::for_cells_at(Frequency f, vec3 position, Function const& of) const
{
    constexpr float kEnough = 16; // photons: a finer lattice then counts by a half
    std::vector<Cascade> const& cascades = cascades_[std::size_t(f)];
    float const together = cells_together(f);
    float left = 1;
    for (std::size_t k = 0; k < cascades.size() && left > 0; ++k) {
        bool const last = k + 1 == cascades.size();
        float weight = last ? 1 : weight_in(cascades[k].frame, position);
        PhotonCell const cell =
            weight > 0 ? trilinear<PhotonCell>(cascades[k].cells.view(), position) : PhotonCell{};
        if (!last && weight > 0) {
            PhotonCell const coarser = trilinear<PhotonCell>(cascades[k + 1].cells.view(), position);
            float const expected =
                coarser.area.x > 0 ? together * coarser.photons * cell.area.x / coarser.area.x : 0;
            weight *= expected / (expected + kEnough);
        }
        if (weight > 0) of(cell, left * weight);
        left -= left * weight;
    }
}

vec3 PhotonLattices::irradiance(Frequency of, vec3 position, vec3 normal) const
{
    vec3 sum{0};
    for_cells_at(of, position, [&](PhotonCell const& cell, float weight) {
        sum += weight * cell_irradiance(cell, normal, settings_.by);
    });
    return sum;
}

vec3 PhotonLattices::radiance(Frequency of, vec3 position, vec3 direction) const
{
    vec3 sum{0};
    for_cells_at(of, position, [&](PhotonCell const& cell, float weight) {
        if (cell.area.x > 0) sum += weight * glm::max(evaluate(cell.arrived, direction) / cell.area.x, vec3{0});
    });
    return sum;
}

} // namespace gi
