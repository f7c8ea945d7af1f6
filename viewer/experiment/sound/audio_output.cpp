#include "viewer/experiment/sound/audio_output.h"

#include "gi/core/error.h"
#include "viewer/experiment/sound/buffer_times.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fcntl.h>
#include <fmt/format.h>
#include <portaudio.h>
#include <thread>
#include <unistd.h>

namespace viewer {
namespace {

double steady_s()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// PortAudio and ALSA write about devices that they do not find to stderr while they look for some.
class WithoutStderr {
public:
    WithoutStderr() : kept_(::dup(STDERR_FILENO))
    {
        int const nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (nowhere >= 0) {
            ::dup2(nowhere, STDERR_FILENO);
            ::close(nowhere);
        }
    }
    ~WithoutStderr()
    {
        if (kept_ < 0) return;
        ::dup2(kept_, STDERR_FILENO);
        ::close(kept_);
    }
    WithoutStderr(WithoutStderr const&) = delete;
    WithoutStderr& operator=(WithoutStderr const&) = delete;

private:
    int kept_;
};

std::string all_outputs()
{
    std::string names;
    for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i)
        if (PaDeviceInfo const* const d = Pa_GetDeviceInfo(i); d && d->maxOutputChannels > 0)
            names += (names.empty() ? "" : ", ") + std::string(d->name);
    return names;
}

constexpr char const* kWithout = "or run without sound: --audio none";

PaDeviceIndex find_output(std::string const& name)
{
    std::string const all = all_outputs();
    if (all.empty())
        throw gi::InputError("there is no sound device", "the script has cues that are heard",
                             fmt::format("connect one, {}", kWithout));
    if (name == "default") {
        if (PaDeviceIndex const d = Pa_GetDefaultOutputDevice(); d != paNoDevice) return d;
    } else {
        for (PaDeviceIndex i = 0; i < Pa_GetDeviceCount(); ++i) {
            PaDeviceInfo const* const d = Pa_GetDeviceInfo(i);
            if (d && d->maxOutputChannels > 0 && std::string(d->name).find(name) != std::string::npos) return i;
        }
    }
    throw gi::InputError(fmt::format("there is no sound device '{}'", name), "there are: " + all,
                         fmt::format("name one of them by --audio, {}", kWithout));
}

} // namespace

struct AudioOutput::Stream {
    AudioOutput& owner;
    PaStream* pa = nullptr;
    std::string device, host;
    int rate_hz, channels = 2;
    std::vector<float> stereo; ///< for devices with one channel
    BufferTimes times;         ///< of the device's thread
    // For others:
    std::atomic<double> latency_s{0};
    std::atomic<bool> is_timed{true}, is_known{false};

    Stream(AudioOutput& o, std::string const& name, int rate, double latency_ms)
        : owner(o), rate_hz(rate), times(rate)
    {
        // PulseAudio would otherwise fill its buffers for seconds, and after an underrun ask for nothing as long.
        setenv("PULSE_LATENCY_MSEC", fmt::format("{:.0f}", std::ceil(latency_ms)).c_str(), 0);
        WithoutStderr const quiet;
        if (PaError const e = Pa_Initialize(); e != paNoError)
            throw gi::InputError("sound devices cannot be listed", Pa_GetErrorText(e), kWithout);
        try {
            open(name, latency_ms);
        } catch (...) {
            Pa_Terminate();
            throw;
        }
    }
    ~Stream()
    {
        Pa_CloseStream(pa);
        Pa_Terminate();
    }
    Stream(Stream const&) = delete;
    Stream& operator=(Stream const&) = delete;

