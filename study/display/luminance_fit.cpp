#include "study/display/luminance_fit.h"

#include "gi/core/error.h"
#include "study/numeric/descent.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

using Points = std::vector<std::pair<double, double>>; // value, cd/m2; rising in value
constexpr double kFloorShare = 1.0 / 20000;            // of the peak: error of a dark photometer
constexpr double kNonMonotone = 0.01, kAdditive = 0.05, kTableResidual_percent = 2;
constexpr double kLeastPeak = 0.8, kRepeatable = 0.05, kLeastGamma = 0.2, kMostGamma = 10;
constexpr std::size_t kTablePoints = 9;
constexpr char const* kColourNames[]{"white", "red", "green", "blue"};

std::map<PatchColour, Points> grouped(std::vector<LuminanceReading> const& readings)
{
    std::map<PatchColour, std::map<double, std::vector<double>>> all;
    for (LuminanceReading const& r : readings) all[r.colour][r.value].push_back(r.cd_m2);
    std::map<PatchColour, Points> out;
    for (auto const& [colour, values] : all)
        for (auto const& [value, list] : values) {
            double sum = 0;
            for (double const v : list) sum += v;
            out[colour].emplace_back(value, sum / double(list.size()));
        }
    return out;
}

void check_points(PatchColour colour, Points const& points)
{
    char const* const name = kColourNames[int(colour)];
    if (points.size() < 3)
        throw gi::InputError(fmt::format("{} was measured at {} values", name, points.size()),
                             "black, white and one in between are the least", "measure 9 or 17 values");
    if (points.back().first < 1)
        throw gi::InputError(fmt::format("{} was not measured at its highest value", name),
                             "the peak would be a guess", "measure the value 1 (or 255)");
    if (points.back().second <= points.front().second)
        throw gi::InputError(fmt::format("{} does not become brighter: {:g} to {:g} cd/m2", name,
                                         points.front().second, points.back().second),
                             "luminance rises with the digital value", "check the columns and the photometer");
    auto const brightest = std::max_element(points.begin(), points.end(),
                                            [](auto const& a, auto const& b) { return a.second < b.second; });
    if (points.back().second < kLeastPeak * brightest->second)
        throw gi::InputError(fmt::format("{} falls to {:g} cd/m2 at its highest value, from {:g} at {:g}", name,
                                         points.back().second, brightest->second, brightest->first),
                             "the highest value is the brightest", "check the readings and their order");
}

/// Reports readings of one colour and value that differ too much, with the largest difference.
void judge_repeats(std::vector<LuminanceReading> const& readings, LuminanceFit& fit)
{
    std::map<std::pair<PatchColour, double>, std::pair<double, double>> ends;
    double peak = 0, worst = 0;
    for (LuminanceReading const& r : readings) {
        peak = std::max(peak, r.cd_m2);
        auto const [at, is_new] = ends.try_emplace({r.colour, r.value}, r.cd_m2, r.cd_m2);
        at->second = {std::min(at->second.first, r.cd_m2), std::max(at->second.second, r.cd_m2)};
    }
    std::string told;
    for (auto const& [of, range] : ends) {
        double const share = (range.second - range.first) / std::max(range.second, 0.01 * peak); // as of the fit
        if (share <= std::max(worst, kRepeatable)) continue;
        worst = share;
        told =
            fmt::format("repeated readings of {} at {:.3g} differ by {:.0f} % ({:g} and {:g} cd/m2): their mean "
                        "is taken",
                        kColourNames[int(of.first)], of.second, 100 * share, range.first, range.second);
    }
    if (!told.empty()) fit.warnings.push_back(told);
}

struct FittedCurve {
    ChannelCurve curve;
    double black = 0;
};

