#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/experiment/control_window.h"

#include <CLI/CLI.hpp>
#include <memory>

namespace viewer {

void add_study_control(CLI::App& study, int& exit_code)
{
    auto const where = std::make_shared<std::string>(), token = std::make_shared<std::string>();
    CLI::App* const c = study.add_subcommand("control", about("study control"));
    c->add_option("SOCKET", *where, "the session's --remote (a path) or --remote-port (a number)")->required();
    c->add_option("--token", *token, "file of the port's token, if --remote-token put it elsewhere than usual");
    c->callback([where, token, &exit_code] {
        gi::Report report;
        gi::StopRequest stop;
        InterruptGuard const guard(stop);
        run_control_window(*where, *token, stop, report);
        print_losses(report);
        exit_code = 0;
    });
    c->footer(R"(Example (while a session runs):
  lightwell study control /tmp/session.sock

The window closes when the session ends.)");
}

} // namespace viewer
