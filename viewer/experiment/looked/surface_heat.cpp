#include "viewer/experiment/looked/surface_heat.h"

#include "gi/core/file.h"
#include "study/gaze/heat_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fmt/format.h>

namespace viewer {
namespace {

template <class T>
void append(std::string& to, T value)
{
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    to.append(bytes, sizeof value);
}

} // namespace

double SurfaceHeat::density(std::size_t t) const
{
    gi::vec3 const* const c = &corners[3 * t];
    double const area = 0.5 * double(glm::length(glm::cross(c[1] - c[0], c[2] - c[0])));
    return area > 0 ? seconds[t] / area : 0;
}

double SurfaceHeat::most() const
{
    double most = 0;
    for (std::size_t t = 0; t < seconds.size(); ++t) most = std::max(most, density(t));
    return most;
}

void write_heat_ply(std::filesystem::path const& file, SurfaceHeat const& heat)
{
    double const most = heat.most();
    std::string text = fmt::format("ply\nformat binary_little_endian 1.0\ncomment seconds of gaze, {}\n"
                                   "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
                                   "element face {}\nproperty list uchar uint vertex_indices\n"
                                   "property float seconds\nproperty float seconds_per_m2\n"
                                   "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n",
                                   heat.scene, heat.corners.size(), heat.seconds.size());
    for (gi::vec3 const& c : heat.corners)
        for (int a = 0; a < 3; ++a) append(text, heat.origin[a] + double(c[a]));
    for (std::size_t t = 0; t < heat.seconds.size(); ++t) {
        append(text, std::uint8_t(3));
        for (std::uint32_t k = 0; k < 3; ++k) append(text, std::uint32_t(3 * t + k));
        double const density = heat.density(t);
        append(text, float(heat.seconds[t]));
        append(text, float(density));
        std::array<unsigned char, 3> const grey{90, 90, 90};
        for (unsigned char const c : heat.seconds[t] > 0 && most > 0 ? study::heat_color(density / most) : grey)
            append(text, c);
    }
    gi::write_text(file, text);
}

} // namespace viewer
