#include "study/display/model_file.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "gi/core/yaml.h"
#include "study/display/geometry.h"

#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

using gi::Yaml;
constexpr char const* kChannels[]{"red", "green", "blue"};

std::string text_of_key(Yaml const& y, char const* key) { return y.has(key) ? y.at(key).text() : ""; }

ScreenGeometry read_screen(Yaml const& y)
{
    y.only_keys({"size_px", "size_cm", "distance_cm", "method"});
    ScreenGeometry s;
    auto const px = y.needed("size_px", "[1920, 1080]").numbers(2, 1, 65536);
    auto const cm = y.needed("size_cm", "[53.1, 29.9]").numbers(2, 0.1, 10000);
    s.width_px = int(px[0]);
    s.height_px = int(px[1]);
    if (s.width_px != px[0] || s.height_px != px[1])
        throw y.at("size_px").error("pixels that are no whole numbers", "a mode has whole pixels",
                                    "write [1920, 1080]");
    s.width_cm = cm[0];
    s.height_cm = cm[1];
    if (y.has("distance_cm")) s.distance_cm = y.at("distance_cm").number(1, 100000);
    s.method = text_of_key(y, "method");
    double const shape = (s.width_px / s.width_cm) / (s.height_px / s.height_cm);
    if (shape < 0.8 || shape > 1.25)
        throw y.at("size_cm").error(fmt::format("pixels {:.2f} times as dense across as down", shape),
                                    "pixels are nearly square", "check size_cm and size_px");
    return s;
}

ChannelCurve read_curve(Yaml const& y)
{
    y.only_keys({"peak", "gamma", "gain", "points", "rms_percent", "worst_percent", "table"});
    ChannelCurve c;
    c.peak = y.needed("peak", "17.0").number(1e-9, 1e5);
    c.gamma = y.needed("gamma", "2.2").number(0.2, 10);
    if (y.has("gain")) c.gain = y.at("gain").number(0.1, 10);
    if (y.has("points")) c.points = int(y.at("points").integer(0, 100000));
    if (y.has("rms_percent")) c.rms_percent = y.at("rms_percent").number(0, 1e6);
    if (y.has("worst_percent")) c.worst_percent = y.at("worst_percent").number(0, 1e6);
    if (!y.has("table")) return c;
    for (Yaml const& item : y.at("table").items(2, 65536)) {
        auto const v = item.numbers(2, 0, 1);
        if (!c.table.empty() && (v[0] <= c.table.back().first || v[1] < c.table.back().second))
            throw item.error("a table that does not rise", "a luminance has one value", "sort it by value");
        c.table.emplace_back(v[0], v[1]);
    }
    if (c.table.front() != std::pair{0.0, 0.0} || c.table.back() != std::pair{1.0, 1.0})
        throw y.at("table").error("a table that does not go from [0, 0] to [1, 1]", "it holds shares of the peak",
                                  "add its ends");
    return c;
}

DisplayLuminance read_luminance(Yaml const& y)
{
    y.only_keys({"method", "unit", "black", "curve", "additivity_error", "red", "green", "blue"});
    DisplayLuminance l;
    l.method =
        LuminanceMethod(y.needed("method", "photometer").one_of({"photometer", "by_eye"}, "way to measure"));
    if (y.has("unit")) l.is_absolute = y.at("unit").one_of({"cd/m2", "relative"}, "unit of luminance") == 0;
    l.black = y.needed("black", "0.3").number(0, 1e5);
    if (y.has("additivity_error")) l.additivity_error = y.at("additivity_error").number(-1, 100);
    for (int c = 0; c < 3; ++c)
        l.channels[std::size_t(c)] = read_curve(y.needed(kChannels[c], "{peak: 17.0, gamma: 2.2}"));
    if (!y.has("curve")) return l;
    l.uses_table = y.at("curve").one_of({"formula", "table"}, "kind of curve") == 1;
    for (ChannelCurve const& c : l.channels)
        if (l.uses_table && c.table.empty())
            throw y.at("curve").error("curve: table without tables", "there is nothing to interpolate",
                                      "add `table` to every channel, or write curve: formula");
    return l;
}

Chromaticity read_xy(Yaml const& y)
{
    auto const v = y.numbers(2, 0, 1);
    if (v[1] <= 0 || v[0] + v[1] > 1)
        throw y.error(fmt::format("({:g}, {:g}) is no chromaticity", v[0], v[1]),
                      "y is above 0 and x + y at most 1", "write CIE 1931 x and y");
    return {v[0], v[1]};
}

