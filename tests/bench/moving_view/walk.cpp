#include "tests/bench/moving_view/walk.h"

#include "gi/core/error.h"

#include <algorithm>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

namespace viewer {
namespace {

std::vector<HeadSample> read_head(std::string const& file)
{
    std::ifstream in(file);
    std::vector<HeadSample> samples;
    std::string line;
    while (std::getline(in, line)) {
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        HeadSample s;
        if (words >> s.time_s >> s.pose[0] >> s.pose[1] >> s.pose[2] >> s.pose[3] >> s.pose[4])
            samples.push_back(s);
    }
    if (samples.size() < 2) throw gi::InputError("'" + file + "' has no samples", "", "give a recorded head");
    return samples;
}

gi::dmat4 head_at(std::vector<HeadSample> const& samples, double time_s)
{
    auto const after = std::ranges::find_if(samples, [&](HeadSample const& s) { return s.time_s > time_s; });
    HeadSample const& b = after == samples.end() ? samples.back() : *after;
    HeadSample const& a = after == samples.begin() || after == samples.end() ? b : *(after - 1);
    double const t = b.time_s > a.time_s ? (time_s - a.time_s) / (b.time_s - a.time_s) : 0;
    std::array<double, 5> p{};
    for (std::size_t k = 0; k < 5; ++k) p[k] = glm::mix(a.pose[k], b.pose[k], t);
    gi::dmat4 m = glm::translate(gi::dmat4(1), gi::dvec3(p[0], p[1], p[2]));
    m = glm::rotate(m, glm::radians(p[3]), gi::dvec3(0, 1, 0));
    return glm::rotate(m, glm::radians(p[4]), gi::dvec3(1, 0, 0));
}

/// The camera's place and heading, level.
gi::dmat4 level(gi::dmat4 const& camera)
{
    gi::dvec3 back(camera[2]);
    back.y = 0;
    back = glm::length(back) > 1e-6 ? glm::normalize(back) : gi::dvec3(0, 0, 1);
    gi::dmat4 m(1);
    m[0] = glm::dvec4(glm::cross(gi::dvec3(0, 1, 0), back), 0);
    m[2] = glm::dvec4(back, 0);
    m[3] = camera[3];
    return m;
}

} // namespace

Walk::Walk(Options const& o, gi::Camera const& first, std::optional<Stance> const& stance)
    : o_(o),
      samples_(read_head(o.head)),
      first_(first),
      start_(level(first.world_from_camera)),
      has_body_(!o.avatar.empty()),
      body_(stance)
{
}

bool Walk::moves(double time_s) const
{
    return !(head_at(samples_, time_s) == head_at(samples_, time_s - 0.001));
}

Viewpoint Walk::at(double time_s, double step_s)
{
    gi::dmat4 const head = start_ * head_at(samples_, time_s);
    Viewpoint v;
    v.pose_s = v.display_s = begun_s + time_s;
    v.world_from_room = head;
    if (has_body_) {
        v.world_from_room = start_ * glm::translate(gi::dmat4(1), gi::dvec3(0, -kEyeHeight_m, 0));
        v.tracked = body_.before_desktop(glm::inverse(v.world_from_room) * head);
        body_.stand(v.tracked, v.world_from_room, step_s);
    }
    for (int e = 0; e < o_.eyes; ++e) {
        gi::Camera c = first_;
        c.yfov_rad = glm::radians(o_.fov_deg);
        double const aside = o_.eyes == 1 ? 0 : (e - 0.5) * 0.063;
        c.world_from_camera = head * glm::translate(gi::dmat4(1), gi::dvec3(aside, 0, 0));
        v.views.push_back({o_.eyes == 1 ? "window"
                           : e == 0     ? "left eye"
                                        : "right eye",
                           c, o_.width, o_.height, e == 0 ? -1 : 0});
    }
    return v;
}

} // namespace viewer
