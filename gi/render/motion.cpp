#include "gi/render/motion.h"

#include "gi/scene/model/projection.h"

#include <limits>
#include <tbb/parallel_for.h>

namespace gi {

std::vector<Corners> corners_of(World const& world, std::size_t first)
{
    std::size_t const count = world.triangles.size();
    std::vector<Corners> corners(first < count ? count - first : 0);
    tbb::parallel_for(std::size_t(0), corners.size(), [&](std::size_t k) {
        uvec3 const vertices = world.triangles[first + k];
        for (int c = 0; c < 3; ++c) corners[k][std::size_t(c)] = world.positions[vertices[c]];
    });
    return corners;
}

void add_motion(SeenRow const& seen, CameraRays const& now, CameraRays const& camera_before,
                EarlierCorners const& before, Picture& picture)
{
    std::vector<float>& out = picture.add("motion", 3).data;
    std::size_t const width = std::size_t(picture.width), height = std::size_t(picture.height);
    Projection const project_now(now), project_before(camera_before);
    tbb::parallel_for(std::size_t(0), height, [&](std::size_t y) {
        thread_local std::vector<SeenPoint> row;
        row.assign(width, {});
        seen(y, row);
        for (std::size_t x = 0; x < width; ++x) {
            float* const to = &out[3 * (y * width + x)];
            std::fill_n(to, 3, std::numeric_limits<float>::quiet_NaN());
            SeenPoint const& here = row[x];
            if (here.triangle == kNoTriangle) continue;
            vec3 there = here.position;
            if (here.triangle >= before.first_moving && !before.corners.empty())
                there = point_on(before.corners[here.triangle - before.first_moving], here.weights);
            vec3 const from = project_now(here.position), at = project_before(there);
            if (!(at.z > 0)) continue;
            to[0] = at.x - from.x;
            to[1] = at.y - from.y;
            to[2] = at.z;
        }
    });
}

} // namespace gi
