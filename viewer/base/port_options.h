#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace viewer {

/// Options of programs with --remote-port, which must be declared already: who may use the port (docs/remote.md).
inline void declare_port_options(CLI::App& command, std::string& token_file, bool& open)
{
    CLI::Option* const port = command.get_option("--remote-port");
    CLI::Option* const token =
        command
            .add_option(
                "--remote-token", token_file,
                "file to write the port's token to, which clients must send; default: in the user's runtime "
                "folder")
            ->needs(port);
    command.add_flag("--remote-open", open, "no token: every account of this machine may use the port")
        ->needs(port)
        ->excludes(token);
}

} // namespace viewer
