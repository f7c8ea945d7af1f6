#pragma once
// A tracker that sees a known motion, a network that loses and delays, a display that asks for poses; and how far
// these are from the truth.

#include "gi/core/pose.h"
#include "viewer/devices/tracking/known_walk.h"

#include <algorithm>
#include <functional>
#include <random>

namespace viewer::test {

using Motion = std::function<RoomPose(double)>;

struct Network {
    double loss = 0.1, jitter_s = 0.05; ///< delay uniform in 0..jitter_s: packets overtake each other
    double rate_hz = 60;
    double noise_m = 0.0003, noise_rad = 0.0005; ///< of the sensor, per axis
    unsigned seed = 1;
};

struct Packet {
    double sent_s = 0, arrives_s = 0;
    std::uint64_t frame = 0;
    RoomPose pose;
};

/// By the time of arrival.
inline std::vector<Packet> through(Network const& n, Motion const& motion, double seconds)
{
    std::mt19937 rng(n.seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal(0, 1);
    std::vector<Packet> packets;
    for (std::uint64_t i = 0; double(i) / n.rate_hz < seconds; ++i) {
        Packet p;
        p.frame = i;
        p.sent_s = double(i) / n.rate_hz;
        p.pose = motion(p.sent_s);
        p.pose.position += n.noise_m * gi::dvec3(normal(rng), normal(rng), normal(rng));
        p.pose.rotation =
            p.pose.rotation * gi::exp_rotation(n.noise_rad * gi::dvec3(normal(rng), normal(rng), normal(rng)));
        p.arrives_s = p.sent_s + n.jitter_s * uniform(rng);
        if (uniform(rng) >= n.loss) packets.push_back(p);
    }
    std::stable_sort(packets.begin(), packets.end(),
                     [](Packet const& a, Packet const& b) { return a.arrives_s < b.arrives_s; });
    return packets;
}

/// Errors of shown poses. Jitter: what changes from frame to frame that the motion does not (second differences of
/// the error, RMS: a constant or steadily growing error is steady).
struct Steadiness {
    double rms_mm = 0, max_mm = 0, rms_deg = 0, max_deg = 0, jitter_mm = 0, jitter_deg = 0;
    int frames = 0;
};

class SteadinessMeter {
public:
    void note(RoomPose const& shown, RoomPose const& truth)
    {
        errors_.push_back(
            {shown.position - truth.position, gi::log_rotation(glm::inverse(truth.rotation) * shown.rotation)});
    }
    Steadiness result() const
    {
        Steadiness s;
        s.frames = int(errors_.size());
        for (std::size_t i = 0; i < errors_.size(); ++i) {
            double const mm = 1e3 * glm::length(errors_[i].m), deg = glm::degrees(glm::length(errors_[i].rad));
            s.rms_mm += mm * mm;
            s.rms_deg += deg * deg;
            s.max_mm = std::max(s.max_mm, mm);
            s.max_deg = std::max(s.max_deg, deg);
            if (i < 2) continue;
            double const dm = 1e3 * glm::length(errors_[i].m - 2.0 * errors_[i - 1].m + errors_[i - 2].m);
            double const dd =
                glm::degrees(glm::length(errors_[i].rad - 2.0 * errors_[i - 1].rad + errors_[i - 2].rad));
            s.jitter_mm += dm * dm;
            s.jitter_deg += dd * dd;
        }
        double const n = std::max(1.0, double(errors_.size()));
        s.rms_mm = std::sqrt(s.rms_mm / n);
        s.rms_deg = std::sqrt(s.rms_deg / n);
        s.jitter_mm = std::sqrt(s.jitter_mm / n);
        s.jitter_deg = std::sqrt(s.jitter_deg / n);
        return s;
    }

private:
    struct Error {
        gi::dvec3 m, rad;
    };
    std::vector<Error> errors_;
};

} // namespace viewer::test
