#include "study/tables/bids.h"

#include "gi/core/text.h"
#include "study/journal/session_summary.h"
#include "study/tables/events.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace study {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(Json const& json) { return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

void add_table(std::vector<TextFile>& files, std::string const& stem, Table const& table,
               std::vector<SidecarFact> const& facts)
{
    if (table.rows.empty()) return;
    files.push_back({stem + ".tsv", tsv_text(table)});
    files.push_back({stem + ".json", sidecar_json(table, facts)});
}

std::vector<SidecarFact> about_task(std::string const& name, SessionStarted const& start)
{
    std::vector<SidecarFact> facts{{"TaskName", name},
                                   {"StimulusPresentation.SoftwareName", "Lightwell"},
                                   {"StimulusPresentation.SoftwareVersion", start.version}};
    if (std::string const os = recorded_fact(start, "os"); !os.empty())
        facts.push_back({"StimulusPresentation.OperatingSystem", os});
    auto const distance_cm = gi::parse_finite(recorded_fact(start, "viewing_distance_cm"));
    auto const px = recorded_pair(start, "screen_px"), size_cm = recorded_pair(start, "screen_cm");
    if (!distance_cm || !px || !size_cm) return facts;
    auto const hz = gi::parse_finite(recorded_fact(start, "refresh_hz"));
    facts.push_back({"StimulusPresentation.ScreenDistance", Json(*distance_cm * 0.01).dump(), true});
    facts.push_back({"StimulusPresentation.ScreenOrigin", R"(["top", "left"])", true});
    facts.push_back({"StimulusPresentation.ScreenResolution", Json{int(px->first), int(px->second)}.dump(), true});
    facts.push_back(
        {"StimulusPresentation.ScreenSize", Json{size_cm->first * 0.01, size_cm->second * 0.01}.dump(), true});
    if (hz) facts.push_back({"StimulusPresentation.ScreenRefreshRate", Json(*hz).dump(), true});
    for (auto const& [key, field] : {std::pair{"DisplayModel", "display_model"},
                                     {"DisplayModelSha256", "display_model_sha256"},
                                     {"PixelsPerDegree", "pixels_per_degree"},
                                     {"ScreenWhiteLuminance", "white_cd_m2"},
                                     {"ScreenBlackLuminance", "black_cd_m2"}})
        if (std::string const value = recorded_fact(start, field); !value.empty()) facts.push_back({key, value});
    return facts;
}

/// Column names of participants.tsv to which BIDS gives a meaning.
std::string asked_column(std::string const& question)
{
    static std::set<std::string> const taken{
        "participant_id", "species", "strain",   "strain_rrid", "sex",       "age",
        "handedness",     "number",  "sessions", "complete",    "simulated", "HED"};
    std::string name;
    for (char const c : question)
        name += static_cast<unsigned char>(c) < 0x80 && !std::isalnum(static_cast<unsigned char>(c)) ? '_' : c;
    return taken.count(name) ? "asked_" + name : name;
}

std::string description_json(Script const& script, std::string const& program_version)
{
    return text_of({{"Name", script.title.empty() ? script.id : script.title},
                    {"BIDSVersion", "1.11.1"},
                    {"HEDVersion", "8.3.0"},
                    {"DatasetType", "raw"},
                    {"GeneratedBy", {{{"Name", "Lightwell"}, {"Version", program_version}}}}});
}

std::string readme(Script const& script, std::size_t sessions)
{
    return fmt::format(
        "# {}\n\n"
        "Records of the experiment '{}', {} session{}, written by Lightwell from the journals of the sessions\n"
        "(`journal.jsonl`, one entry per line), the primary records. Every table can be rewritten from them with\n"
        "`lightwell study rebuild`.\n\n"
        "* `sub-*/ses-*/beh/*_task-BLOCK_events.tsv`: a row per trial; the .json file of the same name "
        "describes\n"
        "  its columns.\n"
        "* `*_task-BLOCK_acq-stimuli_events.tsv`: a row per shown stimulus.\n"
        "* `*_acq-sounds_events.tsv`: sounds of cues.\n"
        "* `*_task-questionnaires_beh.tsv`: answers and scores.\n"
        "* `*_recording-eye1_physio.tsv.gz`: samples of gaze, if it was recorded.\n"
        "* `*_task-session_events.tsv`: session events: instructions, rests, notes.\n"
        "* `session.json`: provenance. `plan.tsv`: the order of the session, written before its first trial.\n\n"
        "Participants are numbers; the only personal data are the answers to the script's questions.\n",
        script.title.empty() ? script.id : script.title, script.id, sessions, sessions == 1 ? "" : "s");
}

} // namespace

std::string session_folder(SessionStarted const& start)
{
    return fmt::format("sub-{}/ses-{:02}/beh", start.participant_id, start.session);
}

