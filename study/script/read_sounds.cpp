#include "study/script/read.h"

#include <algorithm>
#include <fmt/format.h>

namespace study {
namespace {

constexpr double kMostSound_ms = 60000;

void read_tone(gi::Yaml const& y, Sound& s, Mistakes& m)
{
    m.take(y, "tone_hz", [&](gi::Yaml const& v) { s.tone_hz = v.number(20, 20000); });
    bool knows_times =
        m.take(y, "duration_ms", [&](gi::Yaml const& v) { s.duration_ms = v.number(1, kMostSound_ms); });
    knows_times &= m.take(y, "ramp_ms", [&](gi::Yaml const& v) { s.ramp_ms = v.number(0, kMostSound_ms); });
    m.take(y, "channel", [&](gi::Yaml const& v) {
        s.channel = SoundChannel(v.one_of({"both", "left", "right"}, "channel"));
    });
    if (knows_times && 2 * s.ramp_ms > s.duration_ms)
        throw y.error(fmt::format("two ramps of {:g} ms in {:g} ms", s.ramp_ms, s.duration_ms),
                      "the tone would fall before it has risen", "shorten ramp_ms");
}

} // namespace

std::vector<Sound> read_sounds(gi::Yaml const& y, Mistakes& m)
{
    std::vector<Sound> all;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] {
            Sound s;
            s.name = k.name();
            s.place = k.place();
            m.check_keys(v, "sound");
            if (v.is_map() && v.has("file") == v.has("tone_hz"))
                m.add(v.error("sound '" + s.name + "' has " +
                                  (v.has("file") ? "a file and a tone" : "neither file nor tone"),
                              "it is one of them", "write file: FILE, or tone_hz: 1000"));
            if (v.has("file")) {
                for (char const* tone : {"duration_ms", "ramp_ms", "channel"})
                    if (v.has(tone))
                        m.add(v.at(tone).error(fmt::format("'{}' of a file", tone), "only tones have it",
                                               "remove it"));
                s.level_db = 0;
                s.file_place = v.at("file").place();
                m.take(v, "file", [&](gi::Yaml const& file) { s.file = file.text(); });
            } else {
                m.attempt([&] { read_tone(v, s, m); });
            }
            m.take(v, "level_db", [&](gi::Yaml const& level) { s.level_db = level.number(-120, 0); });
            all.push_back(std::move(s));
        });
    return all;
}

std::vector<Cue> read_cues(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    std::vector<Cue> cues;
    if (y.is_text() && y.text() == "none") return cues;
    std::vector<std::string> names;
    for (Sound const& sound : s.sounds) names.push_back(sound.name);
    for (gi::Yaml const& item : y.items())
        m.attempt([&] {
            m.check_keys(item, "cue");
            Cue c;
            bool const is_known =
                m.need(item, "sound", "NAME", [&](gi::Yaml const& v) { c.sound = v.one_of(names, "sound"); });
            m.take(item, "at", [&](gi::Yaml const& v) {
                c.at = CueMoment(v.one_of({"fixation", "first_stimulus", "each_stimulus"}, "moment"));
            });
            // Before the fixation there is nothing to wait in.
            double const least = c.at == CueMoment::fixation ? 0 : -kMostSound_ms;
            m.take(item, "offset_ms", [&](gi::Yaml const& v) { c.offset_ms = v.number(least, kMostSound_ms); });
            if (is_known) cues.push_back(c);
        });
    return cues;
}

} // namespace study
