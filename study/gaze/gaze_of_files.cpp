#include "study/gaze/gaze_recording.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/gzip.h"
#include "gi/core/sha256.h"
#include "gi/core/text.h"
#include "study/gaze/bids_sidecar.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace study {
namespace {

namespace fs = std::filesystem;
using Facts = nlohmann::json;

/// One eye of one recording.
struct EyeFile {
    fs::path file;
    std::string eye; ///< left, right, or as the file says
    std::vector<GazeSample> samples;
    ScreenGeometry screen;
    GazeCounts counts;
};

bool is_missing(std::string_view cell)
{
    return cell.empty() || cell == "n/a" || cell == "nan" || cell == "NaN" || cell == "NA";
}

double seconds_per(std::string const& unit, fs::path const& file)
{
    for (auto const& [name, value] :
         {std::pair{"s", 1.0}, {"seconds", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"µs", 1e-6}, {"ns", 1e-9}})
        if (unit == name) return value;
    throw gi::InputError(fmt::format("'{}': timestamps in '{}'", file.string(), unit), "this unit is not known",
                         "write s, ms, us or ns as Units of timestamp in its .json file");
}

/// Two positive numbers of a list; none if there are none.
std::optional<std::pair<double, double>> pair_in(Facts const& facts, char const* key)
{
    auto const it = facts.find(key);
    if (it == facts.end() || !it->is_array() || it->size() != 2 || !(*it)[0].is_number() || !(*it)[1].is_number())
        return {};
    std::pair const p((*it)[0].get<double>(), (*it)[1].get<double>());
    return p.first > 0 && p.second > 0 ? std::optional(p) : std::nullopt;
}

/// Of StimulusPresentation in the .json files of events, or among the facts of the recording.
Facts screen_facts(fs::path const& file, Facts const& of_recording)
{
    Facts const events = bids_facts(file, "events");
    if (auto const it = events.find("StimulusPresentation"); it != events.end() && it->is_object()) return *it;
    if (auto const it = of_recording.find("StimulusPresentation"); it != of_recording.end() && it->is_object())
        return *it;
    return of_recording;
}

ScreenGeometry screen_of(Facts const& facts, fs::path const& file)
{
    auto const px = pair_in(facts, "ScreenResolution"), m = pair_in(facts, "ScreenSize");
    auto const distance = facts.find("ScreenDistance");
    bool const has_distance = distance != facts.end() && distance->is_number() && distance->get<double>() > 0;
    if (!px || !m || !has_distance)
        throw gi::InputError(
            fmt::format("'{}': ScreenResolution, ScreenSize or ScreenDistance is missing", file.string()),
            "degrees need pixels, metres and distance of the screen",
            "add them to StimulusPresentation in the .json file of its events, or give "
            "--display-model FILE");
    return {int(px->first), int(px->second), 100 * m->first, 100 * m->second, 100 * distance->get<double>(),
            "BIDS"};
}

/// From the origin that the files say to the centre of the screen, x to the right and y down.
void move_origin(std::vector<GazeSample>& samples, Facts const& facts, ScreenGeometry const& screen,
                 fs::path const& file)
{
    Facts const origin = facts.value("ScreenOrigin", Facts{"top", "left"});
    std::string const down = origin.is_array() && origin.size() == 2 && origin[0].is_string() ? origin[0] : "";
    if ((down != "top" && down != "bottom") || origin[1] != "left")
        throw gi::InputError(fmt::format("'{}': ScreenOrigin {}", file.string(), origin.dump()),
                             "places are read from the left of the top or bottom",
                             "convert them, or correct ScreenOrigin: [\"top\", \"left\"]");
    for (GazeSample& s : samples) {
        s.x_px -= 0.5 * screen.width_px;
        s.y_px = down == "top" ? s.y_px - 0.5 * screen.height_px : 0.5 * screen.height_px - s.y_px;
    }
}

std::string text_of_table(fs::path const& file, std::vector<InputFile>& inputs)
{
    std::string bytes = gi::read_text(file, std::size_t(4) << 30);
    inputs.push_back({file.string(), gi::sha256(bytes)});
    return file.extension() == ".gz" ? gi::gunzip(bytes, file.string()) : bytes;
}

/// Columns of a table without a header line, as its .json file names them; -1 = none.
struct PhysioColumns {
    int time = -1, x = -1, y = -1, pupil = -1;
    std::size_t count = 0;
};

PhysioColumns physio_columns(Facts const& facts, fs::path const& file)
{
    auto const it = facts.find("Columns");
    if (it == facts.end() || !it->is_array())
        throw gi::InputError(fmt::format("'{}': no Columns in its .json file", file.string()),
                             "the table has no header line",
                             "name them: \"Columns\": [\"timestamp\", \"x_coordinate\", \"y_coordinate\"]");
    PhysioColumns c;
    c.count = it->size();
    for (std::size_t i = 0; i < it->size(); ++i) {
        std::string const name = (*it)[i].is_string() ? (*it)[i].get<std::string>() : "";
        if (name == "timestamp") c.time = int(i);
        if (name == "x_coordinate") c.x = int(i);
        if (name == "y_coordinate") c.y = int(i);
        if (name == "pupil_size") c.pupil = int(i);
    }
    if (c.x < 0 || c.y < 0)
        throw gi::InputError(fmt::format("'{}': no columns x_coordinate and y_coordinate", file.string()),
                             "they are where gaze was", "name them in Columns of its .json file");
    for (char const* const name : {"x_coordinate", "y_coordinate"}) {
        auto const column = facts.find(name);
        std::string const unit =
            column != facts.end() && column->is_object() ? column->value("Units", "pixel") : "pixel";
        if (unit != "pixel" && unit != "pixels" && unit != "px")
            throw gi::InputError(fmt::format("'{}': {} in {}", file.string(), name, unit),
                                 "places are read in pixels of the screen", "convert them to pixel");
    }
    return c;
}

EyeFile read_physio(fs::path const& file, std::optional<ScreenGeometry> const& screen,
                    std::vector<InputFile>& inputs)
{
    Facts const facts = bids_facts(file, "physio");
    std::string const text = text_of_table(file, inputs);
    if (gi::trimmed(text).empty())
        throw gi::InputError("'" + file.string() + "' has no samples", "the table is empty",
                             "give the data themselves; examples of BIDS come without them");
    PhysioColumns const columns = physio_columns(facts, file);
    double const rate_hz = facts.value("SamplingFrequency", 0.0), start_s = facts.value("StartTime", 0.0);
    if (columns.time < 0 && !(rate_hz > 0))
        throw gi::InputError(fmt::format("'{}': neither timestamp nor SamplingFrequency", file.string()),
                             "times of samples are unknown", "add SamplingFrequency to its .json file");
    double unit_s = 1;
    if (columns.time >= 0)
        if (auto const it = facts.find("timestamp"); it != facts.end() && it->is_object())
            unit_s = seconds_per(it->value("Units", "s"), file);
    EyeFile eye;
    eye.file = file;
    eye.eye = facts.value("RecordedEye", bids_name(file).entity("recording"));
    std::optional<double> first_time;
    std::string const file_name = file.string();
    std::string_view rest = text;
    for (int number = 1; !rest.empty(); ++number) {
        gi::TextLine const line{gi::take_until(rest, '\n'), file_name, number};
        if (gi::trimmed(line.text).empty()) continue;
        std::vector<std::string_view> cells;
        for (std::size_t at = 0, end = 0; end != std::string_view::npos; at = end + 1) {
            end = line.text.find('\t', at);
            cells.push_back(gi::trimmed(line.text.substr(at, end - at)));
        }
        ++eye.counts.samples;
        if (cells.size() != columns.count) {
            ++eye.counts.unreadable;
            continue;
        }
        auto const cell = [&](int i) -> std::optional<double> {
            if (i < 0 || is_missing(cells[std::size_t(i)])) return {};
            if (auto const v = gi::parse_finite(cells[std::size_t(i)])) return v;
            throw line.error(cells[std::size_t(i)], fmt::format("'{}' is no number", cells[std::size_t(i)]),
                             "it is a time, a place or a pupil", "write a number or n/a");
        };
        GazeSample s;
        auto const x = cell(columns.x), y = cell(columns.y), pupil = cell(columns.pupil);
        s.is_valid = x && y;
        s.x_px = x.value_or(0);
        s.y_px = y.value_or(0);
        if (pupil) s.pupil_mm = *pupil;
        if (columns.time < 0) {
            s.time_s = start_s + (eye.counts.samples - 1) / rate_hz;
        } else {
            auto const t = cell(columns.time);
            if (t && !first_time) first_time = *t;
            s.time_s = t ? start_s + (*t - *first_time) * unit_s : NAN;
        }
        eye.samples.push_back(s);
    }
    Facts const of_screen = screen_facts(file, facts);
    eye.screen = screen ? *screen : screen_of(of_screen, file);
    move_origin(eye.samples, of_screen, eye.screen, file);
    eye.samples = clean_gaze(eye.samples, eye.screen, eye.counts);
    return eye;
}

/// The rows of the events.tsv beside a recording: onset and duration in seconds, since the same moment as StartTime.
/// What has no duration is no view.
void add_event_views(GazeRecording& r, fs::path const& file, std::vector<std::string>& remarks)
{
    std::string stem;
    for (std::string const& e : bids_name(file).entities)
        if (!e.starts_with("recording-")) stem += e + "_";
    fs::path const events = file.parent_path() / (stem + "events.tsv");
    std::error_code none;
    if (!fs::exists(events, none)) {
        remarks.push_back(fmt::format("{}: no {}: it is one view", r.name, events.filename().string()));
        return;
    }
    std::string const text = gi::read_text(events, std::size_t(1) << 30);
    std::string_view rest = text;
    std::vector<std::string> names;
    int skipped = 0, rows = 0;
    while (!rest.empty()) {
        std::string_view left = gi::take_until(rest, '\n');
        if (gi::trimmed(left).empty()) continue;
        std::vector<std::string> cells;
        do cells.emplace_back(gi::trimmed(gi::take_until(left, '\t')));
        while (!left.empty());
        if (names.empty()) {
            names = cells;
            continue;
        }
        auto const cell = [&](std::string_view name) {
            for (std::size_t i = 0; i < names.size() && i < cells.size(); ++i)
                if (names[i] == name) return cells[i];
            return std::string();
        };
        ++rows;
        auto const onset = gi::parse_finite(cell("onset")), duration = gi::parse_finite(cell("duration"));
        if (!onset || !duration || !(*duration > 0)) {
            ++skipped;
            continue;
        }
        GazeView view;
        view.block = bids_name(file).entity("task");
        std::string const type = cell("trial_type"), picture = cell("stim_file");
        view.condition = !is_missing(picture) ? picture : is_missing(type) ? "" : type;
        view.step = rows - 1;
        view.start_s = *onset;
        view.end_s = *onset + *duration;
        r.views.push_back(std::move(view));
    }
    if (skipped > 0)
        remarks.push_back(fmt::format("{}: {} of {} rows have no onset and duration, and are no views",
                                      events.string(), skipped, rows));
}

GazeRecording joined(std::vector<EyeFile> eyes, std::string const& name, GazeEyes wanted,
                     std::vector<std::string>& remarks)
{
    GazeRecording r;
    r.name = name;
    r.source = eyes.front().file.string();
    r.participant = bids_name(eyes.front().file).entity("sub");
    r.screen = eyes.front().screen;
    EyeFile const *left = nullptr, *right = nullptr;
    for (EyeFile const& e : eyes) {
        if (e.eye == "left") left = &e;
        if (e.eye == "right") right = &e;
    }
    EyeFile const* const one = wanted == GazeEyes::left            ? left
                               : wanted == GazeEyes::right         ? right
                               : left && right && eyes.size() == 2 ? nullptr
                                                                   : &eyes.front();
    if (wanted != GazeEyes::mean && one == nullptr)
        throw gi::InputError(fmt::format("{}: no {} eye", name, wanted == GazeEyes::left ? "left" : "right"),
                             "RecordedEye of its .json files does not name it", "leave out --eyes");
    if (one != nullptr) {
        r.samples = one->samples;
        r.counts = one->counts;
        r.eyes = one->eye;
        r.source = one->file.string();
        if (wanted == GazeEyes::mean && eyes.size() > 1)
            remarks.push_back(fmt::format("{}: of {} files only {} counts, as they are not a left and a right eye",
                                          name, eyes.size(), one->file.filename().string()));
        return r;
    }
    r.counts = left->counts;
    r.counts += right->counts;
    r.samples = mean_of_eyes(left->samples, right->samples, r.counts);
    r.eyes = "mean of left and right";
    return r;
}

GazeRecording table_recording(fs::path const& file, std::optional<ScreenGeometry> const& screen,
                              std::vector<InputFile>& inputs)
{
    std::string const text = text_of_table(file, inputs);
    GazeRecording r;
    r.name = r.source = file.string();
    if (!screen)
        throw gi::InputError("'" + file.string() + "' says nothing about the screen",
                             "degrees need its pixels, size and distance", "give --display-model FILE");
    r.screen = *screen;
    r.eyes = "as recorded";
    auto samples = read_gaze_csv(text, file.string());
    r.counts.samples = int(samples.size());
    for (GazeSample& s : samples) {
        s.x_px -= 0.5 * screen->width_px;
        s.y_px -= 0.5 * screen->height_px;
    }
    r.samples = clean_gaze(samples, *screen, r.counts);
    return r;
}

} // namespace

