// Luminance of a display: known displays are measured, with noise, and recovered.

#include "gi/core/error.h"
#include "study/display/luminance_fit.h"
#include "study/display/model_file.h"
#include "tests/study_display/luminance_of.h"

#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <random>

namespace study::test {
namespace {

struct TrueDisplay {
    double black = 0.35, gain = 1.02;
    std::array<double, 3> peak{21, 71, 8}, gamma{2.15, 2.2, 2.3};
    double light(int c, double v) const
    {
        double const o = std::pow(std::max(0.0, 1 - gain), gamma[std::size_t(c)]);
        return peak[std::size_t(c)] * (std::pow(std::max(0.0, gain * v + 1 - gain), gamma[std::size_t(c)]) - o) /
               (1 - o);
    }
    double white(double v) const { return black + light(0, v) + light(1, v) + light(2, v); }
};

std::vector<LuminanceReading> readings_of(TrueDisplay const& d, int levels, double noise, bool with_white = true)
{
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<LuminanceReading> out;
    for (int i = 0; i < levels; ++i) {
        double const v = double(i) / (levels - 1);
        auto const read = [&](PatchColour c, double l) {
            out.push_back({c, v, l * (1 + noise * normal(random))});
        };
        if (with_white) read(PatchColour::white, d.white(v));
        for (int c = 0; c < 3; ++c) read(PatchColour(c + 1), d.black + d.light(c, v));
    }
    return out;
}

TEST(LuminanceFit, RecoversAKnownDisplayFromExactReadings)
{
    TrueDisplay const d;
    LuminanceFit const fit = fit_luminance(readings_of(d, 17, 0), {});
    EXPECT_TRUE(fit.warnings.empty()) << fit.warnings[0];
    for (int c = 0; c < 3; ++c) {
        ChannelCurve const& curve = fit.light.channels[std::size_t(c)];
        EXPECT_NEAR(curve.gamma, d.gamma[std::size_t(c)], 1e-3) << c;
        EXPECT_NEAR(curve.peak, d.peak[std::size_t(c)], 1e-3 * curve.peak) << c;
        EXPECT_NEAR(curve.gain, d.gain, 1e-3) << c;
        EXPECT_LT(curve.worst_percent, 0.1);
    }
    EXPECT_NEAR(fit.light.black, 0.35, 1e-9);
    EXPECT_NEAR(*fit.light.additivity_error, 0, 1e-3);
    EXPECT_FALSE(fit.light.uses_table);
}

TEST(LuminanceFit, IsAsExactAsTheReadings)
{
    TrueDisplay const d;
    LuminanceFit const fit = fit_luminance(readings_of(d, 17, 0.01), {});
    double bright = 0, dark = 0; // above and below 1 % of white
    for (int i = 1; i <= 50; ++i) {
        double const v = i / 50.0, off = std::abs(luminance_of(fit.light, {v, v, v}) / d.white(v) - 1);
        (d.white(v) > 1 ? bright : dark) = std::max(d.white(v) > 1 ? bright : dark, off);
    }
    fmt::print(
        "readings with 1 % noise, 17 values: luminance off by {:.2f} % at worst, below 1 % of white by {:.2f} %\n",
        100 * bright, 100 * dark);
    EXPECT_LT(bright, 0.02);
    EXPECT_LT(dark, 0.08);
}

TEST(LuminanceFit, ValuesOfShareUndoSharesOfValue)
{
    LuminanceFit const fit = fit_luminance(readings_of({}, 9, 0), {});
    DisplayLuminance light = fit.light;
    for (bool const table : {false, true}) {
        light.uses_table = table;
        for (int i = 0; i <= 255; ++i)
            for (int c = 0; c < 3; ++c)
                if (double const share = share_of_value(light, c, i / 255.0); share > 0 && share < 1) {
                    EXPECT_NEAR(value_of_share(light, c, share), i / 255.0, 1e-9);
                }
    }
}

/// Residuals that no gamma explains: an S curve, as of panels with "contrast enhancement".
TEST(LuminanceFit, TakesTheTableWhereNoFormulaFits)
{
    std::vector<LuminanceReading> readings;
    auto const light = [](double v) { return 0.2 + 100 * std::pow(v, 2.2) * (1 + 0.25 * std::sin(6.28 * v)); };
    for (int i = 0; i <= 32; ++i) readings.push_back({PatchColour::white, i / 32.0, light(i / 32.0)});
    LuminanceFit const fit = fit_luminance(readings, {});
    EXPECT_TRUE(fit.light.uses_table);
    double worst = 0;
    for (int i = 6; i <= 32; ++i)
        worst = std::max(worst,
                         std::abs(luminance_of(fit.light, {i / 32.0, i / 32.0, i / 32.0}) / light(i / 32.0) - 1));
    EXPECT_LT(worst, 1e-9) << "at the readings";
    EXPECT_NE(std::find_if(fit.warnings.begin(), fit.warnings.end(),
                           [](std::string const& w) { return w.find("the table counts") != std::string::npos; }),
              fit.warnings.end());
}

TEST(LuminanceFit, SaysWhereChannelsDoNotAddUp)
{
    std::vector<LuminanceReading> readings = readings_of({}, 9, 0);
    for (LuminanceReading& r : readings)
        if (r.colour == PatchColour::white) r.cd_m2 *= 1.3; // a white subpixel
    LuminanceFit const fit = fit_luminance(readings, {});
    ASSERT_TRUE(fit.light.additivity_error);
    EXPECT_NEAR(*fit.light.additivity_error, 1 / 1.3 - 1, 0.01);
    EXPECT_TRUE(std::any_of(fit.warnings.begin(), fit.warnings.end(),
                            [](std::string const& w) { return w.find("do not add up") != std::string::npos; }));
}

TEST(LuminanceFit, WhiteAloneIsSharedByTheChannelsOfSrgb)
{
    std::vector<LuminanceReading> readings;
    for (int i = 0; i <= 8; ++i)
        readings.push_back({PatchColour::white, i / 8.0, 0.1 + 100 * std::pow(i / 8.0, 2.2)});
    LuminanceFit const fit = fit_luminance(readings, {});
    EXPECT_NEAR(fit.light.channels[0].peak / 100, 0.2126, 5e-4); // Rec. 709
    EXPECT_NEAR(fit.light.channels[1].peak / 100, 0.7152, 5e-4);
    EXPECT_NEAR(fit.light.channels[2].peak / 100, 0.0722, 5e-4);
}

TEST(LuminanceFit, RefusesWhatCannotBeFitted)
{
    EXPECT_THROW(fit_luminance({}, {}), gi::InputError);
    EXPECT_THROW(fit_luminance({{PatchColour::white, 0, 0.1}, {PatchColour::white, 1, 80}}, {}), gi::InputError);
    EXPECT_THROW(
        fit_luminance({{PatchColour::white, 0, 80}, {PatchColour::white, 0.5, 80}, {PatchColour::white, 1, 80}},
                      {}),
        gi::InputError);
    EXPECT_THROW(
        fit_luminance({{PatchColour::red, 0, 0}, {PatchColour::red, 0.5, 8}, {PatchColour::red, 1, 30}}, {}),
        gi::InputError);
    EXPECT_THROW(luminance_shares({{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, {0.7, 0.2}}), gi::InputError);
}

TEST(LuminanceFit, SaysWhatIsWrongWithReadings)
{
    auto const message = [](std::vector<LuminanceReading> const& readings) -> std::string {
        try {
            fit_luminance(readings, {});
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return "";
    };
    constexpr auto kWhite = PatchColour::white;
    EXPECT_TRUE(message({{kWhite, 0, 0.3}, {kWhite, 0.5, 80}, {kWhite, 1, 20}})
                    .starts_with("white falls to 20 cd/m2 at its highest value, from 80 at 0.5"));
    EXPECT_TRUE(message({{kWhite, 0, 0}, {kWhite, 0.25, 0}, {kWhite, 0.5, 0}, {kWhite, 1, 80}})
                    .starts_with("white rises from 0 to 80 cd/m2 as with a gamma of "));
}

TEST(LuminanceFit, SaysWhereRepeatedReadingsDisagree)
{
    auto readings = readings_of({}, 9, 0);
    auto const is_told = [&] {
        auto const warnings = fit_luminance(readings, {}).warnings;
        return std::any_of(warnings.begin(), warnings.end(), [](std::string const& w) {
            return w.find("repeated readings of white at 1 differ by 30 %") != std::string::npos;
        });
    };
    readings.push_back({PatchColour::white, 1, TrueDisplay{}.white(1)});
    EXPECT_FALSE(is_told());
    readings.back().cd_m2 *= 0.7;
    EXPECT_TRUE(is_told());
}

TEST(GammaByEye, IsTheSlopeOfTheMatches)
{
    std::vector<GammaMatch> matches;
    for (double const share : {0.25, 0.5, 0.75})
        matches.push_back({PatchColour::white, share, std::pow(share, 1 / 2.31)});
    LuminanceFit const fit = fit_matches(matches, 120, 0.4, {});
    EXPECT_NEAR(fit.light.channels[1].gamma, 2.31, 1e-9);
    EXPECT_NEAR(fit.light.white(), 120, 1e-9);
    EXPECT_TRUE(fit.warnings.empty());
    EXPECT_FALSE(fit_matches(matches, {}, {}, {}).light.is_absolute);
    EXPECT_THROW(fit_matches({}, 100, 0, {}), gi::InputError);
    EXPECT_THROW(fit_matches({{PatchColour::white, 0.5, 1}}, 100, 0, {}), gi::InputError);
}

TEST(LuminanceReadings, AreReadFromTablesOfPhotometers)
{
    auto const readings =
        read_readings("# spot meter\nvalue,channel,cd_m2\n0,white,0.2\n128, w ,21.5\n255,white,100\n", "a.csv");
    ASSERT_EQ(readings.size(), 3u);
    EXPECT_NEAR(readings[1].value, 128.0 / 255, 1e-12);
    EXPECT_EQ(readings[1].cd_m2, 21.5);
    auto const error_of = [](std::string const& text) {
        try {
            read_readings(text, "a.csv");
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_EQ(error_of("value,cd_m2\n0.5,x\n").substr(0, 11), "a.csv:2:1: ");
    EXPECT_NE(error_of("a,b\n1,2\n").find("no columns value and cd_m2"), std::string::npos);
    EXPECT_NE(error_of("channel,value,cd_m2\npurple,1,2\n").find("'purple' is no channel"), std::string::npos);
    EXPECT_NE(error_of("value,cd_m2\n300,2\n").find("the value 300"), std::string::npos);
    EXPECT_NE(error_of("").find("no readings"), std::string::npos);
}

TEST(DisplayModelFile, GivesTheSameModelBack)
{
    DisplayModel m;
    m.date = "2026-11-26";
    m.by = "A \"B\" C";
    m.instrument = "LS-150";
    m.monitor = "DELL U2720Q";
    m.refresh_hz = 59.94;
    m.screen = ScreenGeometry{3840, 2160, 59.67, 33.56, 57, "typed"};
    m.ipd_mm = 63;
    m.luminance = fit_luminance(readings_of({}, 9, 0), {}).light;
    m.colour = kSrgbColour;
    std::string const text = display_model_text(m);
    DisplayModel const back = parse_display_model(text, "m.yaml");
    EXPECT_EQ(back.by, m.by);
    EXPECT_EQ(back.screen, m.screen);
    EXPECT_EQ(back.colour, m.colour);
    EXPECT_EQ(display_model_text(back), text);
    EXPECT_EQ(back.luminance->channels[1].table, m.luminance->channels[1].table);
    EXPECT_EQ(back.sha256.size(), 64u);
}

TEST(DisplayModelFile, NamesTheLineOfAMistake)
{
    auto const error_of = [](std::string const& text) {
        try {
            parse_display_model("schema: display-model/1\n" + text, "m.yaml");
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_EQ(error_of("gama: 2\n").substr(0, 9), "m.yaml:2:");
    EXPECT_NE(error_of("screen: {size_px: [1920, 1080], size_cm: [53, 53]}\n").find("nearly square"),
              std::string::npos);
    EXPECT_NE(error_of("ipd_mm: 6.3\n").find("ipd_mm"), std::string::npos);
    EXPECT_NE(
        error_of(
            "luminance: {black: 0.1, red: {peak: 20, gamma: 2.2}, green: {peak: 70, gamma: 2.2}, blue: {peak: "
            "7, gamma: 2.2, table: [[0, 0], [0.5, 0.6], [0.6, 0.5], [1, 1]]}, method: photometer}\n")
            .find("does not rise"),
        std::string::npos);
    EXPECT_NE(
        error_of("colour: {red_xy: [0.6, 0.6], green_xy: [0.3, 0.6], blue_xy: [0.15, 0.06], white_xy: [0.31, "
                 "0.33]}\n")
            .find("no chromaticity"),
        std::string::npos);
}

} // namespace
} // namespace study::test
