// Captures from the virtual camera of libcamera 0.4 through the source that the program has, and prints what it
// saw as "name value" lines. That source is included, not linked: so it is compiled against the headers of that
// libcamera, and the camera's own signal can be sent as its pipeline sends it when somebody pulls the plug.

#include "ar/capture/libcamera_source.cpp"

#include "ar/capture/counter_source.h"

#include <cstdio>
#include <fstream>
#include <set>
#include <thread>
#include <unistd.h>

namespace {

using namespace std::chrono_literals;

double resident_mib()
{
    std::ifstream statm("/proc/self/statm");
    double all = 0, resident = 0;
    statm >> all >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

void print(char const* name, double value) { std::printf("%s %.9g\n", name, value); }

void capture(int frames)
{
    auto source = ar::open_libcamera({.delivery = ar::Delivery::every});
    auto const about = source->description();
    print("width", about.size_px.x);
    print("height", about.size_px.y);
    print("is_nv12", about.format == ar::PixelFormat::nv12);
    double last_s = 0, oldest_ms = 0, sum_ms = 0, first_mib = 0;
    int disordered = 0, unread = 0, unowned = 0, sensor = 0;
    std::set<uchar const*> planes;
    double const start_s = ar::steady_now_s();
    for (int i = 0; i < frames; ++i) {
        auto const f = source->next(2000ms);
        if (!f) break;
        if (i == frames / 10) first_mib = resident_mib(); // whatever is made once has been made
        disordered += !(f->captured_s > last_s);
        last_s = f->captured_s;
        double const age_ms = 1000 * (f->arrived_s - f->captured_s);
        oldest_ms = std::max(oldest_ms, age_ms);
        sum_ms += age_ms;
        sensor += f->origin == ar::TimestampOrigin::sensor;
        unowned += f->owner == nullptr;
        planes.insert(f->planes[0].data);
        if (i % 100 == 0) unread += !ar::read_counter(rgb_of(*f)).has_value();
    }
    double const took_s = ar::steady_now_s() - start_s;
    auto const counts = source->counts();
    print("delivered", double(counts.delivered));
    print("dropped", double(counts.dropped));
    print("refused", double(counts.refused));
    print("disordered", disordered);
    print("unread", unread);
    print("unowned", unowned);
    print("from_sensor_clock", sensor);
    print("planes", double(planes.size()));
    print("mean_age_ms", sum_ms / frames);
    print("oldest_ms", oldest_ms);
    print("frames_per_s", double(counts.delivered) / took_s);
    print("resident_mib", resident_mib());
    print("grown_mib", resident_mib() - first_mib);
}

/// All buffers kept: the camera waits. One given back: one more frame.
/// They stay readable after the source is gone.
void keep()
{
    auto source = ar::open_libcamera({.delivery = ar::Delivery::every});
    std::vector<ar::Frame> kept;
    while (auto f = source->next(500ms)) kept.push_back(std::move(*f));
    print("kept", double(kept.size()));
    print("runs_while_kept", source->state().kind == ar::SourceState::Kind::running);
    ar::Frame copy = kept.back();
    kept.pop_back();
    print("came_while_a_copy_lives", source->next(200ms).has_value());
    copy = {};
    if (auto f = source->next(2000ms)) kept.push_back(std::move(*f));
    print("kept_again", double(kept.size()));
    source.reset();
    int read = 0;
    for (ar::Frame const& f : kept) read += ar::read_counter(gray_of(f)).has_value();
    print("read_after_the_source", read);
}

void unplug()
{
    auto source = ar::open_libcamera({.delivery = ar::Delivery::every});
    print("before", source->next(2000ms).has_value());
    ar::manager()->get(source->description().id)->disconnected.emit();
    int waiting = 0;
    while (waiting < 100 && source->state().kind == ar::SourceState::Kind::running)
        waiting += source->next(2000ms).has_value();
    print("is_lost", source->state().kind == ar::SourceState::Kind::lost);
    std::printf("reason %s\n", source->state().reason.c_str());
}

void newest()
{
    auto source = ar::open_libcamera({});
    std::this_thread::sleep_for(1000ms); // all buffers are full by then
    auto const f = source->next(2000ms);
    print("newest_sequence", f ? double(f->sequence) : -1);
    print("given_up", double(source->counts().dropped));
}

void refusals()
{
    auto const text_of = [](auto&& action) {
        try {
            action();
            return std::string("none");
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
    };
    std::printf("unknown_id %s\n", text_of([] { ar::open_libcamera({.id = "nobody"}); }).c_str());
    std::printf("wrong_format %s\n",
                text_of([] { ar::open_libcamera({.format = ar::PixelFormat::mjpeg}); }).c_str());
    auto const source = ar::open_libcamera({.size_px = {1000, 700}});
    print("nearest_width", source->description().size_px.x);
    for (std::string const& s : source->set({.exposure_time_s = 0.01, .red_gain = 1.5, .blue_gain = 1.2}))
        std::printf("cannot %s\n", s.c_str());
    std::printf("in_use %s\n", text_of([] { ar::open_libcamera(); }).c_str());
}

} // namespace

int main(int argc, char** argv)
{
    try {
        std::printf("version %s\n", ar::libcamera_version().c_str());
        for (ar::CameraEntry const& c : ar::list_cameras())
            std::printf("camera %s %s\n", c.id.c_str(), c.name.c_str());
        for (int i = 1; i < argc; ++i) {
            std::string const what = argv[i];
            if (what == "capture") capture(1000);
            if (what == "keep") keep();
            if (what == "unplug") unplug();
            if (what == "newest") newest();
            if (what == "refusals") refusals();
        }
    } catch (std::exception const& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 2;
    }
    return 0;
}
