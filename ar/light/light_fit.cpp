#include "ar/light/light_fit.h"

#include "ar/light/lamps.h"
#include "ar/light/nonnegative.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <numeric>

namespace ar {
namespace {

constexpr double kSunRad = 0.0047;
constexpr double kSeenShare = 0.5; ///< of a cell, from which on its light is known

/// Light of one channel, or of luminance.
enum Channel { red, green, blue, grey };

double of(cv::Vec3d const& v, int channel) { return channel == grey ? luminance(v) : v[channel]; }

/// The equations of one channel, each divided by its standard deviation, and the prior.
class Fitter {
public:
    Fitter(LightBasis const& basis, LightRows const& rows, LightFitSettings const& settings)
        : basis_(basis), rows_(rows), settings_(settings), weights_(rows.irradiance.size(), 1.0)
    {
    }

    LightFit fit()
    {
        find_lamps();
        reweight();
        LightFit out;
        out.radiance.create(basis_.count(), 1, CV_32FC3);
        out.sigma.create(basis_.count(), 1, CV_32FC3);
        for (int c = red; c <= blue; ++c) {
            solve(c);
            out.mean_radiance[c] = mean_;
            for (int k = 0; k < basis_.count(); ++k)
                out.radiance.at<cv::Vec3f>(k)[c] = float(solution_[std::size_t(k)]);
            for (std::size_t l = 0; l < lamps_.size(); ++l)
                lamps_[l].irradiance[c] = solution_[std::size_t(basis_.count()) + l];
        }
        solve(grey);
        out.residual = residual();
        out.residual_without_lamps = residual_without_lamps_;
        out.outliers = outliers_;
        add_uncertainty(out);
        out.lamps = lamps_;
        std::stable_sort(out.lamps.begin(), out.lamps.end(), [](FittedLamp const& a, FittedLamp const& b) {
            return luminance(a.irradiance) > luminance(b.irradiance);
        });
        return out;
    }

private:
    std::size_t samples() const { return rows_.irradiance.size(); }

    double scale(std::size_t i, int channel) const { return std::sqrt(weights_[i]) / of(rows_.sigma[i], channel); }

    double indirect(std::size_t i, int k, int channel) const
    {
        auto const part = [&](int c) { return double(rows_.by_surfaces[std::size_t(c)].ptr<float>(int(i))[k]); };
        return channel == grey ? of({part(0), part(1), part(2)}, grey) : part(channel);
    }

    /// Irradiance of the samples by a lamp that gives a face turned to it an irradiance of 1.
    std::vector<double> column_of(glm::dvec3 towards, double half_angle_rad, int channel) const
    {
        std::vector<float> const direct = rows_.of_disc(towards, half_angle_rad);
        int const k = basis_.nearest(towards);
        std::vector<double> column(samples());
        for (std::size_t i = 0; i < samples(); ++i)
            column[i] = scale(i, channel) * (double(direct[i]) + indirect(i, k, channel) / basis_.cell_sr());
        return column;
    }

    void build(int channel)
    {
        channel_ = channel;
        int const n = int(samples()), k = basis_.count();
        matrix_.create(n, k, CV_32F);
        right_.assign(std::size_t(n), 0.0);
        double along = 0, square = 0;
        for (int i = 0; i < n; ++i) {
            double const s = scale(std::size_t(i), channel);
            right_[std::size_t(i)] = s * of(rows_.irradiance[std::size_t(i)], channel);
            double all = 0;
            for (int j = 0; j < k; ++j) {
                double const v = double(rows_.direct.ptr<float>(i)[j]) + indirect(std::size_t(i), j, channel);
                matrix_.ptr<float>(i)[j] = float(s * v);
                all += s * v;
            }
            along += all * right_[std::size_t(i)];
            square += all * all;
        }
        if (!(along > 0))
            throw gi::InputError("the known surfaces reflect no light", "it cannot be estimated from them",
                                 "use a frame that shows them lit");
        mean_ = along / square;
        ground_ = settings_.ground_albedo * mean_;
        cv::mulTransposed(matrix_, data_, true, cv::noArray(), 1, CV_64F);
        lamp_columns_.clear();
        for (FittedLamp const& l : lamps_)
            lamp_columns_.push_back(column_of(l.direction, l.half_angle_rad, channel));
    }

