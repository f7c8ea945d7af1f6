#pragma once
// A sound device that plays sounds at given times and says when their first samples left it, by PortAudio.
//
// The device's stream runs from construction to destruction, silent between sounds, so that its timing is steady.

#include "viewer/experiment/sound/sound_mixer.h"

#include <string>
#include <utility>

namespace viewer {

class AudioOutput : public SoundMixer {
public:
    /// Opens the device and waits until its timing is known.
    /// @param device  "default", or a part of its name   @param rate_hz of the sounds
    /// @param latency_ms  wanted; smaller ones risk underruns
    /// Throws InputError: there is none such (all are named), it does not take the rate.
    AudioOutput(std::string const& device, int rate_hz, double latency_ms);
    ~AudioOutput() override;
    AudioOutput(AudioOutput const&) = delete;
    AudioOutput& operator=(AudioOutput const&) = delete;

    double lead_s() const override;
    bool is_running() const override;
    /// Facts for the records: audio_device, audio_host, audio_rate_hz, audio_latency_ms, audio_onset_method.
    std::vector<std::pair<std::string, std::string>> about() const;

private:
    struct Stream;
    std::unique_ptr<Stream> stream_;
};

} // namespace viewer
