#pragma once
// A real runtime for tests: scripts/monado, or a visible skip where its packages cannot be had.

#include "tests/viewer_xr/child.h"

#include <map>
#include <nlohmann/json.hpp>

namespace viewer::test {

inline constexpr char const* kScript = LIGHTWELL_SOURCE_DIR "/scripts/monado";

class Monado : public ::testing::Test {
protected:
    void SetUp() override
    {
        Child fetch({kScript, "fetch"}, folder.path(), "fetch");
        if (fetch.wait(Seconds(500)) != 0) GTEST_SKIP() << "SKIPPED: no Monado: " << fetch.err();
    }
    void TearDown() override
    {
        if (HasFailure() && service) std::fputs((service->out() + service->err()).c_str(), stderr);
    }

    std::filesystem::path runtime_folder() const { return folder / "runtime"; }

    void start_service(std::vector<std::string> const& options = {},
                       std::vector<std::string> const& environment = {})
    {
        std::vector<std::string> arguments{kScript, "service", "--dir", runtime_folder()};
        arguments.insert(arguments.end(), options.begin(), options.end());
        std::filesystem::remove(runtime_folder() / "monado_comp_ipc");
        service.emplace(arguments, folder.path(), "service", environment);
        ASSERT_TRUE(
            wait_for([&] { return std::filesystem::exists(runtime_folder() / "monado_comp_ipc"); }, Seconds(60)))
            << service->out() << service->err();
    }

    std::vector<std::string> client_call(std::string const& arguments) const
    {
        std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", HMD_CLIENT};
        for (std::string const& a : words(arguments)) call.push_back(a);
        return call;
    }

    static std::string control_program()
    {
        char const* const elsewhere = std::getenv("LIGHTWELL_MONADO");
        return (elsewhere ? std::string(elsewhere) : LIGHTWELL_SOURCE_DIR "/build/monado") + "/usr/bin/monado-ctl";
    }

    /// What the client prints last.
    static nlohmann::json result(std::string const& out)
    {
        std::size_t const at = out.rfind("\n{");
        return at == std::string::npos ? nlohmann::json() : nlohmann::json::parse(out.substr(at + 1));
    }

    /// Runs the client to its end, which is expected to be a good one.
    nlohmann::json run_client(std::string const& arguments, std::vector<std::string> const& environment = {})
    {
        Child client(client_call(arguments), folder.path(), "client", environment);
        EXPECT_EQ(client.wait(Seconds(90)), 0) << client.out() << client.err();
        return result(client.out());
    }

    TemporaryFolder folder;
    std::optional<Child> service;
};

/// Rows of a log of the client, by the names of their columns.
inline std::vector<std::map<std::string, std::string>> read_log(std::filesystem::path const& file)
{
    auto const split = [](std::string const& line) {
        std::vector<std::string> parts(1);
        for (char const c : line) c == ',' ? parts.emplace_back() : parts.back() += c;
        return parts;
    };
    std::istringstream in(file_text(file));
    std::string line;
    std::getline(in, line);
    std::vector<std::string> const columns = split(line);
    std::vector<std::map<std::string, std::string>> rows;
    while (std::getline(in, line)) {
        std::vector<std::string> const values = split(line);
        EXPECT_EQ(values.size(), columns.size()) << line;
        auto& row = rows.emplace_back();
        for (std::size_t i = 0; i < std::min(columns.size(), values.size()); ++i) row[columns[i]] = values[i];
    }
    return rows;
}

} // namespace viewer::test
