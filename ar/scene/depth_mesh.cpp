#include "ar/calibration/calibration_file.h"
#include "ar/camera/camera_model.h"
#include "ar/scene/depth_map.h"
#include "ar/scene/proxy_mesh.h"
#include "gi/core/error.h"
#include "gi/scene/motion/vertex_normals.h"

#include <fmt/format.h>

namespace ar {
namespace {

CameraModel camera_of(ProxyDepth const& depth, cv::Size size, gi::Report& report)
{
    CameraModel const camera = read_calibration(depth.camera, std::nullopt, &report).camera;
    glm::ivec2 const map_px(size.width, size.height);
    if (camera.size_px == map_px) return camera;
    if (std::abs(double(camera.size_px.x) * map_px.y - double(camera.size_px.y) * map_px.x) > camera.size_px.x)
        throw gi::InputError(fmt::format("'{}' has {} x {} pixels", depth.file.string(), map_px.x, map_px.y),
                             fmt::format("the calibration '{}' is of {} x {}, another shape",
                                         depth.camera.string(), camera.size_px.x, camera.size_px.y),
                             "use the calibration of the picture that the depth map belongs to");
    return scaled(camera, map_px);
}

} // namespace

gi::Mesh mesh_of(ProxyDepth const& depth, gi::Report& report)
{
    cv::Mat const map = read_depth_map(depth.file, depth.metres_per_unit, &report);
    CameraModel const camera = camera_of(depth, map.size(), report);
    int const step = depth.step_px, columns = (map.cols - 1) / step + 1, rows = (map.rows - 1) / step + 1;
    gi::Mesh mesh;
    constexpr std::uint32_t kNone = ~std::uint32_t(0);
    std::vector<std::uint32_t> index(std::size_t(columns) * std::size_t(rows), kNone);
    std::vector<float> at_m; // per vertex
    std::uint64_t without = 0, beyond_lens = 0, cut = 0;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            int const x = i * step, y = j * step;
            float const z = map.at<float>(y, x);
            if (!(z > 0) || !std::isfinite(z)) {
                ++without;
                continue;
            }
            auto const direction = direction_of(camera, {x, y});
            if (!direction || !(direction->z > 1e-3)) {
                ++beyond_lens;
                continue;
            }
            index[std::size_t(j * columns + i)] = std::uint32_t(mesh.positions.size());
            mesh.positions.push_back(
                gi::vec3(depth.world_from_camera * (*direction * (double(z) / direction->z))));
            mesh.uv0.push_back({(float(x) + 0.5f) / float(map.cols), (float(y) + 0.5f) / float(map.rows)});
            at_m.push_back(z);
        }
    auto const add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (a == kNone || b == kNone || c == kNone) return;
        auto const [near, far] = std::minmax({at_m[a], at_m[b], at_m[c]});
        if (double(far) - near > depth.jump * near)
            ++cut;
        else
            mesh.triangles.push_back({a, b, c});
    };
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i + 1 < columns; ++i) {
            auto const at = [&](int x, int y) { return index[std::size_t(y * columns + x)]; };
            // Rows go down: counter-clockwise seen from the camera.
            add(at(i, j), at(i, j + 1), at(i + 1, j));
            add(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
        }
    std::string const name = depth.file.string();
    report.lose("pixels of depth maps without a depth", without, name);
    report.lose("pixels of depth maps that the lens does not see", beyond_lens, name);
    report.lose("triangles of depth maps left out at jumps", cut, name);
    if (mesh.triangles.empty())
        throw gi::InputError("'" + name + "' gives no triangle", "no neighbouring pixels have similar depths",
                             "check metres_per_unit, jump and step_px");
    mesh.normals = gi::vertex_normals(mesh.positions, mesh.triangles);
    return mesh;
}

} // namespace ar
