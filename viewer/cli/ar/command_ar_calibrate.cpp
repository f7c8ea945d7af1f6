#include "ar/calibration/collector.h"
#include "ar/calibration/lens_choice.h"
#include "ar/calibration/report.h"
#include "ar/camera/camera_doubts.h"
#include "ar/camera/lens_domain.h"
#include "ar/markers/detect.h"
#include "ar/markers/marker_map_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/validators.h"
#include "viewer/base/version.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/ar/ar_outcome.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <memory>

namespace viewer {
namespace {

constexpr int kFewestViews = 4;
constexpr std::size_t kMostViews = 60; ///< from files; each accepted view refits all views

struct CalibrateOptions {
    SourceArguments source;
    BoardArguments board;
    std::string markers, chessboard, lens = "automatic", out, report;
    int every = 1, views = 15;
    bool stills = false;
};

/// Finds the board in a picture; few or no points if it is not visible.
struct FoundBoard {
    ar::BoardView view;
    ar::Sighting sighting; ///< of the picture; empty for a chessboard
};
using Finder = std::function<FoundBoard(cv::Mat const&, std::string const&)>;

Finder finder(CalibrateOptions const& o)
{
    int const given = int(!o.markers.empty()) + int(!o.chessboard.empty()) + int(!o.board.squares.empty());
    if (given != 1)
        throw gi::InputError("the board is not known", "no board or several boards are given",
                             "give one of --markers FILE, --squares 7x5 and --chessboard 9x6");
    if (!o.chessboard.empty()) {
        glm::ivec2 const n = parse_squares("--chessboard", o.chessboard);
        if (n.x < 3 || n.y < 3)
            throw gi::InputError("--chessboard " + o.chessboard, "at least 3 inner corners each way are needed",
                                 "count corners where four squares meet");
        say_doubts({{}, {{n.x + 1, n.y + 1, o.board.square_m, 0, {}, 0, false, {}}}, {}},
                   "--chessboard " + o.chessboard);
        return [n, square_m = o.board.square_m](cv::Mat const& gray, std::string const& name) {
            return FoundBoard{
                ar::find_chessboard(gray, n.x, n.y, square_m, name).value_or(ar::BoardView{name, {}, {}}), {}};
        };
    }
    ar::MarkerMap const map =
        o.markers.empty() ? ar::MarkerMap{{}, {board_of(o.board)}, {}} : ar::read_marker_map(o.markers);
    if (!o.markers.empty()) say_doubts(map, o.markers);
    if (map.boards.empty())
        throw gi::InputError("there is no board in " + o.markers, "calibrating a lens needs a flat board",
                             "add it under boards:, see lightwell ar board --help");
    return [map](cv::Mat const& gray, std::string const& name) {
        ar::Sighting const sighting = ar::detect(gray, map);
        FoundBoard best{{name, {}, {}}, sighting};
        for (std::size_t i = 0; i < map.boards.size(); ++i)
            if (auto v = ar::view_of(sighting, map, i, name); v.pixels.size() > best.view.pixels.size())
                best.view = std::move(v);
        return best;
    };
}

struct Search {
    std::uint64_t looked_at = 0, refused = 0;
    cv::Mat last; ///< picture of the last accepted view
    std::uint64_t contradicted = 0;           ///< pictures that contradict the map of the board
    std::string contradiction;                ///< of the first of them
    std::uint64_t ambiguous = 0, unknown = 0; ///< markers, of the Sightings
    std::string first_ambiguous, first_unknown;
};

Search search(ar::FrameSource& source, ar::Collector& collector, Finder const& find, CalibrateOptions const& o,
              gi::StopRequest const& stop)
{
    Search s;
    gi::ProgressBar bar("calibrate " + o.source.source);
    bool const live = source.description().is_live;
    for (std::uint64_t n = 0; !stop.requested();) {
        if (live ? collector.enough() : collector.views().size() >= kMostViews) break;
        auto const frame = source.next(std::chrono::milliseconds(100));
        if (!frame && source.state().kind != ar::SourceState::Kind::running) break;
        if (!frame || n++ % std::uint64_t(o.every) != 0) continue;
        ++s.looked_at;
        cv::Mat gray;
        try {
            gray = ar::gray_of(*frame);
        } catch (gi::InputError const&) {
            ++s.refused;
            continue;
        }
        FoundBoard found = find(gray, fmt::format("frame {}", frame->sequence));
        ar::Sighting const& seen = found.sighting;
        if (!seen.contradictions.empty() && s.contradicted++ == 0) s.contradiction = seen.contradictions.front();
        if (!seen.ambiguous.empty() && s.ambiguous == 0) s.first_ambiguous = seen.ambiguous.front();
        if (!seen.unknown.empty() && s.unknown == 0) s.first_unknown = seen.unknown.front();
        s.ambiguous += std::uint64_t(seen.markers_ambiguous);
        s.unknown += std::uint64_t(seen.markers_unknown);
        if (collector.offer(std::move(found.view)).taken) s.last = gray.clone();
        bar.update(std::min(1.0, double(collector.views().size()) / o.views),
                   fmt::format("{} views; {}", collector.views().size(), collector.next()));
    }
    return s;
}

constexpr char const* kBoardRemedies =
    "is the board as described? exchange the numbers of --squares (across, then upwards; in a map squares_x and "
    "squares_y), or give --legacy-pattern (legacy_pattern: true) if it was printed by OpenCV before 4.6; check "
    "also "
    "--square, --marker and that all pictures are of one camera at one zoom";

/// Why a fit is none; empty if it is one. Corners are found to a fraction of a pixel and blur adds a few at most, so
/// larger residuals are those of another board.
std::string unexplained(ar::LensCalibration const& c)
{
    constexpr double kMostOfDiagonal = 0.004, kMostAspect = 2.5;
    double const most_px = kMostOfDiagonal * std::hypot(c.camera.size_px.x, c.camera.size_px.y);
    if (!(c.rms_px <= most_px))
        return fmt::format("the best {} misses the points by {:.3g} px RMS; {:.2g} are possible",
                           name_of(c.camera.lens), c.rms_px, most_px);
    double const aspect = std::max(c.camera.fx / c.camera.fy, c.camera.fy / c.camera.fx);
    if (!(aspect <= kMostAspect))
        return fmt::format("the best {} has focal lengths of {:.0f} and {:.0f} px", name_of(c.camera.lens),
                           c.camera.fx, c.camera.fy);
    return {};
}

void print(ar::LensCalibration const& c)
{
    fmt::print("{}, {} x {} px\n", name_of(c.camera.lens), c.camera.size_px.x, c.camera.size_px.y);
    auto const values = parameters_of(c.camera);
    for (std::size_t i = 0; i < values.size(); ++i)
        fmt::print("  {:<3} {:>12.5f} +- {:.5f}\n", c.parameters[i], values[i], c.standard_deviations[i]);
    fmt::print("reprojection: {:.3f} px RMS of {} views\n", c.rms_px, c.used_views());
    for (ar::ViewResult const& v : c.views)
        fmt::print("  {:<14} {:.3f} px, {} points{}\n", v.name, v.rms_px, v.residuals_px.size(),
                   v.used ? "" : "; excluded: " + v.why);
}

/// Response, vignetting, colour and noise belong to the sensor; they are kept from the file that is replaced.
ar::Calibration known_sensor(std::string const& file)
{
    ar::Calibration known;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return known;
    ar::Calibration const before = ar::read_calibration(file);
    known.camera.size_px = before.camera.size_px;
    known.photometry = before.photometry;
    known.noise = before.noise;
    for (auto const& entry : before.provenance)
        if (entry.first == "vignetting" || entry.first == "noise" || entry.first == "colour")
            known.provenance.push_back(entry);
    return known;
}

void say_what_is_kept(ar::Calibration& c, glm::ivec2 size_px, std::string const& file)
{
    if (!c.photometry && !c.noise && c.provenance.empty()) return;
    if (c.camera.size_px == size_px) {
        fmt::print("{}: response, vignetting, colour and noise are kept from before\n", file);
        return;
    }
    fmt::print("warning: {} had response, vignetting, colour or noise for pictures of {} x {}: left out\n", file,
               c.camera.size_px.x, c.camera.size_px.y);
    c = {};
}

int run_calibrate(CalibrateOptions const& o)
{
    check_outputs({o.out, o.report}, {o.source.source, o.markers});
    Finder const find = finder(o);
    ar::Calibration calibration = known_sensor(o.out);
    auto const source = open(o.source, ar::Pace::fastest, ar::Delivery::newest);
    std::error_code error;
    bool const pictures = o.source.source.find('%') != std::string::npos ||
                          (std::filesystem::is_directory(o.source.source, error) &&
                           !std::filesystem::exists(o.source.source + "/session.json", error));
    bool const stills = o.stills || pictures;
    auto const lens = ar::lens_named(o.lens);
    ar::Collector collector(source->description().size_px, stills ? ar::ViewSource::stills : ar::ViewSource::live,
                            lens.value_or(ar::LensModel::radial_tangential), o.views);
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    Search const s = search(*source, collector, find, o, stop);
    if (stop.requested()) return interrupted_code();
    auto const& counts = collector.counts();
    fmt::print("{}; of {} frames examined, {} are new views, {} like others, {} show too little of the board, {} "
               "show it moving, {} cannot be decoded\n",
               describe(source->counts()), s.looked_at, counts.taken, counts.alike, counts.too_few_points,
               counts.moving, s.refused);
    if (s.ambiguous > 0)
        fmt::print("{} markers are left out: their identifier is in a picture more than once (first: {})\n",
                   s.ambiguous, s.first_ambiguous);
    if (s.unknown > 0) fmt::print("{} markers are not the board's (first: {})\n", s.unknown, s.first_unknown);
    auto const too_few = [&](std::string const& why) {
        fmt::print(stderr, "lightwell: these views are not enough ({}) {}\n", why,
                   collector.enough() ? "take other views" : collector.next());
        return 1;
    };
    if (s.contradicted > 0)
        fmt::print(stderr, "lightwell: {} of {} frames contradict the board's map ({}) {}\n", s.contradicted,
                   s.looked_at, s.contradiction, kBoardRemedies);
    if (2 * s.contradicted > s.looked_at) return 1;
    if (counts.taken < kFewestViews) return too_few(fmt::format("{} of {}", counts.taken, kFewestViews));
    ar::CalibrationReport report;
    report.views = collector.views();
    report.background = s.last;
    try {
        if (!lens) report.choice = ar::choose_lens(report.views, source->description().size_px);
        report.lens =
            ar::calibrate_lens(report.views, source->description().size_px, lens ? *lens : report.choice->chosen);
        ar::check(report.lens.camera, o.out);
    } catch (gi::InputError const& e) {
        return too_few(e.what());
    }
    if (std::string const why = unexplained(report.lens); !why.empty()) {
        fmt::print(stderr, "lightwell: no lens explains these views ({}) {}\n", why, kBoardRemedies);
        return 1;
    }
    say_what_is_kept(calibration, report.lens.camera.size_px, o.out);
    calibration.camera = report.lens.camera;
    calibration.rms_px = report.lens.rms_px;
    calibration.covariance = report.lens.covariance;
    std::vector<std::pair<std::string, std::string>> provenance{
        {"made_by", "lightwell ar calibrate"},
        {"version", version_text()},
        {"source", o.source.source},
        {"views", std::to_string(report.lens.used_views())}};
    provenance.insert(provenance.end(), calibration.provenance.begin(), calibration.provenance.end());
    calibration.provenance = std::move(provenance);
    report.photometry = calibration.photometry;
    report.noise = calibration.noise;
    ar::write_calibration(o.out, calibration);
    if (!o.report.empty()) gi::write_text(o.report, ar::to_html(report));
    if (report.choice) fmt::print("lens: {}\n", report.choice->why);
    print(report.lens);
    fmt::print("coverage: {:.0f} % of the picture{}\n", 100 * report.lens.coverage,
               collector.enough() ? "" : "; to improve it: " + collector.next());
    for (std::string const& w : report.lens.warnings) fmt::print("warning: {}\n", w);
    for (std::string const& d : doubts_about(report.lens.camera)) fmt::print("warning: {}\n", d);
    if (ar::LensReach const reach = ar::reach_of(report.lens.camera); reach.share < 1)
        fmt::print("warning: the lens {}; elsewhere pixels have no rays\n", describe(reach));
    fmt::print("{}\n", o.out);
    std::uint64_t const unread = source->counts().refused;
    return exit_code_of(most_refused(s.looked_at - s.refused, s.refused + unread, "pictures"));
}

} // namespace

void add_ar_calibrate(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<CalibrateOptions>();
    CLI::App* const c = ar.add_subcommand("calibrate", "Calibrate a camera's lens from views of a printed board.");
    declare_source_arguments(*c, o->source);
    c->add_option("--markers", o->markers, "marker map with the board, as written by lightwell ar board");
    declare_board_arguments(*c, o->board);
    c->add_option("--chessboard", o->chessboard, "plain chessboard: inner corners, e.g. 9x6; see --square");
    c->add_option("--lens", o->lens, "lens model; automatic: the one that predicts unseen views best")
        ->check(CLI::IsMember({"automatic", "pinhole", "radial_tangential", "rational", "fisheye"}))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "calibration to write (YAML, readable by OpenCV)")->required();
    c->add_option("--report", o->report, "HTML page: residuals, coverage, parameters");
    c->add_option("--every", o->every, "use only every Nth frame")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    c->add_option("--views", o->views, "wanted number; a camera is read until it is reached")
        ->check(CLI::Range(kFewestViews, int(kMostViews)))
        ->capture_default_str();
    c->add_flag("--stills", o->stills, "the frames are stills, as in a folder of pictures");
    c->footer(R"(Prepared by:
  lightwell ar board --squares 7x5 --out board.svg --markers markers.yaml --views board_views
Examples:
  lightwell ar calibrate board_views --markers markers.yaml --lens radial_tangential --out camera.yaml --report report.html
  lightwell ar calibrate board_views --squares 7x5 --every 2 --lens fisheye --out fisheye.yaml

From cameras, videos and sessions only frames in which the board is held still are used. A calibration that is
replaced keeps its response, vignetting, colour and noise. Exit code 1: too few usable views, a board that is not
the one described, or views that no lens explains (nothing is written); or most pictures were refused (it is written).)");
    c->callback([o, &exit_code] { exit_code = run_calibrate(*o); });
}

} // namespace viewer
