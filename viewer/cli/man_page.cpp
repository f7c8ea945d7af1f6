#include "viewer/cli/man_page.h"

#include "viewer/cli/command_tree.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>

namespace viewer {
namespace {

/// Text of roff: no line is a request by accident, and dashes and backslashes stay what they are.
std::string roff(std::string const& text)
{
    std::string out;
    bool begins_line = true;
    for (char const c : text) {
        if (begins_line && (c == '.' || c == '\'')) out += "\\&";
        if (c == '\\')
            out += "\\e";
        else if (c == '-')
            out += "\\-";
        else
            out += c;
        begins_line = c == '\n';
    }
    return out;
}

/// A word within quotes of a macro's argument.
std::string in_quotes(std::string const& text)
{
    std::string out = "\"";
    for (char const c : roff(text)) out += c == '"' ? "\\(dq" : std::string(1, c);
    return out + "\"";
}

/// Paragraphs; lines that the text breaks itself stay broken.
std::string paragraphs(std::string const& text)
{
    std::string out;
    std::size_t at = 0;
    while (at < text.size()) {
        std::size_t const end = std::min(text.find('\n', at), text.size());
        std::string line = text.substr(at, end - at);
        line.erase(0, line.find_first_not_of(' ') == line.npos ? line.size() : line.find_first_not_of(' '));
        out += line.empty() ? ".PP\n" : (at > 0 && !out.ends_with(".PP\n") ? ".br\n" : "") + roff(line) + "\n";
        at = end + 1;
    }
    return out;
}

/// As it stands, such as examples.
std::string verbatim(std::string const& text) { return ".nf\n" + roff(text) + "\n.fi\n"; }

std::string names_of(CLI::Option const& o)
{
    if (o.get_positional()) return "\\fI" + roff(o.get_name(true)) + "\\fR";
    std::string out;
    for (std::string const& n : o.get_snames())
        out += (out.empty() ? "" : ", ") + ("\\fB" + roff("-" + n) + "\\fR");
    for (std::string const& n : o.get_lnames())
        out += (out.empty() ? "" : ", ") + ("\\fB" + roff("--" + n) + "\\fR");
    if (o.get_items_expected_max() > 0) {
        std::string const type = o.get_type_name();
        out += " \\fI" + roff(type.empty() ? "VALUE" : type) + "\\fR";
    }
    return out;
}

std::string synopsis(CLI::App const& c, std::string const& name)
{
    std::string out = ".B " + roff(name) + "\n";
    auto const has_subcommands = !subcommands(c).empty();
    if (has_subcommands) return out + ".I COMMAND\n[\\fIOPTIONS\\fR]\n";
    out += "[\\fIOPTIONS\\fR]\n";
    for (CLI::Option const* const o : c.get_options()) {
        if (!o->get_positional()) continue;
        bool const many = o->get_items_expected_max() > 1;
        std::string const word = "\\fI" + roff(o->get_name(true)) + "\\fR" + (many ? "..." : "");
        out += (o->get_required() ? word : "[" + word + "]") + "\n";
    }
    return out;
}

std::string options(CLI::App const& c)
{
    std::string out;
    for (CLI::Option const* const o : c.get_options()) {
        if (o->get_group().empty()) continue; // hidden
        out += ".TP\n" + names_of(*o) + "\n";
        std::string about = o->get_description();
        char const* const gap = about.find('\n') == about.npos ? " " : "\n"; // after a list
        if (!o->get_default_str().empty()) about += gap + ("(default: " + o->get_default_str() + ")");
        if (o->get_required() && !o->get_positional()) about += " (required)";
        out += paragraphs(about.empty() ? "(see above)" : about);
    }
    return out;
}

std::string section_of(CLI::App const& c, std::string const& name)
{
    std::string out = ".SS " + in_quotes(name) + "\n" + paragraphs(c.get_description()) + ".PP\n" +
                      synopsis(c, name) + options(c);
    if (!c.get_footer().empty()) out += ".PP\n" + verbatim(c.get_footer());
    for (CLI::App const* const s : subcommands(c)) out += section_of(*s, name + " " + s->get_name());
    return out;
}

} // namespace

std::string man_page(CLI::App const& command, std::string const& name, std::string const& version)
{
    std::string title = name;
    std::ranges::replace(title, ' ', '-');
    std::string const about = command.get_description().substr(0, command.get_description().find('\n'));
    std::string out =
        fmt::format(".TH {} 1 \"\" {} {}\n.ad l\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n", in_quotes(title),
                    in_quotes(version), in_quotes("Lightwell"), roff(title), roff(about));
    out += synopsis(command, name) + ".SH DESCRIPTION\n" + paragraphs(command.get_description()) +
           ".SH OPTIONS\n" + options(command);
    if (auto const parts = subcommands(command); !parts.empty()) {
        out += ".SH COMMANDS\n";
        for (CLI::App const* const s : parts) out += section_of(*s, name + " " + s->get_name());
    }
    if (!command.get_footer().empty()) out += ".SH NOTES\n" + verbatim(command.get_footer());
    if (name != "lightwell") out += ".SH SEE ALSO\n.BR lightwell (1)\n";
    return out;
}

} // namespace viewer
