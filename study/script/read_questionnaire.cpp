#include "study/script/read.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

QuestionnaireItem read_item(gi::Yaml const& y, RatingScale const* usual)
{
    check_keys(y, "item");
    QuestionnaireItem item;
    item.id = y.needed("id", "q1").name();
    item.text = y.needed("text", "\"How real did it look?\"").text();
    if (y.has("type")) item.type = ItemType(y.at("type").one_of({"scale", "text"}, "type of item"));
    if (y.has("required")) item.is_required = y.at("required").boolean();
    bool const is_text = item.type == ItemType::text;
    for (char const* key : {"min", "max", "step", "labels", "reverse"})
        if (is_text && y.has(key))
            throw y.at(key).error(fmt::format("'{}' of the text '{}'", key, item.id), "only scales have it",
                                  "remove it, or 'type: text'");
    for (char const* key : {"lines", "max_chars"})
        if (!is_text && y.has(key))
            throw y.at(key).error(fmt::format("'{}' of the scale '{}'", key, item.id), "only texts have it",
                                  "remove it, or write 'type: text'");
    if (is_text) {
        if (y.has("lines")) item.lines = y.at("lines").integer(1, 50);
        if (y.has("max_chars")) item.max_chars = y.at("max_chars").integer(1, 10000);
        return item;
    }
    if (usual != nullptr) {
        item.low = usual->low;
        item.high = usual->high;
        item.step = usual->step;
        for (auto const& [unused, label] : usual->labels) item.labels.push_back(label);
    }
    if (y.has("min")) item.low = y.at("min").number(-1e6, 1e6);
    if (y.has("max")) item.high = y.at("max").number(-1e6, 1e6);
    if (y.has("step")) item.step = y.at("step").number(1e-6, 1e6);
    double const steps = (item.high - item.low) / item.step;
    if (!(steps >= 1 && steps <= 1e5) || std::abs(steps - std::round(steps)) > 1e-6)
        throw y.error(
            fmt::format("item '{}' goes from {:g} to {:g} by {:g}", item.id, item.low, item.high, item.step),
            "it needs at least two values, the last of them max", "change max or step");
    if (y.has("labels")) {
        item.labels.clear();
        for (gi::Yaml const& label : y.at("labels").items()) item.labels.push_back(label.text());
    }
    bool const fits =
        item.labels.empty() || item.labels.size() == 2 || double(item.labels.size()) == std::round(steps) + 1;
    if (!fits && y.has("labels"))
        throw y.at("labels").error(fmt::format("{} labels", item.labels.size()),
                                   "labels are for the two ends, or for every step", "change their number");
    if (y.has("reverse")) item.is_reversed = y.at("reverse").boolean();
    return item;
}

Subscale read_subscale(gi::Yaml const& name, gi::Yaml const& y, Questionnaire const& q)
{
    check_keys(y, "subscale");
    Subscale s;
    s.name = name.name();
    std::vector<std::string> ids;
    for (QuestionnaireItem const& item : q.items) ids.push_back(item.id);
    for (gi::Yaml const& id : y.needed("items", "[q1, q2]").one_or_more()) {
        s.items.push_back(id.one_of(ids, "item"));
        if (q.items[std::size_t(s.items.back())].type == ItemType::text)
            throw id.error(fmt::format("item '{}' in the scale '{}'", id.text(), s.name),
                           "its answer is a text, which has no score", "remove it");
    }
    if (s.items.empty()) throw y.error("scale '" + s.name + "' has no items", "it has no score", "name some");
    if (y.has("score")) s.combine = Combine(y.at("score").one_of({"sum", "mean", "count"}, "way to score"));
    if (y.has("weight")) s.weight = y.at("weight").number(-1e6, 1e6);
    if (y.has("offset")) s.offset = y.at("offset").number(-1e6, 1e6);
    if ((s.combine == Combine::count) != y.has("at_least"))
        throw y.error("'at_least' and 'score: count' belong together", "at_least defines what is counted",
                      "give both or none");
    if (y.has("at_least")) s.at_least = y.at("at_least").number(-1e6, 1e6);
    return s;
}

} // namespace

namespace {

void read_items(gi::Yaml const& y, Questionnaire& q, Mistakes& m)
{
    std::optional<RatingScale> usual;
    m.take(y, "scale", [&](gi::Yaml const& v) { usual = read_scale(v); });
    std::set<std::string> ids;
    std::size_t const before = m.count();
    m.need(y, "items", "[{id: q1, text: \"...\"}]", [&](gi::Yaml const& list) {
        for (gi::Yaml const& item : list.items())
            m.attempt([&] {
                q.items.push_back(read_item(item, usual ? &*usual : nullptr));
                if (!ids.insert(q.items.back().id).second)
                    throw item.error("item '" + q.items.back().id + "' twice", "tables could not distinguish them",
                                     "rename one");
            });
    });
    bool const is_told = q.items.empty() && m.count() > before;
    if ((q.items.empty() || q.items.size() > 1000) && !is_told)
        m.add(y.error(fmt::format("questionnaire '{}' has {} items", q.name, q.items.size()),
                      "1 to 1000 are allowed", "change it"));
    if (m.count() == before && y.has("scales")) // scores refer to items
        for (auto const& [name, scale] : m.entries(y.at("scales")))
            m.attempt([&, n = name, v = scale] { q.subscales.push_back(read_subscale(n, v, q)); });
}

} // namespace

std::vector<Questionnaire> read_questionnaires(gi::Yaml const& y, Mistakes& m)
{
    std::vector<Questionnaire> all;
    for (auto const& [key, value] : m.entries(y))
        m.attempt([&, k = key, v = value] {
            Questionnaire q;
            q.name = k.name();
            q.place = k.place();
            for (Questionnaire const& known : known_questionnaires())
                if (known.name == q.name)
                    throw k.error("questionnaire '" + q.name + "' is known already", "the name is taken",
                                  "choose another name");
            m.check_keys(v, "questionnaire");
            m.take(v, "title", [&](gi::Yaml const& x) { q.title = x.text(); });
            m.take(v, "instructions", [&](gi::Yaml const& x) { q.instructions = x.text(); });
            read_items(v, q, m);
            all.push_back(std::move(q));
        });
    return all;
}

} // namespace study