TextFile gaze_sidecar(Script const& script, RecordedSession const& session, double rate_hz, double start_s)
{
    SessionStarted const& start = start_of(script, session);
    bool const on_screen = !recorded_fact(start, "viewing_distance_cm").empty();
    Json j{
        {"TaskName", "session"},
        {"SamplingFrequency", rate_hz},
        {"StartTime", start_s},
        {"Columns", {"timestamp", "x_coordinate", "y_coordinate", "pupil_size", "step"}},
        {"PhysioType", "eyetrack"},
        {"RecordedEye", "cyclopean"},
        {"SampleCoordinateSystem", on_screen ? "gaze-on-screen" : "custom"},
        {"timestamp", {{"Description", "Since the beginning of the session"}, {"Units", "s"}}},
        {"x_coordinate", {{"Description", "From the left edge of the window, to the right"}, {"Units", "pixel"}}},
        {"y_coordinate", {{"Description", "From the upper edge of the window, down"}, {"Units", "pixel"}}},
        {"pupil_size", {{"Description", "diameter of the pupil, as the eye tracker reports it"}, {"Units", "mm"}}},
        {"step", {{"Description", "Step of the plan, from 1; n/a between them"}}}};
    if (std::string const source = recorded_fact(start, "gaze_source"); !source.empty())
        j["RawDataFilters"] = source;
    return {gaze_stem(script, session) + ".json", text_of(j)};
}

std::string gaze_stem(Script const& script, RecordedSession const& session)
{
    SessionStarted const& start = start_of(script, session);
    return fmt::format("{}/sub-{}_ses-{:02}_task-session_recording-eye1_physio", session_folder(start),
                       start.participant_id, start.session);
}

std::vector<TextFile> session_files(Script const& script, RecordedSession const& session)
{
    SessionStarted const& start = start_of(script, session);
    std::string const folder = session_folder(start) + "/";
    std::string const stem = fmt::format("{}sub-{}_ses-{:02}_task-", folder, start.participant_id, start.session);
    std::vector<TrialRow> const rows = trial_rows(script, session);
    std::vector<std::string> labels{"questionnaires", "session"};
    std::vector<TextFile> files;
    for (std::size_t b = 0; b < script.blocks.size(); ++b) {
        Block const& block = script.blocks[b];
        labels.push_back(label_of(block.name, labels));
        auto facts = about_task(block.name, start);
        facts.insert(facts.begin() + 1,
                     SidecarFact{"TaskDescription", std::string(study::facts(block.task).name)});
        if (!block.prompt.empty()) facts.push_back({"Instructions", block.prompt});
        add_table(files, stem + labels.back() + "_events", events_table(script, rows, int(b)), facts);
        add_table(files, stem + labels.back() + "_acq-stimuli_events", stimuli_table(script, rows, int(b)), facts);
        add_table(files, stem + labels.back() + "_acq-sounds_events", sounds_table(script, rows, int(b)), facts);
    }
    add_table(files, stem + "questionnaires_beh", questionnaires_table(script, session),
              about_task("questionnaires", start));
    add_table(files, stem + "session_events", session_events_table(session), about_task("session", start));
    files.push_back({folder + "session.json", session_summary(session.record)});
    return files;
}

Table participants_table(Script const& script, std::vector<RecordedSession> const& sessions)
{
    Table table{{{"participant_id", "Participant"},
                 {"number", "Number of the participant, which determines every order"},
                 {"sessions", "Number of sessions started"},
                 {"complete", "Whether all of them were finished"},
                 {"simulated", "Whether the participant is a model observer"}}};
    for (AskedQuestion const& q : script.participants.ask) {
        Column column{asked_column(q.id), "Answer to the question: " + q.text};
        for (std::string const& choice : q.choices) column.meanings.emplace_back(choice, choice);
        table.columns.push_back(std::move(column));
    }
    std::map<std::string, std::vector<RecordedSession const*>> people;
    for (RecordedSession const& s : sessions) people[s.plan.participant_id].push_back(&s);
    for (auto const& [id, theirs] : people) {
        bool complete = true, simulated = false;
        std::map<std::string, std::string> answers;
        for (RecordedSession const* s : theirs) {
            complete = complete && is_complete(*s);
            simulated = simulated || start_of(script, *s).is_simulated;
            for (JournalEntry const& entry : s->record.entries)
                if (auto const* asked = std::get_if<ParticipantAsked>(&entry))
                    for (auto const& [question, answer] : asked->answers) answers[question] = answer;
        }
        std::vector<std::string> row{"sub-" + id, cell(theirs.front()->plan.participant), cell(int(theirs.size())),
                                     cell(complete), cell(simulated)};
        for (AskedQuestion const& q : script.participants.ask) row.push_back(cell(answers[q.id]));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::vector<TextFile> dataset_files(Script const& script, std::vector<RecordedSession> const& sessions,
                                    std::string const& program_version)
{
    Table const participants = participants_table(script, sessions);
    return {{"dataset_description.json", description_json(script, program_version)},
            {"participants.tsv", tsv_text(participants)},
            {"participants.json", sidecar_json(participants)},
            {"README.md", readme(script, sessions.size())},
            {".bidsignore", "*.yaml\n*.md.txt\ntruth.json\n**/journal*\n**/plan.tsv\n**/session.json\n**/*.csv\n"
                            "**/*.csv.gz\n**/*.yaml\n**/*.lock\n"}};
}

} // namespace study
