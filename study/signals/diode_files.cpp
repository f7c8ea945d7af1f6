#include "gi/core/quantile.h"
#include "gi/core/text.h"
#include "study/signals/photodiode.h"

#include <cstdint>
#include <cstring>
#include <fmt/format.h>

namespace study {
namespace {

template <class T>
T little_endian(std::string const& bytes, std::size_t at)
{
    T value{};
    if (at + sizeof value <= bytes.size()) std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

gi::InputError wrong_wav(std::string const& file, std::string const& problem, std::string const& suggestion)
{
    return {gi::TextLocation{file, 0, 0}, problem, "it is read as a WAV file", suggestion};
}

/// One sample of PCM or float, about -1 to 1.
double sample_of(std::string const& b, std::size_t at, int bits, bool is_float)
{
    if (is_float) return bits == 64 ? little_endian<double>(b, at) : double(little_endian<float>(b, at));
    if (bits == 8) return (double(std::uint8_t(b[at])) - 128) / 128;
    if (bits == 16) return little_endian<std::int16_t>(b, at) / 32768.0;
    if (bits == 32) return little_endian<std::int32_t>(b, at) / 2147483648.0;
    std::int32_t const v =
        std::int32_t(std::uint32_t(std::uint8_t(b[at])) << 8 | std::uint32_t(std::uint8_t(b[at + 1])) << 16 |
                     std::uint32_t(std::uint8_t(b[at + 2])) << 24);
    return v / 2147483648.0;
}

} // namespace

DiodeSignal read_wav(std::string const& b, std::string const& file)
{
    if (b.size() < 44 || b.compare(0, 4, "RIFF") != 0 || b.compare(8, 4, "WAVE") != 0)
        throw wrong_wav(file, "this is no WAV file", "record WAV (PCM or float), or CSV");
    int format = 0, channels = 0, bits = 0;
    std::uint32_t rate = 0;
    for (std::size_t at = 12; at + 8 <= b.size();) {
        std::size_t const size = little_endian<std::uint32_t>(b, at + 4), data = at + 8;
        if (b.compare(at, 4, "fmt ") == 0 && size >= 16) {
            format = little_endian<std::uint16_t>(b, data);
            channels = little_endian<std::uint16_t>(b, data + 2);
            rate = little_endian<std::uint32_t>(b, data + 4);
            bits = little_endian<std::uint16_t>(b, data + 14);
            if (format == 0xfffe && size >= 26) format = little_endian<std::uint16_t>(b, data + 24); // extensible
        } else if (b.compare(at, 4, "data") == 0) {
            bool const is_float = format == 3 && (bits == 32 || bits == 64);
            bool const is_pcm = format == 1 && (bits == 8 || bits == 16 || bits == 24 || bits == 32);
            if ((!is_float && !is_pcm) || channels < 1 || rate == 0)
                throw wrong_wav(file, fmt::format("format {} with {} channels of {} bits", format, channels, bits),
                                "record PCM or float samples");
            std::size_t const width = std::size_t(bits / 8), step = width * std::size_t(channels);
            std::size_t const frames = std::min(size, b.size() - data) / step;
            DiodeSignal s;
            s.rate_hz = rate;
            s.time_s.reserve(frames);
            s.light.reserve(frames);
            for (std::size_t i = 0; i < frames; ++i) {
                s.time_s.push_back(double(i) / rate);
                s.light.push_back(sample_of(b, data + i * step, bits, is_float));
                if (channels > 1) s.trigger.push_back(sample_of(b, data + i * step + width, bits, is_float));
            }
            return s;
        }
        at = data + size + (size & 1);
    }
    throw wrong_wav(file, "no samples in it", "record longer than a trial, with the input switched on");
}

DiodeSignal read_diode_csv(std::string const& text, std::string const& file)
{
    DiodeSignal s;
    int time = -1, light = -1, trigger = -1;
    double unit_s = 1;
    std::string_view rest = text;
    for (int number = 1; !rest.empty(); ++number) {
        gi::TextLine const line{gi::take_until(rest, '\n'), file, number};
        if (gi::trimmed(line.text).empty() || line.text.front() == '#') continue;
        auto const cells = gi::split_at_commas(line.text);
        if (time < 0) {
            for (int i = 0; i < int(cells.size()); ++i) {
                std::string_view const n = cells[std::size_t(i)];
                if (n == "t_s" || n == "time_s" || n == "t_ms" || n == "time_ms") {
                    time = i;
                    unit_s = n.ends_with("_ms") ? 1e-3 : 1;
                } else if (n == "light" || n == "value" || n == "photodiode" || n == "sound") {
                    light = i;
                } else if (n == "trigger") {
                    trigger = i;
                }
            }
            if (time < 0 || light < 0)
                throw line.error(line.text, "no columns t_s and light",
                                 "they hold times and the photodiode's signal",
                                 "begin the file with the line: t_s,light");
            continue;
        }
        auto const cell = [&](int column) {
            auto const v =
                column < int(cells.size()) ? gi::parse_finite(cells[std::size_t(column)]) : std::nullopt;
            if (!v)
                throw line.error(line.text, fmt::format("column {} has no number", column + 1),
                                 "every sample has one", "correct or remove the line");
            return *v;
        };
        double const t = unit_s * cell(time);
        if (!s.time_s.empty() && t <= s.time_s.back())
            throw line.error(line.text, fmt::format("the time {:g} s is not after the last one", t),
                             "samples are in the order of their times", "sort them");
        s.time_s.push_back(t);
        s.light.push_back(cell(light));
        if (trigger >= 0) s.trigger.push_back(cell(trigger));
    }
    std::vector<double> steps;
    for (std::size_t i = 1; i < s.time_s.size(); ++i) steps.push_back(s.time_s[i] - s.time_s[i - 1]);
    if (!steps.empty()) s.rate_hz = 1 / gi::median(steps);
    return s;
}

} // namespace study