    /// Expected radiances, and their precision: a normal distribution of what differs from them.
    void expect()
    {
        int const k = basis_.count();
        expected_.create(k, 1, CV_64F);
        for (int j = 0; j < k; ++j) {
            double const above = std::clamp(0.5 + 5 * basis_.direction(j).y, 0.0, 1.0);
            expected_.at<double>(j) = above * mean_ + (1 - above) * ground_;
        }
        prior_ = cv::Mat::zeros(k, k, CV_64F);
        for (int j = 0; j < k; ++j)
            prior_.at<double>(j, j) = std::pow(settings_.mean_spread * expected_.at<double>(j), -2);
        for (auto const& [a, b] : basis_.neighbours()) {
            // The horizon is where light changes most.
            bool const is_horizon = (basis_.direction(a).y > 0) != (basis_.direction(b).y > 0);
            double const precision = (is_horizon ? 0.1 : 1) / (std::pow(settings_.neighbour_spread, 2) *
                                                               expected_.at<double>(a) * expected_.at<double>(b));
            prior_.at<double>(a, a) += precision;
            prior_.at<double>(b, b) += precision;
            prior_.at<double>(a, b) -= precision;
            prior_.at<double>(b, a) -= precision;
        }
    }

    /// Solves with the present lamps; the prior's expectation follows from the previous solution.
    void solve_once()
    {
        int const k = basis_.count();
        auto const all = std::size_t(k) + lamp_columns_.size();
        normal_ = cv::Mat::zeros(int(all), int(all), CV_64F);
        expect();
        normal_(cv::Rect(0, 0, k, k)) = data_ + prior_;
        gradient_ = transposed_times(right_);
        cv::Mat const pull = prior_ * expected_;
        std::vector<double> lower(all, 0.0);
        for (int j = 0; j < k; ++j) {
            gradient_[std::size_t(j)] += pull.at<double>(j);
            if (rows_.seen.empty()) continue;
            SeenLight const& seen = rows_.seen[std::size_t(j)];
            if (seen.share < kSeenShare) continue;
            double const value = of(seen.radiance, channel_);
            if (seen.clipped) {
                lower[std::size_t(j)] = value;
                continue;
            }
            double const precision = seen.share / std::pow(settings_.seen_sigma * (value + 0.1 * mean_), 2);
            normal_.at<double>(j, j) += precision;
            gradient_[std::size_t(j)] += precision * value;
        }
        for (std::size_t l = 0; l < lamp_columns_.size(); ++l) {
            int const at = k + int(l);
            std::vector<double> const h = transposed_times(lamp_columns_[l]);
            for (int j = 0; j < k; ++j) normal_.at<double>(j, at) = normal_.at<double>(at, j) = h[std::size_t(j)];
            for (std::size_t m = 0; m < lamp_columns_.size(); ++m)
                normal_.at<double>(at, k + int(m)) = std::inner_product(
                    lamp_columns_[l].begin(), lamp_columns_[l].end(), lamp_columns_[m].begin(), 0.0);
            gradient_.push_back(
                std::inner_product(lamp_columns_[l].begin(), lamp_columns_[l].end(), right_.begin(), 0.0));
        }
        solution_ = solve_nonnegative(normal_, gradient_, lower);
    }

    /// The ground as far as the camera sees it, else as guessed.
    double ground_of(double guess) const
    {
        double light = 0, sr = 0;
        for (int j = 0; j < basis_.count() && !rows_.seen.empty(); ++j) {
            SeenLight const& s = rows_.seen[std::size_t(j)];
            if (basis_.direction(j).y > -0.1 || s.clipped) continue;
            light += s.share * basis_.cell_sr() * of(s.radiance, channel_);
            sr += s.share * basis_.cell_sr();
        }
        constexpr double kGuessed = 0.05; // sr that the guess counts for
        return (light + kGuessed * guess) / (sr + kGuessed);
    }

