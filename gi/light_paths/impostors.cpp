#include "gi/light_paths/impostors.h"

#include "gi/core/error.h"
#include "gi/kernel/launch.h"
#include "gi/light_paths/impostor_places.h"
#include "gi/light_paths/memory_limit.h"

#include <algorithm>
#include <fmt/format.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Turns what the rasteriser drew into texels of an impostor. @param keep_nearer  existing texels stay if they are
/// nearer  @param face  in blocks
void store_face(PerspectiveGrid const& grid, std::span<NearestTexel const> drawn, bool keep_nearer,
                std::span<ImpostorTexel> face)
{
    constexpr int kBlock = ImpostorsView::kBlock;
    auto const n = int(grid.width);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            NearestTexel const texel = drawn[std::size_t(j * n + i)];
            ImpostorTexel now;
            if (texel.primitive != kNoPrimitive && texel.key > 0) {
                now.distance = glm::length(grid.direction(std::uint32_t(i), std::uint32_t(j))) / texel.key;
                now.triangle = texel.primitive;
            }
            ImpostorTexel& out = face[std::size_t((j / kBlock * (n / kBlock) + i / kBlock) * kBlock * kBlock +
                                                  j % kBlock * kBlock + i % kBlock)];
            if (!keep_nearer || now.distance < out.distance) out = now;
        }
}

/// Item = block.
struct BoundBlocks {
    std::span<ImpostorTexel const> texels;
    std::span<ImpostorBlock> blocks;

    void operator()(std::size_t k) const
    {
        constexpr std::size_t kTexels = std::size_t(ImpostorsView::kBlock) * ImpostorsView::kBlock;
        ImpostorBlock out;
        for (ImpostorTexel const& texel : texels.subspan(k * kTexels, kTexels)) {
            out.nearest = glm::min(out.nearest, texel.distance);
            out.farthest = glm::max(out.farthest, texel.distance);
        }
        blocks[k] = out;
    }
};

} // namespace

std::uint32_t impostor_resolution(int texels)
{
    constexpr int kBlock = ImpostorsView::kBlock;
    return std::uint32_t((texels + kBlock - 1) / kBlock * kBlock);
}

std::uint64_t impostor_bytes(int count, int texels, bool moves)
{
    std::uint64_t const side = impostor_resolution(texels), all = std::uint64_t(count) * 6 * side * side;
    return all * sizeof(ImpostorTexel) * (moves ? 2 : 1) +
           all / (ImpostorsView::kBlock * ImpostorsView::kBlock) * sizeof(ImpostorBlock);
}

void check_impostors(PhotonSettings const& settings, bool moves)
{
    check_bytes(impostor_bytes(impostor_count(settings), settings.impostor_texels, moves), "distance impostors",
                settings.impostor_places.empty() ? "choose fewer --impostors or --impostor-texels"
                                                 : "choose fewer --impostor-places or --impostor-texels");
}

float impostor_near(World const& world, vec3 centre)
{
    float const coordinates =
        glm::max(world.bounds.radius(),
                 glm::max(max_component(glm::abs(centre)), max_component(glm::abs(world.bounds.center()))));
    return glm::max(1e-6f * coordinates, 1e-20f);
}

Impostors::Impostors(World const& world, std::vector<vec3> centres, std::uint32_t resolution, std::uint32_t seed,
                     std::size_t first_moving, BuildStop const& stop)
    : centres_(std::move(centres)),
      resolution_(resolution),
      seed_(seed),
      soup_(make_soup(world)),
      cut_outs_(world),
      first_moving_(std::min(first_moving, world.triangles.size()))
{
    constexpr std::uint32_t kFinest = 4096;
    constexpr std::uint32_t kBlock = ImpostorsView::kBlock;
    if (resolution < kBlock || resolution > kFinest || resolution % kBlock != 0)
        throw InputError(fmt::format("impostors of {} texels along an edge are not possible", resolution),
                         "their faces have 8 to 4096, in steps of 8", "choose such a resolution");
    for (vec3 const c : centres_)
        if (!all_finite(c) || !(max_component(glm::abs(c)) < kFarthest))
            throw InputError(fmt::format("an impostor cannot be at ({}, {}, {})", c.x, c.y, c.z),
                             "its centre must be finite", "give a point of the scene");
    texels_.resize(centres_.size() * 6 * resolution_ * resolution_);
    draw(world, 0, first_moving_, false, stop);
    if (first_moving_ == soup_.count) return;
    still_ = texels_;
    draw(world, first_moving_, soup_.count, true, stop);
}

void Impostors::moved(World const& world)
{
    if (first_moving_ == soup_.count) return;
    update_soup(world, first_moving_, soup_);
    texels_ = still_;
    draw(world, first_moving_, soup_.count, true, BuildStop(nullptr));
}

void Impostors::draw(World const& world, std::size_t first, std::size_t last, bool keep_nearer,
                     BuildStop const& stop)
{
    std::size_t const face = std::size_t(resolution_) * resolution_;
    tbb::parallel_for(std::size_t(0), 6 * centres_.size(), [&](std::size_t k) {
        BorrowedFragments fragments;
        static thread_local NearestMap map;
        if (stop.given_up()) throw Interrupted();
        vec3 const centre = centres_[k / 6];
        PerspectiveGrid const grid = cube_face(centre, int(k % 6), resolution_, impostor_near(world, centre));
        clear(map, resolution_, resolution_);
        rasterize(soup_, first, last, grid, *fragments);
        cut_outs_.remove(*fragments, grid, seed_);
        resolve(*fragments, 1, map);
        store_face(grid, map.texels, keep_nearer, {texels_.data() + k * face, face});
    });
    blocks_.resize(texels_.size() / (ImpostorsView::kBlock * ImpostorsView::kBlock));
    launch_host(blocks_.size(), BoundBlocks{texels_, blocks_});
}

} // namespace gi
