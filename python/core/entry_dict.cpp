#include "python/core/entry_dict.h"

#include "gi/core/error.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <set>

namespace bindings {
namespace {

using study::EntryPart;
using Pairs = std::vector<std::pair<std::string, std::string>>;

template <class Entry>
py::dict fields_of(Entry const& entry);

template <class T>
py::object to_python(T const& value)
{
    return py::cast(value);
}
py::object to_python(Pairs const& pairs)
{
    py::dict d;
    for (auto const& [key, value] : pairs) d[py::str(key)] = value;
    return d;
}
template <EntryPart T>
py::object to_python(std::vector<T> const& parts)
{
    py::list all;
    for (T const& s : parts) all.append(fields_of(s));
    return all;
}

template <class Entry>
py::dict fields_of(Entry const& entry)
{
    py::dict d;
    study::Fields<Entry>::visit(entry, [&](char const* name, auto const& field) { d[name] = to_python(field); });
    return d;
}

template <class T>
void from_python(py::handle value, T& field)
{
    field = py::cast<T>(value);
}
template <EntryPart T>
void from_python(py::handle value, std::vector<T>& parts)
{
    parts.clear();
    for (py::handle const s : value) parts.push_back(from_dict<T>(s));
}

} // namespace

py::dict to_dict(study::JournalEntry const& entry)
{
    return std::visit(
        [](auto const& e) {
            py::dict d;
            d["kind"] = study::Fields<std::decay_t<decltype(e)>>::kKind;
            for (auto const& [name, value] : fields_of(e)) d[name] = value;
            return d;
        },
        entry);
}

template <class Entry>
Entry from_dict(py::handle given)
{
    if (!py::isinstance<py::dict>(given))
        throw gi::InputError(fmt::format("a presenter returned {}", std::string(py::repr(given))),
                             "it must be a dict or a dataclass of lightwell.study",
                             "see the documentation of Presenter");
    auto const dict = py::reinterpret_borrow<py::dict>(given);
    Entry entry;
    std::set<std::string> known;
    study::Fields<Entry>::visit(entry, [&](char const* name, auto& field) {
        known.insert(name);
        if (!dict.contains(name)) return;
        try {
            from_python(dict[name], field);
        } catch (py::cast_error const&) {
            throw gi::InputError(
                fmt::format("a presenter returned {} = {}", name, std::string(py::repr(dict[name]))),
                "the field has another type", "see the documentation of Presenter");
        }
    });
    for (auto const& [key, value] : dict)
        if (auto const name = std::string(py::str(key)); !known.contains(name))
            throw gi::InputError(fmt::format("a presenter returned the field '{}'", name),
                                 "the result has no such field", "leave it out");
    return entry;
}

template study::CalibrationDone from_dict(py::handle);
template study::StimulusShown from_dict(py::handle);
template study::SoundPlayed from_dict(py::handle);
template study::TrialDone from_dict(py::handle);
template study::StepDone from_dict(py::handle);
template study::QuestionnaireDone from_dict(py::handle);
template study::NoteTaken from_dict(py::handle);

} // namespace bindings
