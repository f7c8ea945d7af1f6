#include "viewer/offline/empty_view.h"

#include "gi/scene/model/projection.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

/// A rectangle of the picture, in pixels; empty at first.
struct Extent {
    float left = INFINITY, top = INFINITY, right = -INFINITY, bottom = -INFINITY;

    bool is_empty() const { return left > right; }
    float width() const { return right - left; }
    float height() const { return bottom - top; }
};

std::string metres(gi::dvec3 p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z); }

} // namespace

void report_empty_view(gi::World const& world, gi::Camera const& camera, int width, int height, gi::Report& report)
{
    float const speck_px = std::min(width, height) < 32 ? 0.0f : 3.0f;
    gi::Projection const project(gi::camera_rays(camera, width, height, world.origin));
    Extent seen;
    for (gi::uvec3 const& triangle : world.triangles) {
        Extent of;
        int behind = 0;
        for (int k = 0; k < 3; ++k) {
            gi::vec3 const p = project(world.positions[triangle[k]]);
            behind += !camera.orthographic && !(p.z > 0);
            of = {std::min(of.left, p.x), std::min(of.top, p.y), std::max(of.right, p.x),
                  std::max(of.bottom, p.y)};
        }
        if (behind == 3) continue;
        if (behind > 0) return; // it passes the camera
        of = {std::max(of.left, 0.0f), std::max(of.top, 0.0f), std::min(of.right, float(width)),
              std::min(of.bottom, float(height))};
        if (of.left > of.right || of.top > of.bottom) continue;
        seen = {std::min(seen.left, of.left), std::min(seen.top, of.top), std::max(seen.right, of.right),
                std::max(seen.bottom, of.bottom)};
        if (seen.width() > speck_px || seen.height() > speck_px) return;
    }
    bool const is_sky = world.environment && world.scene->background.kind == gi::BackgroundKind::map;
    if (world.triangles.empty() && is_sky) return; // a picture of it was asked for
    if (world.triangles.empty()) return report.lose(std::string(kSeesNothing), 1, "the scene has no triangles");
    std::string const where = fmt::format("the scene lies from {} to {} m, the camera is at {} m",
                                          metres(world.origin + gi::dvec3(world.bounds.low)),
                                          metres(world.origin + gi::dvec3(world.bounds.high)),
                                          metres(gi::dvec3(camera.world_from_camera[3])));
    if (seen.is_empty())
        report.lose(std::string(kSeesNothing), 1, where + "; give another --camera, or --look-from and --look-at");
    else
        report.lose(std::string(kSeesSpeck), 1,
                    fmt::format("{:.0f} x {:.0f} pixels; {}: is it in metres?", std::ceil(seen.width()),
                                std::ceil(seen.height()), where));
}

} // namespace viewer
