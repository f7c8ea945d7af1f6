#include "viewer/offline/rank_work.h"

#include "gi/render/accumulator.h"
#include "viewer/base/standard_streams.h"

#include <cstring>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::size_t kPieceBytes = std::size_t(4) << 20;

/// Sent before the pixels.
struct SumsHeader {
    std::uint32_t paths = 0;
    gi::PathCounts counts;
    double seconds = 0;
};
static_assert(std::is_trivially_copyable_v<SumsHeader>);

void give_sums(Cluster& cluster, gi::Accumulator const& sums)
{
    SumsHeader const header{sums.paths, sums.counts, sums.seconds};
    auto const* const at = reinterpret_cast<std::uint8_t const*>(&header);
    cluster.give({at, at + sizeof header});
    if (sums.paths == 0) return;
    auto const* const pixels = reinterpret_cast<std::uint8_t const*>(sums.pixels.data());
    std::size_t const bytes = sums.pixels.size() * sizeof(gi::PixelMeans);
    for (std::size_t from = 0; from < bytes; from += kPieceBytes)
        cluster.give({pixels + from, pixels + std::min(bytes, from + kPieceBytes)});
}

/// Returns false if the rank is lost before everything is received.
bool take_sums(Cluster& cluster, int from, gi::Accumulator& sums)
{
    auto const head = cluster.take(from);
    if (!head) return false;
    SumsHeader header;
    if (head->size() != sizeof header) throw std::runtime_error("sums of another rank have a different format");
    std::memcpy(&header, head->data(), sizeof header);
    sums.counts = header.counts;
    sums.seconds = header.seconds;
    if (header.paths == 0) return true;
    auto* const pixels = reinterpret_cast<std::uint8_t*>(sums.pixels.data());
    std::size_t const bytes = sums.pixels.size() * sizeof(gi::PixelMeans);
    for (std::size_t at = 0; at < bytes;) {
        auto const piece = cluster.take(from);
        if (!piece) return false;
        if (piece->empty() || piece->size() > bytes - at)
            throw std::runtime_error("sums of another rank have a different size");
        std::memcpy(pixels + at, piece->data(), piece->size());
        at += piece->size();
    }
    sums.paths = header.paths;
    return true;
}

std::uint32_t first_path(std::uint32_t paths, int rank, int size)
{
    return std::uint32_t(std::uint64_t(paths) * std::uint64_t(rank) / std::uint64_t(size));
}

} // namespace

RankWork::RankWork(Cluster& cluster, gi::StopRequest& stop) : cluster_(cluster), stop_(stop) { stay_alive(); }

void RankWork::stay_alive()
{
    alive_.emplace(cluster_, needs_others_ ? std::function<void()>([this] { stop_.request(); }) : nullptr);
}

void RankWork::talk(std::function<void(Cluster&)> const& what)
{
    if (alone()) return;
    alive_.reset();
    cluster_.check();
    if (needs_others_ && stop_.requested()) {
        cluster_.leave("it was interrupted");
        throw RankInterrupted();
    }
    what(cluster_);
    for (std::string const& news : cluster_.take_news()) say(news);
    stay_alive();
}

gi::PathShare RankWork::share(std::uint32_t paths)
{
    if (alone()) return {};
    paths_ = paths;
    std::uint32_t const first = first_path(paths, rank(), size());
    return {first, first_path(paths, rank() + 1, size()) - first, [this](gi::Accumulator& sums) { merge(sums); }};
}

void RankWork::merge(gi::Accumulator& sums)
{
    talk([&](Cluster& cluster) {
        if (!leads()) {
            give_sums(cluster, sums);
            sums.counts = {}; // they are counted by the leader now
            return;
        }
        for (int r = 1; r < size(); ++r) {
            gi::Accumulator theirs(sums.width, sums.height);
            if (take_sums(cluster, r, theirs))
                sums.add(theirs);
            else
                missing_paths_ += first_path(paths_, r + 1, size()) - first_path(paths_, r, size());
        }
    });
}

void RankWork::gather(gi::RenderResult& result, gi::Report& report,
                      std::map<std::string, gi::Report::Loss> const& loaded)
{
    talk([&](Cluster& cluster) {
        if (!leads()) {
            std::map<std::string, gi::Report::Loss> of_paths = report.losses();
            std::erase_if(of_paths, [&](auto const& l) { return loaded.contains(l.first); });
            cluster.give(nlohmann::json::to_cbor(
                {{"rays", result.rays}, {"loaded", losses_json(loaded)}, {"lost", losses_json(of_paths)}}));
            return;
        }
        for (int r = 1; r < size(); ++r) {
            auto const bytes = cluster.take(r);
            if (!bytes) continue;
            nlohmann::json const theirs = nlohmann::json::from_cbor(*bytes);
            result.rays += theirs.at("rays").get<double>();
            for (auto const& [what, loss] : losses_of(theirs.at("lost")))
                report.lose(what, loss.count, loss.first);
            add_other_losses(report, loaded, losses_of(theirs.at("loaded")), cluster.name(r));
        }
        report.lose("paths per pixel missing because ranks were lost", missing_paths_);
        needs_others_ = false; // whoever is lost from here on, the picture can be finished
    });
}

void RankWork::finish()
{
    try {
        talk([](Cluster& cluster) { cluster.finish(); });
    } catch (RankLoss const& e) { // the leader has received the part of that rank already
        if (!leads()) throw;
        say(std::string(e.what()) + "; all its work was complete");
    } catch (RankInterrupted const&) {
        if (!leads()) throw;
    }
    alive_.reset();
}

nlohmann::json losses_json(std::map<std::string, gi::Report::Loss> const& losses)
{
    nlohmann::json all = nlohmann::json::object();
    for (auto const& [what, loss] : losses) all[what] = {loss.count, loss.first};
    return all;
}

std::map<std::string, gi::Report::Loss> losses_of(nlohmann::json const& json)
{
    std::map<std::string, gi::Report::Loss> all;
    for (auto const& [what, loss] : json.items())
        all[what] = {loss.at(0).get<std::uint64_t>(), loss.at(1).get<std::string>()};
    return all;
}

void add_other_losses(gi::Report& to, std::map<std::string, gi::Report::Loss> const& mine,
                      std::map<std::string, gi::Report::Loss> const& theirs, std::string const& name)
{
    for (auto const& [what, loss] : theirs) {
        auto const found = mine.find(what);
        if (found == mine.end() || found->second.count != loss.count)
            to.lose(what + ", on another rank", loss.count,
                    loss.first.empty() ? name : fmt::format("{}, {}", name, loss.first));
    }
}

} // namespace viewer
