#include "ar/calibration/calibration_file.h"
#include "ar/camera/camera_model.h"
#include "ar/scene/proxy_mesh.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/motion/vertex_normals.h"

#include <cctype>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace viewer {
namespace {

cv::Mat decoded_exr(std::filesystem::path const& file)
{
    gi::Picture const picture = gi::read_exr(file);
    // Channels without a layer, Z or Y, are read as "color"; several of them are colours, and no depths.
    for (char const* name : {"depth", "Z", "Y", "color"})
        if (gi::Layer const* const layer = picture.find(name); layer && layer->channels == 1) {
            cv::Mat map(picture.height, picture.width, CV_32FC1);
            for (std::size_t i = 0; i < picture.pixels(); ++i)
                map.ptr<float>()[i] = layer->data[i * std::size_t(layer->channels)];
            return map;
        }
    throw gi::InputError("'" + file.string() + "' has no layer 'depth', 'Z' or 'Y' of one channel",
                         "the depth channel cannot be identified",
                         "write a file whose only channel without a layer is Z or Y, or name it depth.V");
}

cv::Mat decoded_png(std::filesystem::path const& file)
{
    auto const bad = [&](std::string const& problem) {
        return gi::InputError("'" + file.string() + "' " + problem, "depth maps have one channel of 16 bits",
                              "save it as PNG of 16 bits, or as EXR in metres");
    };
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(1) << 30);
    cv::Mat map;
    try {
        map = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    } catch (cv::Exception const&) {
        throw bad("cannot be decoded");
    }
    if (map.empty()) throw bad("cannot be decoded");
    if (map.type() != CV_16UC1) throw bad(fmt::format("has pixels of {}", cv::typeToString(map.type())));
    map.convertTo(map, CV_32F);
    return map;
}

/// Converts to metres; 0 and non-finite values: no surface.
cv::Mat depths_of(ProxyDepth const& depth)
{
    std::string ending = depth.file.extension().string();
    for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
    bool const is_exr = ending == ".exr";
    cv::Mat const map = is_exr ? decoded_exr(depth.file) : decoded_png(depth.file);
    double const metres = depth.metres_per_unit > 0 ? depth.metres_per_unit : is_exr ? 1 : 1e-3;
    return map * metres;
}

ar::CameraModel camera_of(ProxyDepth const& depth, cv::Size size)
{
    ar::CameraModel const camera = ar::read_calibration(depth.camera).camera;
    glm::ivec2 const map_px(size.width, size.height);
    if (camera.size_px == map_px) return camera;
    if (std::abs(double(camera.size_px.x) * map_px.y - double(camera.size_px.y) * map_px.x) > camera.size_px.x)
        throw gi::InputError(fmt::format("'{}' has {} x {} pixels", depth.file.string(), map_px.x, map_px.y),
                             fmt::format("the calibration '{}' is of {} x {}, another shape",
                                         depth.camera.string(), camera.size_px.x, camera.size_px.y),
                             "use the calibration of the picture that the depth map belongs to");
    return ar::scaled(camera, map_px);
}

} // namespace

gi::Mesh mesh_of(ProxyDepth const& depth, gi::Report& report)
{
    cv::Mat const map = depths_of(depth);
    ar::CameraModel const camera = camera_of(depth, map.size());
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
            auto const direction = ar::direction_of(camera, {x, y});
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

} // namespace viewer
