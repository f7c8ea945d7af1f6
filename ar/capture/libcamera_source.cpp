#include "ar/capture/libcamera_source.h"

#include "ar/capture/buffer_memory.h"
#include "ar/capture/camera_pixels.h"
#include "ar/capture/clock.h"
#include "ar/capture/libcamera_controls.h"
#include "ar/capture/libcamera_requests.h"
#include "ar/capture/tally.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fmt/format.h>
#include <libcamera/libcamera.h>
#include <mutex>

namespace ar {
namespace {

/// libcamera allows one manager per process.
std::shared_ptr<lc::CameraManager> manager()
{
    static std::mutex mutex;
    static std::unique_ptr<lc::CameraManager> running; // at most one, also while the last one is being stopped
    static int users = 0;
    std::lock_guard const lock(mutex);
    if (users == 0) {
        // Silence its log on stderr; errors are also returned as codes.
        if (std::getenv("LIBCAMERA_LOG_LEVELS") == nullptr && std::getenv("LIBCAMERA_LOG_FILE") == nullptr)
            lc::logSetTarget(lc::LoggingTargetNone);
        running = std::make_unique<lc::CameraManager>();
        if (int const error = running->start(); error != 0) {
            running.reset();
            throw gi::InputError("libcamera does not start", text_of_error(error),
                                 "use a device number or a video in its place");
        }
    }
    ++users;
    return {running.get(), [](lc::CameraManager*) {
                std::lock_guard const last(mutex);
                if (--users > 0) return;
                running->stop();
                running.reset();
            }};
}

std::string name_of(lc::Camera const& camera)
{
    return std::string(camera.properties().get(lc::properties::Model).value_or(camera.id()));
}

std::shared_ptr<lc::Camera> find_camera(lc::CameraManager const& manager, std::string const& id)
{
    std::vector<std::shared_ptr<lc::Camera>> const all = manager.cameras();
    if (all.empty())
        throw gi::InputError("no camera", "libcamera " + lc::CameraManager::version() + " finds none",
                             "plug one in, or name a video, pictures or a recorded session");
    if (id.empty()) return all.front();
    std::vector<std::shared_ptr<lc::Camera>> named;
    std::string ids;
    for (auto const& camera : all) {
        if (camera->id() == id) return camera;
        if (name_of(*camera) == id) named.push_back(camera);
        ids += (ids.empty() ? "'" : ", '") + camera->id() + "'";
    }
    if (named.size() == 1) return named.front();
    throw gi::InputError(fmt::format("{} camera '{}'", named.empty() ? "no" : "more than one", id),
                         "libcamera finds " + ids, "name one of them by its id");
}

/// Configures the camera's stream as closely to the options as possible.
std::unique_ptr<lc::CameraConfiguration> configured(lc::Camera& camera, LibcameraOptions const& options)
{
    auto const refuse = [&](std::string const& why) {
        throw gi::InputError("camera '" + camera.id() + "' cannot be used", why,
                             "choose another format or camera");
    };
    std::unique_ptr<lc::CameraConfiguration> config = camera.generateConfiguration({lc::StreamRole::Viewfinder});
    if (!config || config->empty()) refuse("it has no stream of pictures");
    lc::StreamConfiguration& stream = config->at(0);
    auto const offered = stream.formats().pixelformats();
    std::string names;
    for (lc::PixelFormat const& f : offered) names += " " + f.toString();
    auto const is_wanted = [&](CameraPixels const& p) { return !options.format || p.format == *options.format; };
    for (CameraPixels const& p : camera_pixels()) {
        lc::PixelFormat const format(p.fourcc);
        if (!is_wanted(p) || std::find(offered.begin(), offered.end(), format) == offered.end()) continue;
        stream.pixelFormat = format;
        break;
    }
    stream.size = lc::Size(unsigned(options.size_px.x), unsigned(options.size_px.y));
    stream.bufferCount = unsigned(std::clamp(options.buffers, 1, 64));
    if (config->validate() == lc::CameraConfiguration::Invalid) refuse("no configuration of it is valid");
    auto const pixels = camera_pixels_of(stream.pixelFormat.fourcc());
    if (!pixels || !is_wanted(*pixels) || stream.pixelFormat.modifier() != 0)
        refuse(fmt::format("its formats are{}, none of them {}",
                           names.empty() ? " " + stream.pixelFormat.toString() : names,
                           options.format ? name_of(*options.format) : "known here"));
    if (int const error = camera.configure(config.get()); error != 0) refuse(text_of_error(error));
    return config;
}

class LibcameraSource final : public FrameSource {
public:
    explicit LibcameraSource(LibcameraOptions const& options)
        : options_(options), manager_(manager()), camera_(find_camera(*manager_, options.id))
    {
        if (int const error = camera_->acquire(); error != 0)
            throw gi::InputError("camera '" + camera_->id() + "' cannot be opened", text_of_error(error),
                                 error == -EBUSY ? "close the program that uses it" : "use another camera");
        try {
            start();
        } catch (...) {
            close();
            throw;
        }
    }
    ~LibcameraSource() override { close(); }

