#pragma once
// Two walls side by side that both show a strip of the room, in windows of their own, before a tracked head: where they
// overlap, their pixels show the same places.

#include "tests/viewer/run_program.h"
#include "tests/viewer_show/x/x_window.h"
#include "viewer/devices/tracking/osc.h"
#include "viewer/devices/tracking/udp_socket.h"

#include <atomic>
#include <fmt/format.h>
#include <fstream>
#include <gtest/gtest.h>
#include <thread>

namespace viewer::test {

/// Pixels; the overlap begins a whole number of pixels from the left at every size at which surfaces are drawn.
constexpr glm::ivec2 kWall_px{200, 120};
constexpr int kOverlap_px = 80;

/// A free UDP port of the loopback.
inline int free_port() { return UdpReceiver("127.0.0.1", 0).port(); }

/// @param ranks  that show them, 1 or 2
inline void write_two_walls(std::filesystem::path const& file, int port, int ranks)
{
    std::ofstream(file) << fmt::format(R"(walls:
  - {{name: one, window: a, lower_left_m: [-1, 0.4, -1], lower_right_m: [1, 0.4, -1], upper_left_m: [-1, 1.6, -1]}}
  - {{name: two, window: b, rank: {}, lower_left_m: [0.2, 0.4, -1], lower_right_m: [2.2, 0.4, -1], upper_left_m: [0.2, 1.6, -1]}}
windows:
  - {{name: a, size_px: [200, 120]}}
  - {{name: b, size_px: [200, 120], position_px: [300, 0]}}
users:
  - {{name: u, head_position_m: [0.6, 1, 0.5], head_tracker: head}}
trackers:
  - {{name: head, type: osc, port: {}, body: head}}
)",
                                       ranks - 1, port);
}

/// Sends where a head is, 50 times a second.
class SentHead {
public:
    explicit SentHead(int port) : sender_("127.0.0.1", port), thread_([this] { run(); }) {}
    ~SentHead()
    {
        ends_ = true;
        thread_.join();
    }
    void go_to(double x_m) { x_m_ = x_m; }

private:
    void run()
    {
        for (std::uint64_t frame = 1; !ends_; ++frame) {
            TrackerSample s;
            s.body = "head";
            s.pose.position = {x_m_.load(), 1, 0.5};
            s.measured_s =
                std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
            sender_.send(format_osc({s}, frame));
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
    }

    UdpSender sender_;
    std::atomic<double> x_m_{0.6};
    std::atomic<bool> ends_ = false;
    std::thread thread_;
};

struct Agreement {
    int places = 0, most = 0; ///< compared; greatest difference of a channel, 0..255
    double beyond = 0;        ///< share of places that differ by more than 1
};

/// Of what two windows show where their walls overlap, without the pixels so near to their ends that outlines are
/// smoothed by what only one of them shows.
inline Agreement agreement(std::vector<unsigned char> const& one, std::vector<unsigned char> const& two)
{
    constexpr int kBeside = 16;
    Agreement a;
    for (int y = 0; y < kWall_px.y; ++y)
        for (int x = kBeside; x < kOverlap_px - kBeside; ++x) {
            int off = 0;
            for (int c = 0; c < 3; ++c)
                off = std::max(
                    off, std::abs(int(one[std::size_t(3 * (y * kWall_px.x + kWall_px.x - kOverlap_px + x) + c)]) -
                                  int(two[std::size_t(3 * (y * kWall_px.x + x) + c)])));
            ++a.places;
            a.most = std::max(a.most, off);
            a.beyond += off > 1;
        }
    a.beyond /= a.places;
    return a;
}

/// While the head goes from one end of its way to the other and stands there, before other light comes.
/// @param one, two  the windows
inline void expect_walls_agree(SentHead& head, XWindow& one, XWindow& two)
{
    std::vector<unsigned char> const before = one.picture();
    head.go_to(0.75);
    std::this_thread::sleep_for(std::chrono::milliseconds(2000));
    std::vector<unsigned char> const first = one.picture(), second = two.picture();
    ASSERT_EQ(first.size(), std::size_t(3 * kWall_px.x * kWall_px.y));
    ASSERT_EQ(second.size(), first.size());
    EXPECT_NE(first, before) << "the head has moved";
    if (char const* const keep = std::getenv("LIGHTWELL_TEST_PICTURES"))
        for (auto const& [name, picture] : {std::pair{"one", &first}, std::pair{"two", &second}})
            std::ofstream(std::string(keep) + "/" + name + ".ppm", std::ios::binary)
                << "P6 " << kWall_px.x << " " << kWall_px.y << " 255\n"
                << std::string(picture->begin(), picture->end());
    Agreement const a = agreement(first, second);
    std::cout << a.places << " places, differences up to " << a.most << "/255, " << 100 * a.beyond
              << " % beyond 1/255\n";
    EXPECT_LT(a.beyond, 0.02); // pixels at creases, where rounding decides between two surfaces
}

} // namespace viewer::test
