#pragma once
// Copies the outputs of a batch from the store to FOLDER/GROUP/NAME, and joins tables.

#include "viewer/batch/store.h"

namespace viewer::batch {

enum class Placing { copy, link };
enum class Existing { refuse, replace };

struct Gathered {
    std::size_t files = 0;            ///< placed, or there already with the same content
    std::size_t tasks = 0;            ///< whose outputs are there
    std::size_t missing = 0;          ///< tasks without a result
    std::vector<std::string> merged;  ///< files
    std::vector<std::string> damaged; ///< outputs whose content in the store has changed
};

/// Each output is checked against its hash while it is copied. A damaged one is removed from the store,
/// so that resuming makes it again.
/// @throws InputError a file of another content is there, two tasks made different files of one name, or the
/// tables of a group have different columns
Gathered gather(Store const& store, Batch const& batch, std::filesystem::path const& folder, Placing placing,
                Existing existing);

} // namespace viewer::batch
