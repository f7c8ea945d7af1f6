#include "gi/raster/triangle_soup.h"

#include "gi/base/huge_pages.h"

#include <tbb/parallel_for.h>

namespace gi {

TriangleSoup make_soup(World const& world)
{
    TriangleSoup soup;
    soup.count = world.triangles.size();
    std::size_t const padded = (soup.count + TriangleSoup::kPadding - 1) / TriangleSoup::kPadding * TriangleSoup::kPadding;
    for (auto& values : soup.corner) resize_on_huge_pages(values, padded);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, soup.count, 4096), [&](auto const& range) {
        for (std::size_t t = range.begin(); t != range.end(); ++t)
            for (glm::length_t k = 0; k < 3; ++k) {
                vec3 const p = world.positions[world.triangles[t][k]];
                for (glm::length_t c = 0; c < 3; ++c) soup.corner[std::size_t(3 * k + c)][t] = p[c];
            }
    });
    return soup;
}

} // namespace gi
