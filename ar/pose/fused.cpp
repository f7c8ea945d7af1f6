#include "ar/pose/fused.h"

#include "ar/pose/expected_error.h"
#include "gi/core/rotation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace ar {
namespace {

using Gain = cv::Matx<double, 12, 6>;

constexpr double kSame_m = 0.02, kSame_deg = 1; ///< poses nearer than this count as one in the confidence
constexpr double kRivalry = 0.01;

template <int rows, int columns, class M>
cv::Matx<double, rows, columns> part(M const& m, int row, int column)
{
    cv::Matx<double, rows, columns> p;
    for (int i = 0; i < rows; ++i)
        for (int j = 0; j < columns; ++j) p(i, j) = m(row + i, column + j);
    return p;
}

glm::dvec3 three(cv::Vec<double, 12> const& v, int at) { return {v[at], v[at + 1], v[at + 2]}; }

bool are_same(gi::RigidPose const& a, gi::RigidPose const& b, double m, double deg)
{
    return glm::length(a.position - b.position) < m && angle_between_deg(a.rotation, b.rotation) < deg;
}

/// Covariances of few points may be singular to rounding, and are never exact: 0.1 mm and 0.01 degrees at least.
cv::Matx66d widened(cv::Matx66d c)
{
    for (int i = 0; i < 3; ++i) c(i, i) += 1e-8;
    for (int i = 3; i < 6; ++i) c(i, i) += 3e-8;
    return c;
}

} // namespace

std::vector<PoseFusion::Measured> PoseFusion::measured(PoseEstimate const& e)
{
    double const other = std::clamp(e.other ? e.other_likelihood : 0, 1e-12, 1 - 1e-12);
    std::vector<Measured> m{{e.world_from_camera, widened(e.covariance), std::log(1 - other)}};
    if (e.other) m.push_back({*e.other, widened(e.other_covariance), std::log(other)});
    return m;
}

PoseFusion::Hypothesis PoseFusion::begun(Measured const& m, double log_weight) const
{
    Hypothesis h;
    h.pose = m.pose;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) h.covariance(i, j) = m.covariance(i, j);
    for (int i = 0; i < 3; ++i) {
        h.covariance(6 + i, 6 + i) = settings_.speed_m_s * settings_.speed_m_s;
        h.covariance(9 + i, 9 + i) = settings_.speed_rad_s * settings_.speed_rad_s;
    }
    h.log_weight = log_weight;
    return h;
}

PoseFusion::Hypothesis PoseFusion::moved(Hypothesis h, double dt) const
{
    h.pose.position += dt * h.velocity;
    glm::dquat const turn = gi::exp_rotation(dt * h.turning);
    h.pose.rotation = glm::normalize(h.pose.rotation * turn);
    Covariance f = Covariance::eye();
    glm::dmat3 const back = glm::mat3_cast(glm::conjugate(turn)); // errors are about the axes of the moved camera
    for (int i = 0; i < 3; ++i) {
        f(i, 6 + i) = f(3 + i, 9 + i) = dt;
        for (int j = 0; j < 3; ++j) f(3 + i, 3 + j) = back[j][i];
    }
    h.covariance = f * h.covariance * f.t();
    for (int i = 0; i < 6; ++i) {
        double const q = i < 3 ? settings_.acceleration : settings_.turning;
        h.covariance(i, i) += q * dt * dt * dt / 3;
        h.covariance(i, 6 + i) += q * dt * dt / 2;
        h.covariance(6 + i, i) += q * dt * dt / 2;
        h.covariance(6 + i, 6 + i) += q * dt;
    }
    return h;
}

PoseFusion::Hypothesis PoseFusion::updated(Hypothesis h, Measured const& m) const
{
    glm::dvec3 const shift = m.pose.position - h.pose.position;
    glm::dvec3 const turn = gi::log_rotation(glm::conjugate(h.pose.rotation) * m.pose.rotation);
    cv::Vec6d const innovation(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z);
    cv::Matx66d const s = part<6, 6>(h.covariance, 0, 0) + m.covariance;
    cv::Matx66d const inverse = s.inv(cv::DECOMP_CHOLESKY);
    Gain const gain = part<12, 6>(h.covariance, 0, 0) * inverse;
    cv::Vec<double, 12> const step = gain * innovation;
    h.pose.position += three(step, 0);
    h.pose.rotation = glm::normalize(h.pose.rotation * gi::exp_rotation(three(step, 3)));
    h.velocity += three(step, 6);
    h.turning += three(step, 9);
    h.covariance = h.covariance - gain * part<6, 12>(h.covariance, 0, 0);
    h.covariance = 0.5 * (h.covariance + h.covariance.t());
    double const distance = innovation.dot(inverse * innovation);
    double const log_density =
        -0.5 * (distance + std::log(std::max(1e-300, cv::determinant(s))) + 6 * std::log(2 * CV_PI));
    h.log_weight += settings_.evidence * (log_density + m.log_fit);
    return h;
}