GazeRecordings gaze_of_files(std::vector<fs::path> const& files, std::optional<ScreenGeometry> const& screen,
                             GazeEyes eyes)
{
    GazeRecordings all;
    std::map<std::string, std::vector<EyeFile>> of_recording;
    for (fs::path const& file : files) {
        std::error_code none;
        if (fs::is_directory(file, none))
            throw gi::InputError("'" + file.string() + "' is a folder", "--gaze reads files of samples",
                                 "give the folder of records before --gaze, or name the files");
        if (std::ranges::any_of(all.inputs, [&](InputFile const& f) { return f.file == file.string(); }))
            throw gi::InputError("'" + file.string() + "' is given twice", "its samples would count twice",
                                 "name each file once");
        if (bids_name(file).suffix != "physio") {
            all.recordings.push_back(table_recording(file, screen, all.inputs));
            continue;
        }
        std::string name;
        for (std::string const& e : bids_name(file).entities)
            if (!e.starts_with("recording-")) name += (name.empty() ? "" : "_") + e;
        try {
            of_recording[(file.parent_path() / name).string()].push_back(read_physio(file, screen, all.inputs));
        } catch (Facts::exception const& e) {
            throw gi::InputError("'" + file.string() + "': a fact in its .json files has the wrong type", e.what(),
                                 "numbers without quotes, names in quotes");
        }
    }
    for (auto& [path, of_eyes] : of_recording) {
        fs::path const file = of_eyes.front().file;
        GazeRecording r = joined(std::move(of_eyes), fs::path(path).filename().string(), eyes, all.remarks);
        add_event_views(r, file, all.remarks);
        all.recordings.push_back(std::move(r));
    }
    for (GazeRecording& r : all.recordings)
        if (r.views.empty() && !r.samples.empty())
            r.views.push_back({"", "", "", -1, 1, true, r.samples.front().time_s, r.samples.back().time_s});
    return all;
}

} // namespace study
