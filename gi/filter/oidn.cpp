#include "gi/filter/oidn.h"

#include "gi/core/error.h"
#include "gi/core/threads.h"
#include "gi/filter/filter_input.h"
#include "gi/filter/oidn_library.h"

#include <mutex>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <utility>

namespace gi {
namespace {

/// Width of the margin of mirrored pixels around the picture; without it the network's result is wrong by up to a
/// third in the corners.
constexpr int kMargin = 8;

/// Parameters that a filter is built for.
struct OidnSettings {
    int width, height; ///< 0 = only the device
    OidnQuality quality;
    int threads;

    bool operator==(OidnSettings const&) const = default;
};

/// A device of Open Image Denoise with one filter, for pictures of one size; building both takes longer than
/// filtering a small picture.
class OidnFilter {
public:
    explicit OidnFilter(OidnSettings const& s) : settings(s), device_(lib_.new_device(lib_.device_cpu))
    {
        // It runs on TBB's threads, which other code uses too.
        lib_.set_device_bool(device_, "setAffinity", false);
        if (s.threads > 0) lib_.set_device_int(device_, "numThreads", s.threads);
        lib_.commit_device(device_);
        check("start");
        if (s.width == 0) return;
        filter_ = lib_.new_filter(device_, "RT");
        set_image("color", light);
        set_image("albedo", albedo);
        set_image("normal", normal);
        set_image("output", filtered);
        lib_.set_filter_bool(filter_, "hdr", true);
        lib_.set_filter_int(filter_, "quality",
                            s.quality == OidnQuality::high ? lib_.quality_high : lib_.quality_fast);
        lib_.commit_filter(filter_);
        check("prepare");
    }
    ~OidnFilter()
    {
        if (filter_ != nullptr) lib_.release_filter(filter_);
        if (device_ != nullptr) lib_.release_device(device_);
    }
    OidnFilter(OidnFilter const&) = delete;
    OidnFilter& operator=(OidnFilter const&) = delete;

    /// @param stop  null = none
    void run(StopRequest const* stop)
    {
        lib_.set_filter_progress_monitor(
            filter_,
            [](void* user, double) {
                auto const* const asked = static_cast<StopRequest const*>(user);
                return asked == nullptr || !asked->requested();
            },
            const_cast<StopRequest*>(stop));
        lib_.execute_filter(filter_);
        if (stop != nullptr && stop->requested()) {
            char const* cancelled = nullptr;
            lib_.device_error(device_, &cancelled); // the next filter does not find it
            throw Interrupted();
        }
        check("filter");
    }

    OidnSettings const settings;
    std::vector<float> light, albedo, normal; ///< input of run(): 3 floats per pixel, with margins
    std::vector<float> filtered;              ///< output of run()

    std::size_t row_start(int y) const { return 3 * std::size_t(y) * std::size_t(settings.width + 2 * kMargin); }

private:
    void set_image(char const* name, std::vector<float>& values)
    {
        auto const width = std::size_t(settings.width + 2 * kMargin),
                   height = std::size_t(settings.height + 2 * kMargin);
        values.assign(3 * width * height, 0.0f);
        lib_.set_filter_image(filter_, name, values.data(), lib_.format_float3, width, height, 0, 0, 0);
    }

    void check(char const* what) const
    {
        char const* message = nullptr;
        if (lib_.device_error(device_, &message) != 0)
            throw InputError("the filter oidn cannot be used",
                             std::string("Open Image Denoise did not ") + what + ": " +
                                 (message != nullptr ? message : "no reason given"),
                             "choose another filter");
    }

    OidnLibrary const& lib_ = oidn_library();
    void *device_ = nullptr, *filter_ = nullptr;
};

enum class Pixel : std::uint8_t { surface, without_surface, not_finite };

/// L1, L2, and the layers that guide the filter.
struct OidnLayers {
    Layer const &l0, &albedo, &normal;
    Layer &color, &l1, &l2;

