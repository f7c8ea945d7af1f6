#include "study/stats/sampler.h"

#include "study/numeric/error.h"
#include "study/numeric/random.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <tbb/parallel_for.h>

namespace study {
namespace {

constexpr double kLostEnergy = 1000;

/// A point of phase space.
struct State {
    std::vector<double> x, momentum, gradient;
    double log_density = 0;
};

/// Part of a path: its ends, the sum of its momenta, and a point drawn from it.
struct Path {
    State left, right;
    std::vector<double> momenta;
    std::vector<double> x, gradient; ///< of the drawn point
    double log_density = 0;
    double log_weight = -INFINITY; ///< of all its points
    bool is_good = true;           ///< neither turned nor diverged
};

double log_add(double a, double b)
{
    double const most = std::max(a, b);
    return std::isinf(most) ? most : most + std::log1p(std::exp(-std::abs(a - b)));
}

/// Step size that reaches the wanted acceptance (Hoffman & Gelman 2014, section 3.2).
class StepSize {
public:
    void restart(double step)
    {
        step_ = step;
        target_ = std::log(10 * step);
        mean_error_ = mean_log_ = 0;
        count_ = 0;
    }
    double step() const { return step_; }
    void learn(double acceptance, double wanted)
    {
        ++count_;
        double const share = 1 / (count_ + 10.0);
        mean_error_ = (1 - share) * mean_error_ + share * (wanted - acceptance);
        double const log_step = target_ - mean_error_ * std::sqrt(count_) / 0.05;
        double const weight = std::pow(count_, -0.75);
        mean_log_ = weight * log_step + (1 - weight) * mean_log_;
        step_ = std::exp(log_step);
    }
    void finish() { step_ = std::exp(mean_log_); }

private:
    double step_ = 1, target_ = 0, mean_error_ = 0, mean_log_ = 0;
    double count_ = 0;
};

class Chain {
public:
    Chain(LogDensity const& density, std::span<double const> start, SamplerSettings const& s, int number,
          Draws& out, std::function<void()> const& drawn)
        : density_(density),
          s_(s),
          random_(Random::part(s.seed, std::uint64_t(number))),
          out_(out),
          drawn_(drawn),
          variance_(start.size(), 1)
    {
        begin(start);
    }

    void run()
    {
        warm_up();
        step_.finish();
        for (int i = 0; i < s_.draws; ++i) {
            draw(true);
            out_.values.insert(out_.values.end(), here_.x.begin(), here_.x.end());
        }
        out_.step.push_back(step_.step());
    }

private:
    double evaluate(State& s)
    {
        ++out_.evaluations;
        double const v = density_(s.x, s.gradient);
        bool const finite = std::isfinite(v) && std::all_of(s.gradient.begin(), s.gradient.end(),
                                                            [](double g) { return std::isfinite(g); });
        return s.log_density = finite ? v : -INFINITY;
    }

    void begin(std::span<double const> start)
    {
        std::size_t const n = start.size();
        here_ = {std::vector<double>(start.begin(), start.end()), std::vector<double>(n), std::vector<double>(n),
                 0};
        double spread = s_.spread;
        for (int attempt = 0; attempt < 50; ++attempt, spread *= attempt < 48 ? 0.8 : 0) {
            for (std::size_t i = 0; i < n; ++i) here_.x[i] = start[i] + spread * random_.normal();
            if (std::isfinite(evaluate(here_))) return;
        }
        refuse("a density that is 0 or not a number at and near its start", "chains have nowhere to begin",
               "start where it is finite");
    }

    double kinetic(State const& s) const
    {
        double sum = 0;
        for (std::size_t i = 0; i < s.x.size(); ++i) sum += s.momentum[i] * s.momentum[i] * variance_[i];
        return 0.5 * sum;
    }

    void push(State& s, double step)
    {
        for (std::size_t i = 0; i < s.x.size(); ++i) {
            s.momentum[i] += 0.5 * step * s.gradient[i];
            s.x[i] += step * variance_[i] * s.momentum[i];
        }
        evaluate(s);
        for (std::size_t i = 0; i < s.x.size(); ++i) s.momentum[i] += 0.5 * step * s.gradient[i];
    }

