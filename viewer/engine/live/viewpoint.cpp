#include "viewer/engine/live/viewpoint.h"

#include <algorithm>

namespace viewer {
namespace {

// Velocities are measured over this time: shorter would follow noise, longer lags behind.
constexpr double kBaseline_s = 0.04, kLongest_s = 0.15;

/// @param t  0 = a, 1 = b; beyond 1 = further on
gi::RigidPose onward(gi::RigidPose const& a, gi::RigidPose const& b, double t)
{
    gi::dquat const turn = b.rotation * glm::inverse(a.rotation);
    return {a.position + t * (b.position - a.position),
            glm::normalize(gi::exp_rotation(t * gi::log_rotation(turn)) * a.rotation)};
}

bool is_rigid(gi::dmat4 const& m)
{
    gi::dmat4 const left = glm::transpose(gi::dmat4(glm::dmat3(m))) * gi::dmat4(glm::dmat3(m));
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (std::abs(left[c][r] - (c == r ? 1 : 0)) > 1e-6) return false;
    return glm::determinant(glm::dmat3(m)) > 0;
}

gi::dmat4 onward(gi::dmat4 const& a, gi::dmat4 const& b, double t)
{
    if (a == b || !is_rigid(a) || !is_rigid(b)) return b;
    auto const pose = [](gi::dmat4 const& m) {
        return gi::RigidPose{gi::dvec3(m[3]), glm::normalize(glm::quat_cast(glm::dmat3(m)))};
    };
    gi::RigidPose const p = onward(pose(a), pose(b), t);
    gi::dmat4 m(glm::mat3_cast(p.rotation));
    m[3] = glm::dvec4(p.position, 1);
    return m;
}

void move_on(Tracked const& a, Tracked& b, double t)
{
    for (auto const body : kBodyMembers)
        if (a.*body && b.*body && !(*(a.*body) == *(b.*body))) b.*body = onward(*(a.*body), *(b.*body), t);
}

void move_on(gi::Camera const& a, gi::Camera& b, double t)
{
    b.world_from_camera = onward(a.world_from_camera, b.world_from_camera, t);
    if (!a.off_axis || !b.off_axis || *a.off_axis == *b.off_axis) return;
    gi::ViewTangents const &from = *a.off_axis, to = *b.off_axis;
    gi::ViewTangents const moved{glm::mix(from.left, to.left, t), glm::mix(from.right, to.right, t),
                                 glm::mix(from.bottom, to.bottom, t), glm::mix(from.top, to.top, t)};
    if (moved.left < moved.right && moved.bottom < moved.top) b.off_axis = moved;
}

} // namespace

bool same_cameras(std::vector<ViewCommand> const& a, std::vector<ViewCommand> const& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](ViewCommand const& x, ViewCommand const& y) {
        return x.camera == y.camera && x.name == y.name;
    });
}

void Anticipation::see(Viewpoint const& now)
{
    bool const same_people = !seen_.empty() && seen_.back().others.size() == now.others.size() &&
                             std::equal(seen_.back().views.begin(), seen_.back().views.end(), now.views.begin(),
                                        now.views.end(), [](ViewCommand const& a, ViewCommand const& b) {
                                            return a.name == b.name && a.camera.name == b.camera.name &&
                                                   a.camera.off_axis.has_value() == b.camera.off_axis.has_value();
                                        });
    if (!same_people || seen_.back().jump != now.jump || jumps(now)) seen_.clear();
    seen_.push_back(now);
    while (seen_.size() > 2 && now.time_s() - seen_[1].time_s() >= kBaseline_s) seen_.pop_front();
}

