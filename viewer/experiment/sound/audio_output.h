#pragma once
// A sound device that plays sounds at given times and says when their first samples left it, by PortAudio.
//
// The device's stream runs from construction to destruction, silent between sounds, so that its timing is steady.
// For each buffer PortAudio says when its first sample reaches the converter (outputBufferDacTime),
// by the device's clock. That clock is mapped to the steady clock by the least difference seen in
// the last seconds, and the buffers' times are smoothed by their median relative to the count of samples:
// single late or wrong reports do not count.

#include "viewer/experiment/sound/sound_samples.h"

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace viewer {

/// A sound that was started.
struct SoundTicket {
    int voice = -1;
};
struct SoundReport {
    std::optional<double> onset_s; ///< steady clock; none = it has not begun
    int underruns = 0;             ///< of the device, from its start to its end
};

class AudioOutput {
public:
    /// Opens the device and waits until its timing is known.
    /// @param device  "default", or a part of its name   @param rate_hz of the sounds
    /// @param latency_ms  wanted; smaller ones risk underruns
    /// Throws InputError: there is none such (all are named), it does not take the rate.
    AudioOutput(std::string const& device, int rate_hz, double latency_ms);
    ~AudioOutput();
    AudioOutput(AudioOutput const&) = delete;
    AudioOutput& operator=(AudioOutput const&) = delete;

    /// How long before its onset a sound must be started to begin in time, s.
    double lead_s() const;
    /// Plays the sound so that its first sample leaves at that time of the steady clock, or as soon as possible.
    /// None if too many sounds are playing.
    std::optional<SoundTicket> start(std::shared_ptr<SoundSamples const> sound, double at_s);
    SoundReport report(SoundTicket ticket) const;
    /// Gives the ticket back: a sound that plays ends normally; one that has not begun is never played.
    void release(SoundTicket ticket);

    bool is_running() const; ///< false: the device was lost
    int underruns() const { return underruns_; }
    std::size_t clipped() const { return clipped_; } ///< samples beyond full scale, of sounds that overlap
    /// Facts for the records: audio_device, audio_host, audio_rate_hz, audio_latency_ms, audio_onset_method.
    std::vector<std::pair<std::string, std::string>> about() const;

private:
    struct Stream;
    friend struct Stream;
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
    void fill(float* out, std::size_t frames, double first_s, double rate_hz);

    std::array<Voice, 16> voices_;
    std::atomic<int> underruns_{0};
    std::atomic<std::size_t> clipped_{0};
    std::unique_ptr<Stream> stream_;
};

} // namespace viewer
