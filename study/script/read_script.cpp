#include "study/script/read.h"
#include "study/script/script_file.h"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <sstream>

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

/// The keys that a type of question has need of, and no others.
void check_type_keys(gi::Yaml const& y, AskedQuestion const& q, Mistakes& m)
{
    for (char const* const key : {"min", "max", "whole"})
        if (y.has(key) && q.type != AskedType::number)
            m.add(y.at(key).error(fmt::format("'{}' of a question without a number", key), "it would be ignored",
                                  "write type: number, or remove it"));
    if (y.has("choices") && q.type != AskedType::choice)
        m.add(y.at("choices").error("choices of a question that has none", "they would be ignored",
                                    "write type: choice, or remove them"));
}

AskedQuestion read_question(gi::Yaml const& y, Mistakes& m)
{
    AskedQuestion q;
    if (y.is_text()) {
        q.id = q.text = y.name();
        return q;
    }
    m.check_keys(y, "ask");
    m.need(y, "id", "age", [&](gi::Yaml const& v) { q.id = v.name(); });
    q.text = q.id;
    m.take(y, "text", [&](gi::Yaml const& v) { q.text = v.text(); });
    m.take(y, "type", [&](gi::Yaml const& v) {
        q.type = AskedType(v.one_of({"text", "number", "choice"}, "type of question"));
    });
    check_type_keys(y, q, m);
    if (q.type == AskedType::number) {
        m.need(y, "min", "18", [&](gi::Yaml const& v) { q.low = v.number(-1e9, 1e9); });
        m.need(y, "max", "99", [&](gi::Yaml const& v) {
            q.high = v.number(-1e9, 1e9);
            if (q.high < q.low) throw v.error("a range that does not rise", "min comes first", "swap them");
        });
        m.take(y, "whole", [&](gi::Yaml const& v) { q.is_whole = v.boolean(); });
    }
    if (q.type == AskedType::choice)
        m.need(y, "choices", "[left, right]", [&](gi::Yaml const& v) {
            for (gi::Yaml const& choice : v.items(2, 9)) {
                std::string const text = choice.text();
                if (std::find(q.choices.begin(), q.choices.end(), text) != q.choices.end())
                    throw choice.error("'" + text + "' twice", "answers could not be distinguished", "remove one");
                q.choices.push_back(text);
            }
        });
    return q;
}

/// True if participants.tsv could have one column for both questions: its names have letters, digits and _, and
/// begin with asked_ where BIDS has another meaning for one.
bool are_one_column(std::string const& a, std::string const& b)
{
    auto const column = [](std::string name) {
        std::replace_if(
            name.begin(), name.end(), [](char c) { return c == '.' || c == '+' || c == '-'; }, '_');
        return name;
    };
    std::string const one = column(a), other = column(b);
    return one == other || one == "asked_" + other || other == "asked_" + one;
}

void read_asked(gi::Yaml const& y, Participants& p, Mistakes& m)
{
    for (gi::Yaml const& item : y.one_or_more())
        m.attempt([&] {
            p.ask.push_back(read_question(item, m));
            for (std::size_t i = 0; i + 1 < p.ask.size(); ++i)
                if (are_one_column(p.ask[i].id, p.ask.back().id))
                    throw item.error(p.ask[i].id == p.ask.back().id
                                         ? "question '" + p.ask[i].id + "' twice"
                                         : "questions '" + p.ask[i].id + "' and '" + p.ask.back().id + "'",
                                     "tables could not distinguish them", "rename one");
        });
}

Participants read_participants(gi::Yaml const& y, Mistakes& m)
{
    m.check_keys(y, "participants");
    Participants p;
    p.place = y.place();
    p.count = 1;
    m.need(y, "count", "24", [&](gi::Yaml const& v) { p.count = int(v.integer(1, 100000)); });
    m.take(y, "id", [&](gi::Yaml const& v) {
        check_id_pattern(v);
        p.id = v.text();
    });
    m.take(y, "ask", [&](gi::Yaml const& v) { read_asked(v, p, m); });
    m.take(y, "consent", [&](gi::Yaml const& v) { p.consent = v.text(); });
    return p;
}