DisplayColour read_colour(Yaml const& y)
{
    y.only_keys({"red_xy", "green_xy", "blue_xy", "white_xy"});
    return {read_xy(y.needed("red_xy", "[0.64, 0.33]")), read_xy(y.needed("green_xy", "[0.30, 0.60]")),
            read_xy(y.needed("blue_xy", "[0.15, 0.06]")), read_xy(y.needed("white_xy", "[0.3127, 0.3290]"))};
}

std::string quoted(std::string const& text)
{
    std::string out = "\"";
    for (char const c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + '"';
}

std::string curve_text(char const* name, ChannelCurve const& c)
{
    std::string t =
        fmt::format("  {}:\n    peak: {}\n    gamma: {}\n    gain: {}\n    points: {}\n    rms_percent: "
                    "{:.3f}\n    worst_percent: {:.3f}\n",
                    name, c.peak, c.gamma, c.gain, c.points, c.rms_percent, c.worst_percent);
    if (c.table.empty()) return t;
    t += "    table: [";
    for (std::size_t i = 0; i < c.table.size(); ++i)
        t += fmt::format("{}[{}, {}]", i == 0 ? "" : ", ", c.table[i].first, c.table[i].second);
    return t + "]\n";
}

} // namespace

DisplayModel parse_display_model(std::string const& text, std::string const& file)
{
    Yaml const y = Yaml::parse(text, file, "display model");
    Yaml const schema = y.needed("schema", "display-model/1");
    if (schema.text() != "display-model/1") throw schema.unknown("known schema", {"display-model/1"});
    y.only_keys({"schema", "date", "by", "instrument", "room", "monitor", "connector", "refresh_hz", "bits",
                 "screen", "ipd_mm", "luminance", "colour"});
    DisplayModel m;
    m.date = text_of_key(y, "date");
    m.by = text_of_key(y, "by");
    m.instrument = text_of_key(y, "instrument");
    m.room = text_of_key(y, "room");
    m.monitor = text_of_key(y, "monitor");
    m.connector = text_of_key(y, "connector");
    if (y.has("refresh_hz")) m.refresh_hz = y.at("refresh_hz").number(0, 10000);
    if (y.has("bits")) m.bits = int(y.at("bits").integer(1, 16));
    if (y.has("screen")) m.screen = read_screen(y.at("screen"));
    if (y.has("ipd_mm")) m.ipd_mm = y.at("ipd_mm").number(40, 80);
    if (y.has("luminance")) m.luminance = read_luminance(y.at("luminance"));
    if (y.has("colour")) m.colour = read_colour(y.at("colour"));
    m.sha256 = gi::sha256(text);
    return m;
}

DisplayModel load_display_model(std::filesystem::path const& file)
{
    return parse_display_model(gi::read_text(file, std::size_t(1) << 20), file.string());
}

std::string display_model_text(DisplayModel const& m)
{
    std::string t = "schema: display-model/1\n";
    for (auto const& [key, value] : {std::pair{"date", &m.date},
                                     {"by", &m.by},
                                     {"instrument", &m.instrument},
                                     {"room", &m.room},
                                     {"monitor", &m.monitor},
                                     {"connector", &m.connector}})
        if (!value->empty()) t += fmt::format("{}: {}\n", key, quoted(*value));
    if (m.refresh_hz > 0) t += fmt::format("refresh_hz: {}\n", m.refresh_hz);
    t += fmt::format("bits: {}\n", m.bits);
    if (m.ipd_mm) t += fmt::format("ipd_mm: {}\n", *m.ipd_mm);
    if (auto const& s = m.screen) {
        t += fmt::format("screen:\n  size_px: [{}, {}]\n  size_cm: [{}, {}]\n", s->width_px, s->height_px,
                         s->width_cm, s->height_cm);
        if (s->distance_cm > 0) t += fmt::format("  distance_cm: {}\n", s->distance_cm);
        if (!s->method.empty()) t += fmt::format("  method: {}\n", quoted(s->method));
    }
    if (auto const& l = m.luminance) {
        t += fmt::format("luminance:\n  method: {}\n  unit: {}\n  black: {}\n  curve: {}\n",
                         l->method == LuminanceMethod::photometer ? "photometer" : "by_eye",
                         l->is_absolute ? "cd/m2" : "relative", l->black, l->uses_table ? "table" : "formula");
        if (l->additivity_error) t += fmt::format("  additivity_error: {:.5f}\n", *l->additivity_error);
        for (int c = 0; c < 3; ++c) t += curve_text(kChannels[c], l->channels[std::size_t(c)]);
    }
    if (auto const& c = m.colour)
        t += fmt::format(
            "colour: {{red_xy: [{}, {}], green_xy: [{}, {}], blue_xy: [{}, {}], white_xy: [{}, {}]}}\n", c->red.x,
            c->red.y, c->green.x, c->green.y, c->blue.x, c->blue.y, c->white.x, c->white.y);
    return t;
}

