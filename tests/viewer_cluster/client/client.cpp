// A viewer without a picture: rank 0 makes orders, the others follow, and each writes down what it got.
//   cluster_client FOLDER FRAMES FRAME_MS SILENCE_S stop|continue [OPTION RANK VALUE]...
// Options: --other-version R 0, --other-scene R 0, --astray R FRAME, --slow-start R SECONDS, --busy R SECONDS
// FOLDER/rank.R: "pid N", a line "frame scene_s hash" per frame, "said TEXT", at the end "left CODE".

#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "viewer/protocol/cluster/cluster.h"
#include "viewer/protocol/frame_command.h"

#include <fmt/format.h>
#include <fstream>
#include <map>
#include <thread>
#include <unistd.h>

namespace viewer {
namespace {

FrameCommand order_of(std::uint64_t frame)
{
    FrameCommand o;
    o.frame = frame;
    o.pose_s = double(frame) / 60;
    o.scene_s = double(frame) / 7;
    o.tracked.head = RoomPose{{0.1 * double(frame), 1.7, 0}, {1, 0, 0, 0}};
    if (frame % 5 == 0) o.changes.push_back({"exposure", double(frame) / 3});
    for (int k = 0; k < 8; ++k) {
        ViewCommand v;
        v.name = fmt::format("wall {}", k);
        v.width = v.height = 64;
        o.views.push_back(v);
    }
    return o;
}

std::uint64_t hash_of(FrameCommand const& command)
{
    std::uint64_t h = 0;
    for (std::uint8_t const b : to_bytes(command)) h = gi::mix_bits(h + b + 1);
    return h;
}

struct Call {
    std::string folder;
    std::uint64_t frames = 0;
    double frame_ms = 0;
    ClusterSettings settings;
    std::map<std::string, std::pair<int, double>> special; ///< option -> rank, value

    bool is(std::string const& option, int rank) const
    {
        auto const found = special.find(option);
        return found != special.end() && found->second.first == rank;
    }
};

Call parse(int argc, char** argv)
{
    Call c;
    c.folder = argv[1];
    c.frames = std::stoull(argv[2]);
    c.frame_ms = std::stod(argv[3]);
    c.settings.silence_s = std::stod(argv[4]);
    c.settings.start_s = 20;
    c.settings.on_loss = parse_on_rank_loss(argv[5]);
    for (int k = 6; k + 2 < argc; k += 3) c.special[argv[k]] = {std::stoi(argv[k + 1]), std::stod(argv[k + 2])};
    return c;
}

void show(Cluster& cluster, Call const& call, std::ofstream& log)
{
    for (std::uint64_t frame = 0;; ++frame) {
        FrameCommand command = order_of(frame);
        if (cluster.leads()) {
            if (frame == call.frames) break;
            cluster.send(to_bytes(command));
        } else {
            auto const received = cluster.receive();
            if (!received) break;
            command = command_from_bytes(*received);
        }
        log << fmt::format("{} {} {:016x}", command.frame, command.scene_s, hash_of(command)) << std::endl;
        std::this_thread::sleep_for(std::chrono::duration<double, std::milli>(call.frame_ms));
        if (call.is("--busy", cluster.rank()) && frame == 10) { // longer than others are patient
            KeepAlive const alive(cluster);
            std::this_thread::sleep_for(std::chrono::duration<double>(call.special.at("--busy").second));
        }
        bool const astray =
            call.is("--astray", cluster.rank()) && double(frame) >= call.special.at("--astray").second;
        std::vector<std::string> const notes = cluster.wait(
            command.frame, astray ? 1 : 0, fmt::format("{} of rank {}", command.frame, cluster.rank()));
        for (std::string const& note : notes)
            if (frame == 10) log << "note " << note << std::endl;
        cluster.report_swap(command.frame, Cluster::now_s());
        for (std::string const& text : cluster.take_news()) log << "said " << text << std::endl;
    }
    cluster.finish();
    if (!cluster.leads()) return;
    log << "skew " << to_text(cluster.swap_skew()) << std::endl;
    for (int r = 1; r < cluster.size(); ++r) {
        auto const [ahead, error] = cluster.clock_ahead_s(r);
        log << fmt::format("clock {} {} {}", r, ahead, error) << std::endl;
    }
}

int run(int argc, char** argv)
{
    Call const call = parse(argc, argv);
    char const* const text = std::getenv("OMPI_COMM_WORLD_RANK");
    int const rank = text != nullptr ? std::atoi(text) : 0;
    std::ofstream log(fmt::format("{}/rank.{}", call.folder, rank));
    log << "pid " << getpid() << std::endl;
    int code = 0;
    try {
        if (call.is("--slow-start", rank))
            std::this_thread::sleep_for(std::chrono::duration<double>(call.special.at("--slow-start").second));
        Cluster cluster({call.is("--other-version", rank) ? "test 2" : "test 1", "show",
                         call.is("--other-scene", rank) ? 2u : 1u},
                        call.settings);
        log << "name " << cluster.name() << std::endl;
        show(cluster, call, log);
    } catch (RankLoss const& e) {
        log << "said " << e.what() << std::endl;
        code = 1;
    } catch (gi::InputError const& e) {
        log << "said " << e.what() << std::endl;
        code = 2;
    } catch (std::exception const& e) {
        log << "said internal error: " << e.what() << std::endl;
        code = 3;
    }
    log << "left " << code << std::endl;
    return code;
}

} // namespace
} // namespace viewer

int main(int argc, char** argv) { return viewer::run(argc, argv); }