    void solve(int channel)
    {
        build(channel);
        for (int turn = 0; turn < 3; ++turn) {
            solve_once();
            double above = 0, up = 0, n = 0;
            for (int j = 0; j < basis_.count(); ++j) {
                double const y = basis_.direction(j).y;
                if (y <= 0) continue;
                above += solution_[std::size_t(j)];
                up += y * basis_.cell_sr() * solution_[std::size_t(j)];
                n += 1;
            }
            for (std::size_t l = 0; l < lamps_.size(); ++l)
                up += std::max(0.0, lamps_[l].direction.y) * solution_[std::size_t(basis_.count()) + l];
            double const before = mean_;
            mean_ = std::max(above / n, 0.05 * mean_);
            ground_ = std::max(ground_of(settings_.ground_albedo * up / std::numbers::pi), 0.02 * mean_);
            if (std::abs(before - mean_) < 0.03 * mean_) break;
        }
        residuals_ = right_;
        for (int i = 0; i < int(samples()); ++i) {
            double sum = 0;
            for (int j = 0; j < basis_.count(); ++j)
                sum += double(matrix_.ptr<float>(i)[j]) * solution_[std::size_t(j)];
            for (std::size_t l = 0; l < lamp_columns_.size(); ++l)
                sum += lamp_columns_[l][std::size_t(i)] * solution_[std::size_t(basis_.count()) + l];
            residuals_[std::size_t(i)] -= sum;
        }
    }

    std::vector<double> transposed_times(std::vector<double> const& v) const
    {
        std::vector<double> out(std::size_t(basis_.count()), 0.0);
        for (int i = 0; i < matrix_.rows; ++i) {
            double const f = v[std::size_t(i)];
            float const* const row = matrix_.ptr<float>(i);
            for (int j = 0; j < matrix_.cols; ++j) out[std::size_t(j)] += f * double(row[j]);
        }
        return out;
    }

    double squares() const
    {
        return std::inner_product(residuals_.begin(), residuals_.end(), residuals_.begin(), 0.0);
    }

    double residual() const
    {
        return std::sqrt(squares() / std::inner_product(right_.begin(), right_.end(), right_.begin(), 0.0));
    }

    bool lights_enough(std::vector<double> const& column) const
    {
        if (!(settings_.least_lit > 0)) return true;
        std::size_t lit = 0;
        for (std::size_t i = 0; i < samples(); ++i) lit += column[i] > 0.05 * scale(i, grey);
        return double(lit) >= settings_.least_lit * double(samples());
    }

    /// How much a lamp there would lower half the sum of squares if all other light is fitted again:
    /// the Schur complement of its column.
    double gain_of(std::vector<double> const& column, cv::Mat const& inverse, std::vector<int> const& free) const
    {
        double const slope = std::inner_product(column.begin(), column.end(), residuals_.begin(), 0.0);
        if (!(slope > 0) || !lights_enough(column)) return 0;
        std::vector<double> h = transposed_times(column);
        for (auto const& other : lamp_columns_)
            h.push_back(std::inner_product(column.begin(), column.end(), other.begin(), 0.0));
        double curvature = std::inner_product(column.begin(), column.end(), column.begin(), 0.0);
        double const whole = curvature;
        for (std::size_t a = 0; a < free.size(); ++a) {
            double sum = 0;
            for (std::size_t b = 0; b < free.size(); ++b)
                sum += inverse.at<double>(int(a), int(b)) * h[std::size_t(free[b])];
            curvature -= h[std::size_t(free[a])] * sum;
        }
        return 0.5 * slope * slope / std::max(curvature, 1e-3 * whole);
    }

    struct Candidate {
        glm::dvec3 direction{0, 1, 0};
        double half_angle_rad = kSunRad, gain = 0;
    };

    bool is_seen(glm::dvec3 d) const
    {
        if (rows_.seen.empty()) return false;
        SeenLight const& s = rows_.seen[std::size_t(basis_.nearest(d))];
        return s.share > 0.8 && !s.clipped && of(s.radiance, grey) < 4 * mean_;
    }