    void draw_momentum(State& s)
    {
        for (std::size_t i = 0; i < s.x.size(); ++i) s.momentum[i] = random_.normal() / std::sqrt(variance_[i]);
    }

    /// A step size whose single step is accepted with a probability near 0.8.
    double first_step()
    {
        double step = 0.1;
        for (int direction = 0, i = 0; i < 60; ++i) {
            State s = here_;
            draw_momentum(s);
            double const before = s.log_density - kinetic(s);
            push(s, step);
            double const gain = s.log_density - kinetic(s) - before;
            int const wanted = gain > std::log(0.8) ? 1 : -1;
            if (direction != 0 && wanted != direction) break;
            direction = wanted;
            step *= direction > 0 ? 2 : 0.5;
        }
        return step;
    }

    /// True while both ends of the path move apart (no U-turn).
    bool goes_on(std::vector<double> const& momenta, std::vector<double> const& left,
                 std::vector<double> const& right) const
    {
        double at_left = 0, at_right = 0;
        for (std::size_t i = 0; i < momenta.size(); ++i) {
            double const v = momenta[i] * variance_[i];
            at_left += v * left[i];
            at_right += v * right[i];
        }
        return at_left > 0 && at_right > 0;
    }

    Path one_step(State const& from, double direction)
    {
        Path p;
        p.left = from;
        push(p.left, direction * step_.step());
        double const loss = energy_ - (p.left.log_density - kinetic(p.left));
        p.is_good = loss < kLostEnergy;
        if (!p.is_good) diverged_ = true;
        accepted_ += std::isnan(loss) ? 0 : std::min(1.0, std::exp(-loss));
        ++steps_;
        p.log_weight = std::isnan(loss) ? -INFINITY : -loss;
        p.momenta = p.left.momentum;
        p.x = p.left.x;
        p.gradient = p.left.gradient;
        p.log_density = p.left.log_density;
        p.right = p.left;
        return p;
    }

    /// Joins `later`, which continues `p` in the direction.
    /// @param is_biased towards the later part, at the top level
    void join(Path& p, Path&& later, double direction, bool is_biased)
    {
        double const total = log_add(p.log_weight, later.log_weight);
        double const against = is_biased ? p.log_weight : total;
        if (std::log(1 - random_.uniform()) < later.log_weight - against) {
            p.x = std::move(later.x);
            p.gradient = std::move(later.gradient);
            p.log_density = later.log_density;
        }
        Path& before = direction > 0 ? p : later;
        Path& after = direction > 0 ? later : p;
        std::vector<double> momenta = before.momenta, across_left = before.momenta, across_right = after.momenta;
        for (std::size_t i = 0; i < momenta.size(); ++i) {
            momenta[i] += after.momenta[i];
            across_left[i] += after.left.momentum[i];
            across_right[i] += before.right.momentum[i];
        }
        // Also across the seam, so that a path of two turns is noticed (Stan, since 2.21).
        p.is_good = goes_on(momenta, before.left.momentum, after.right.momentum) &&
                    goes_on(across_left, before.left.momentum, after.left.momentum) &&
                    goes_on(across_right, before.right.momentum, after.right.momentum);
        p.momenta = std::move(momenta);
        if (direction > 0)
            p.right = std::move(later.right);
        else
            p.left = std::move(later.left);
        p.log_weight = total;
    }

    Path grow(State const& from, double direction, int doublings)
    {
        if (doublings == 0) return one_step(from, direction);
        Path p = grow(from, direction, doublings - 1);
        if (!p.is_good) return p;
        Path later = grow(direction > 0 ? p.right : p.left, direction, doublings - 1);
        if (!later.is_good) {
            p.is_good = false;
            return p;
        }
        join(p, std::move(later), direction, false);
        return p;
    }

