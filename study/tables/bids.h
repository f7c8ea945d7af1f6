#pragma once
// Records in the layout of BIDS 1.11 (Gorgolewski et al. 2016, Sci. Data 3:160044;
// https://bids-specification.readthedocs.io), modality `beh`. All files are derived from script, plan and journal
// and can be rewritten at any time.

#include "study/tables/recorded_session.h"
#include "study/tables/table.h"

namespace study {

/// "sub-P001/ses-01/beh"
std::string session_folder(SessionStarted const& start);

/// Tables with their sidecars and session.json, relative to the folder of the data set:
///   <folder>/sub-P001_ses-01_task-NAME_events.tsv             a row per trial, NAME of each block
///   <folder>/sub-P001_ses-01_task-NAME_acq-stimuli_events.tsv a row per stimulus
///   <folder>/sub-P001_ses-01_task-NAME_acq-sounds_events.tsv  a row per sound, of blocks with cues
///   <folder>/sub-P001_ses-01_task-questionnaires_beh.tsv
///   <folder>/sub-P001_ses-01_task-session_events.tsv          session events
///   <folder>/session.json                                     provenance
/// Blocks without trials have no file.
std::vector<TextFile> session_files(Script const& script, RecordedSession const& session);

/// "sub-P001/ses-01/beh/sub-P001_ses-01_task-session_recording-eye1_physio":
/// of its samples of gaze (.tsv.gz, .json).
std::string gaze_stem(Script const& script, RecordedSession const& session);
/// Its sidecar (BIDS eye tracking). @param start_s  of the first sample, since the beginning of the session
TextFile gaze_sidecar(Script const& script, RecordedSession const& session, double rate_hz, double start_s);

/// dataset_description.json, participants.tsv and .json, README, .bidsignore of all sessions together.
std::vector<TextFile> dataset_files(Script const& script, std::vector<RecordedSession> const& sessions,
                                    std::string const& program_version);

/// participant_id, number, sessions, complete, simulated, and the answers to the script's questions.
Table participants_table(Script const& script, std::vector<RecordedSession> const& sessions);

} // namespace study