    std::optional<Frame> next(std::chrono::milliseconds wait) override
    {
        auto const until = std::chrono::steady_clock::now() + wait;
        for (;;) {
            auto const left =
                std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
            lc::Request* const request = pool_->take(std::max(left, std::chrono::milliseconds(0)));
            if (request == nullptr) return std::nullopt;
            lc::FrameMetadata const& metadata = request->buffers().begin()->second->metadata();
            std::uint64_t const sequence = number_of(metadata.sequence);
            if (options_.delivery == Delivery::newest && pool_->has_waiting()) {
                tally_.drop(sequence);
                pool_->give_back(request);
                continue;
            }
            if (auto frame = frame_of(request, sequence)) return frame;
        }
    }

    SourceState state() const override
    {
        std::string const loss = pool_->loss();
        if (!loss.empty() && !pool_->has_waiting()) return {SourceState::Kind::lost, loss};
        return {};
    }

    SourceDescription description() const override
    {
        lc::StreamConfiguration const& stream = config_->at(0);
        return {.name = name_of(*camera_),
                .id = camera_->id(),
                .size_px = size_px(),
                .format = camera_pixels_of(stream.pixelFormat.fourcc())->format,
                .frames_per_s = frames_per_s_,
                .is_live = true,
                .controls = names_of_controls(camera_->controls())};
    }
    SourceCounts counts() const override { return tally_.counts(); }

    std::vector<std::string> set(Controls const& controls) override
    {
        check(controls);
        ControlTranslation const t = translated(controls, camera_->controls());
        if (!t.list.empty()) pool_->set_controls(t.list);
        return t.problems;
    }

private:
    void start()
    {
        config_ = configured(*camera_, options_);
        pool_ = std::make_shared<RequestPool>(camera_);
        make_buffers();
        set(options_.controls);
        if (options_.controls.frame_duration_s) frames_per_s_ = 1 / *options_.controls.frame_duration_s;
        camera_->requestCompleted.connect(this, &LibcameraSource::complete);
        camera_->disconnected.connect(this, &LibcameraSource::unplug);
        if (int const error = camera_->start(); error != 0)
            throw gi::InputError("camera '" + camera_->id() + "' does not start", text_of_error(error),
                                 "plug it in again, or use another one");
        is_started_ = true;
        pool_->queue_all();
    }

    void close()
    {
        if (pool_) pool_->stop();
        if (is_started_) camera_->stop();
        camera_->requestCompleted.disconnect(this);
        camera_->disconnected.disconnect(this);
        if (pool_) pool_->forget_requests();
        allocator_.reset();
        camera_->release();
    }

    /// If the driver cannot allocate memory (no dma-heap), anonymous files suffice
    /// for pipelines that write by CPU.
    void make_buffers()
    {
        lc::StreamConfiguration const& config = config_->at(0);
        allocator_ = std::make_unique<lc::FrameBufferAllocator>(camera_);
        if (allocator_->allocate(config.stream()) > 0) {
            for (auto const& buffer : allocator_->buffers(config.stream()))
                pool_->add(config.stream(), buffer.get(), {});
            return;
        }
        auto const bytes = plane_bytes(config.pixelFormat.fourcc(), size_px(), config.stride, config.frameSize);
        for (unsigned i = 0; i < config.bufferCount; ++i) {
            std::size_t all = 0;
            for (std::size_t const n : bytes) all += n;
            lc::SharedFD const file(make_memory_file(all));
            if (!file.isValid())
                throw gi::InputError("no memory for pictures of the camera", std::strerror(errno),
                                     "choose smaller ones");
            std::vector<lc::FrameBuffer::Plane> planes;
            std::size_t at = 0;
            for (std::size_t const n : bytes) {
                lc::FrameBuffer::Plane& plane = planes.emplace_back();
                plane.fd = file;
                plane.offset = unsigned(at);
                plane.length = unsigned(n);
                at += n;
            }
            auto buffer = std::make_unique<lc::FrameBuffer>(planes);
            lc::FrameBuffer* const raw = buffer.get();
            pool_->add(config.stream(), raw, std::move(buffer));
        }
    }

    void complete(lc::Request* request) { pool_->complete(request); }
    void unplug() { pool_->lose("camera '" + camera_->id() + "' was unplugged"); }

    glm::ivec2 size_px() const { return {int(config_->at(0).size.width), int(config_->at(0).size.height)}; }

