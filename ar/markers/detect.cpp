#include "ar/markers/detect.h"

#include "ar/markers/refine.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>

namespace ar {
namespace {

/// Typical error of corners, measured on synthetic pictures with noise and blur (docs/decisions/markers.md).
constexpr double kMarkerSigma_px = 0.15, kBoardSigma_px = 0.08, kUnrefinedSigma_px = 0.6;

void check_picture(cv::Mat const& gray)
{
    if (gray.empty() || gray.type() != CV_8UC1)
        throw gi::InputError("markers are looked for in a picture that is not 8 bit grey",
                             "their edges are in its luma", "hand over gray_of(frame)");
}

struct Found {
    Sighting sighting;
    cv::Rect2f around; ///< of all markers of the map
};

struct Match {
    FoundMarker found;
    PlacedMarker placed;
};

cv::Rect2f around(FoundMarker const& m)
{
    auto const [left, right] = std::minmax({m.corners[0].x, m.corners[1].x, m.corners[2].x, m.corners[3].x});
    auto const [top, bottom] = std::minmax({m.corners[0].y, m.corners[1].y, m.corners[2].y, m.corners[3].y});
    return {left, top, right - left, bottom - top};
}

/// Markers of the map, thing by thing; those of one identifier seen twice, and others, are counted.
std::map<int, std::vector<Match>> match(cv::Mat const& gray, cv::Rect part, MarkerMap const& map,
                                        SearchSettings const& search, Sighting& s)
{
    std::map<std::string, std::map<int, PlacedMarker>> wanted;
    for (PlacedMarker& m : placed_markers(map)) wanted[m.dictionary].emplace(m.id, m);
    std::map<int, std::vector<Match>> by_thing;
    for (auto const& [dictionary, placed] : wanted) {
        FoundMarkers found = find_markers(gray(part), dictionary, search);
        s.candidates_rejected += found.rejected;
        std::map<int, int> times;
        for (FoundMarker const& m : found.markers) {
            ++times[m.id];
            s.ids[dictionary].insert(m.id);
        }
        for (FoundMarker& m : found.markers) {
            for (auto& c : m.corners) c += cv::Point2f(part.tl());
            auto const at = placed.find(m.id);
            auto const note = [&, &of = dictionary](std::vector<std::string>& names) {
                std::string name = fmt::format("marker {} of {}", m.id, of);
                if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
            };
            if (at == placed.end()) {
                ++s.markers_unknown;
                note(s.unknown);
            } else if (times[m.id] > 1) {
                ++s.markers_ambiguous;
                note(s.ambiguous);
            } else {
                ++s.markers_seen;
                by_thing[at->second.thing].push_back({m, at->second});
            }
        }
    }
    return by_thing;
}

/// Adds the board's inner corners; false if there are too few.
bool add_inner_corners(Sighting& s, cv::Mat const& gray, CharucoBoard const& board, int thing,
                       std::vector<Match> const& matches)
{
    std::vector<FoundMarker> markers;
    for (Match const& m : matches) markers.push_back(m.found);
    auto const inner = find_inner_corners(gray, board, markers);
    if (inner.size() < 4) return false;
    auto const corners_m = inner_corners(board);
    for (FoundCorner const& c : inner)
        s.points.push_back({board.world_from_board * corners_m[std::size_t(c.index)],
                            {c.pixel.x, c.pixel.y},
                            thing,
                            kBoardSigma_px});
    return true;
}

/// Whether the picture contradicts the map's board or grid; what earlier pictures said counts where this one is
/// silent. A board that they confirmed is given up only after several contradictions in a row: a hand or a reflection
/// may cause one.
bool is_contradicted(cv::Mat const& gray, MarkerMap const& map, int thing, std::vector<Match> const& matches,
                     std::map<int, BoardMemory>& known)
{
    constexpr int kEnoughAgainst = 3;
    std::vector<FoundMarker> markers;
    for (Match const& m : matches) markers.push_back(m.found);
    BoardFinding const now = check_board(gray, map, thing, markers);
    auto& [last, against] = known[thing];
    bool const is_confirmed = last.verdict == BoardVerdict::agrees;
    against = is_confirmed && now.verdict == BoardVerdict::contradicts ? against + 1 : 0;
    if (is_confirmed ? against >= kEnoughAgainst : now.verdict != BoardVerdict::silent) last = now;
    return last.verdict == BoardVerdict::doubtful || last.verdict == BoardVerdict::contradicts;
}

/// @param known  what earlier pictures said about boards and grids, by thing
Found find(cv::Mat const& gray, cv::Rect part, MarkerMap const& map, DetectorSettings const& settings,
           std::map<int, BoardMemory>& known)
{
    Found out;
    Sighting& s = out.sighting;
    double const sigma = settings.refinement == Refinement::none ? kUnrefinedSigma_px : kMarkerSigma_px;
    int const lone = int(map.markers.size()), boards = int(map.boards.size());
    for (auto const& [thing, matches] : match(gray, part, map, search_settings(settings, gray.size()), s)) {
        for (Match const& m : matches)
            out.around = out.around.empty() ? around(m.found) : out.around | around(m.found);
        if (thing >= lone && is_contradicted(gray, map, thing, matches, known)) {
            BoardFinding const& why = known.at(thing).last;
            s.contradictions.push_back(fmt::format("{}; {}", why.problem, why.remedy));
            continue;
        }
        bool const is_board = thing >= lone && thing < lone + boards;
        if (is_board && add_inner_corners(s, gray, map.boards[std::size_t(thing - lone)], thing, matches))
            continue;
        gi::RigidPose const world = world_from_thing(map, thing);
        for (Match const& m : matches)
            for (std::size_t i = 0; i < 4; ++i)
                s.points.push_back(
                    {world * m.placed.corners_m[i], {m.found.corners[i].x, m.found.corners[i].y}, thing, sigma});
    }
    return out;
}

/// Region where the markers are expected: their last position, their motion, and a margin.
cv::Rect expected(cv::Rect2f last, cv::Rect2f before, float margin, cv::Size picture)
{
    if (last.empty()) return {};
    cv::Rect2f all = last;
    if (!before.empty()) {
        cv::Point2f const low = 2 * last.tl() - before.tl(), high = 2 * last.br() - before.br();
        if (low.x < high.x && low.y < high.y) all |= cv::Rect2f(low, high);
    }
    auto const left = int(std::floor(all.x - margin)), top = int(std::floor(all.y - margin));
    cv::Rect const r(cv::Point(left, top),
                     cv::Point(int(std::ceil(all.br().x + margin)) + 1, int(std::ceil(all.br().y + margin)) + 1));
    return r & cv::Rect({}, picture);
}

} // namespace

SearchSettings search_settings(DetectorSettings const& settings, cv::Size picture)
{
    SearchSettings s;
    s.refinement = settings.refinement;
    int const width = std::max(picture.width, picture.height);
    s.smallest_side_px = settings.smallest_side_px > 0 ? settings.smallest_side_px : std::max(8., width / 80.);
    s.enlarge = settings.enlarge;
    // Windows must be wider than the blur of edges, and narrower than the white margins.
    s.smallest_window_px = s.enlarge > 1 || width > 1400 ? 5 : 3;
    s.window_step_px = width > 1400 ? 16 : 10;
    s.largest_window_px = s.smallest_window_px + 2 * s.window_step_px;
    return s;
}

Sighting detect(cv::Mat const& gray, MarkerMap const& map, DetectorSettings const& settings)
{
    check_picture(gray);
    check(map, "the map of markers");
    std::map<int, BoardMemory> nothing;
    return find(gray, {{}, gray.size()}, map, settings, nothing).sighting;
}

MarkerTracker::MarkerTracker(MarkerMap map, DetectorSettings settings) : map_(std::move(map)), settings_(settings)
{
    check(map_, "the map of markers");
}

void MarkerTracker::reset()
{
    last_ = before_ = {};
    seen_ = since_whole_ = 0;
}

Sighting MarkerTracker::next(cv::Mat const& gray)
{
    check_picture(gray);
    if (gray.size() != size_) reset();
    size_ = gray.size();
    ++counts_.pictures;
    float const margin = settings_.margin_px > 0 ? float(settings_.margin_px) : float(gray.cols) / 40;
    cv::Rect const whole({}, gray.size());
    cv::Rect near = expected(last_, before_, margin, gray.size());
    ++since_whole_;
    bool const due = settings_.whole_picture_every > 0 && since_whole_ >= settings_.whole_picture_every;
    if (due || seen_ == 0 || near.area() > 0.8 * whole.area()) near = {};

    Found found;
    auto const known_before = known_; // a picture that is searched twice counts once
    if (!near.empty()) found = find(gray, near, map_, settings_, known_);
    if (near.empty() || found.sighting.markers_seen < seen_) {
        ++counts_.whole;
        counts_.in_vain += !near.empty();
        since_whole_ = 0;
        known_ = known_before;
        found = find(gray, whole, map_, settings_, known_);
    }
    before_ = last_;
    last_ = found.around;
    seen_ = found.sighting.markers_seen;
    return found.sighting;
}

} // namespace ar