void read_sync_patch(gi::Yaml const& y, Timing& t, Mistakes& m)
{
    m.check_keys(y, "sync_patch");
    t.sync_patch.emplace();
    m.take(y, "corner", [&](gi::Yaml const& v) {
        Words const corners{"bottom_left", "bottom_right", "top_left", "top_right"};
        t.sync_patch->corner = Corner(v.one_of(corners, "corner"));
    });
    m.take(y, "px", [&](gi::Yaml const& v) { t.sync_patch->px = int(v.integer(1, 1000)); });
}

void read_calibrate(gi::Yaml const& y, Calibrate& c, Mistakes& m)
{
    m.check_keys(y, "calibrate");
    m.take(y, "frames", [&](gi::Yaml const& v) { c.frames = int(v.integer(50, 100000)); });
    m.take(y, "max_sd_ms", [&](gi::Yaml const& v) { c.max_sd_ms = v.number(1e-3, 100); });
    m.take(y, "max_deviation", [&](gi::Yaml const& v) { c.max_deviation = v.number(1e-4, 1); });
}

Timing read_timing(gi::Yaml const& y, Mistakes& m)
{
    m.check_keys(y, "timing");
    Timing t;
    m.take(y, "vsync", [&](gi::Yaml const& v) {
        t.vsync = Vsync(v.one_of({"required", "record"}, "way to treat vsync"));
    });
    m.take(y, "onset", [&](gi::Yaml const& v) {
        Words const known{"auto", "oml", "wp_presentation", "openxr", "swap_finish"};
        t.onset = OnsetMethod(v.one_of(known, "way to time onsets"));
    });
    m.take(y, "max_dropped_frames", [&](gi::Yaml const& v) { t.max_dropped_frames = int(v.integer(0, 100000)); });
    m.take(y, "on_bad_trial", [&](gi::Yaml const& v) {
        t.on_bad_trial = BadTrial(v.one_of({"keep", "repeat_at_end"}, "way to treat bad trials"));
    });
    m.take(y, "sync_patch", [&](gi::Yaml const& v) { read_sync_patch(v, t, m); });
    m.take(y, "calibrate", [&](gi::Yaml const& v) { read_calibrate(v, t.calibrate, m); });
    m.take(y, "display_lag_ms", [&](gi::Yaml const& v) { t.display_lag_ms = v.number(0, 10000); });
    m.take(y, "display_lag_uncertainty_ms",
           [&](gi::Yaml const& v) { t.display_lag_uncertainty_ms = v.number(0, 10000); });
    m.take(y, "expected_hz", [&](gi::Yaml const& v) { t.expected_hz = v.number(1, 1000); });
    return t;
}

Defaults read_defaults(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    m.check_keys(y, "defaults");
    Defaults d;
    read_trial_timing(y, d.timing, m);
    m.take(y, "camera", [&](gi::Yaml const& v) { d.camera = v.text(); });
    m.take(y, "stimuli", [&](gi::Yaml const& v) {
        d.stimuli = Stimuli(v.one_of({"live", "prepared"}, "way to make stimuli"));
    });
    m.take(y, "settings", [&](gi::Yaml const& v) { d.settings = read_patch(v, m); });
    m.take(y, "gaze", [&](gi::Yaml const& v) { read_gaze(v, d.gaze, m); });
    m.take(y, "cues", [&](gi::Yaml const& v) { d.cues = read_cues(v, s, m); });
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

std::vector<Device> read_devices(gi::Yaml const& y, Mistakes& m)
{
    Words const answers{"first", "second", "third", "same",    "different", "yes",
                        "no",    "up",     "down",  "confirm", "neither",   "pause"};
    std::vector<Device> devices;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] {
            Device d{answers[std::size_t(k.one_of(answers, "answer"))], {}, k.place()};
            auto const inputs = v.one_or_more();
            for (gi::Yaml const& input : inputs)
                m.attempt([&] {
                    if (!is_input(input.text()))
                        throw input.error(fmt::format("'{}' is no input", input.text().substr(0, 64)),
                                          "an input is a device and a button or key",
                                          "write key:left, pad:x, mouse:left or xr:left/trigger");
                    if (std::find(d.inputs.begin(), d.inputs.end(), input.text()) != d.inputs.end())
                        throw input.error("'" + input.text() + "' twice", "once is enough", "remove one");
                    d.inputs.push_back(input.text());
                });
            if (inputs.empty()) throw v.error("no inputs", "the answer could not be given", "write [key:left]");
            devices.push_back(std::move(d));
        });
    return devices;
}

