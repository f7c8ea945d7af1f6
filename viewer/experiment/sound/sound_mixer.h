#pragma once
// Mixes sounds that begin at given times into the buffers of a device, and says when their first samples leave it.
// Sounds are started by one thread; the device's asks for the buffers.

#include "viewer/experiment/sound/sound_samples.h"

#include <array>
#include <atomic>
#include <memory>
#include <optional>

namespace viewer {

/// A sound that was started.
struct SoundTicket {
    int voice = -1;
};
struct SoundReport {
    std::optional<double> onset_s; ///< steady clock; none = it has not begun
    int underruns = 0;             ///< of the device, from its start to its end
};

class SoundMixer {
public:
    virtual ~SoundMixer() = default;
    /// How long before its onset a sound must be started to begin in time, s.
    virtual double lead_s() const = 0;
    virtual bool is_running() const = 0; ///< false: the device was lost
    /// Plays the sound so that its first sample leaves at that time of the steady clock, or as soon as possible.
    /// None if too many sounds are playing.
    std::optional<SoundTicket> start(std::shared_ptr<SoundSamples const> sound, double at_s);
    SoundReport report(SoundTicket ticket) const;
    /// Gives the ticket back: a sound that plays ends normally; one that has not begun is never played.
    void release(SoundTicket ticket);
    /// Mixes the next buffer, of two channels: left, right. @param first_s  when its first frame leaves, steady clock
    void fill(float* out, std::size_t frames, double first_s, double rate_hz);

    int underruns() const { return underruns_; }
    std::size_t clipped() const { return clipped_; } ///< samples beyond full scale, of sounds that overlap

protected:
    std::atomic<int> underruns_{0}; ///< of the device

private:
    enum class VoiceState { free, waiting, playing, done };
    struct Voice {
        std::atomic<VoiceState> state{VoiceState::free};
        std::shared_ptr<SoundSamples const> sound; ///< of the thread that starts it
        double at_s = 0;
        std::size_t next = 0; ///< frame; of the device's thread
        int underruns_before = 0;
        std::atomic<bool> is_released{false};
        std::atomic<double> onset_s{0}; ///< 0 = not yet
        std::atomic<int> underruns{0};
    };
    std::array<Voice, 16> voices_;
    std::atomic<std::size_t> clipped_{0};
};

} // namespace viewer
