#pragma once
// The settings of the methods: one plain struct for each that has any, declared in its folder and found by its type.
// Who passes settings on names no method.

#include <memory>
#include <typeindex>
#include <utility>
#include <vector>

namespace gi {

/// Copies are deep. A reference from of() stays valid as long as the object.
class MethodSettings {
public:
    MethodSettings() = default;
    MethodSettings(MethodSettings&&) = default;
    MethodSettings& operator=(MethodSettings&&) = default;
    MethodSettings(MethodSettings const& other) { *this = other; }
    MethodSettings& operator=(MethodSettings const& other)
    {
        std::vector<Entry> copies;
        for (auto const& [type, held] : other.held_) copies.emplace_back(type, held->copy());
        held_ = std::move(copies);
        return *this;
    }

    /// The struct of this type, with its defaults if nothing has been set.
    template <class T>
    T& of()
    {
        if (Held* const h = find(typeid(T))) return static_cast<Value<T>*>(h)->value;
        auto made = std::make_unique<Value<T>>();
        T& value = made->value;
        held_.emplace_back(typeid(T), std::move(made));
        return value;
    }
    template <class T>
    T const& of() const
    {
        static T const defaults{};
        Held const* const h = find(typeid(T));
        return h != nullptr ? static_cast<Value<T> const*>(h)->value : defaults;
    }

private:
    struct Held {
        virtual ~Held() = default;
        virtual std::unique_ptr<Held> copy() const = 0;
    };
    template <class T>
    struct Value final : Held {
        std::unique_ptr<Held> copy() const override { return std::make_unique<Value>(*this); }
        T value{};
    };
    using Entry = std::pair<std::type_index, std::unique_ptr<Held>>;

    Held* find(std::type_index type) const
    {
        for (auto const& [of, held] : held_)
            if (of == type) return held.get();
        return nullptr;
    }

    std::vector<Entry> held_;
};

} // namespace gi
