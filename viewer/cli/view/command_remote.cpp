#include "gi/core/error.h"
#include "viewer/base/arguments.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/protocol/json_text.h"
#include "viewer/protocol/remote/remote_client.h"
#include "viewer/protocol/remote/request.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>

namespace viewer {
namespace {

struct RemoteCommand {
    std::string where, timeout = "5s", token;
    std::vector<std::string> requests;
};

int run(RemoteCommand const& o)
{
    auto const timeout = std::chrono::milliseconds(std::llround(1000 * parse_duration("--timeout", o.timeout)));
    std::vector<nlohmann::json> requests;
    for (std::string const& text : o.requests) {
        requests.push_back(parse_request(text));
        check_request(requests.back()); // check all before the first is sent
    }
    RemoteClient client(o.where, o.token);
    for (nlohmann::json const& request : requests) {
        nlohmann::json const answer = client.ask(request, timeout);
        if (!answer.contains("result"))
            throw gi::InputError("the viewer refused " + json_line(request),
                                 answer.contains("error") ? json_line(answer["error"]) : "it gave no reason",
                                 "see docs/remote.md");
        std::fputs((json_line(answer["result"]) + "\n").c_str(), stdout);
        std::fflush(stdout);
    }
    return 0;
}

} // namespace

void add_remote(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RemoteCommand>();
    CLI::App* const c = app.add_subcommand("remote", about("remote"));
    c->add_option("WHERE", o->where, "the viewer's --remote (path of the socket) or --remote-port")->required();
    c->add_option("REQUESTS", o->requests, "JSON objects such as '{\"do\": \"stats\"}', sent in order")
        ->required();
    c->add_option("--token", o->token, "file of the port's token, if --remote-token put it elsewhere than usual");
    c->add_option("--timeout", o->timeout, "longest wait for each answer")->capture_default_str();
    c->footer("Requests:\n" + requests_as_text());
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
