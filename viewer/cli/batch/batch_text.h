#pragma once
// Texts that `lightwell batch` prints, and its hidden command.

#include "viewer/batch/gather.h"
#include "viewer/batch/local_runner.h"
#include "viewer/batch/state.h"

namespace CLI {
class App;
}

namespace viewer {

void add_batch_work(CLI::App& batch_command, int& exit_code);

void print_plan(batch::Batch const& b, batch::BatchState const& state, int cores, bool as_json);
void print_run(batch::Store const& store, std::string const& id, batch::Batch const& b,
               batch::RunOutcome const& outcome, bool as_json);
void print_states(batch::Store const& store, std::vector<std::string> const& ids, bool with_messages,
                  bool as_json);
void print_gathered(batch::Gathered const& gathered, batch::Batch const& b, std::string const& folder,
                    bool as_json);

} // namespace viewer