    /// Moves to the next draw; returns its acceptance.
    double draw(bool is_kept)
    {
        draw_momentum(here_);
        energy_ = here_.log_density - kinetic(here_);
        accepted_ = 0;
        steps_ = 0;
        diverged_ = false;
        Path p{here_, here_, here_.momentum, here_.x, here_.gradient, here_.log_density, 0, true};
        int doublings = 0;
        for (; doublings < s_.most_doublings && p.is_good; ++doublings) {
            double const direction = random_.uniform() < 0.5 ? 1 : -1;
            Path later = grow(direction > 0 ? p.right : p.left, direction, doublings);
            if (!later.is_good) break;
            join(p, std::move(later), direction, true);
        }
        here_.x = std::move(p.x);
        here_.gradient = std::move(p.gradient);
        here_.log_density = p.log_density;
        double const acceptance = steps_ > 0 ? accepted_ / steps_ : 0;
        if (is_kept) {
            out_.divergences += diverged_;
            out_.longest_paths += doublings == s_.most_doublings;
            out_.acceptance += acceptance / (double(s_.chains) * s_.draws);
        }
        drawn_();
        return acceptance;
    }

    void warm_up()
    {
        // 15 % to find the mass of the density, then windows of doubling length for the metric, the last 10 % for
        // the step size alone.
        int const n = s_.warm_up, first = n * 15 / 100, last = n - n / 10;
        int window = std::max(20, n / 16), end = first + window;
        step_.restart(first_step());
        std::vector<double> sum(here_.x.size()), squares(here_.x.size());
        int count = 0;
        for (int i = 0; i < n; ++i) {
            step_.learn(draw(false), s_.acceptance);
            if (i < first || i >= last) continue;
            ++count;
            for (std::size_t k = 0; k < sum.size(); ++k) { // Welford's update
                double const away = here_.x[k] - sum[k];
                sum[k] += away / count;
                squares[k] += away * (here_.x[k] - sum[k]);
            }
            if (i + 1 == end || i + 1 == last) {
                for (std::size_t k = 0; k < sum.size(); ++k)
                    variance_[k] = (count * squares[k] / std::max(1, count - 1) + 5e-3) / (count + 5.0);
                window *= 2;
                end = i + 1 + window + 2 * window > last ? last : i + 1 + window;
                count = 0;
                std::fill(sum.begin(), sum.end(), 0);
                std::fill(squares.begin(), squares.end(), 0);
                step_.restart(first_step());
            }
        }
    }

    LogDensity const& density_;
    SamplerSettings const& s_;
    Random random_;
    Draws& out_;
    std::function<void()> const& drawn_;
    std::vector<double> variance_; ///< of the parameters: the inverse of the metric
    State here_;
    StepSize step_;
    double energy_ = 0, accepted_ = 0;
    int steps_ = 0;
    bool diverged_ = false;
};

} // namespace

Draws sample(LogDensity const& density, std::span<double const> start, SamplerSettings const& settings)
{
    if (start.empty() || settings.chains < 1 || settings.draws < 1 || settings.warm_up < 20)
        refuse("a sampler without parameters, chains or draws, or with fewer than 20 draws to warm up",
               "there is nothing to draw, or nothing to adapt by", "use 4 chains of 500 draws after 400");
    Draws d;
    d.parameters = start.size();
    d.chains = settings.chains;
    d.per_chain = settings.draws;
    std::vector<Draws> by_chain(std::size_t(settings.chains), Draws{});
    std::mutex telling;
    double drawn = 0;
    double const all = double(settings.chains) * (settings.warm_up + settings.draws);
    std::function<void()> const tell = [&] {
        if (!settings.progress) return;
        std::lock_guard const lock(telling);
        settings.progress(++drawn / all);
    };
    tbb::parallel_for(0, settings.chains,
                      [&](int c) { Chain(density, start, settings, c, by_chain[std::size_t(c)], tell).run(); });
    for (Draws const& c : by_chain) {
        d.values.insert(d.values.end(), c.values.begin(), c.values.end());
        d.step.insert(d.step.end(), c.step.begin(), c.step.end());
        d.divergences += c.divergences;
        d.longest_paths += c.longest_paths;
        d.acceptance += c.acceptance;
        d.evaluations += c.evaluations;
    }
    return d;
}

} // namespace study
