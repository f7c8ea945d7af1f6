#include "python/core/bind_study.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "python/core/entry_dict.h"
#include "python/core/errors.h"
#include "python/core/python_presenter.h"
#include "study/journal/journal_file.h"
#include "study/observers/simulate.h"
#include "study/plan/doubts.h"
#include "study/plan/plan_text.h"
#include "study/script/examples.h"
#include "study/tables/export.h"
#include "viewer/base/version.h"
#include "viewer/study/study_records.h"
#include "viewer/study/study_script.h"

#include <pybind11/stl.h>

namespace bindings {
namespace {

using viewer::LoadedScript;

study::Plan plan_of(LoadedScript const& loaded, int participant)
{
    check_range("participant", participant, 1, loaded.script.participants.count);
    return study::make_plan(loaded.script, participant);
}

study::SessionSettings settings_of(LoadedScript const& loaded, std::string const& dir, int session, bool resume)
{
    check_range("session", session, 1, 99);
    study::SessionSettings s;
    s.dir = dir;
    s.script_folder = loaded.folder;
    s.script_text = loaded.text;
    s.session = session;
    s.start = resume ? study::SessionStart::go_on : study::SessionStart::begin;
    s.version = viewer::version_number();
    s.git_hash = viewer::git_hash();
    return s;
}

py::dict outcome_dict(std::string const& id, study::SessionOutcome const& o)
{
    py::dict d;
    d["participant_id"] = id;
    d["folder"] = o.folder.string();
    d["is_complete"] = o.is_complete;
    d["reason"] = o.reason;
    d["trials"] = o.trials;
    d["bad_trials"] = o.bad_trials;
    d["steps"] = o.steps;
    d["plan_remark"] = o.plan_remark;
    return d;
}

py::dict run(LoadedScript const& loaded, int participant, py::object const& steps, std::string const& dir,
             int session, bool resume, std::vector<std::pair<std::string, std::string>> const& about)
{
    check_range("participant", participant, 1, loaded.script.participants.count);
    std::string const id = participant_id(loaded.script, participant);
    study::SessionSettings settings = settings_of(loaded, dir, session, resume);
    settings.about = about;
    settings.about.emplace_back("program", viewer::version_text());
    PythonPresenter presenter(steps);
    study::SessionOutcome outcome;
    try {
        py::gil_scoped_release const unlocked;
        outcome = study::run_session(loaded.script, participant, presenter, settings);
    } catch (...) {
        if (presenter.raised()) std::rethrow_exception(presenter.raised());
        throw;
    }
    // The session has ended properly and its journal records why; the caller gets the presenter's exception.
    if (presenter.raised()) std::rethrow_exception(presenter.raised());
    return outcome_dict(id, outcome);
}

py::dict simulate(LoadedScript const& loaded, int participant, std::string const& dir, std::string const& observer,
                  std::optional<std::uint64_t> const& given_seed, int session, bool resume, double gap_s)
{
    study::Script const& s = loaded.script;
    check_range("participant", participant, 1, s.participants.count);
    std::string const id = participant_id(s, participant);
    study::SessionSettings const settings = settings_of(loaded, dir, session, resume);
    std::uint64_t const seed = given_seed.value_or(s.seed);
    study::SessionOutcome outcome;
    {
        py::gil_scoped_release const unlocked;
        study::ObserverModel model = study::usual_observers(s);
        if (!observer.empty()) {
            auto const bytes = gi::read_bytes(observer, std::size_t(1) << 20);
            model = study::read_observers({bytes.begin(), bytes.end()}, observer, s);
        }
        if (!resume) check_is_new(id, settings);
        study::keep_truth(settings.dir, study::truth_text(s, model, seed));
        outcome = study::simulate_session(s, participant, study::draw_observer(model, seed, participant), settings,
                                          gap_s);
    }
    return outcome_dict(id, outcome);
}

py::tuple read_journal(std::string const& file)
{
    study::JournalText journal;
    {
        py::gil_scoped_release const unlocked;
        journal = study::read_journal(file);
    }
    py::list entries;
    for (study::JournalEntry const& e : journal.record.entries) entries.append(to_dict(e));
    return py::make_tuple(entries, journal.torn_bytes);
}

/// Table name -> (tab-separated text, column -> description).
py::dict export_tables(std::string const& dir, std::string const& script)
{
    std::vector<study::NamedTable> tables;
    {
        py::gil_scoped_release const unlocked;
        study::Dataset const records = viewer::load_records(dir, script);
        tables = study::export_tables(records.script, records.sessions);
    }
    py::dict all;
    for (study::NamedTable const& t : tables) {
        py::dict columns;
        for (study::Column const& c : t.table.columns)
            columns[py::str(c.name)] = c.description + (c.units.empty() ? "" : " [" + c.units + "]");
        all[py::str(t.name)] = py::make_tuple(study::tsv_text(t.table), columns);
    }
    return all;
}

int rebuild_tables(std::string const& dir, std::string const& script)
{
    return viewer::rebuild_tables(dir, viewer::load_records(dir, script));
}

std::string example(std::string const& name)
{
    std::string known;
    for (study::StudyExample const& e : study::study_examples()) {
        if (e.name == name) return std::string(e.text);
        known += (known.empty() ? "" : ", ") + std::string(e.name);
    }
    throw gi::InputError("there is no example '" + name + "'", "the program does not have it",
                         "choose one of: " + known);
}

std::vector<std::pair<std::string, std::vector<std::string>>> factors_of(LoadedScript const& loaded)
{
    std::vector<std::pair<std::string, std::vector<std::string>>> factors;
    for (study::Factor const& f : loaded.script.factors) {
        auto& levels = factors.emplace_back(f.name, std::vector<std::string>()).second;
        for (study::FactorLevel const& level : f.levels) levels.push_back(level.name);
    }
    return factors;
}

} // namespace

void bind_study(py::module_& m)
{
    using Self = LoadedScript const&;
    py::class_<LoadedScript>(m, "Script")
        .def(py::init([](std::string const& file) { return viewer::load_script(file); }), py::arg("file"))
        .def_property_readonly("id", [](Self s) { return s.script.id; })
        .def_property_readonly("title", [](Self s) { return s.script.title; })
        .def_property_readonly("seed", [](Self s) { return s.script.seed; })
        .def_property_readonly("participants", [](Self s) { return s.script.participants.count; })
        .def_property_readonly("record_dir", [](Self s) { return s.script.record.dir; })
        .def_property_readonly("factors", &factors_of)
        .def_property_readonly("blocks",
                               [](Self s) {
                                   std::vector<std::pair<std::string, std::string>> blocks;
                                   for (study::Block const& b : s.script.blocks)
                                       blocks.emplace_back(b.name, std::string(study::facts(b.task).name));
                                   return blocks;
                               })
        .def("doubts", [](Self s) { return study::find_doubts(s.script); })
        .def("text", [](Self s) { return study::script_text(s.script, study::make_plan(s.script, 1)); })
        .def("participant_id", [](Self s, int p) { return plan_of(s, p).participant_id; })
        .def("plan_tsv", [](Self s, int p) { return study::plan_table(s.script, plan_of(s, p)); })
        .def("plan_seconds", [](Self s, int p) { return double(plan_of(s, p).duration_us) * 1e-6; })
        .def("run", &run)
        .def("simulate", &simulate);
    m.def("read_journal", &read_journal, py::arg("file"));
    m.def("export_tables", &export_tables, py::arg("dir"), py::arg("script"));
    m.def("rebuild_tables", &rebuild_tables, py::arg("dir"), py::arg("script"),
          py::call_guard<py::gil_scoped_release>());
    m.def("study_example", &example, py::arg("name"));
}

} // namespace bindings