    explicit OidnLayers(Picture& p)
        : l0(needed_layer(p, "L0")),
          albedo(needed_layer(p, "albedo")),
          normal(needed_layer(p, "normal")),
          color(needed_layer(p, "color")),
          l1(needed_layer(p, "L1")),
          l2(needed_layer(p, "L2"))
    {
    }
    Pixel kind(std::size_t i) const
    {
        vec3 const n = rgb(normal, i);
        if (!in_range(n) || !in_range(rgb(albedo, i)) || !in_range(rgb(l1, i)) || !in_range(rgb(l2, i)))
            return Pixel::not_finite;
        return n == vec3{0} ? Pixel::without_surface : Pixel::surface;
    }
};

/// Index of the pixel of a row or column of length `count` that pixel i in the margin mirrors.
int mirrored(int i, int count)
{
    int const turned = ((i % (2 * count)) + 2 * count) % (2 * count);
    return turned < count ? turned : 2 * count - 1 - turned;
}

/// Mean of a layer over those of the eight neighbours with finite values; 0 without any.
vec3 mean_around(Layer const& layer, std::vector<Pixel> const& kinds, int width, int height, std::size_t pixel)
{
    int const x = int(pixel % std::size_t(width)), y = int(pixel / std::size_t(width));
    vec3 sum{0};
    float count = 0;
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
            std::size_t const at = std::size_t(j) * std::size_t(width) + std::size_t(i);
            if (kinds[at] == Pixel::not_finite) continue;
            sum += rgb(layer, at);
            count += 1;
        }
    return count > 0 ? sum / count : sum;
}

/// Copies a layer to an input buffer of Open Image Denoise.
void load(Layer const& layer, std::vector<Pixel> const& kinds, OidnFilter const& f, std::vector<float>& values)
{
    int const width = f.settings.width, height = f.settings.height;
    tbb::parallel_for(0, height + 2 * kMargin, [&](int y) {
        std::size_t const row = std::size_t(mirrored(y - kMargin, height)) * std::size_t(width);
        float* out = values.data() + f.row_start(y);
        for (int x = 0; x < width + 2 * kMargin; ++x) {
            std::size_t const i = row + std::size_t(mirrored(x - kMargin, width));
            vec3 const v =
                kinds[i] == Pixel::not_finite ? mean_around(layer, kinds, width, height, i) : rgb(layer, i);
            for (int c = 0; c < 3; ++c) *out++ = v[c];
        }
    });
}

/// Writes the filtered light to all pixels with a surface.
void store(OidnFilter const& f, std::vector<Pixel> const& kinds, Layer& layer)
{
    int const width = f.settings.width;
    tbb::parallel_for(0, f.settings.height, [&](int y) {
        std::size_t const row = std::size_t(y) * std::size_t(width);
        float const* const in = f.filtered.data() + f.row_start(y + kMargin) + 3 * kMargin;
        for (std::size_t x = 0; x < std::size_t(width); ++x)
            if (kinds[row + x] == Pixel::surface)
                for (std::size_t c = 0; c < 3; ++c) layer.data[3 * (row + x) + c] = std::max(in[3 * x + c], 0.0f);
    });
}

/// Built at the first call and kept; rebuilt if size, quality or number of threads change.
OidnFilter& filter_for(OidnSettings const& settings)
{
    static OidnFilter* kept = nullptr; // never deleted, because the library's own threads may have ended by then
    if (kept == nullptr || kept->settings != settings) {
        delete std::exchange(kept, nullptr);
        kept = new OidnFilter(settings);
    }
    return *kept;
}

} // namespace

void check_oidn()
{
    static bool const starts = (OidnFilter({0, 0, OidnQuality::fast, 0}), true);
    static_cast<void>(starts);
}

DenoiseReport filter_oidn(Picture& picture, OidnQuality quality, int threads, StopRequest const* stop)
{
    OidnLayers const layers(picture);
    DenoiseReport report;
    if (picture.pixels() == 0) return report;
    std::vector<Pixel> kinds(picture.pixels());
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        kinds[i] = layers.kind(i);
        report.not_finite += kinds[i] == Pixel::not_finite;
        report.without_surface += kinds[i] == Pixel::without_surface;
    }
    static std::mutex mutex;
    std::scoped_lock const lock(mutex);
    OidnFilter& f = filter_for({picture.width, picture.height, quality, threads});
    // Isolated, because a thread that waits here must not start another task that needs the lock.
    on_threads(threads, [&] {
        tbb::this_task_arena::isolate([&] {
            load(layers.albedo, kinds, f, f.albedo);
            load(layers.normal, kinds, f, f.normal);
            for (Layer* const layer : {&layers.l1, &layers.l2}) {
                load(*layer, kinds, f, f.light);
                f.run(stop);
                store(f, kinds, *layer);
            }
            tbb::parallel_for(std::size_t(0), kinds.size(), [&](std::size_t i) {
                if (kinds[i] == Pixel::surface)
                    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k)
                        layers.color.data[k] = layers.l0.data[k] + layers.l1.data[k] + layers.l2.data[k];
            });
        });
    });
    return report;
}

} // namespace gi