/// b + k max(0, g v + 1 - g)^gamma: a black level, a peak, a gain and a gamma. The gain is 1 with fewer than six
/// values. @param black  known already; none = fitted
FittedCurve fit_curve(PatchColour colour, Points const& points, std::optional<double> black)
{
    double const peak = points.back().second, floor = kFloorShare * peak;
    bool const fits_gain = points.size() >= 6;
    auto const parts = [&](std::span<double const> p) {
        struct {
            double k, gamma, b, g;
        } out{std::exp(p[0]), std::exp(p[1]), black ? *black : std::exp(p[2]) - 1e-9,
              fits_gain ? std::exp(p[black ? 2 : 3]) : 1.0};
        return out;
    };
    auto const model = [&](std::span<double const> p, double v) {
        auto const [k, gamma, b, g] = parts(p);
        double const low = std::pow(std::max(0.0, 1 - g), gamma);
        return b + k * (std::pow(std::max(0.0, g * v + 1 - g), gamma) - low) / (1 - low);
    };
    auto const cost = [&](std::span<double const> p) {
        double sum = 0;
        for (auto const& [v, l] : points) {
            double const e = (model(p, v) - l) / (0.02 * l + floor);
            sum += e * e;
        }
        if (fits_gain) { // a gain below 0.5 or above 2 is no display
            double const g = parts(p).g;
            if (g > 2) sum += 1e4 * (g - 2) * (g - 2);
            if (g < 0.5) sum += 1e4 * (g - 0.5) * (g - 0.5);
        }
        return sum;
    };
    Minimum best;
    for (double const gamma : {1.2, 1.8, 2.2, 2.6}) {
        std::vector<double> start{std::log(peak - points.front().second), std::log(gamma)};
        if (!black) start.push_back(std::log(std::max(points.front().second, 1e-6 * peak)));
        if (fits_gain) start.push_back(0);
        Minimum const found = minimise(cost, start);
        if (best.at.empty() || found.value < best.value) best = found;
    }
    auto const [k, gamma, b, g] = parts(best.at);
    if (!(gamma >= kLeastGamma && gamma <= kMostGamma))
        throw gi::InputError(fmt::format("{} rises from {:g} to {:g} cd/m2 as with a gamma of {:.2g}",
                                         kColourNames[int(colour)], points.front().second, peak, gamma),
                             fmt::format("that of displays is {:g} to {:g}", kLeastGamma, kMostGamma),
                             "check the readings, and whether the photometer measures dark light");
    FittedCurve out{{k, gamma, g, {}, 0, 0, int(points.size())}, std::max(0.0, b)};
    double squares = 0;
    for (auto const& [v, l] : points) {
        double const e = 100 * (model(best.at, v) - l) / std::max(l, 0.01 * peak); // dark ones: of 1 % of the peak
        squares += e * e;
        out.curve.worst_percent = std::max(out.curve.worst_percent, std::abs(e));
    }
    out.curve.rms_percent = std::sqrt(squares / double(points.size()));
    return out;
}

/// Shares of the peak, made to rise by pooling neighbours that fall (isotonic regression), from (0, 0) to (1, 1).
Points table_of(Points const& points, double black, bool& fell)
{
    struct Pool {
        double sum, weight;
        std::size_t count;
    };
    std::vector<Pool> pools;
    for (auto const& [v, l] : points) {
        pools.push_back({l, 1, 1});
        while (pools.size() > 1) {
            Pool const last = pools.back();
            Pool& before = pools[pools.size() - 2];
            if (last.sum / last.weight >= before.sum / before.weight) break;
            if (before.sum / before.weight - last.sum / last.weight > kNonMonotone * points.back().second)
                fell = true;
            before.sum += last.sum;
            before.weight += last.weight;
            before.count += last.count;
            pools.pop_back();
        }
    }
    Points table;
    double const peak = pools.back().sum / pools.back().weight - black;
    std::size_t at = 0;
    for (Pool const& p : pools)
        for (std::size_t i = 0; i < p.count; ++i, ++at)
            table.emplace_back(points[at].first, std::clamp((p.sum / p.weight - black) / peak, 0.0, 1.0));
    if (table.front().first > 0) table.insert(table.begin(), {0, 0});
    table.front().second = 0;
    table.back().second = 1;
    return table;
}

void judge(LuminanceFit& fit, int channel, char const* name)
{
    ChannelCurve const& c = fit.light.channels[std::size_t(channel)];
    if (c.worst_percent > 5)
        fit.warnings.push_back(fmt::format("{}: the formula misses a reading by {:.1f} % (rms {:.1f} %)", name,
                                           c.worst_percent, c.rms_percent));
    if (c.gamma < 1.4 || c.gamma > 3)
        fit.warnings.push_back(
            fmt::format("{}: a gamma of {:.2f} is unusual (1.8 to 2.6 are common)", name, c.gamma));
    if (c.points < 6)
        fit.warnings.push_back(fmt::format(
            "{}: only {} values were measured; 9 or 17 show departures from the formula", name, c.points));
}

} // namespace