/// A group of blocks. @throws InputError there is no order of them
void read_group(gi::Yaml const& key, gi::Yaml const& y, Words const& blocks, Counterbalance& c, Mistakes& m)
{
    if (std::find(blocks.begin(), blocks.end(), c.name) != blocks.end())
        throw key.error("a group named as the block '" + c.name + "'", "it would be ambiguous", "rename one");
    std::size_t const before = m.count();
    for (gi::Yaml const& name : y.at("of").items())
        m.attempt([&] {
            int const b = name.one_of(blocks, "block");
            if (std::find(c.blocks.begin(), c.blocks.end(), b) != c.blocks.end())
                throw name.error("'" + name.text() + "' twice", "it has one place", "remove one");
            c.blocks.push_back(b);
        });
    if (c.blocks.size() < 2 && m.count() == before)
        throw y.error("fewer than two blocks", "there is no order", "name more");
    if (c.method == Balance::between)
        throw y.at("method").error("blocks between participants", "only factors can do this",
                                   "use latin or williams");
}

/// An entry with mistakes has method fixed, so that its name stays known.
Counterbalance read_counterbalance_entry(gi::Yaml const& key, gi::Yaml const& y, Script const& s, Mistakes& m)
{
    Words blocks;
    for (Block const& b : s.blocks) blocks.push_back(b.name);
    Counterbalance c;
    c.name = key.name();
    c.place = key.place();
    std::size_t const before = m.count();
    m.check_keys(y, "counterbalance");
    m.need(y, "method", "williams", [&](gi::Yaml const& v) {
        Words const methods{"fixed", "alternate", "latin", "williams", "random", "between"};
        c.method = Balance(v.one_of(methods, "way to counterbalance"));
    });
    for (std::size_t f = 0; f < s.factors.size(); ++f)
        if (s.factors[f].name == c.name) c.factor = int(f);
    m.attempt([&] {
        if ((c.factor >= 0) == y.has("of"))
            throw key.error(c.factor >= 0 ? "the factor '" + c.name + "' with a list of blocks"
                                          : "'" + c.name + "' is neither a factor nor has it 'of'",
                            "levels of a factor are counterbalanced, or a group of blocks",
                            "write NAME: {method: williams, of: [block, block]}, or name a factor");
        if (c.factor < 0) read_group(key, y, blocks, c, m);
    });
    if (m.count() > before) c.method = Balance::fixed;
    return c;
}

std::vector<Counterbalance> read_counterbalance(gi::Yaml const& y, Script const& s, Mistakes& m)
{
    std::vector<Counterbalance> all;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] { all.push_back(read_counterbalance_entry(k, v, s, m)); });
    return all;
}

/// Empty = none.
std::string read_gaze_source(gi::Yaml const& y)
{
    std::string const source = y.text();
    if (source == "none") return "";
    if (source.empty() || source == "lsl" || source == "openxr" ||
        (source.starts_with("lsl:") && source.size() > 4))
        return source;
    throw y.error("'" + source.substr(0, 64) + "' is no source of gaze", "it would not be recorded",
                  "write lsl (any stream of type Gaze), lsl:NAME, openxr (a headset's) or none");
}

