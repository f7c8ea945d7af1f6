#include "gi/raster/triangle_soup.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

TriangleSoup make_soup(World const& world)
{
    TriangleSoup soup;
    soup.count = world.triangles.size();
    std::size_t const padded =
        (soup.count + TriangleSoup::kPadding - 1) / TriangleSoup::kPadding * TriangleSoup::kPadding;
    for (auto& values : soup.corner) values.resize(padded);
    soup.chunks.resize((soup.count + TriangleSoup::kChunk - 1) / TriangleSoup::kChunk);
    tbb::parallel_for(std::size_t(0), soup.chunks.size(), [&](std::size_t chunk) {
        std::size_t const first = chunk * TriangleSoup::kChunk;
        Bounds& bounds = soup.chunks[chunk];
        for (std::size_t t = first; t < std::min(first + TriangleSoup::kChunk, soup.count); ++t)
            for (glm::length_t k = 0; k < 3; ++k) {
                vec3 const p = world.positions[world.triangles[t][k]];
                for (glm::length_t c = 0; c < 3; ++c) soup.corner[std::size_t(3 * k + c)][t] = p[c];
                bounds.low = glm::min(bounds.low, p);
                bounds.high = glm::max(bounds.high, p);
            }
    });
    return soup;
}

} // namespace gi
