// The kernels of the lattices on host and device against plain loops.

#include "gi/core/rng.h"
#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/methods/photons/lattice_kernels.h"
#include "gi/methods/photons/light_propagation.h"
#include "gi/methods/photons/photon_cell_kernels.h"
#include "gi/methods/photons/propagation_kernels.h"
#include "tests/support/on_device.h"

namespace gi::test {
namespace {

vec3 random_vector(Pcg32& rng) { return vec3{rng.uniform(), rng.uniform(), rng.uniform()}; }
vec3 random_direction(Pcg32& rng) { return glm::normalize(random_vector(rng) - 0.5f + 1e-4f); }

ShColor random_light(Pcg32& rng)
{
    ShColor light;
    light.add_cosine_lobe(random_vector(rng), random_direction(rng));
    light.add_beam(random_vector(rng), random_direction(rng));
    return light;
}

void expect_same(ShColor const& a, ShColor const& b)
{
    for (int k = 0; k < 4; ++k) ASSERT_LT(max_component(glm::abs(a.c[k] - b.c[k])), 1e-4f);
}

template <class T, Space S>
View<T const> read(Buffer<T, S> const& b)
{
    return b.view();
}

template <Space S>
void check_propagation()
{
    Pcg32 rng(7, 1);
    GridFrame const frame{.low = vec3{-1}, .cell = 0.25f, .size = {8, 7, 6}};
    GridFrame const coarse{.low = vec3{-2}, .cell = 0.5f, .size = {8, 8, 8}};
    GridFrame corners = frame;
    corners.low -= 0.5f * frame.cell;
    corners.size += 1;
    std::vector<ShColor> lights(frame.cells()), around(coarse.cells());
    for (std::size_t i = 0; i < lights.size(); i += 1 + i % 3) lights[i] = random_light(rng);
    for (ShColor& light : around) light = random_light(rng);
    std::vector<Blocker> blocked(corners.cells());
    for (Blocker& b : blocked) b.area = 0.8f * random_vector(rng);
    auto const on_lights = upload<S>(lights), on_around = upload<S>(around);
    auto const on_blocked = upload<S>(blocked);
    Buffer<vec3, S> scales(lights.size()), open(corners.cells());
    Buffer<ShColor, S> moved(lights.size()), total = upload<S>(lights);
    launch(S, "scale faces of cells", lights.size(), ScaleFaces{read(on_lights), scales.view()});
    launch(S, "open faces of cells", corners.cells(), OpenFaces{corners, read(on_blocked), open.view()});
    for (Reprojection const by : {Reprojection::beams, Reprojection::cosine_lobes}) {
        launch(S, "propagate light", lights.size(),
               Propagate{{frame, read(on_lights)},
                         read(scales),
                         corners,
                         read(open),
                         {coarse, read(on_around)},
                         by,
                         moved.view(),
                         total.view()});
        std::vector<ShColor> const found = download(moved);
        // Light that each cell receives: the sum over its neighbours of the flux between them.
        std::vector<vec3> const is_open = download(open);
        for (std::size_t i = 0; i < lights.size(); ++i) {
            glm::ivec3 const at = frame.cell_of(std::uint32_t(i));
            ShColor expected;
            for (int axis = 0; axis < 3; ++axis)
                for (int sign = -1; sign <= 1; sign += 2) {
                    glm::ivec3 from = at, face = at;
                    from[axis] -= sign;
                    face[axis] += sign > 0 ? 0 : 1;
                    ShColor const light =
                        frame.holds(from)
                            ? lights[frame.index(from)]
                            : 0.25f * trilinear<ShColor>(DenseView<ShColor>{coarse, around}, frame.center(from));
                    for (int side = 0; side < 5; ++side)
                        add_through_face(by,
                                         is_open[corners.index(face)][axis] * face_scale(light) *
                                             glm::max(face_flux(light, axis, float(sign), side), vec3{0}),
                                         axis, float(sign), side, expected);
                }
            expect_same(found[i], expected);
        }
    }
}
LIGHTWELL_TEST_BOTH(LatticeKernels, Propagation, check_propagation);

template <Space S>
void check_photons()
{
    Pcg32 rng(9, 1);
    SparseCells<PhotonCell> cells(GridFrame{.low = vec3{0}, .cell = 0.1f, .size = {10, 10, 10}});
    for (int k = 0; k < 300; ++k) {
        vec4 const area(1, 0.9f * random_direction(rng));
        cells.at(glm::ivec3(10.0f * random_vector(rng))).area += area;
    }
    std::size_t const n = 2000;
    std::vector<vec3> positions;
    std::vector<LatticePhoton> photons;
    for (std::size_t i = 0; i < n; ++i) {
        positions.push_back(random_vector(rng));
        photons.push_back({random_vector(rng), random_direction(rng), random_direction(rng), 0});
    }
    auto const place = upload<S>(cells.place), of_values = upload<S>(cells.cells);
    auto values = upload<S>(cells.values);
    auto on_photons = upload<S>(photons);
    auto const on_positions = upload<S>(positions);
    CellsView<PhotonCell> const on{cells.frame, read(place), read(values)};
    Buffer<std::uint64_t, S> keys(n);
    launch(S, "find cells of photons", n, FindPhotonCells{on, read(on_positions), on_photons.view(), keys.view()});
    std::vector<std::uint64_t> found = download(keys);
    photons = download(on_photons);
    std::vector<PhotonCell> expected = cells.values;
    for (std::size_t i = 0; i < n; ++i) {
        std::uint32_t const own = cells.view().find_place(cells.frame.at(positions[i]));
        if (found[i] == kNoCell) {
            EXPECT_EQ(own, kNoCell);
            continue;
        }
        vec4 const a = cells.values[found[i]].area;
        float const facing = a.x + glm::dot(vec3(a.y, a.z, a.w), photons[i].normal);
        EXPECT_GT(facing, 0);
        if (own != kNoCell && found[i] != own) {
            vec4 const b = cells.values[own].area;
            EXPECT_LT(b.x + glm::dot(vec3(b.y, b.z, b.w), photons[i].normal), 2e-3f * b.x);
        }
        photons[i].add_to(expected[found[i]]);
    }
    ItemsByCell const sorted = sort_by_cell(found, cells.values.size());
    auto const order = upload<S>(sorted.order), firsts = upload<S>(sorted.firsts);
    launch(S, "inject photons", cells.values.size(),
           SumItems<LatticePhoton, PhotonCell>{read(on_photons), read(order), read(firsts), values.view()});
    std::vector<PhotonCell> const summed = download(values);
    Buffer<PhotonCell, S> smoothed(summed.size());
    launch(S, "smooth lattice", summed.size(), SmoothCells<PhotonCell>{on, read(of_values), smoothed.view()});
    std::vector<PhotonCell> const smooth = download(smoothed);
    for (std::size_t i = 0; i < summed.size(); ++i) {
        for (int k = 0; k < 4; ++k)
            ASSERT_LT(max_component(glm::abs(summed[i].received.c[k] - expected[i].received.c[k])), 1e-3f);
        glm::ivec3 const at = cells.frame.cell_of(cells.cells[i]);
        vec3 mean{0};
        for (std::size_t j = 0; j < summed.size(); ++j) {
            glm::ivec3 const away = glm::abs(cells.frame.cell_of(cells.cells[j]) - at);
            if (glm::max(away.x, glm::max(away.y, away.z)) <= 1) mean += summed[j].arrived.c[0] / 27.0f;
        }
        ASSERT_LT(max_component(glm::abs(smooth[i].arrived.c[0] - mean)), 1e-3f);
    }
    // Gathering: a cell exchanges a seventh with each neighbour that shares a face. Sums over cells are conserved.
    Buffer<PhotonCell, S> on_gathered(summed.size());
    launch(S, "gather in lattice", summed.size(),
           GatherCells<PhotonCell>{on, read(of_values), on_gathered.view()});
    std::vector<PhotonCell> const gathered = download(on_gathered);
    double before = 0, after = 0, area_before = 0, area_after = 0, moved = 0;
    for (std::size_t i = 0; i < summed.size(); ++i) {
        glm::ivec3 const at = cells.frame.cell_of(cells.cells[i]);
        vec3 flux = summed[i].received.c[0];
        for (std::size_t j = 0; j < summed.size(); ++j) {
            glm::ivec3 const away = glm::abs(cells.frame.cell_of(cells.cells[j]) - at);
            if (away.x + away.y + away.z == 1) flux += (summed[j].received.c[0] - summed[i].received.c[0]) / 7.0f;
        }
        ASSERT_LT(max_component(glm::abs(gathered[i].received.c[0] - flux)), 1e-3f);
        before += double(summed[i].received.c[0].x);
        after += double(gathered[i].received.c[0].x);
        area_before += double(summed[i].area.x);
        area_after += double(gathered[i].area.x);
        moved += double(std::abs(gathered[i].received.c[0].x - summed[i].received.c[0].x));
    }
    EXPECT_NEAR(after / before, 1, 1e-5);
    EXPECT_NEAR(area_after / area_before, 1, 1e-5);
    EXPECT_GT(moved, 0.1 * before);
}
LIGHTWELL_TEST_BOTH(LatticeKernels, Photons, check_photons);

} // namespace
} // namespace gi::test
