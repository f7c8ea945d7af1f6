#include "viewer/experiment/sound/sound_mixer.h"

#include <algorithm>
#include <cmath>

namespace viewer {

void SoundMixer::fill(float* out, std::size_t frames, double first_s, double rate_hz)
{
    std::fill_n(out, 2 * frames, 0.0f);
    for (Voice& v : voices_) {
        VoiceState state = v.state.load(std::memory_order_acquire);
        std::size_t at = 0;
        if (state == VoiceState::waiting) {
            double const wait = std::round((v.at_s - first_s) * rate_hz);
            if (wait >= double(frames)) continue;
            // A voice released before it began is already free.
            if (!v.state.compare_exchange_strong(state, VoiceState::playing)) continue;
            at = std::size_t(std::max(0.0, wait));
            v.onset_s = first_s + double(at) / rate_hz;
            v.underruns_before = underruns_;
        } else if (state != VoiceState::playing) {
            continue;
        }
        std::vector<float> const& samples = v.sound->samples;
        for (; at < frames && v.next < samples.size(); ++at, v.next += 2) {
            out[2 * at] += samples[v.next];
            out[2 * at + 1] += samples[v.next + 1];
        }
        v.underruns = underruns_ - v.underruns_before;
        if (v.next < samples.size()) continue;
        v.state = VoiceState::done;
        if (v.is_released) v.state = VoiceState::free;
    }
    for (std::size_t i = 0; i < 2 * frames; ++i)
        if (std::abs(out[i]) > 1) {
            out[i] = std::clamp(out[i], -1.0f, 1.0f);
            ++clipped_;
        }
}

std::optional<SoundTicket> SoundMixer::start(std::shared_ptr<SoundSamples const> sound, double at_s)
{
    for (std::size_t i = 0; i < voices_.size(); ++i) {
        Voice& v = voices_[i];
        if (v.state.load(std::memory_order_acquire) != VoiceState::free) continue;
        v.sound = std::move(sound);
        v.at_s = at_s;
        v.next = 0;
        v.is_released = false;
        v.onset_s = 0;
        v.underruns = 0;
        v.state.store(VoiceState::waiting, std::memory_order_release);
        return SoundTicket{int(i)};
    }
    return {};
}

SoundReport SoundMixer::report(SoundTicket ticket) const
{
    Voice const& v = voices_.at(std::size_t(ticket.voice));
    SoundReport r;
    if (v.onset_s > 0) r.onset_s = v.onset_s;
    r.underruns = v.underruns;
    return r;
}

void SoundMixer::release(SoundTicket ticket)
{
    Voice& v = voices_.at(std::size_t(ticket.voice));
    VoiceState waiting = VoiceState::waiting, done = VoiceState::done;
    if (v.state.compare_exchange_strong(waiting, VoiceState::free)) return;
    v.is_released = true;
    v.state.compare_exchange_strong(done, VoiceState::free); // it may have ended before it saw that
}

} // namespace viewer
