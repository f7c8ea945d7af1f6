#include "gi/methods/sh_grid/field.h"

#include "gi/core/rng.h"
#include "gi/hit_buffers/directions/direction_map.h"

#include <algorithm>

namespace gi {

FieldDirections::FieldDirections(int count, int degree, std::uint32_t turned)
    : all(std::size_t(count), FieldDirection{})
{
    glm::dmat3 turn{1};
    if (turned > 0) { // columns: a random frame, turned by a random angle
        Pcg32 rng(turned, 0xf1e1d);
        double const z = 1 - 2 * rng.uniform_double(), around = 2 * kPiD * rng.uniform_double();
        double const level = std::sqrt(std::max(0.0, 1 - z * z));
        Frame const frame = Frame::about(vec3(dvec3{level * std::cos(around), level * std::sin(around), z}));
        double const angle = 2 * kPiD * rng.uniform_double(), c = std::cos(angle), s = std::sin(angle);
        dvec3 const a(frame.tangent), b(frame.bitangent);
        turn = {c * a + s * b, c * b - s * a, dvec3(frame.normal)};
    }
    double const golden = kPiD * (3 - std::sqrt(5.0));
    for (int i = 0; i < count; ++i) {
        double const y = 1 - (2 * i + 1) / double(count), r = std::sqrt(std::max(0.0, 1 - y * y)),
                     phi = golden * i;
        FieldDirection& d = all[std::size_t(i)];
        d.direction = glm::normalize(vec3(turn * dvec3{r * std::cos(phi), y, r * std::sin(phi)}));
        spherical_harmonics(d.direction, degree, d.harmonics);
    }
    // Lobes as wide as a texel, and wide enough to hold some directions.
    float const narrow = std::min(60.0f, 0.15f * float(count));
    firsts.push_back(0);
    for (int texel = 0; texel < FieldCell::kNear * FieldCell::kNear; ++texel) {
        vec2 const at{float(texel % FieldCell::kNear) + 0.5f, float(texel / FieldCell::kNear) + 0.5f};
        vec3 const about = direction_from_octahedral(at / float(FieldCell::kNear));
        float sum = 0;
        std::size_t const first = weights.size();
        for (std::uint32_t k = 0; k < all.size(); ++k) {
            float const weight = std::exp(narrow * (glm::dot(about, all[k].direction) - 1));
            if (weight < 0.02f) continue;
            weights.push_back({k, weight});
            sum += weight;
        }
        for (std::size_t k = first; k < weights.size(); ++k) weights[k].weight /= sum;
        firsts.push_back(std::uint32_t(weights.size()));
    }
}

PackedTint packed(vec3 tint)
{
    PackedTint out;
    float const largest = max_component(tint);
    if (!(largest > 1e-30f)) {
        for (std::uint8_t& m : out.mantissa) m = 0;
        return out;
    }
    int exponent = 0;
    std::frexp(std::min(largest, 1e30f), &exponent); // 2^exponent is above it
    out.exponent = std::int8_t(exponent - 8);
    for (int k = 0; k < 3; ++k)
        out.mantissa[k] = std::uint8_t(std::min(std::round(std::ldexp(tint[k], 8 - exponent)), 255.0f));
    return out;
}

std::vector<std::uint32_t> cells_near_surfaces(SparseCells<BlockVoxels> const& blocks)
{
    GridFrame const& frame = blocks.frame;
    std::vector<std::uint32_t> all;
    for (std::uint32_t const cell : blocks.cells)
        for (int k = 0; k < 27; ++k) {
            glm::ivec3 const c = frame.cell_of(cell) + glm::ivec3{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
            if (frame.holds(c)) all.push_back(frame.index(c));
        }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

} // namespace gi
