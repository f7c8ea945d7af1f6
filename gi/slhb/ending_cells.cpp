#include "gi/slhb/ending_cells.h"

#include "gi/base/rng.h"

#include <bit>
#include <cmath>

namespace gi {
namespace {

/// Widest cell over its distance from the eye; the narrowest of the same level is half of that.
constexpr float kWidth = 0.1f;
/// Nearer than that over the size of the world, cells get no smaller.
constexpr float kNear = 1e-4f;

std::uint64_t joined_bits(std::uint64_t key, std::uint64_t value) { return mix_bits(key ^ value); }

/// Which of the six sides of a cube a normal points through.
std::uint64_t side_of(vec3 n)
{
    vec3 const a = glm::abs(n);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return std::uint64_t(2 * axis + (n[axis] < 0 ? 1 : 0));
}

} // namespace

EndingCells::EndingCells(World const& world, vec3 eye, std::uint32_t pass)
    : world_(view(world)), eye_(eye), near_(kNear * world.bounds.radius())
{
    // The additive recurrence of the plastic number in three dimensions (Roberts 2018).
    constexpr double kStep[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    for (int c = 0; c < 3; ++c) shift_[c] = float(std::fmod(kStep[c] * pass, 1.0));
}

std::uint64_t EndingCells::key(Ending const& e) const
{
    Surface const& s = world_.surfaces[e.triangle];
    vec3 normal = glm::cross(s.edge1, s.edge2);
    if (glm::dot(normal, e.arrival) > 0) normal = -normal;
    float const distance = std::max(near_, glm::length(e.position - eye_));
    int const level = std::ilogb(kWidth * distance);
    vec3 const place = glm::floor(e.position * std::ldexp(1.0f, -level) + shift_);
    std::uint64_t key = std::uint64_t(s.material) << 16 | std::uint64_t(level + 1024) << 3 | side_of(normal);
    for (int c = 0; c < 3; ++c) key = joined_bits(key, std::bit_cast<std::uint32_t>(place[c]));
    return key;
}

} // namespace gi