Record read_record(gi::Yaml const& y, Mistakes& m)
{
    m.check_keys(y, "record");
    Record r;
    m.take(y, "dir", [&](gi::Yaml const& v) { r.dir = v.text(); });
    m.take(y, "head_pose_hz", [&](gi::Yaml const& v) {
        r.poses_by_frame = v.is_text() && v.text() == "frame";
        if (!r.poses_by_frame) r.head_pose_hz = v.number(0, 1000);
    });
    m.take(y, "markers", [&](gi::Yaml const& v) {
        for (gi::Yaml const& marker : v.one_or_more())
            m.attempt([&] {
                marker.one_of({"lsl", "udp"}, "kind of marker");
                r.markers.push_back(marker.text());
            });
    });
    m.take(y, "compress_frames", [&](gi::Yaml const& v) { r.compress_frames = v.boolean(); });
    m.take(y, "gaze", [&](gi::Yaml const& v) { r.gaze = read_gaze_source(v); });
    return r;
}

Resume read_resume(gi::Yaml const& y, Mistakes& m)
{
    m.check_keys(y, "resume");
    Resume r;
    m.take(y, "max_gap_min", [&](gi::Yaml const& v) { r.max_gap_min = v.number(0, 1e6); });
    if (!y.has("repeat")) return r;
    r.instructions = r.practice = false;
    for (gi::Yaml const& what : y.at("repeat").one_or_more())
        m.attempt([&] {
            bool const is_first = what.one_of({"instructions", "practice"}, "thing to repeat") == 0;
            (is_first ? r.instructions : r.practice) = true;
        });
    return r;
}

void read_design(gi::Yaml const& y, Script& s, Mistakes& m)
{
    m.take(y, "factors", [&](gi::Yaml const& v) { s.factors = read_factors(v, m); });
    m.take(y, "reference", [&](gi::Yaml const& v) { s.reference = read_choice(v, s, m); });
    m.take(y, "sounds", [&](gi::Yaml const& v) { s.sounds = read_sounds(v, m); });
    m.take(y, "defaults", [&](gi::Yaml const& v) { s.defaults = read_defaults(v, s, m); });
    m.take(y, "devices", [&](gi::Yaml const& v) { s.devices = read_devices(v, m); });
    auto const known = known_questionnaires();
    s.questionnaires.assign(known.begin(), known.end());
    m.take(y, "questionnaires", [&](gi::Yaml const& v) {
        for (Questionnaire& q : read_questionnaires(v, m)) s.questionnaires.push_back(std::move(q));
    });
    if (y.has("blocks"))
        for (auto const& [key, value] : m.entries(y.at("blocks")))
            m.attempt([&, k = key, v = value] { s.blocks.push_back(read_block(k, v, s, m)); });
    m.take(y, "counterbalance", [&](gi::Yaml const& v) { s.counterbalances = read_counterbalance(v, s, m); });
    m.need(y, "sequence", "[{instructions: intro.md}, BLOCK]",
           [&](gi::Yaml const& v) { s.sequence = read_sequence(v, s, m); });
}

Script read_whole(gi::Yaml const& y, std::string const& file, Mistakes& m)
{
    Script s;
    s.file = file;
    m.check_keys(y, "study");
    if (!y.is_map()) return s;
    m.need(y, "schema", "study/2", [&](gi::Yaml const& v) {
        if (v.text() != "study/1" && v.text() != "study/2") throw v.unknown("known schema", {"study/2", "study/1"});
        s.schema = v.text() == "study/1" ? 1 : 2;
    });
    m.need(y, "id", "visibility2026", [&](gi::Yaml const& v) { s.id = v.name(); });
    m.take(y, "title", [&](gi::Yaml const& v) {
        s.title = v.text();
        if (s.title.find('\n') != std::string::npos)
            throw v.error("a title of several lines", "it stands in one line of tables and pages", "shorten it");
    });
    m.need(y, "seed", "20261", [&](gi::Yaml const& v) { s.seed = v.seed(); });
    m.need(y, "participants", "{count: 24}", [&](gi::Yaml const& v) { s.participants = read_participants(v, m); });
    m.take(y, "timing", [&](gi::Yaml const& v) { s.timing = read_timing(v, m); });
    read_design(y, s, m);
    m.take(y, "record", [&](gi::Yaml const& v) { s.record = read_record(v, m); });
    m.take(y, "resume", [&](gi::Yaml const& v) { s.resume = read_resume(v, m); });
    return s;
}

