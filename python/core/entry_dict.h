#pragma once
// Entries of journals as dicts of Python, with the names that they have in a journal.

#include "study/journal/entry_fields.h"

#include <pybind11/pybind11.h>

namespace bindings {

namespace py = pybind11;

/// "kind" and the fields of its kind; times as in the journal.
py::dict to_dict(study::JournalEntry const& entry);

/// What a presenter gave back. Fields that are not there keep their defaults. Throws InputError where it is no
/// mapping, or has other fields or other types.
template <class Entry>
Entry from_dict(py::handle given);

extern template study::CalibrationDone from_dict(py::handle);
extern template study::StimulusShown from_dict(py::handle);
extern template study::TrialDone from_dict(py::handle);
extern template study::StepDone from_dict(py::handle);
extern template study::QuestionnaireDone from_dict(py::handle);
extern template study::NoteTaken from_dict(py::handle);

} // namespace bindings