    /// Extends sequence numbers to 64 bits. Pipelines that do not number their frames (0.4.0's virtual one leaves
    /// the memory uninitialised) give numbers that repeat, decrease or jump: from then on frames are counted here.
    std::uint64_t number_of(std::uint32_t sequence)
    {
        if (!last_) return *(last_ = sequence);
        auto const step = std::int32_t(sequence - std::uint32_t(*last_));
        if (step < 1 || step > kMostGap) is_numbered_ = false;
        return *(last_ = *last_ + (is_numbered_ ? std::uint64_t(step) : 1));
    }

    std::optional<Frame> frame_of(lc::Request* request, std::uint64_t sequence)
    {
        std::shared_ptr<void const> const owner(request, [pool = pool_](void const* r) {
            pool->give_back(const_cast<lc::Request*>(static_cast<lc::Request const*>(r)));
        });
        lc::FrameMetadata const& metadata = request->buffers().begin()->second->metadata();
        auto const refuse = [&](std::string const& why) {
            tally_.refuse(sequence, fmt::format("frame {}: {}", sequence, why));
            return std::nullopt;
        };
        // Test for errors instead of success: 0.4.0's virtual pipeline leaves the status uninitialised.
        if (metadata.status == lc::FrameMetadata::FrameError ||
            metadata.status == lc::FrameMetadata::FrameCancelled)
            return refuse("the camera says that it failed");
        RequestPool::Buffer const& buffer = pool_->buffer_of(*request);
        for (int const file : buffer.files) tell_driver(file, Reading::begins);
        std::vector<std::span<std::uint8_t const>> written = buffer.planes;
        for (std::size_t i = 0; i < written.size() && i < metadata.planes().size(); ++i)
            if (std::size_t const used = metadata.planes()[i].bytesused; used > 0 && used < written[i].size())
                written[i] = written[i].first(used);
        Frame f;
        lc::StreamConfiguration const& config = config_->at(0);
        std::string const problem = set_planes(f, config.pixelFormat.fourcc(), size_px(), config.stride, written);
        if (!problem.empty()) return refuse(problem);
        f.sequence = sequence;
        set_times(f, *request, metadata.timestamp);
        set_exposure(f.exposure, request->metadata());
        f.owner = owner;
        tally_.deliver(sequence);
        return f;
    }

    static void set_times(Frame& f, lc::Request const& request, std::uint64_t buffer_stamp_ns)
    {
        DriverClocks const now = driver_clocks();
        f.arrived_s = steady_now_s();
        auto const& metadata = const_cast<lc::Request&>(request).metadata(); // it has no other way in
        if (auto const s = steady_time_of(metadata.get(lc::controls::SensorTimestamp).value_or(0), now)) {
            f.captured_s = *s;
            f.origin = TimestampOrigin::sensor;
        } else if (auto const d = steady_time_of(std::int64_t(buffer_stamp_ns), now)) {
            f.captured_s = *d;
            f.origin = TimestampOrigin::driver;
        } else {
            f.captured_s = f.arrived_s;
            f.origin = TimestampOrigin::arrival;
        }
    }

    static void set_exposure(Exposure& e, lc::ControlList const& metadata)
    {
        e.time_s = 1e-6 * metadata.get(lc::controls::ExposureTime).value_or(0);
        e.gain = double(metadata.get(lc::controls::AnalogueGain).value_or(0));
        if (auto const digital = metadata.get(lc::controls::DigitalGain); digital && e.gain > 0)
            e.gain *= double(*digital);
        if (auto const colour = metadata.get(lc::controls::ColourGains)) {
            e.red_gain = double((*colour)[0]);
            e.blue_gain = double((*colour)[1]);
        }
    }

    LibcameraOptions options_;
    std::shared_ptr<lc::CameraManager> manager_; // outlives the camera
    std::shared_ptr<lc::Camera> camera_;
    std::unique_ptr<lc::CameraConfiguration> config_;
    std::unique_ptr<lc::FrameBufferAllocator> allocator_;
    std::shared_ptr<RequestPool> pool_;
    bool is_started_ = false;
    double frames_per_s_ = 0;
    static constexpr int kMostGap = 1000; // frames: larger gaps are invalid numbers
    bool is_numbered_ = true;
    std::optional<std::uint64_t> last_;
    Tally tally_;
};

} // namespace

std::vector<CameraEntry> list_cameras()
{
    std::vector<CameraEntry> all;
    auto const running = manager();
    for (auto const& camera : running->cameras()) all.push_back({camera->id(), name_of(*camera)});
    return all;
}

std::string libcamera_version() { return lc::CameraManager::version(); }

std::unique_ptr<FrameSource> open_libcamera(LibcameraOptions const& options)
{
    check(options.controls);
    if (options.size_px.x < 1 || options.size_px.y < 1)
        throw gi::InputError(fmt::format("pictures of {} x {} pixels", options.size_px.x, options.size_px.y),
                             "a camera's have at least one", "choose another size");
    return std::make_unique<LibcameraSource>(options);
}

} // namespace ar
