#pragma once
// Journal entries as Python dicts, with the field names of the journal.

#include "study/journal/entry_fields.h"

#include <pybind11/pybind11.h>

namespace bindings {

namespace py = pybind11;

/// Returns "kind" and the fields of this kind of entry; times as in the journal.
py::dict to_dict(study::JournalEntry const& entry);

/// Converts a dict returned by a presenter. Missing fields keep their defaults. Throws InputError if it is not a
/// dict, has unknown fields, or a field has the wrong type.
template <class Entry>
Entry from_dict(py::handle given);

extern template study::CalibrationDone from_dict(py::handle);
extern template study::StimulusShown from_dict(py::handle);
extern template study::TrialDone from_dict(py::handle);
extern template study::StepDone from_dict(py::handle);
extern template study::SoundPlayed from_dict(py::handle);
extern template study::QuestionnaireDone from_dict(py::handle);
extern template study::NoteTaken from_dict(py::handle);

} // namespace bindings
