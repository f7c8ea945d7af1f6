#pragma once
// Text files that are compiled into the program.

namespace viewer::batch {

extern char const* const kHyperQueueScript; ///< hyperqueue.py
extern char const* const kExampleManifest;  ///< data/batch/example.yaml

} // namespace viewer::batch
