#include "viewer/protocol/cluster/messenger.h"

#include "gi/core/error.h"
#include "gi/core/module.h"

#include <cstdlib>

namespace viewer {

bool started_with_others()
{
    char const* const size = std::getenv("OMPI_COMM_WORLD_SIZE");
    return size != nullptr && std::atoi(size) > 1;
}

std::unique_ptr<Messenger> make_messenger()
{
    auto* const make = reinterpret_cast<decltype(&lightwell_messenger)>(
        gi::module_function("liblightwell_cluster.so", "lightwell_messenger",
                            "mpirun started this program with others, but they cannot talk to each other",
                            "install the package lightwell-cluster, or build all: scripts/build release"));
    std::unique_ptr<Messenger> messenger(make());
    if (!messenger)
        throw gi::InputError("this MPI has no MPI_THREAD_SERIALIZED",
                             "ranks send signs of life from a second thread while they render",
                             "use Open MPI as packaged by Debian");
    return messenger;
}

} // namespace viewer
