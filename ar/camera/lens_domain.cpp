#include "ar/camera/lens_domain.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <vector>

namespace ar {
namespace {

constexpr double kMostTangent = 1e3; ///< on the plane z = 1: 89.94 degrees

using Polynomial = std::vector<double>; ///< c[0] + c[1] x + ...

double value(Polynomial const& c, double x)
{
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * x + c[i];
    return sum;
}

Polynomial slope(Polynomial const& c)
{
    Polynomial d;
    for (std::size_t i = 1; i < c.size(); ++i) d.push_back(double(i) * c[i]);
    return d;
}

Polynomial product(Polynomial const& a, Polynomial const& b)
{
    Polynomial p(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t k = 0; k < b.size(); ++k) p[i + k] += a[i] * b[k];
    return p;
}

/// Where it changes its sign between 0 and `most`, ascending: between the extremes that its slope has.
std::vector<double> roots(Polynomial c, double most)
{
    while (!c.empty() && c.back() == 0) c.pop_back();
    if (c.size() < 2) return {};
    std::vector<double> ends = roots(slope(c), most), found;
    ends.push_back(most);
    double low = 0;
    for (double const end : ends) {
        double from = low, to = end;
        bool const is_positive = value(c, from) > 0;
        low = end;
        if (is_positive == (value(c, to) > 0)) continue;
        for (int i = 0; i < 100; ++i) {
            double const middle = 0.5 * (from + to);
            ((value(c, middle) > 0) == is_positive ? from : to) = middle;
        }
        found.push_back(from);
    }
    return found;
}

/// Of the lens x N(x^2) / D(x^2), or of a fisheye x N(x^2).
LensDomain domain(Polynomial const& n, Polynomial const& d, double most)
{
    // With u = x^2 the slope is (N D + 2 u (N' D - N D')) / D^2.
    Polynomial slope_above = product(n, d);
    Polynomial const a = product(slope(n), d), b = product(n, slope(d));
    slope_above.resize(std::max({slope_above.size(), a.size() + 1, b.size() + 1}));
    for (std::size_t i = 0; i < a.size(); ++i) slope_above[i + 1] += 2 * a[i];
    for (std::size_t i = 0; i < b.size(); ++i) slope_above[i + 1] -= 2 * b[i];
    auto const first = [&](Polynomial const& p) {
        auto const u = roots(p, most * most);
        return u.empty() ? most : std::sqrt(u.front());
    };
    double const pole = first(d), fold = first(slope_above);
    // A fold shortly before a pole is the pole's.
    if (pole < most && pole < 1.1 * fold) return {std::min(pole, fold), DomainEnd::pole};
    return {fold, fold < most ? DomainEnd::fold : DomainEnd::none};
}

} // namespace

LensDomain domain_of(CameraModel const& c)
{
    struct Last {
        LensModel lens = LensModel::pinhole;
        std::array<double, 8> distortion{};
        LensDomain domain{kMostTangent, DomainEnd::none};
    };
    thread_local Last last;
    if (c.lens == last.lens && c.distortion == last.distortion) return last.domain;
    auto const& d = c.distortion;
    last = {c.lens, d, {kMostTangent, DomainEnd::none}};
    if (c.lens == LensModel::fisheye)
        last.domain = domain({1, d[0], d[1], d[2], d[3]}, {1}, std::numbers::pi);
    else if (c.lens == LensModel::radial_tangential || c.lens == LensModel::rational)
        last.domain = domain({1, d[0], d[1], d[4]}, {1, d[5], d[6], d[7]}, kMostTangent);
    return last.domain;
}

LensReach reach_of(CameraModel const& c)
{
    constexpr int kSteps = 32;
    LensReach reach;
    int rays = 0, wide = 0;
    for (int y = 0; y <= kSteps; ++y)
        for (int x = 0; x <= kSteps; ++x) {
            auto const d = direction_of(c, glm::dvec2(x, y) / double(kSteps) * glm::dvec2(c.size_px - 1));
            if (!d) continue;
            double const angle_deg = glm::degrees(std::atan2(std::hypot(d->x, d->y), d->z));
            reach.widest_deg = std::max(reach.widest_deg, angle_deg);
            wide += angle_deg >= kWide_deg;
            ++rays;
        }
    double const all = (kSteps + 1) * (kSteps + 1);
    reach.share = rays / all;
    reach.share_wide = wide / all;
    return reach;
}

std::string describe(LensReach const& r)
{
    return fmt::format("holds over {:.3g} % of the picture, up to {:.1f} degrees off its axis", 100 * r.share,
                       r.widest_deg);
}

} // namespace ar
