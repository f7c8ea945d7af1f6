#include "viewer/bench/shown/head_path.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/bench/shown/recorded_paths.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glm/gtc/matrix_transform.hpp>
#include <sstream>

namespace viewer {
namespace {

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

std::vector<std::string> head_path_names()
{
    std::vector<std::string> names;
    for (RecordedPath const& p : recorded_paths()) names.emplace_back(p.name);
    return names;
}

HeadPath::HeadPath(std::string const& what)
{
    auto const known = std::ranges::find(recorded_paths(), what, &RecordedPath::name);
    bool const is_known = known != recorded_paths().end();
    std::string const text = is_known ? std::string(known->csv) : gi::read_text(what);
    std::istringstream in(text);
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        std::ranges::replace(line, ',', ' ');
        std::istringstream words(line);
        Sample s;
        bool const is_whole =
            bool(words >> s.time_s >> s.pose[0] >> s.pose[1] >> s.pose[2] >> s.pose[3] >> s.pose[4]);
        bool const follows = samples_.empty() || s.time_s > samples_.back().time_s;
        if (is_whole && follows)
            samples_.push_back(s);
        else if (number > 1 && line.find_first_not_of(" \t\r") != std::string::npos)
            throw gi::InputError(fmt::format("{}:{}: no pose of a head", what, number),
                                 is_whole ? "its time is not after that of the line before"
                                          : "it has not six numbers",
                                 "time_s,x_m,y_m,z_m,yaw_deg,pitch_deg");
    }
    if (samples_.size() < 2)
        throw gi::InputError("'" + what + "' is no path of a head", "it has fewer than two poses",
                             fmt::format("give a CSV file, or {}", fmt::join(head_path_names(), ", ")));
}

gi::dmat4 HeadPath::at(double time_s) const
{
    auto const after = std::ranges::find_if(samples_, [&](Sample const& s) { return s.time_s > time_s; });
    Sample const& b = after == samples_.end() ? samples_.back() : *after;
    Sample const& a = after == samples_.begin() || after == samples_.end() ? b : *(after - 1);
    double const t = b.time_s > a.time_s ? (time_s - a.time_s) / (b.time_s - a.time_s) : 0;
    std::array<double, 5> p{};
    for (std::size_t k = 0; k < p.size(); ++k) p[k] = glm::mix(a.pose[k], b.pose[k], t);
    gi::dmat4 m = glm::translate(gi::dmat4(1), gi::dvec3(p[0], p[1], p[2]));
    m = glm::rotate(m, glm::radians(p[3]), gi::dvec3(0, 1, 0));
    return glm::rotate(m, glm::radians(p[4]), gi::dvec3(1, 0, 0));
}

bool HeadPath::moves(double time_s) const { return !(at(time_s) == at(time_s - 0.001)); }

Walker::Walker(HeadPath path, gi::Camera const& first, double fov_deg, glm::ivec2 size_px, double apart_m,
               std::optional<Stance> const& stance)
    : path_(std::move(path)),
      camera_(first),
      start_(level(first.world_from_camera)),
      size_px_(size_px),
      apart_m_(apart_m),
      has_body_(stance.has_value()),
      body_(stance)
{
    camera_.yfov_rad = glm::radians(fov_deg);
}

Viewpoint Walker::at(double time_s, double step_s, double begun_s)
{
    gi::dmat4 const head = start_ * path_.at(time_s);
    Viewpoint v;
    v.pose_s = v.display_s = begun_s + time_s;
    v.world_from_room = head;
    if (has_body_) {
        v.world_from_room = start_ * glm::translate(gi::dmat4(1), gi::dvec3(0, -kPathEyeHeight_m, 0));
        v.tracked = body_.before_desktop(glm::inverse(v.world_from_room) * head);
        body_.stand(v.tracked, v.world_from_room, step_s);
    }
    for (int e = 0; e < (apart_m_ > 0 ? 2 : 1); ++e) {
        gi::Camera c = camera_;
        c.world_from_camera =
            head * glm::translate(gi::dmat4(1), gi::dvec3((apart_m_ > 0 ? e - 0.5 : 0) * apart_m_, 0, 0));
        v.views.push_back({apart_m_ > 0 ? e == 0 ? "left eye" : "right eye" : "window", c, size_px_.x, size_px_.y,
                           e == 0 ? -1 : 0});
    }
    return v;
}

} // namespace viewer