    /// Rates lamps by how much they would improve the present solution.
    class Rating {
    public:
        explicit Rating(Fitter const& fitter) : fitter_(fitter)
        {
            for (std::size_t k = 0; k < fitter.solution_.size(); ++k)
                if (fitter.solution_[k] > 1e-6 * fitter.mean_) free_.push_back(int(k));
            int const n = int(free_.size());
            cv::Mat part(n, n, CV_64F);
            for (int a = 0; a < n; ++a)
                for (int b = 0; b < n; ++b)
                    part.at<double>(a, b) =
                        fitter.normal_.at<double>(free_[std::size_t(a)], free_[std::size_t(b)]);
            cv::invert(part, inverse_, cv::DECOMP_CHOLESKY);
        }
        void operator()(Candidate& c) const
        {
            c.gain =
                fitter_.is_seen(c.direction)
                    ? 0
                    : fitter_.gain_of(fitter_.column_of(c.direction, c.half_angle_rad, grey), inverse_, free_);
        }

    private:
        Fitter const& fitter_;
        std::vector<int> free_;
        cv::Mat inverse_;
    };

    static Candidate of_best_width(Candidate here, Rating const& rate)
    {
        Candidate best = here;
        for (double const width_rad :
             {kSunRad, glm::radians(2.0), glm::radians(5.0), glm::radians(10.0), glm::radians(16.0)}) {
            Candidate wide = here;
            wide.half_angle_rad = width_rad;
            rate(wide);
            if (wide.gain > best.gain) best = wide;
        }
        return best;
    }

    std::optional<Candidate> best_lamp() const
    {
        Rating const rate(*this);
        LightBasis const fine(settings_.candidates);
        std::vector<Candidate> all(std::size_t(fine.count()));
        for (int k = 0; k < fine.count(); ++k) all[std::size_t(k)].direction = fine.direction(k);
        cv::parallel_for_({0, fine.count()}, [&](cv::Range const& range) {
            for (int k = range.start; k < range.end; ++k) rate(all[std::size_t(k)]);
        });
        std::stable_sort(all.begin(), all.end(),
                         [](Candidate const& a, Candidate const& b) { return a.gain > b.gain; });
        Candidate best;
        for (std::size_t k = 0; k < std::min<std::size_t>(all.size(), 6); ++k) {
            Candidate const here = of_best_width(climbed(all[k], fine.cell_radius_rad(), rate), rate);
            if (here.gain > best.gain) best = here;
        }
        if (!(best.gain > 0)) return std::nullopt;
        return climbed(best, 0.25 * fine.cell_radius_rad(), rate);
    }

    /// Fits each lamp again with the others fixed.
    void settle_lamps()
    {
        for (int turn = 0; turn < 2; ++turn)
            for (std::size_t l = 0; l < lamps_.size() && lamps_.size() > 1; ++l) {
                FittedLamp const lamp = lamps_[l];
                lamps_.erase(lamps_.begin() + std::ptrdiff_t(l));
                solve(grey);
                Rating const rate(*this);
                Candidate c{lamp.direction, lamp.half_angle_rad, 0};
                rate(c);
                c = climbed(of_best_width(climbed(c, glm::radians(2.0), rate), rate), glm::radians(1.0), rate);
                lamps_.insert(lamps_.begin() + std::ptrdiff_t(l),
                              {c.direction, c.half_angle_rad, {}, {}, lamp.gain});
            }
        solve(grey);
    }

