#include "viewer/experiment/sound/sound_files.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <sndfile.h>

namespace viewer {
namespace {

constexpr int kUsualRate_hz = 48000;
constexpr double kMost_s = 600;

struct Close {
    void operator()(SNDFILE* f) const { sf_close(f); }
};

double gain(study::Sound const& s) { return std::pow(10, s.level_db / 20); }

/// Sampling rate of the files; reports files whose rate differs from the first.
int common_rate(study::Script const& script, std::vector<SoundSamples> const& files, study::Mistakes& m)
{
    int rate_hz = 0;
    std::string first;
    for (std::size_t i = 0; i < files.size(); ++i) {
        study::Sound const& s = script.sounds[i];
        if (s.file.empty() || files[i].samples.empty()) continue;
        if (rate_hz == 0) {
            rate_hz = files[i].rate_hz;
            first = s.file;
        } else if (files[i].rate_hz != rate_hz) {
            m.add(gi::InputError(
                {script.file, s.file_place.line, s.file_place.column},
                fmt::format("'{}' has {} samples a second, '{}' {}", s.file, files[i].rate_hz, first, rate_hz),
                "all are played as they are, by one device",
                fmt::format("convert it: sox {} -r {} OUT.wav", s.file, rate_hz)));
        }
    }
    return rate_hz > 0 ? rate_hz : kUsualRate_hz;
}

std::vector<SoundSamples> read_files(study::Script const& script, std::filesystem::path const& folder,
                                     study::Mistakes& m)
{
    std::vector<SoundSamples> files(script.sounds.size());
    for (std::size_t i = 0; i < files.size(); ++i)
        if (!script.sounds[i].file.empty())
            m.attempt([&] { files[i] = read_sound(script, script.sounds[i], folder); });
    return files;
}

} // namespace

SoundSamples make_tone(study::Sound const& tone, int rate_hz)
{
    SoundSamples out;
    out.rate_hz = rate_hz;
    auto const frames = std::size_t(std::max(1L, std::lround(1e-3 * tone.duration_ms * rate_hz)));
    double const ramp = 1e-3 * tone.ramp_ms * rate_hz, amplitude = gain(tone);
    out.samples.reserve(2 * frames);
    for (std::size_t i = 0; i < frames; ++i) {
        double const to_end = double(std::min(i, frames - 1 - i)) + 0.5;
        // 0 to 1 over the ramp.
        double const rise = to_end < ramp ? 0.5 - 0.5 * std::cos(std::numbers::pi * to_end / ramp) : 1;
        auto const v =
            float(amplitude * rise * std::sin(2 * std::numbers::pi * tone.tone_hz * double(i) / rate_hz));
        out.samples.push_back(tone.channel == study::SoundChannel::right ? 0 : v);
        out.samples.push_back(tone.channel == study::SoundChannel::left ? 0 : v);
    }
    return out;
}

SoundSamples read_sound(study::Script const& script, study::Sound const& sound,
                        std::filesystem::path const& folder)
{
    gi::TextLocation const place{script.file, sound.file_place.line, sound.file_place.column};
    std::filesystem::path const file = folder / sound.file;
    std::error_code failure;
    if (!std::filesystem::is_regular_file(file, failure))
        throw gi::InputError(place, "there is no file '" + sound.file + "'", "paths begin at the script",
                             "correct the name");
    SF_INFO info{};
    std::unique_ptr<SNDFILE, Close> const open(sf_open(file.c_str(), SFM_READ, &info));
    if (!open)
        throw gi::InputError(place, fmt::format("'{}' is no sound that can be read", sound.file),
                             sf_strerror(nullptr), "convert it to WAV");
    if (info.channels > 2)
        throw gi::InputError(place, fmt::format("'{}' has {} channels", sound.file, info.channels),
                             "sounds have one or two", "mix them down");
    if (info.frames < 1 || double(info.frames) / info.samplerate > kMost_s)
        throw gi::InputError(place, fmt::format("'{}' has {} samples a channel", sound.file, info.frames),
                             "sounds have 1 sample to 10 minutes", "choose another file");
    std::vector<float> read(std::size_t(info.frames) * std::size_t(info.channels));
    sf_count_t const got = sf_readf_float(open.get(), read.data(), info.frames);
    if (got != info.frames)
        throw gi::InputError(place, fmt::format("'{}' ends after {} of {} samples", sound.file, got, info.frames),
                             "it was cut off, or is damaged", "copy it again, or write it as WAV of 16 bits");
    SoundSamples out;
    out.rate_hz = info.samplerate;
    auto const amplitude = float(gain(sound));
    for (std::size_t i = 0; i < read.size(); ++i)
        for (int copies = info.channels == 1 ? 2 : 1; copies > 0; --copies)
            out.samples.push_back(amplitude * read[i]);
    return out;
}

std::vector<std::shared_ptr<SoundSamples const>> load_sounds(study::Script const& script,
                                                             std::filesystem::path const& folder)
{
    study::Mistakes m;
    std::vector<SoundSamples> files = read_files(script, folder, m);
    int const rate_hz = common_rate(script, files, m);
    if (!m.empty()) throw m.in_order().front();
    std::vector<std::shared_ptr<SoundSamples const>> all;
    for (std::size_t i = 0; i < files.size(); ++i)
        all.push_back(std::make_shared<SoundSamples const>(
            script.sounds[i].file.empty() ? make_tone(script.sounds[i], rate_hz) : std::move(files[i])));
    return all;
}

void find_wrong_sounds(study::Script const& script, std::filesystem::path const& folder, study::Mistakes& m)
{
    common_rate(script, read_files(script, folder, m), m);
}

} // namespace viewer
