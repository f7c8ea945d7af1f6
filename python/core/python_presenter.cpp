#include "python/core/python_presenter.h"

#include "gi/core/error.h"
#include "python/core/entry_dict.h"

#include <pybind11/stl.h>

namespace bindings {

/// Calls with the GIL held. An exception is kept for run() and ends the session like a lost display.
template <class Result>
Result PythonPresenter::call(std::function<Result()> const& ask) const
{
    py::gil_scoped_acquire const locked;
    try {
        return ask();
    } catch (py::error_already_set const& e) {
        raised_ = std::current_exception();
        throw std::runtime_error(e.what());
    } catch (...) {
        raised_ = std::current_exception();
        throw;
    }
}

double PythonPresenter::now() const
{
    return call<double>([&] { return py::cast<double>(steps_.attr("now")()); });
}

std::vector<std::pair<std::string, std::string>> PythonPresenter::about() const
{
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    return call<Pairs>([&] { return py::cast<Pairs>(steps_.attr("about")()); });
}

study::CalibrationDone PythonPresenter::calibrate(study::Timing const& timing)
{
    return call<study::CalibrationDone>([&] {
        py::dict d;
        d["frames"] = timing.calibrate.frames;
        d["max_sd_ms"] = timing.calibrate.max_sd_ms;
        d["max_deviation"] = timing.calibrate.max_deviation;
        d["expected_hz"] = timing.expected_hz;
        d["vsync"] = timing.vsync == study::Vsync::required ? "required" : "record";
        return from_dict<study::CalibrationDone>(steps_.attr("calibrate")(d));
    });
}

bool PythonPresenter::ask_consent(std::string const& markdown)
{
    return call<bool>([&] { return py::cast<bool>(steps_.attr("ask_consent")(markdown)); });
}

namespace {

py::dict question_dict(study::AskedQuestion const& q)
{
    constexpr char const* kTypes[] = {"text", "number", "choice"};
    py::dict d;
    d["id"] = q.id;
    d["text"] = q.text;
    d["type"] = kTypes[std::size_t(q.type)];
    if (q.type == study::AskedType::number) {
        d["min"] = q.low;
        d["max"] = q.high;
        d["whole"] = q.is_whole;
    }
    if (q.type == study::AskedType::choice) d["choices"] = q.choices;
    return d;
}

} // namespace

study::ParticipantAsked PythonPresenter::ask_participant(std::vector<study::AskedQuestion> const& questions)
{
    return call<study::ParticipantAsked>([&] {
        study::ParticipantAsked asked;
        py::list given; // a question without a type is given by its id, others by a dict
        for (study::AskedQuestion const& q : questions)
            if (q.type == study::AskedType::text && q.text == q.id)
                given.append(q.id);
            else
                given.append(question_dict(q));
        asked.answers = py::cast<decltype(asked.answers)>(steps_.attr("ask_participant")(given));
        return asked;
    });
}

study::StepDone PythonPresenter::instruct(std::string const& markdown, int step)
{
    return call<study::StepDone>(
        [&] { return from_dict<study::StepDone>(steps_.attr("instruct")(markdown, step)); });
}

study::StepDone PythonPresenter::rest(std::string const& prompt, double least_s, int step)
{
    return call<study::StepDone>(
        [&] { return from_dict<study::StepDone>(steps_.attr("rest")(prompt, least_s, step)); });
}

study::StepDone PythonPresenter::walk(study::TrialRequest const& where, std::string const& prompt, double seconds)
{
    return call<study::StepDone>(
        [&] { return from_dict<study::StepDone>(steps_.attr("walk")(to_dict(where), prompt, seconds)); });
}

study::QuestionnaireDone PythonPresenter::ask(study::QuestionnaireRequest const& request)
{
    study::Questionnaire const& questionnaire = *request.questionnaire;
    return call<study::QuestionnaireDone>([&] {
        py::list items;
        for (study::QuestionnaireItem const& i : questionnaire.items) {
            py::dict d;
            d["id"] = i.id;
            d["text"] = i.text;
            d["type"] = i.type == study::ItemType::text ? "text" : "scale";
            d["is_required"] = i.is_required;
            d["lines"] = i.lines;
            d["max_chars"] = i.max_chars;
            d["low"] = i.low;
            d["high"] = i.high;
            d["step"] = i.step;
            d["labels"] = i.labels;
            items.append(d);
        }
        py::dict d;
        d["name"] = questionnaire.name;
        d["title"] = questionnaire.title;
        d["instructions"] = questionnaire.instructions;
        d["items"] = items;
        return from_dict<study::QuestionnaireDone>(steps_.attr("ask")(d, request.step));
    });
}

study::TrialDone PythonPresenter::show(study::TrialRequest const& trial)
{
    return call<study::TrialDone>(
        [&] { return from_dict<study::TrialDone>(steps_.attr("show")(to_dict(trial))); });
}

study::ExperimenterAction PythonPresenter::action()
{
    return call<study::ExperimenterAction>([&] {
        static std::map<std::string, study::ExperimenterAction> const kWishes{
            {"go_on", study::ExperimenterAction::go_on},
            {"pause", study::ExperimenterAction::pause},
            {"skip", study::ExperimenterAction::skip},
            {"abort", study::ExperimenterAction::abort}};
        auto const word = py::cast<std::string>(steps_.attr("wish")());
        auto const found = kWishes.find(word);
        if (found == kWishes.end())
            throw gi::InputError("wish() of the presenter returned '" + word + "'", "there is no such action",
                                 "choose go_on, pause, skip or abort");
        return found->second;
    });
}

std::vector<study::NoteTaken> PythonPresenter::notes()
{
    return call<std::vector<study::NoteTaken>>([&] {
        std::vector<study::NoteTaken> notes;
        for (py::handle const note : py::object(steps_.attr("notes")()))
            notes.push_back(from_dict<study::NoteTaken>(note));
        return notes;
    });
}

} // namespace bindings
