#include "gi/raster/triangle_soup.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

TriangleSoup make_soup(World const& world)
{
    TriangleSoup soup;
    soup.count = world.triangles.size();
    for (auto& values : soup.corner) values.resize(soup.count + TriangleSoup::kPadding);
    soup.chunks.resize((soup.count + TriangleSoup::kChunk - 1) / TriangleSoup::kChunk);
    update_soup(world, 0, soup);
    return soup;
}

void update_soup(World const& world, std::size_t first_triangle, TriangleSoup& soup)
{
    tbb::parallel_for(first_triangle / TriangleSoup::kChunk, soup.chunks.size(), [&](std::size_t chunk) {
        std::size_t const first = chunk * TriangleSoup::kChunk;
        Bounds bounds;
        for (std::size_t t = first; t < std::min(first + TriangleSoup::kChunk, soup.count); ++t)
            for (glm::length_t k = 0; k < 3; ++k) {
                vec3 const p = world.positions[world.triangles[t][k]];
                for (glm::length_t c = 0; c < 3; ++c) soup.corner[std::size_t(3 * k + c)][t] = p[c];
                bounds.low = glm::min(bounds.low, p);
                bounds.high = glm::max(bounds.high, p);
            }
        soup.chunks[chunk] = bounds;
    });
}

} // namespace gi