/// True if a view is elsewhere than any motion would have led it: at another camera, in another scene.
bool Anticipation::jumps(Viewpoint const& now) const
{
    constexpr double kFar_m = 0.2, kTurned_rad = 0.2, kTimes = 6; // times the speed before
    if (seen_.empty() || now.views.empty()) return false;
    auto const speed = [](Viewpoint const& a, Viewpoint const& b, bool turning) {
        gi::dmat4 const &m = a.views[0].camera.world_from_camera, &n = b.views[0].camera.world_from_camera;
        double const way = turning ? glm::length(gi::dvec3(n[2]) - gi::dvec3(m[2]))
                                   : glm::length(gi::dvec3(n[3]) - gi::dvec3(m[3]));
        return std::pair{way, way / std::max(b.time_s() - a.time_s(), 1e-4)};
    };
    for (bool const turning : {false, true}) {
        auto const [way, per_s] = speed(seen_.back(), now, turning);
        double const before = seen_.size() > 1 ? speed(seen_.front(), seen_.back(), turning).second : 0;
        if (way > (turning ? kTurned_rad : kFar_m) && per_s > kTimes * before) return true;
    }
    return false;
}

Viewpoint Anticipation::at(double now_s, double time_s, double farthest_s) const
{
    Viewpoint v = seen_.empty() ? Viewpoint{} : seen_.back();
    if (seen_.size() < 2 || now_s - v.pose_s > kForgotten_s) return v;
    Viewpoint const &before = seen_.front(), &last = seen_[seen_.size() - 2];
    double const over_s = v.time_s() - before.time_s(), ahead_s = std::clamp(time_s - v.time_s(), 0.0, farthest_s);
    bool const stands = same_cameras(last.views, v.views) && last.tracked == v.tracked && last.others == v.others;
    if (stands || !(over_s > 0) || over_s > kLongest_s || !(ahead_s > 0)) return v;
    double const t = 1 + ahead_s / over_s;
    v.world_from_room = onward(before.world_from_room, v.world_from_room, t);
    move_on(before.tracked, v.tracked, t);
    for (std::size_t k = 0; k < v.others.size(); ++k) move_on(before.others[k], v.others[k], t);
    for (std::size_t k = 0; k < v.views.size(); ++k) move_on(before.views[k].camera, v.views[k].camera, t);
    return v;
}

std::vector<ViewCommand>
Anticipation::far_ahead(double now_s, double later_s,
                        std::function<double(gi::dvec3, gi::dvec3, double)> const& free_way_m) const
{
    constexpr double kFromWalls_m = 0.3;
    later_s = std::min(later_s, kFarAhead_s);
    double const least_s = std::min(later_s, kFarthest_s);
    std::vector<ViewCommand> const now = at(now_s, now_s, 0).views;
    std::vector<ViewCommand> const far = at(now_s, now_s + later_s, later_s).views;
    double share = later_s > least_s ? 1 : 0;
    for (std::size_t k = 0; k < now.size() && share > 0; ++k) {
        gi::Camera const &camera = now[k].camera, &then = far[k].camera;
        if (!(camera.off_axis == then.off_axis)) share = 0;
        gi::dmat4 const &from = camera.world_from_camera, &to = then.world_from_camera;
        gi::dvec3 const axis =
            -glm::transpose(glm::dmat3(from)) * gi::dvec3(to[2]); // of the later view, in this one
        gi::ViewTangents const edges = gi::view_edges(camera, now[k].width, now[k].height);
        auto const stay = [&](double along, double low, double high) {
            double const turn_rad = std::atan2(along, -axis.z), edge_rad = std::atan(turn_rad < 0 ? low : high);
            if (std::abs(turn_rad) > std::abs(edge_rad)) share = std::min(share, edge_rad / turn_rad);
        };
        stay(axis.x, edges.left, edges.right);
        stay(axis.y, edges.bottom, edges.top);
        gi::dvec3 const way = share * gi::dvec3(to[3] - from[3]);
        double const way_m = glm::length(way);
        if (!(way_m > 0)) continue;
        double const free_m = free_way_m(gi::dvec3(from[3]), way / way_m, way_m + kFromWalls_m) - kFromWalls_m;
        share *= std::max(0.0, free_m) / way_m;
    }
    later_s = std::max(share * later_s, least_s); // as what is shown, walls or not
    return at(now_s, now_s + later_s, later_s).views;
}

} // namespace viewer