std::array<double, 3> luminance_shares(DisplayColour const& c)
{
    // Solves r R + g G + b B = W for luminances, each column being (x/y, 1, (1-x-y)/y); Lindbloom's RGB to XYZ.
    auto const column = [](Chromaticity const& p) {
        if (!(p.y > 1e-6))
            throw gi::InputError(fmt::format("a chromaticity of ({:g}, {:g})", p.x, p.y), "y is above 0",
                                 "write CIE 1931 x and y");
        return std::array<double, 3>{p.x / p.y, 1, (1 - p.x - p.y) / p.y};
    };
    auto const r = column(c.red), g = column(c.green), b = column(c.blue), w = column(c.white);
    auto const det = [](auto const& u, auto const& v, auto const& t) {
        return u[0] * (v[1] * t[2] - v[2] * t[1]) - v[0] * (u[1] * t[2] - u[2] * t[1]) +
               t[0] * (u[1] * v[2] - u[2] * v[1]);
    };
    double const d = det(r, g, b);
    std::array<double, 3> const shares{det(w, g, b) / d, det(r, w, b) / d, det(r, g, w) / d};
    for (double const s : shares)
        if (!(std::abs(d) > 1e-9) || !(s > 0))
            throw gi::InputError("these primaries cannot mix this white", "white lies outside of their triangle",
                                 "check the order: red, green, blue, white, each x and y");
    return shares;
}

LuminanceFit fit_luminance(std::vector<LuminanceReading> readings, std::optional<DisplayColour> const& colour)
{
    auto const all = grouped(readings);
    for (auto const& [c, points] : all) check_points(c, points);
    bool const has_white = all.count(PatchColour::white) > 0;
    bool const has_channels =
        all.count(PatchColour::red) && all.count(PatchColour::green) && all.count(PatchColour::blue);
    if (!has_white && !has_channels)
        throw gi::InputError("neither white nor all three channels were measured", "the rest cannot be inferred",
                             "measure white, or red, green and blue");
    LuminanceFit fit;
    judge_repeats(readings, fit);
    DisplayLuminance& light = fit.light;
    double black = 0;
    int blacks = 0;
    for (auto const& [c, points] : all)
        if (points.front().first == 0) {
            black += points.front().second;
            ++blacks;
        }
    std::optional<double> const known = blacks > 0 ? std::optional(black / blacks) : std::nullopt;
    bool fell = false;
    std::size_t least = SIZE_MAX;
    double worst = 0;
    std::optional<FittedCurve> white;
    if (has_white) {
        white = fit_curve(PatchColour::white, all.at(PatchColour::white), known);
        light.black = white->black;
    }
    auto const take = [&](int channel, FittedCurve const& fitted, Points const& points) {
        light.channels[std::size_t(channel)] = fitted.curve;
        light.channels[std::size_t(channel)].table = table_of(points, known.value_or(fitted.black), fell);
        least = std::min(least, points.size());
        worst = std::max(worst, fitted.curve.rms_percent);
    };
    if (has_channels) {
        double lowest = 1e300;
        for (int c = 0; c < 3; ++c) {
            Points const& points = all.at(PatchColour(c + 1));
            FittedCurve const fitted = fit_curve(PatchColour(c + 1), points, known);
            lowest = std::min(lowest, fitted.black);
            take(c, fitted, points);
            judge(fit, c, kColourNames[c + 1]);
        }
        if (!has_white) light.black = known.value_or(lowest);
        if (has_white) {
            double const sum = light.white(), measured = white->curve.peak + white->black;
            light.additivity_error = sum / measured - 1;
            if (std::abs(*light.additivity_error) > kAdditive)
                fit.warnings.push_back(fmt::format("red, green and blue together give {:.1f} cd/m2, white {:.1f} "
                                                   "({:+.1f} %): the channels do not add "
                                                   "up (dynamic contrast, a white subpixel, colour management?); "
                                                   "luminances of mixed colours are off "
                                                   "by as much",
                                                   sum, measured, 100 * *light.additivity_error));
        }
    } else {
        auto const shares = luminance_shares(colour.value_or(kSrgbColour));
        for (int c = 0; c < 3; ++c) {
            take(c, *white, all.at(PatchColour::white));
            light.channels[std::size_t(c)].peak *= shares[std::size_t(c)];
        }
        judge(fit, 0, "white");
        fit.warnings.push_back(
            fmt::format("only white was measured: the channels share its curve, and their peaks are "
                        "those of {}",
                        colour ? "the given chromaticities" : "sRGB's primaries"));
    }
    if (fell) fit.warnings.push_back("luminance falls by more than 1 % of the peak where the value rises");
    if (!known) fit.warnings.push_back("value 0 was not measured: black is that of the fit");
    light.uses_table = least >= kTablePoints && worst > kTableResidual_percent;
    if (light.uses_table)
        for (int c = 0; c < 3; ++c) { // the table's peak is the measured one
            PatchColour const of = has_channels ? PatchColour(c + 1) : PatchColour::white;
            double const fitted = has_channels ? light.channels[std::size_t(c)].peak : white->curve.peak;
            light.channels[std::size_t(c)].peak *= (all.at(of).back().second - light.black) / fitted;
        }
    if (light.uses_table)
        fit.warnings.push_back(
            fmt::format("the formula misses the readings by {:.1f} % (rms): the table counts", worst));
    if (light.white() / std::max(light.black, 1e-9) < 20)
        fit.warnings.push_back(
            fmt::format("a contrast of {:.0f}:1: is the room dark?", light.white() / light.black));
    return fit;
}