/// Reports a quoted text that continues in lines which are not indented further than its own:
/// its closing quote is missing, and the following lines became part of it.
void check_quote(gi::Yaml const& y, std::vector<std::string> const& lines, Mistakes& m)
{
    std::size_t line = std::size_t(y.place().line) - 1, at = std::size_t(y.place().column) - 1;
    if (line >= lines.size() || at >= lines[line].size()) return;
    char const quote = lines[line][at];
    if (quote != '"' && quote != '\'') return;
    auto const indent_of = [](std::string const& s) { return s.find_first_not_of(" \t\r"); };
    std::size_t const indent = indent_of(lines[line]);
    for (++at;; at = 0) {
        for (; at < lines[line].size(); ++at) {
            bool const is_pair = quote == '"' ? lines[line][at] == '\\' : lines[line].substr(at, 2) == "''";
            if (is_pair)
                ++at;
            else if (lines[line][at] == quote)
                return;
        }
        if (++line == lines.size()) return;
        std::size_t const next = indent_of(lines[line]);
        if (next != std::string::npos && next <= indent)
            return m.add(y.error(
                "a quote that its line does not close",
                fmt::format("line {}, which is not indented further, belongs to the text", line + 1), "close it"));
    }
}

void check_quotes(gi::Yaml const& y, std::vector<std::string> const& lines, Mistakes& m)
{
    if (y.is_quoted()) check_quote(y, lines, m);
    if (y.is_list())
        for (gi::Yaml const& item : y.items()) check_quotes(item, lines, m);
    std::vector<gi::InputError> told;
    if (y.is_map())
        for (auto const& [key, value] : y.entries(told)) {
            check_quotes(key, lines, m);
            check_quotes(value, lines, m);
        }
}

std::vector<std::string> lines_of(std::string const& text)
{
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// How often a word is a key or a value, alone or before a colon.
int count_mentions(gi::Yaml const& y, std::string const& word)
{
    if (y.is_text()) return y.text() == word;
    int count = 0;
    if (y.is_list())
        for (gi::Yaml const& item : y.items()) count += count_mentions(item, word);
    std::vector<gi::InputError> told;
    if (y.is_map())
        for (auto const& [key, value] : y.entries(told))
            count += (key.text() == word) + count_mentions(value, word);
    return count;
}

} // namespace

ReadScript read_script(std::string const& text, std::string const& name)
{
    ReadScript read;
    read.script.file = name;
    try {
        read.mistakes.attempt([&] {
            gi::Yaml const y = gi::Yaml::parse(text, name, "script");
            check_quotes(y, lines_of(text), read.mistakes);
            read.script = read_whole(y, name, read.mistakes);
            read.is_whole = y.is_map();
            check_design(read.script, read.mistakes,
                         [&](std::string const& word) { return count_mentions(y, word) > 1; });
        });
    } catch (YAML::Exception const& e) {
        read.mistakes.add(ScriptError(name, {e.mark.line + 1, e.mark.column + 1}, "this YAML cannot be read",
                                      e.msg, "simplify it"));
    }
    return read;
}

Script parse_script(std::string const& text, std::string const& name)
{
    ReadScript read = read_script(text, name);
    if (!read.mistakes.empty()) throw read.mistakes.in_order().front();
    return std::move(read.script);
}

} // namespace study