std::string display_model_summary(DisplayModel const& m)
{
    std::string t =
        fmt::format("display model: {}{}{}\n", m.monitor.empty() ? "unnamed monitor" : m.monitor,
                    m.date.empty() ? "" : ", " + m.date, m.instrument.empty() ? "" : ", " + m.instrument);
    if (auto const& s = m.screen) {
        t += fmt::format("  {} x {} px, {:.1f} x {:.1f} cm", s->width_px, s->height_px, s->width_cm, s->height_cm);
        if (s->distance_cm > 0) {
            auto const [across, down] = screen_deg(*s);
            t += fmt::format(" at {:.1f} cm: {:.2f} pixels per degree, {:.1f} x {:.1f} deg", s->distance_cm,
                             pixels_per_degree(*s), across, down);
        }
        t += "\n";
    } else {
        t += "  size unknown: no degrees\n";
    }
    if (auto const& l = m.luminance) {
        t += fmt::format("  {}{}: black {:.3g}, white {:.4g}{}\n",
                         l->method == LuminanceMethod::photometer ? "measured" : "matched by eye",
                         l->uses_table ? ", table" : "", l->black, l->white(),
                         l->is_absolute ? " cd/m2" : " (relative)");
        for (int c = 0; c < 3; ++c) {
            ChannelCurve const& v = l->channels[std::size_t(c)];
            t += fmt::format("  {:<5} peak {:.4g}, gamma {:.3f}, gain {:.3f}; {} values", kChannels[c], v.peak,
                             v.gamma, v.gain, v.points);
            if (l->method == LuminanceMethod::photometer)
                t += fmt::format(", off by {:.2f} % (rms), {:.2f} % (worst)", v.rms_percent, v.worst_percent);
            t += "\n";
        }
    } else {
        t += "  luminance unknown: no cd/m2\n";
    }
    return t;
}

std::vector<std::pair<std::string, std::string>> display_model_facts(DisplayModel const& m)
{
    std::vector<std::pair<std::string, std::string>> facts{
        {"display_model",
         (m.monitor.empty() ? "unnamed monitor" : m.monitor) + (m.date.empty() ? "" : ", " + m.date)},
        {"display_model_sha256", m.sha256}};
    if (!m.instrument.empty()) facts.emplace_back("photometer", m.instrument);
    if (!m.room.empty()) facts.emplace_back("room", m.room);
    if (m.ipd_mm) facts.emplace_back("ipd_mm", fmt::format("{:g}", *m.ipd_mm));
    if (auto const& s = m.screen) {
        facts.emplace_back("screen_px", fmt::format("{} x {}", s->width_px, s->height_px));
        facts.emplace_back("screen_cm", fmt::format("{:.2f} x {:.2f}", s->width_cm, s->height_cm));
        if (s->distance_cm > 0) {
            facts.emplace_back("viewing_distance_cm", fmt::format("{:g}", s->distance_cm));
            facts.emplace_back("pixels_per_degree", fmt::format("{:.3f}", pixels_per_degree(*s)));
        }
    }
    if (auto const& l = m.luminance; l && l->is_absolute) {
        facts.emplace_back("black_cd_m2", fmt::format("{:.4g}", l->black));
        facts.emplace_back("white_cd_m2", fmt::format("{:.5g}", l->white()));
    }
    if (auto const& l = m.luminance)
        facts.emplace_back("gamma", fmt::format("{:.3f} {:.3f} {:.3f}", l->channels[0].gamma, l->channels[1].gamma,
                                                l->channels[2].gamma));
    return facts;
}

} // namespace study