LuminanceFit fit_matches(std::vector<GammaMatch> const& matches, std::optional<double> white,
                         std::optional<double> black, std::optional<DisplayColour> const& colour)
{
    if (matches.empty()) throw gi::InputError("no match", "gamma is unknown", "match at least one pattern");
    auto const gamma_of = [&](PatchColour wanted, double& spread) -> std::optional<double> {
        double top = 0, bottom = 0;
        std::vector<double> single;
        for (GammaMatch const& m : matches) {
            if (m.colour != wanted) continue;
            if (!(m.value > 0 && m.value < 1 && m.share > 0 && m.share < 1))
                throw gi::InputError(fmt::format("a match of {:g} with the value {:g}", m.share, m.value),
                                     "at an end of the values nothing can match", "match it again");
            double const x = std::log(m.value), y = std::log(m.share); // y = gamma x
            top += x * y;
            bottom += x * x;
            single.push_back(y / x);
        }
        if (single.empty()) return {};
        spread = *std::max_element(single.begin(), single.end()) - *std::min_element(single.begin(), single.end());
        return top / bottom;
    };
    LuminanceFit fit;
    DisplayLuminance& light = fit.light;
    light.method = LuminanceMethod::by_eye;
    light.is_absolute = white.has_value();
    light.black = white ? black.value_or(0) : 0;
    double const range = white.value_or(1) - light.black;
    if (!(range > 0))
        throw gi::InputError(fmt::format("white of {:g} and black of {:g} cd/m2", white.value_or(1), light.black),
                             "white is brighter", "check the numbers");
    auto const shares = luminance_shares(colour.value_or(kSrgbColour));
    double spread = 0, most = 0;
    auto const grey = gamma_of(PatchColour::white, spread);
    most = spread;
    for (int c = 0; c < 3; ++c) {
        auto const own = gamma_of(PatchColour(c + 1), spread);
        most = own ? std::max(most, spread) : most;
        if (!own && !grey)
            throw gi::InputError(fmt::format("{} was not matched", kColourNames[c + 1]), "its gamma is unknown",
                                 "match white, or all three channels");
        light.channels[std::size_t(c)] = {range * shares[std::size_t(c)], own ? *own : *grey, 1, {}, 0, 0, 0};
        int count = 0;
        for (GammaMatch const& m : matches) count += m.colour == (own ? PatchColour(c + 1) : PatchColour::white);
        light.channels[std::size_t(c)].points = count;
    }
    if (most > 0.2)
        fit.warnings.push_back(
            fmt::format("single matches differ in gamma by {:.2f}: match again, from further away", most));
    if (!white)
        fit.warnings.push_back(
            "no luminance was measured: scripts cannot name cd/m2, and pictures are only linear");
    else if (!black)
        fit.warnings.push_back("black was not given and counts as 0 cd/m2");
    return fit;
}

} // namespace study
