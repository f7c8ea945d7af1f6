#include "ar/features/point_grid.h"

#include <algorithm>
#include <cmath>

namespace ar {

std::size_t PointGrid::Hash::operator()(Cell const& c) const
{
    std::uint64_t h = 0;
    for (std::int64_t const v : c) {
        h = (h ^ std::uint64_t(v)) * 0x9e3779b97f4a7c15u;
        h ^= h >> 32;
    }
    return std::size_t(h);
}

PointGrid::Cell PointGrid::cell_of(glm::dvec3 const& at, int level)
{
    constexpr double kFar = 4e18; // within 64 bits
    Cell c{};
    for (int k = 0; k < 3; ++k)
        c[std::size_t(k)] = std::int64_t(std::clamp(std::floor(std::ldexp(at[k], -level)), -kFar, kFar));
    return c;
}

void PointGrid::add(glm::dvec3 const& at)
{
    for (auto& [level, cells] : levels_) cells[cell_of(at, level)].push_back(points_.size());
    points_.push_back(at);
}

void PointGrid::move(std::size_t index, glm::dvec3 const& to)
{
    for (auto& [level, cells] : levels_) {
        Cell const before = cell_of(points_[index], level), now = cell_of(to, level);
        if (before == now) continue;
        std::erase(cells[before], index);
        cells[now].push_back(index);
    }
    points_[index] = to;
}

std::vector<std::size_t> PointGrid::near(glm::dvec3 const& at, double radius)
{
    int level = 0;
    std::frexp(radius, &level); // radius < 2^level
    auto const [known, is_new] = levels_.try_emplace(level);
    Level& cells = known->second;
    if (is_new)
        for (std::size_t k = 0; k < points_.size(); ++k) cells[cell_of(points_[k], level)].push_back(k);
    std::vector<std::size_t> found;
    Cell const low = cell_of(at - radius, level), high = cell_of(at + radius, level);
    for (std::int64_t z = low[2]; z <= high[2]; ++z)
        for (std::int64_t y = low[1]; y <= high[1]; ++y)
            for (std::int64_t x = low[0]; x <= high[0]; ++x)
                if (auto const cell = cells.find({x, y, z}); cell != cells.end())
                    for (std::size_t const k : cell->second)
                        if (glm::length(points_[k] - at) <= radius) found.push_back(k);
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace ar
