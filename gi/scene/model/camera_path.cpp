#include "gi/scene/model/camera_path.h"

#include "gi/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <functional>

namespace gi {
namespace {

/// Position of a time: u = 0..1 between keys i and i + 1.
struct Segment {
    std::size_t i;
    double u, span_s;
};

/// Returns the rotation by the angle |v| about v.
dquat exponential(dvec3 v)
{
    double const angle = glm::length(v);
    double const scale = angle > 1e-8 ? std::sin(0.5 * angle) / angle : 0.5;
    return dquat(std::cos(0.5 * angle), v.x * scale, v.y * scale, v.z * scale);
}

/// Inverse of the above, with an angle of at most half a turn.
dvec3 logarithm(dquat q)
{
    if (q.w < 0) q = -q;
    dvec3 const v(q.x, q.y, q.z);
    double const sine = glm::length(v);
    return sine > 1e-12 ? v * (2 * std::atan2(sine, q.w) / sine) : 2.0 * v;
}

class PathCurves {
public:
    explicit PathCurves(std::vector<CameraKey> const& keys) : keys_(keys) {}

    /// Interpolates a vector of the keys along its cubic curve.
    dvec3 point(Segment s, std::function<dvec3(CameraKey const&)> const& value) const
    {
        auto const chord = [&](std::size_t i) { return (value(keys_[i + 1]) - value(keys_[i])) / span(i); };
        double const u = s.u, u2 = u * u, u3 = u2 * u;
        return (2 * u3 - 3 * u2 + 1) * value(keys_[s.i]) + (3 * u2 - 2 * u3) * value(keys_[s.i + 1]) +
               s.span_s * ((u3 - 2 * u2 + u) * velocity(s.i, chord) + (u3 - u2) * velocity(s.i + 1, chord));
    }

    /// Kim et al., equations 9 and 10: Bezier of rotations in cumulative form.
    dquat rotation(Segment s) const
    {
        auto const turn = [&](std::size_t i) {
            return logarithm(glm::conjugate(keys_[i].rotation) * keys_[i + 1].rotation) / span(i);
        };
        dvec3 const leave = velocity(s.i, turn) * (s.span_s / 3),
                    arrive = velocity(s.i + 1, turn) * (s.span_s / 3);
        dquat const a = keys_[s.i].rotation, b = keys_[s.i + 1].rotation;
        dvec3 const middle = logarithm(exponential(-leave) * glm::conjugate(a) * b * exponential(-arrive));
        double const u = s.u, v = 1 - u;
        return glm::normalize(a * exponential(leave * (1 - v * v * v)) *
                              exponential(middle * (u * u * (3 - 2 * u))) * exponential(arrive * (u * u * u)));
    }

    /// Cubic in log tan(fov / 2), between the values of the two keys (Fritsch and Butland 1984: velocities are
    /// harmonic means, and zero at a turning point).
    double field_of_view(Segment s) const
    {
        auto const zoom = [&](std::size_t i) { return std::log(std::tan(0.5 * *keys_[i].fov_rad)); };
        auto const chord = [&](std::size_t i) { return (zoom(i + 1) - zoom(i)) / span(i); };
        auto const inner = [&](std::size_t i) {
            double const a = chord(i - 1), b = chord(i), wa = span(i - 1) + 2 * span(i),
                         wb = 2 * span(i - 1) + span(i);
            return a * b > 0 ? (wa + wb) / (wa / b + wb / a) : 0.0;
        };
        std::size_t const last = keys_.size() - 1;
        bool const from_end = s.i == 0, to_end = s.i + 1 == last;
        double const c = chord(s.i);
        double const arrive = to_end ? from_end ? c : 1.5 * c - 0.5 * inner(s.i) : inner(s.i + 1);
        double const leave = from_end ? 1.5 * c - 0.5 * arrive : inner(s.i);
        double const u = s.u, v = 1 - u;
        return 2 * std::atan(std::exp(v * v * (1 + 2 * u) * zoom(s.i) + u * u * (3 - 2 * u) * zoom(s.i + 1) +
                                      s.span_s * u * v * (v * leave - u * arrive)));
    }

private:
    using Chord = std::function<dvec3(std::size_t)>;

    double span(std::size_t i) const { return keys_[i + 1].time_s - keys_[i].time_s; }

    /// Velocity at key i, per second, from the chords per second between keys.
    dvec3 velocity(std::size_t i, Chord const& chord) const
    {
        std::size_t const last = keys_.size() - 1;
        if (last == 1) return chord(0);
        if (i == 0) return 2.0 * chord(0) - velocity(1, chord);
        if (i == last) return 2.0 * chord(last - 1) - velocity(last - 1, chord);
        return (span(i) * chord(i - 1) + span(i - 1) * chord(i)) / (span(i - 1) + span(i));
    }

    std::vector<CameraKey> const& keys_;
};

Camera make_camera(dvec3 from, dquat rotation, double fov_rad)
{
    Camera camera;
    camera.yfov_rad = fov_rad;
    camera.world_from_camera = glm::mat4_cast(rotation);
    camera.world_from_camera[3] = glm::dvec4(from, 1);
    return camera;
}

} // namespace

Camera camera_at(CameraPath const& path, double time_s, double fov_rad)
{
    std::vector<CameraKey> const& keys = path.keys;
    auto const after = std::upper_bound(keys.begin(), keys.end(), time_s,
                                        [](double t, CameraKey const& key) { return t < key.time_s; });
    bool const looks_at = std::all_of(keys.begin(), keys.end(), [](CameraKey const& k) { return bool(k.at); });
    CameraKey const& key = after == keys.begin() ? keys.front() : *(after - 1);
    if (after == keys.begin() || after == keys.end() || time_s == key.time_s) {
        double const fov = key.fov_rad.value_or(fov_rad);
        return looks_at ? look_at(key.from, *key.at, glm::degrees(fov)) : make_camera(key.from, key.rotation, fov);
    }
    auto const i = std::size_t(after - keys.begin()) - 1;
    double const span_s = keys[i + 1].time_s - keys[i].time_s;
    Segment const s{i, (time_s - keys[i].time_s) / span_s, span_s};

    PathCurves const curves(keys);
    dvec3 const from = curves.point(s, [](CameraKey const& k) { return k.from; });
    double const fov = keys.front().fov_rad ? curves.field_of_view(s) : fov_rad;
    if (!looks_at) return make_camera(from, curves.rotation(s), fov);
    dvec3 const at = curves.point(s, [](CameraKey const& k) { return *k.at; });
    try {
        return look_at(from, at, glm::degrees(fov));
    } catch (InputError const&) {
        throw InputError(fmt::format("the camera path has no direction at {} s", time_s),
                         "the camera passes through the point that it looks at", "add a key there");
    }
}

} // namespace gi