    /// Steps around, ever smaller ones, to 0.1 degrees.
    template <class Rate>
    static Candidate climbed(Candidate best, double step_rad, Rate const& rate)
    {
        while (step_rad > glm::radians(0.1)) {
            glm::dvec3 const d = best.direction;
            glm::dvec3 const side =
                glm::normalize(glm::cross(d, std::abs(d.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
            glm::dvec3 const up = glm::cross(side, d);
            Candidate next = best;
            for (int k = 0; k < 6; ++k) {
                double const turn = std::numbers::pi / 3 * k;
                Candidate c = best;
                c.direction =
                    glm::normalize(d + std::tan(step_rad) * (std::cos(turn) * side + std::sin(turn) * up));
                rate(c);
                if (c.gain > next.gain) next = c;
            }
            if (next.gain > best.gain)
                best = next;
            else
                step_rad *= 0.5;
        }
        return best;
    }

    void find_lamps()
    {
        solve(grey);
        residual_without_lamps_ = residual();
        while (int(lamps_.size()) < settings_.most_lamps) {
            double const before = squares();
            std::vector<FittedLamp> const until_now = lamps_;
            auto const found = best_lamp();
            if (!found) break;
            lamps_.push_back({found->direction, found->half_angle_rad, {}, {}, 0});
            settle_lamps();
            double const irradiance = solution_.back();
            double const gain = 1 - squares() / before;
            double const all = irradiance + std::numbers::pi * mean_;
            if (gain < settings_.least_gain || irradiance < settings_.least_share * all) {
                lamps_ = until_now;
                solve(grey);
                break;
            }
            lamps_.back().gain = gain;
        }
    }

    /// Huber's weights: samples far off (a shadow's edge, something not modelled) count less.
    void reweight()
    {
        for (int turn = 0; turn < 2; ++turn) {
            std::vector<double> off(samples());
            for (std::size_t i = 0; i < samples(); ++i) off[i] = std::abs(residuals_[i]) / std::sqrt(weights_[i]);
            std::vector<double> sorted = off;
            auto const middle = sorted.begin() + std::ptrdiff_t(sorted.size() / 2);
            std::nth_element(sorted.begin(), middle, sorted.end());
            double const limit = 2.5 * std::max(1.4826 * *middle, 1.0);
            outliers_ = 0;
            for (std::size_t i = 0; i < samples(); ++i) {
                weights_[i] = std::min(1.0, limit / std::max(off[i], 1e-12));
                outliers_ += weights_[i] < 0.5;
            }
            solve(grey);
        }
    }

    void add_uncertainty(LightFit& out)
    {
        int const k = basis_.count();
        double const misfit = std::max(1.0, squares() / double(samples()));
        cv::Mat prior_covariance;
        cv::invert(normal_, out.covariance, cv::DECOMP_CHOLESKY);
        cv::invert(prior_, prior_covariance, cv::DECOMP_CHOLESKY);
        out.covariance *= misfit;
        for (int j = 0; j < k; ++j) {
            double const is = out.covariance.at<double>(j, j), was = prior_covariance.at<double>(j, j);
            out.known.push_back(float(std::clamp(1 - std::sqrt(is / was), 0.0, 1.0)));
            double const relative = std::sqrt(std::min(is, was)) / mean_;
            for (int c = 0; c < 3; ++c) out.sigma.at<cv::Vec3f>(j)[c] = float(relative * out.mean_radiance[c]);
        }
        for (std::size_t l = 0; l < lamps_.size(); ++l) {
            double const all = luminance(lamps_[l].irradiance);
            double const sigma = std::sqrt(out.covariance.at<double>(k + int(l), k + int(l)));
            lamps_[l].sigma = all > 0 ? lamps_[l].irradiance * (sigma / all) : cv::Vec3d::all(sigma);
        }
    }

    LightBasis const& basis_;
    LightRows const& rows_;
    LightFitSettings const& settings_;
    std::vector<double> weights_;
    std::vector<FittedLamp> lamps_;
    int outliers_ = 0;
    double residual_without_lamps_ = 0;

    int channel_ = grey; ///< of what follows
    double mean_ = 0;    ///< radiance of the rest above the horizon
    double ground_ = 0;  ///< expected radiance below it
    cv::Mat expected_;   ///< per direction
    cv::Mat matrix_, data_, normal_, prior_;
    std::vector<double> right_, gradient_, solution_, residuals_;
    std::vector<std::vector<double>> lamp_columns_;
};

} // namespace

LightFit fit_light(LightBasis const& basis, LightRows const& rows, LightFitSettings const& settings)
{
    if (rows.irradiance.size() < 50)
        throw gi::InputError(
            fmt::format("{} usable pixels of known surfaces", rows.irradiance.size()),
            "the light is estimated from their shading",
            "model larger surfaces under real:, or expose the frame so that they are not clipped");
    CV_Assert(rows.direct.rows == int(rows.irradiance.size()) && rows.direct.cols == basis.count());
    return Fitter(basis, rows, settings).fit();
}
} // namespace ar