void PoseFusion::prune()
{
    std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                     [](Hypothesis const& a, Hypothesis const& b) { return a.log_weight > b.log_weight; });
    std::vector<Hypothesis> kept;
    double const most = hypotheses_.front().log_weight;
    for (Hypothesis& h : hypotheses_) {
        h.log_weight = std::exp(h.log_weight - most); // the weight itself, below
        auto const twin = std::find_if(kept.begin(), kept.end(), [&](Hypothesis const& k) {
            return are_same(k.pose, h.pose, 0.002, 0.1) && glm::length(k.velocity - h.velocity) < 0.1 &&
                   glm::length(k.turning - h.turning) < 0.2;
        });
        if (twin != kept.end())
            twin->log_weight += h.log_weight;
        else if (kept.size() < settings_.hypotheses)
            kept.push_back(h);
    }
    double const sum = std::accumulate(kept.begin(), kept.end(), 0.0,
                                       [](double s, Hypothesis const& h) { return s + h.log_weight; });
    for (Hypothesis& h : kept) h.log_weight = std::log(std::max(1e-300, h.log_weight / sum));
    hypotheses_ = std::move(kept);
}

PoseEstimate PoseFusion::next(double time_s, PoseEstimate const& estimate)
{
    if (!estimate.found() || !std::isfinite(time_s)) return estimate;
    double const dt = time_s - last_s_;
    if (!(dt > 0 && dt <= settings_.restart_after_s)) hypotheses_.clear();
    last_s_ = time_s;
    std::vector<Measured> const all = measured(estimate);
    std::vector<Hypothesis> next;
    for (Hypothesis const& before : hypotheses_) {
        Hypothesis h = moved(before, dt);
        for (Measured const& m : all) next.push_back(updated(h, m));
        h.log_weight += settings_.evidence * std::log(settings_.outlier_density);
        next.push_back(h);
    }
    double const density = estimate.ambiguous ? settings_.ambiguous_restart_density : settings_.restart_density;
    for (Measured const& m : all)
        next.push_back(begun(m, settings_.evidence * (m.log_fit + (hypotheses_.empty() ? 0 : std::log(density)))));
    hypotheses_ = std::move(next);
    prune();

    Hypothesis const& best = hypotheses_.front();
    PoseEstimate e = estimate;
    e.world_from_camera = best.pose;
    e.covariance = part<6, 6>(best.covariance, 0, 0);
    double likely = 0;
    std::optional<gi::RigidPose> rival;
    for (Hypothesis const& h : hypotheses_)
        if (are_same(h.pose, best.pose, kSame_m, kSame_deg))
            likely += std::exp(h.log_weight);
        else if (!rival)
            rival = h.pose;
    for (int i = 0; i < 3; ++i) {
        e.position_sigma_m[i] = std::sqrt(std::max(0.0, e.covariance(i, i)));
        e.rotation_sigma_deg[i] = glm::degrees(std::sqrt(std::max(0.0, e.covariance(3 + i, 3 + i))));
    }
    e.other = rival;
    e.other_likelihood = std::clamp(1 - likely, 0.0, 1.0);
    e.ambiguous = estimate.ambiguous && e.other_likelihood > kRivalry;
    e.confidence = confidence_of(e.fit, 1 - e.other_likelihood, e.rotation_sigma_deg);
    // A hypothesis of an earlier frame is no likely pose of this one unless its own picture allows another.
    PoseEstimate likely_off = e;
    likely_off.other_likelihood = std::min(e.other_likelihood, estimate.other ? estimate.other_likelihood : 0);
    e.expected_error_m = expected_error(likely_off);
    return e;
}

} // namespace ar