    void open(std::string const& name, double latency_ms)
    {
        PaStreamParameters out{};
        out.device = find_output(name);
        PaDeviceInfo const& info = *Pa_GetDeviceInfo(out.device);
        device = info.name;
        host = Pa_GetHostApiInfo(info.hostApi)->name;
        channels = std::min(2, info.maxOutputChannels);
        out.channelCount = channels;
        out.sampleFormat = paFloat32;
        out.suggestedLatency = std::max(1e-3 * latency_ms, info.defaultLowOutputLatency);
        if (PaError const e = Pa_IsFormatSupported(nullptr, &out, rate_hz); e != paFormatIsSupported)
            throw gi::InputError(fmt::format("the sound device '{}' does not play {} Hz", device, rate_hz),
                                 Pa_GetErrorText(e),
                                 fmt::format("convert the sounds, name another device by --audio, {}", kWithout));
        PaError e =
            Pa_OpenStream(&pa, nullptr, &out, rate_hz, paFramesPerBufferUnspecified, paNoFlag, &called, this);
        if (e == paNoError) e = Pa_StartStream(pa);
        if (e != paNoError)
            throw gi::InputError(fmt::format("the sound device '{}' cannot be opened", device), Pa_GetErrorText(e),
                                 fmt::format("end the program that uses it, {}", kWithout));
    }

    static int called(void const*, void* out, unsigned long frames, PaStreamCallbackTimeInfo const* time,
                      PaStreamCallbackFlags flags, void* self)
    {
        static_cast<Stream*>(self)->play(static_cast<float*>(out), frames, *time, flags);
        return paContinue;
    }

    void play(float* out, std::size_t frames, PaStreamCallbackTimeInfo const& time, PaStreamCallbackFlags flags)
    {
        double const now_s = steady_s();
        bool const has_underrun = flags & paOutputUnderflow;
        if (has_underrun) ++owner.underruns_;
        is_timed = time.outputBufferDacTime > 0 && time.currentTime > 0;
        BufferTimes::Asked const asked{
            now_s,       is_timed, time.currentTime, time.outputBufferDacTime, Pa_GetStreamInfo(pa)->outputLatency,
            has_underrun};
        double const first_s = times.first_s(asked, frames);
        latency_s = first_s + double(frames) / rate_hz - now_s;
        if (channels == 2) {
            owner.fill(out, frames, first_s, rate_hz);
        } else {
            stereo.resize(2 * frames); // grows in the first calls only
            owner.fill(stereo.data(), frames, first_s, rate_hz);
            for (std::size_t i = 0; i < frames; ++i) out[i] = 0.5f * (stereo[2 * i] + stereo[2 * i + 1]);
        }
        if (times.is_known()) is_known = true;
    }
};

AudioOutput::AudioOutput(std::string const& device, int rate_hz, double latency_ms)
    : stream_(std::make_unique<Stream>(*this, device, rate_hz, latency_ms))
{
    for (int i = 0; i < 300 && !stream_->is_known; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (!stream_->is_known)
        throw gi::InputError(fmt::format("the sound device '{}' does not play", stream_->device),
                             "it asked for no samples within 3 s",
                             fmt::format("name another one by --audio, {}", kWithout));
    underruns_ = 0; // those of the start are of nothing
}

AudioOutput::~AudioOutput() = default;

double AudioOutput::lead_s() const
{
    constexpr double kMargin_s = 0.01; // for the buffer that is being asked for, and its thread
    return stream_->latency_s + kMargin_s;
}

bool AudioOutput::is_running() const { return Pa_IsStreamActive(stream_->pa) == 1; }

std::vector<std::pair<std::string, std::string>> AudioOutput::about() const
{
    PaStreamInfo const& info = *Pa_GetStreamInfo(stream_->pa);
    return {{"audio_device", stream_->device},
            {"audio_host", stream_->host},
            {"audio_rate_hz", fmt::format("{:g}", info.sampleRate)},
            {"audio_channels", std::to_string(stream_->channels)},
            {"audio_latency_ms", fmt::format("{:.2f}", 1e3 * info.outputLatency)},
            {"audio_onset_method", stream_->is_timed ? "dac_time" : "reported_latency"}};
}

} // namespace viewer
