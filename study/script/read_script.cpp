#include "study/script/read.h"
#include "study/script/script_file.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>

namespace study {
namespace {

using Words = std::vector<std::string>;

/// BIDS allows letters and digits only in the label of a participant.
void check_id_pattern(gi::Yaml const& y)
{
    std::string const s = y.text();
    auto const open = s.find('{'), close = s.find('}');
    std::string const spec = open < close && close != std::string::npos ? s.substr(open, close - open + 1) : "";
    bool const is_known =
        spec == "{n}" || (spec.size() == 6 && spec.starts_with("{n:0") && spec[4] >= '1' && spec[4] <= '9');
    std::string const rest = is_known ? s.substr(0, open) + s.substr(close + 1) : s;
    bool const is_plain =
        std::all_of(rest.begin(), rest.end(), [](unsigned char c) { return c < 128 && std::isalnum(c); });
    if (!is_known || !is_plain || s.size() > 40)
        throw y.error(fmt::format("'{}' is no pattern for participants' ids", s.substr(0, 64)),
                      "it must have the number once and otherwise only letters and digits", "write \"P{n:03}\"");
}

Participants read_participants(gi::Yaml const& y)
{
    check_keys(y, "participants");
    Participants p;
    p.place = y.place();
    p.count = y.needed("count", "24").integer(1, 100000);
    if (y.has("id")) {
        check_id_pattern(y.at("id"));
        p.id = y.at("id").text();
    }
    if (y.has("ask"))
        for (gi::Yaml const& item : y.at("ask").one_or_more()) p.ask.push_back(item.name());
    if (y.has("consent")) p.consent = y.at("consent").text();
    return p;
}

Timing read_timing(gi::Yaml const& y)
{
    check_keys(y, "timing");
    Timing t;
    if (y.has("vsync")) t.vsync = Vsync(y.at("vsync").one_of({"required", "record"}, "way to treat vsync"));
    if (y.has("onset")) {
        Words const known{"auto", "oml", "wp_presentation", "openxr", "swap_finish"};
        t.onset = OnsetMethod(y.at("onset").one_of(known, "way to time onsets"));
    }
    if (y.has("max_dropped_frames")) t.max_dropped_frames = y.at("max_dropped_frames").integer(0, 100000);
    if (y.has("on_bad_trial"))
        t.on_bad_trial =
            BadTrial(y.at("on_bad_trial").one_of({"keep", "repeat_at_end"}, "way to treat bad trials"));
    if (y.has("sync_patch")) {
        gi::Yaml const patch = y.at("sync_patch");
        check_keys(patch, "sync_patch");
        t.sync_patch.emplace();
        Words const corners{"bottom_left", "bottom_right", "top_left", "top_right"};
        if (patch.has("corner")) t.sync_patch->corner = Corner(patch.at("corner").one_of(corners, "corner"));
        if (patch.has("px")) t.sync_patch->px = patch.at("px").integer(1, 1000);
    }
    if (y.has("calibrate")) {
        gi::Yaml const calibrate = y.at("calibrate");
        check_keys(calibrate, "calibrate");
        if (calibrate.has("frames")) t.calibrate.frames = calibrate.at("frames").integer(50, 100000);
        if (calibrate.has("max_sd_ms")) t.calibrate.max_sd_ms = calibrate.at("max_sd_ms").number(1e-3, 100);
        if (calibrate.has("max_deviation"))
            t.calibrate.max_deviation = calibrate.at("max_deviation").number(1e-4, 1);
    }
    if (y.has("display_lag_ms")) t.display_lag_ms = y.at("display_lag_ms").number(0, 10000);
    if (y.has("display_lag_uncertainty_ms"))
        t.display_lag_uncertainty_ms = y.at("display_lag_uncertainty_ms").number(0, 10000);
    if (y.has("expected_hz")) t.expected_hz = y.at("expected_hz").number(1, 1000);
    return t;
}

Defaults read_defaults(gi::Yaml const& y)
{
    check_keys(y, "defaults");
    Defaults d;
    read_trial_timing(y, d.timing);
    if (y.has("camera")) d.camera = y.at("camera").text();
    if (y.has("stimuli")) d.stimuli = Stimuli(y.at("stimuli").one_of({"live", "prepared"}, "way to make stimuli"));
    if (y.has("settings")) d.settings = read_patch(y.at("settings"));
    if (y.has("gaze")) read_gaze(y.at("gaze"), d.gaze);
    return d;
}

bool is_input(std::string const& s)
{
    auto const colon = s.find(':');
    std::string const kind = s.substr(0, colon), rest = colon == std::string::npos ? "" : s.substr(colon + 1);
    bool const is_word = !rest.empty() && rest.size() <= 32 && std::all_of(rest.begin(), rest.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '/';
    });
    bool const has_hand = rest.starts_with("left/") || rest.starts_with("right/");
    bool const has_slash = rest.find('/') != std::string::npos;
    if (kind == "xr") return is_word && has_hand && rest.back() != '/';
    return is_word && !has_slash && (kind == "key" || kind == "pad" || kind == "mouse");
}

std::vector<Device> read_devices(gi::Yaml const& y)
{
    Words const answers{"first", "second", "third", "same",    "different", "yes",
                        "no",    "up",     "down",  "confirm", "neither",   "pause"};
    std::vector<Device> devices;
    for (auto const& [key, value] : y.entries()) {
        Device d{answers[std::size_t(key.one_of(answers, "answer"))], {}, key.place()};
        for (gi::Yaml const& input : value.one_or_more()) {
            if (!is_input(input.text()))
                throw input.error(fmt::format("'{}' is no input", input.text().substr(0, 64)),
                                  "an input is a device and a button or key",
                                  "write key:left, pad:x, mouse:left or xr:left/trigger");
            d.inputs.push_back(input.text());
        }
        if (d.inputs.empty()) throw value.error("no inputs", "the answer could not be given", "write [key:left]");
        devices.push_back(std::move(d));
    }
    return devices;
}

std::vector<Counterbalance> read_counterbalance(gi::Yaml const& y, Script const& s)
{
    Words blocks;
    for (Block const& b : s.blocks) blocks.push_back(b.name);
    std::vector<Counterbalance> all;
    for (auto const& [key, value] : y.entries()) {
        check_keys(value, "counterbalance");
        Counterbalance c;
        c.name = key.name();
        c.place = key.place();
        Words const methods{"fixed", "alternate", "latin", "williams", "random", "between"};
        gi::Yaml const method = value.needed("method", "williams");
        c.method = Balance(method.one_of(methods, "way to counterbalance"));
        for (std::size_t f = 0; f < s.factors.size(); ++f)
            if (s.factors[f].name == c.name) c.factor = int(f);
        if ((c.factor >= 0) == value.has("of"))
            throw key.error(c.factor >= 0 ? "the factor '" + c.name + "' with a list of blocks"
                                          : "'" + c.name + "' is neither a factor nor has it 'of'",
                            "levels of a factor are counterbalanced, or a group of blocks",
                            "write NAME: {method: williams, of: [block, block]}, or name a factor");
        if (c.factor < 0) {
            if (std::find(blocks.begin(), blocks.end(), c.name) != blocks.end())
                throw key.error("a group named as the block '" + c.name + "'", "it would be ambiguous",
                                "rename one");
            for (gi::Yaml const& name : value.at("of").items()) {
                int const b = name.one_of(blocks, "block");
                if (std::find(c.blocks.begin(), c.blocks.end(), b) != c.blocks.end())
                    throw name.error("'" + name.text() + "' twice", "it has one place", "remove one");
                c.blocks.push_back(b);
            }
            if (c.blocks.size() < 2) throw value.error("fewer than two blocks", "there is no order", "name more");
            if (c.method == Balance::between)
                throw method.error("blocks between participants", "only factors can do this",
                                   "use latin or williams");
        }
        all.push_back(std::move(c));
    }
    return all;
}

Record read_record(gi::Yaml const& y)
{
    check_keys(y, "record");
    Record r;
    if (y.has("dir")) r.dir = y.at("dir").text();
    if (y.has("head_pose_hz")) {
        r.poses_by_frame = y.at("head_pose_hz").is_text() && y.at("head_pose_hz").text() == "frame";
        if (!r.poses_by_frame) r.head_pose_hz = y.at("head_pose_hz").number(0, 1000);
    }
    if (y.has("markers"))
        for (gi::Yaml const& m : y.at("markers").one_or_more()) {
            m.one_of({"lsl", "udp"}, "kind of marker");
            r.markers.push_back(m.text());
        }
    if (y.has("compress_frames")) r.compress_frames = y.at("compress_frames").boolean();
    if (y.has("gaze")) {
        gi::Yaml const gaze = y.at("gaze");
        r.gaze = gaze.text();
        if (r.gaze == "none") r.gaze.clear();
        bool const is_known =
            r.gaze.empty() || r.gaze == "lsl" || (r.gaze.starts_with("lsl:") && r.gaze.size() > 4);
        if (!is_known)
            throw gaze.error("'" + r.gaze.substr(0, 64) + "' is no source of gaze", "it would not be recorded",
                             "write lsl (any stream of type Gaze), lsl:NAME or none");
    }
    return r;
}

Resume read_resume(gi::Yaml const& y)
{
    check_keys(y, "resume");
    Resume r;
    if (y.has("max_gap_min")) r.max_gap_min = y.at("max_gap_min").number(0, 1e6);
    if (!y.has("repeat")) return r;
    r.instructions = r.practice = false;
    for (gi::Yaml const& what : y.at("repeat").one_or_more())
        (what.one_of({"instructions", "practice"}, "thing to repeat") == 0 ? r.instructions : r.practice) = true;
    return r;
}

Script read_script(gi::Yaml const& y, std::string const& file)
{
    check_keys(y, "study");
    gi::Yaml const schema = y.needed("schema", "study/1");
    if (schema.text() != "study/1") throw schema.unknown("known schema", {"study/1"});
    Script s;
    s.file = file;
    s.id = y.needed("id", "visibility2026").name();
    if (y.has("title")) s.title = y.at("title").text();
    s.seed = y.needed("seed", "20261").seed();
    s.participants = read_participants(y.needed("participants", "{count: 24}"));
    if (y.has("timing")) s.timing = read_timing(y.at("timing"));
    if (y.has("factors")) s.factors = read_factors(y.at("factors"));
    if (y.has("reference")) s.reference = read_choice(y.at("reference"), s);
    if (y.has("defaults")) s.defaults = read_defaults(y.at("defaults"));
    if (y.has("devices")) s.devices = read_devices(y.at("devices"));
    auto const known = known_questionnaires();
    s.questionnaires.assign(known.begin(), known.end());
    if (y.has("questionnaires"))
        for (Questionnaire& q : read_questionnaires(y.at("questionnaires")))
            s.questionnaires.push_back(std::move(q));
    if (y.has("blocks"))
        for (auto const& [key, value] : y.at("blocks").entries()) s.blocks.push_back(read_block(key, value, s));
    if (y.has("counterbalance")) s.counterbalances = read_counterbalance(y.at("counterbalance"), s);
    s.sequence = read_sequence(y.needed("sequence", "[{instructions: intro.md}, BLOCK]"), s);
    if (y.has("record")) s.record = read_record(y.at("record"));
    if (y.has("resume")) s.resume = read_resume(y.at("resume"));
    return s;
}

} // namespace

Script parse_script(std::string const& text, std::string const& name)
{
    try {
        Script s = read_script(gi::Yaml::parse(text, name, "script"), name);
        check_design(s);
        return s;
    } catch (ScriptError const&) {
        throw;
    } catch (gi::InputError const& e) {
        throw ScriptError(e);
    } catch (YAML::Exception const& e) {
        throw ScriptError(name, {e.mark.line + 1, e.mark.column + 1}, "this YAML cannot be read", e.msg,
                          "simplify it");
    }
}

} // namespace study
