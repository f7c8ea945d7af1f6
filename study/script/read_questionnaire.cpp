#include "study/script/read.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

/// Adds what is wrong; the id is empty if that is not known.
QuestionnaireItem read_item(gi::Yaml const& y, RatingScale const* usual, Mistakes& m)
{
    m.check_keys(y, "item");
    QuestionnaireItem item;
    m.need(y, "id", "q1", [&](gi::Yaml const& v) { item.id = v.name(); });
    m.need(y, "text", "\"How real did it look?\"", [&](gi::Yaml const& v) { item.text = v.text(); });
    bool const knows_type = m.take(y, "type", [&](gi::Yaml const& v) {
        item.type = ItemType(v.one_of({"scale", "text"}, "type of item"));
    });
    m.take(y, "required", [&](gi::Yaml const& v) { item.is_required = v.boolean(); });
    if (!knows_type) return item;
    bool const is_text = item.type == ItemType::text;
    for (char const* key : {"min", "max", "step", "labels", "reverse"})
        if (is_text && y.has(key))
            m.add(y.at(key).error(fmt::format("'{}' of the text '{}'", key, item.id), "only scales have it",
                                  "remove it, or 'type: text'"));
    for (char const* key : {"lines", "max_chars"})
        if (!is_text && y.has(key))
            m.add(y.at(key).error(fmt::format("'{}' of the scale '{}'", key, item.id), "only texts have it",
                                  "remove it, or write 'type: text'"));
    if (is_text) {
        m.take(y, "lines", [&](gi::Yaml const& v) { item.lines = int(v.integer(1, 50)); });
        m.take(y, "max_chars", [&](gi::Yaml const& v) { item.max_chars = int(v.integer(1, 10000)); });
        return item;
    }
    if (usual != nullptr) {
        item.low = usual->low;
        item.high = usual->high;
        item.step = usual->step;
        for (auto const& [unused, label] : usual->labels) item.labels.push_back(label);
    }
    bool knows_range = m.take(y, "min", [&](gi::Yaml const& v) { item.low = v.number(-1e6, 1e6); });
    knows_range &= m.take(y, "max", [&](gi::Yaml const& v) { item.high = v.number(-1e6, 1e6); });
    knows_range &= m.take(y, "step", [&](gi::Yaml const& v) { item.step = v.number(1e-6, 1e6); });
    double const steps = (item.high - item.low) / item.step;
    if (knows_range && (!(steps >= 1 && steps <= 1e5) || std::abs(steps - std::round(steps)) > 1e-6)) {
        m.add(y.error(
            fmt::format("item '{}' goes from {:g} to {:g} by {:g}", item.id, item.low, item.high, item.step),
            "it needs at least two values, the last of them max", "change max or step"));
        knows_range = false;
    }
    m.take(y, "labels", [&](gi::Yaml const& v) {
        item.labels.clear();
        for (gi::Yaml const& label : v.items()) item.labels.push_back(label.text());
        bool const fits =
            item.labels.empty() || item.labels.size() == 2 || double(item.labels.size()) == std::round(steps) + 1;
        if (knows_range && !fits)
            throw v.error(fmt::format("{} labels", item.labels.size()),
                          "labels are for the two ends, or for every step", "change their number");
    });
    m.take(y, "reverse", [&](gi::Yaml const& v) { item.is_reversed = v.boolean(); });
    return item;
}

/// @param knows_items  all items of the questionnaire have ids
Subscale read_subscale(gi::Yaml const& name, gi::Yaml const& y, Questionnaire const& q, bool knows_items,
                       Mistakes& m)
{
    std::size_t const before = m.count();
    m.check_keys(y, "subscale");
    Subscale s;
    m.attempt([&] { s.name = name.name(); });
    std::vector<std::string> ids;
    for (QuestionnaireItem const& item : q.items) ids.push_back(item.id);
    auto const read_id = [&](gi::Yaml const& id) {
        if (!knows_items && std::find(ids.begin(), ids.end(), id.text()) == ids.end()) return;
        s.items.push_back(id.one_of(ids, "item"));
        if (q.items[std::size_t(s.items.back())].type == ItemType::text)
            throw id.error(fmt::format("item '{}' in the scale '{}'", id.text(), s.name),
                           "its answer is a text, which has no score", "remove it");
    };
    m.need(y, "items", "[q1, q2]", [&](gi::Yaml const& v) {
        for (gi::Yaml const& id : v.one_or_more()) m.attempt([&] { read_id(id); });
        if (s.items.empty() && knows_items && m.count() == before)
            throw y.error("scale '" + s.name + "' has no items", "it has no score", "name some");
    });
    bool const knows_score = m.take(y, "score", [&](gi::Yaml const& v) {
        s.combine = Combine(v.one_of({"sum", "mean", "count"}, "way to score"));
    });
    m.take(y, "weight", [&](gi::Yaml const& v) { s.weight = v.number(-1e6, 1e6); });
    m.take(y, "offset", [&](gi::Yaml const& v) { s.offset = v.number(-1e6, 1e6); });
    m.take(y, "at_least", [&](gi::Yaml const& v) { s.at_least = v.number(-1e6, 1e6); });
    if (knows_score && (s.combine == Combine::count) != y.has("at_least"))
        m.add(y.error("'at_least' and 'score: count' belong together", "at_least defines what is counted",
                      "give both or none"));
    return s;
}

void read_items(gi::Yaml const& y, Questionnaire& q, Mistakes& m)
{
    std::optional<RatingScale> usual;
    m.take(y, "scale", [&](gi::Yaml const& v) { usual = read_scale(v, m); });
    std::set<std::string> ids;
    std::size_t const before = m.count();
    bool knows_items = true;
    m.need(y, "items", "[{id: q1, text: \"...\"}]", [&](gi::Yaml const& list) {
        for (gi::Yaml const& item : list.items())
            m.attempt([&] {
                q.items.push_back(read_item(item, usual ? &*usual : nullptr, m));
                std::string const& id = q.items.back().id;
                knows_items &= !id.empty();
                if (!id.empty() && !ids.insert(id).second)
                    throw item.error("item '" + id + "' twice", "tables could not distinguish them", "rename one");
            });
    });
    bool const is_told = q.items.empty() && m.count() > before;
    if ((q.items.empty() || q.items.size() > 1000) && !is_told)
        m.add(y.error(fmt::format("questionnaire '{}' has {} items", q.name, q.items.size()),
                      "1 to 1000 are allowed", "change it"));
    if (y.has("scales"))
        for (auto const& [name, scale] : m.entries(y.at("scales")))
            q.subscales.push_back(read_subscale(name, scale, q, knows_items && !q.items.empty(), m));
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
