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

MotionVectors::MotionVectors(World const& world) : world_(world), now_(corners_of(world, first_moving()))
{
    earlier_.first_moving = first_moving();
}

void MotionVectors::changed(Changes const& changes)
{
    if (!changes.geometry) return;
    if (earlier_.corners.empty()) earlier_.corners = std::move(now_);
    now_ = corners_of(world_, first_moving());
}

void MotionVectors::see(std::span<FrameView const> views)
{
    std::size_t const known = std::min(views_.size(), views.size());
    views_.resize(views.size());
    for (std::size_t k = 0; k < views.size(); ++k) {
        FrameView const& v = views[k];
        View& own = views_[k];
        bool const same = k < known && own.width == v.width && own.height == v.height;
        own.now = camera_rays(v.camera, v.width, v.height, world_.origin);
        if (!same) own.earlier = own.now;
        own.width = v.width;
        own.height = v.height;
        own.hits.assign(std::size_t(v.width) * std::size_t(v.height), {});
    }
}

void MotionVectors::add(std::size_t view, Picture& picture) const
{
    View const& own = views_[view];
    if (own.now.orthographic) return;
    std::size_t const width = std::size_t(own.width);
    auto const seen = [&](std::size_t y, std::span<SeenPoint> row) {
        for (std::size_t x = 0; x < width; ++x) {
            auto const [triangle, weights] = own.hits[y * width + x];
            if (triangle == kNoTriangle) continue;
            uvec3 const v = world_.triangles[triangle];
            Corners const corners{world_.positions[v.x], world_.positions[v.y], world_.positions[v.z]};
            row[x] = {triangle, weights, point_on(corners, weights)};
        }
    };
    add_motion(seen, own.now, own.earlier, earlier_, picture);
}

void MotionVectors::end_frame()
{
    earlier_.corners.clear();
    for (View& v : views_) v.earlier = v.now;
}

} // namespace gi
