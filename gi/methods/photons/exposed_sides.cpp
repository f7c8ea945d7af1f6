#include "gi/methods/photons/exposed_sides.h"

#include <algorithm>

namespace gi {
namespace {

constexpr int kExposureCells = 48; // along the longest side
/// Shares are estimated by few rays: a share below the first counts as 0, others as at least the second.
constexpr float kLeastShare = 0.02f, kSurelyExposed = 0.2f;

} // namespace

std::vector<GridFrame> exposure_frames(Bounds const& bounds, vec3 center, int cascades)
{
    std::vector<GridFrame> frames = frames_off_walls(bounds, center, kExposureCells, cascades);
    for (GridFrame& f : frames) f.size = (f.size + 3) / 4 * 4;
    return frames;
}

ExposedSides::ExposedSides(World const& world, GridFrame const& frame, std::size_t first_moving,
                           ExactVisibility const& visibility, BuildStop const& stop)
    : frame_(frame), reached_(frame), shares_(12 * frame.cells())
{
    first_moving = std::min(first_moving, world.triangles.size());
    sample(world, 0, first_moving, visibility, stop);
    still_ = samples_.size();
    sample(world, first_moving, world.triangles.size(), visibility, stop);
}

void ExposedSides::moved(World const& world, std::size_t first_moving, ExactVisibility const& visibility,
                         BuildStop const& stop)
{
    samples_.resize(still_);
    sample(world, std::min(first_moving, world.triangles.size()), world.triangles.size(), visibility, stop);
}

void ExposedSides::sample(World const& world, std::size_t first, std::size_t last,
                          ExactVisibility const& visibility, BuildStop const& stop)
{
    constexpr std::size_t kTogether = std::size_t(1) << 18; // triangles
    GridFrame blocks = frame_;
    blocks.cell *= 4;
    blocks.size /= 4;
    std::size_t const begin = samples_.size();
    for (; first < last; first += kTogether) {
        VoxelGrid grid{SparseCells<BlockVoxels>(blocks), {}};
        add_triangles(world, first, std::min(last, first + kTogether), grid, stop);
        std::vector<std::uint32_t> patch_of;
        for (SurfacePiece const& p : grid.pieces) {
            glm::ivec3 const cell = 4 * blocks.cell_of(grid.blocks.cells[p.block]) +
                                    glm::ivec3{p.voxel % 4, p.voxel / 4 % 4, p.voxel / 16};
            patch_of.push_back(6 * frame_.index(cell) + main_axis(p.normal));
        }
        choose_samples(grid.pieces, patch_of, samples_);
    }
    look_around(world, visibility, frame_, RayWorld::all, stop, std::span(samples_).subspan(begin));
}

bool ExposedSides::add(std::span<Photon const> photons, bool sky_shines, BuildStop const& stop)
{
    for (Photon const& p : photons) {
        if (stop.given_up()) throw Interrupted();
        glm::ivec3 const cell = frame_.at(p.position);
        if (frame_.holds(cell))
            reached_.of_cell[frame_.index(cell)] |=
                std::uint16_t(1u << ReachedSides::side_index(p.normal, p.front));
    }
    std::vector<float> whole(shares_.size()), exposed(shares_.size());
    for (PatchSample const& s : samples_) {
        if (stop.given_up()) throw Interrupted();
        std::uint32_t const cell = s.patch / 6;
        for (std::size_t k = 0; k < 2; ++k) {
            vec3 const normal = k == 0 ? s.normal : -s.normal;
            std::uint32_t const side = ReachedSides::side_index(normal, k == 0);
            bool const lit = (reached_.of_cell[cell] >> side & 1) != 0;
            auto const lets_light_in = [&](std::uint32_t code) {
                if (code == PatchSample::kNear) return false;
                if (code == PatchSample::kSky) return sky_shines || lit;
                return code == PatchSample::kMirrorOrGlass || (reached_.of_cell[code / 16] >> code % 16 & 1) != 0;
            };
            whole[12 * std::size_t(cell) + side] += s.area;
            if (std::ranges::any_of(s.met[k], lets_light_in)) exposed[12 * std::size_t(cell) + side] += s.area;
        }
    }
    bool changed = false;
    hidden_m2_ = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        if (!(whole[i] > 0)) continue;
        bool const lit = (reached_.of_cell[i / 12] >> i % 12 & 1) != 0;
        float share = exposed[i] / whole[i];
        share = share < kLeastShare && !lit ? 0.0f : std::max(share, kSurelyExposed);
        changed = changed || share != shares_[i];
        shares_[i] = share;
        hidden_m2_ += double((1 - share) * whole[i]);
    }
    return changed;
}

} // namespace gi
