// Declaring the parameters of a scene section once: key, unit, default, range, sentence, and the member of the plain
// options struct it fills. The reader, `spindrift check`, the echo of a run and inputs/REFERENCE.md all come from it.
// A default is the member's initial value. How to declare: src/scene/README.md. Used by the options.cpp of every module.
// Tested in tests/src/scene/section_test.cpp.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "kernels/base/constants.hpp"
#include "src/scene/parameter.hpp"

namespace spindrift::scene {

/// Says that something is wrong with `key` of the section being checked; an empty key means the section.
using Report = std::function<void(std::string_view key, std::string message)>;

/// A section's declaration with the options type erased: what readers, echo and reference work with.
class SectionBase {
 public:
  const std::string& name() const { return name_; }  ///< "time", "bodies"; of a nested section: its word in the reference
  const std::string& help() const { return help_; }
  bool is_named() const { return named_; }  ///< [bodies.NAME] rather than [time]
  const std::vector<Parameter>& parameters() const { return parameters_; }
  const Parameter* find(std::string_view key) const;

  /// Of `keys`, exactly one is given (at_most: or none) among those that have an effect.
  struct Exclusive {
    std::vector<std::string> keys;
    bool at_most;
  };
  const std::vector<Exclusive>& exclusives() const { return exclusives_; }
  const std::vector<std::function<void(const void*, const Report&)>>& checks() const { return checks_; }
  std::shared_ptr<void> default_options() const { return make_(); }

  /// What is wrong with the declaration itself: a default outside its range, a key without its unit, a missing sentence ...
  /// Empty for a good one; a test holds every section of the program to it.
  std::vector<std::string> faults() const;

 protected:
  SectionBase(std::string name, std::string help, std::function<std::shared_ptr<void>()> make)
      : name_(std::move(name)), help_(std::move(help)), make_(std::move(make)) {}
  Parameter& last();

  std::string name_, help_;
  bool named_ = false;
  std::vector<Parameter> parameters_;
  std::vector<Exclusive> exclusives_;
  std::vector<std::function<void(const void*, const Report&)>> checks_;
  std::function<std::shared_ptr<void>()> make_;
};

namespace detail {

template <class T>
struct Inside {
  using type = T;
  static constexpr bool is_optional = false;
};
template <class T>
struct Inside<std::optional<T>> {
  using type = T;
  static constexpr bool is_optional = true;
};

/// Fixed numbers: an Eigen vector or matrix of doubles, or a std::array; recognised without their headers.
template <class T>
constexpr std::size_t fixed_size() {
  if constexpr (requires { T::SizeAtCompileTime; })
    return std::size_t(T::SizeAtCompileTime);
  else
    return std::tuple_size_v<T>;
}

template <class T>
Slot slot_of(T& x) {
  if constexpr (std::is_constructible_v<Slot, T*>)
    return &x;
  else
    return std::span<double>(x.data(), fixed_size<T>());
}

template <class Options, class M>
Member access(M Options::*member) {
  Member result;
  if constexpr (Inside<M>::is_optional) {
    result.has = [member](const void* o) { return (static_cast<const Options*>(o)->*member).has_value(); };
    result.slot = [member](void* o) {
      auto& value = static_cast<Options*>(o)->*member;
      return slot_of(value ? *value : value.emplace());
    };
  } else {
    result.slot = [member](void* o) { return slot_of(static_cast<Options*>(o)->*member); };
  }
  return result;
}

template <class Options, class M>
void add_list_access(Member& result, std::vector<M> Options::*member) {
  result.size = [member](const void* o) { return (static_cast<const Options*>(o)->*member).size(); };
  result.resize = [member](void* o, std::size_t n) { (static_cast<Options*>(o)->*member).assign(n, M()); };
}

}  // namespace detail

/// The declaration of one section, filling an Options struct. Methods name a kind and return *this for the next;
/// modifiers (required, only_if, size) speak of the parameter declared last.
template <class Options>
class Section : public SectionBase {
 public:
  Section(std::string name, std::string help)
      : SectionBase(std::move(name), std::move(help), [] { return std::make_shared<Options>(); }) {}

  /// [name.NAME], any number of them, read by Document::read_named.
  Section& named() {
    named_ = true;
    return *this;
  }

  // Kinds. M is the type named or a std::optional of it, unless the comment says otherwise; Of is Options or one of its bases.
  template <class M, class Of>
  Section& number(std::string key, M Of::*m, std::string unit, std::string help, Range range = any()) {
    return add<M>(Kind::number, std::move(key), m, std::move(unit), std::move(help), range);
  }
  /// Degrees in the file, radians in the options. `unit`: of a rate "deg/s", of its rate "deg/s2".
  template <class M, class Of>
  Section& degrees(std::string key, M Of::*m, std::string help, Range range = any(), std::string unit = "deg") {
    return scaled<M>(number_like<M>(), std::move(key), m, std::move(unit), std::move(help), range, radians_per_degree);
  }
  /// Revolutions per minute in the file, rad/s in the options.
  template <class M, class Of>
  Section& rpm(std::string key, M Of::*m, std::string help, Range range = any()) {
    return scaled<M>(number_like<M>(), std::move(key), m, "rpm", std::move(help), range, rad_s_per_rpm);
  }
  template <class M, class Of>
  Section& integer(std::string key, M Of::*m, std::string unit, std::string help, Range range = any()) {
    return add<M>(Kind::integer, std::move(key), m, std::move(unit), std::move(help), range);
  }
  template <class M, class Of>
  Section& flag(std::string key, M Of::*m, std::string help) {
    return add<M>(Kind::flag, std::move(key), m, "", std::move(help), any());
  }
  template <class M, class Of>
  Section& text(std::string key, M Of::*m, std::string help) {
    return add<M>(Kind::text, std::move(key), m, "", std::move(help), any());
  }
  /// An existing file (std::string, or std::vector<std::string> for a list of them).
  template <class M, class Of>
  Section& path(std::string key, M Of::*m, std::string help) {
    return add<M>(Kind::path, std::move(key), m, "", std::move(help), any());
  }
  /// Eigen::Vector3d, std::array<double, N>.
  template <class M, class Of>
  Section& vector(std::string key, M Of::*m, std::string unit, std::string help, Range range = any()) {
    return add<M>(Kind::vector, std::move(key), m, std::move(unit), std::move(help), range);
  }
  /// Eigen::Matrix3d, symmetric: [a, b, c] is its diagonal, or three rows of three.
  template <class M, class Of>
  Section& symmetric(std::string key, M Of::*m, std::string unit, std::string help) {
    return add<M>(Kind::symmetric, std::move(key), m, std::move(unit), std::move(help), any());
  }
  /// std::vector<double>.
  template <class M, class Of>
  Section& numbers(std::string key, M Of::*m, std::string unit, std::string help, Range range = any()) {
    return add<M>(Kind::numbers, std::move(key), m, std::move(unit), std::move(help), range);
  }
  /// std::vector<std::string>.
  template <class M, class Of>
  Section& texts(std::string key, M Of::*m, std::string help) {
    return add<M>(Kind::texts, std::move(key), m, "", std::move(help), any());
  }
  /// std::vector<std::string>, each the TOML text of a value of any type: what an override is given.
  template <class M, class Of>
  Section& values(std::string key, M Of::*m, std::string help) {
    return add<M>(Kind::values, std::move(key), m, "", std::move(help), any());
  }
  /// std::vector<std::array<double, N>> or of Eigen vectors: a list of rows of N numbers.
  template <class Row>
  Section& rows(std::string key, std::vector<Row> Options::*m, std::string unit, std::string help, Range range = any()) {
    Parameter& p = push(Kind::rows, std::move(key), std::move(unit), std::move(help), range);
    detail::add_list_access(p.member, m);
    p.member.row = [m](void* o, std::size_t i) {
      Row& row = (static_cast<Options*>(o)->*m)[i];
      return std::span<double>(row.data(), detail::fixed_size<Row>());
    };
    return *this;
  }

  /// One of a list of names (std::string member).
  Section& choice(std::string key, std::string Options::*m, std::vector<Choice> choices, std::string help) {
    std::vector<std::string> values;
    for (const Choice& c : choices) values.push_back(c.name);
    return add_choice(std::move(key), m, std::move(values), std::move(choices), std::move(help));
  }
  /// One of a list of names, each standing for a value of an enum: {"rk4", Integrator::rk4, "classical ..."}.
  template <class E>
  struct Case {
    std::string name;
    E value;
    std::string help;
  };
  template <class E, class Of>
  requires std::is_enum_v<E> Section& choice(std::string key, E Of::*m, std::vector<std::type_identity_t<Case<E>>> cases,
                                             std::string help) {
    std::vector<E> values;
    std::vector<Choice> choices;
    for (Case<E>& c : cases) values.push_back(c.value), choices.push_back({c.name, c.help});
    return add_choice<E>(std::move(key), m, std::move(values), std::move(choices), std::move(help));
  }

  /// Nested options under one key: [sea.grid]. Of a std::optional member: absent where the scene does not name it.
  template <class M, class Of>
  Section& table(std::string key, M Of::*m, const Section<typename detail::Inside<M>::type>& nested, std::string help) {
    Parameter& p = push(Kind::table, std::move(key), "", std::move(help), any());
    p.nested = &nested;
    if constexpr (detail::Inside<M>::is_optional) {
      p.optional = true;
      p.member.has = [m](const void* o) { return (static_cast<const Options*>(o)->*m).has_value(); };
      p.member.element = [m](void* o, std::size_t) -> void* {
        auto& value = static_cast<Options*>(o)->*m;
        return value ? &*value : &value.emplace();
      };
    } else {
      p.member.element = [m](void* o, std::size_t) -> void* { return &(static_cast<Options*>(o)->*m); };
    }
    return *this;
  }
  /// A list of nested options: [[bodies.platform.cylinders]]. The nested section must outlive this one (both static).
  template <class T, class Of>
  Section& tables(std::string key, std::vector<T> Of::*m, const Section<T>& nested, std::string help) {
    Parameter& p = push(Kind::tables, std::move(key), "", std::move(help), any());
    p.nested = &nested;
    detail::add_list_access<Options, T>(p.member, m);
    p.member.element = [m](void* o, std::size_t i) -> void* { return &(static_cast<Options*>(o)->*m)[i]; };
    return *this;
  }

  // Modifiers of the parameter declared last.
  Section& required() {
    last().required = true;
    return *this;
  }
  /// It has an effect only where `key` of the same section (a choice, text or flag: "true") is one of `values`;
  /// given elsewhere it is an error, and required there only. Several conditions must all hold.
  Section& only_if(std::string key, std::vector<std::string> values) {
    last().conditions.push_back({std::move(key), std::move(values)});
    return *this;
  }
  /// Number of entries of a list.
  Section& size(std::size_t low, std::size_t high = std::numeric_limits<std::size_t>::max()) {
    last().min_size = low, last().max_size = high;
    return *this;
  }

  // Rules of the section as a whole.
  /// Exactly one of these keys is given (of those that have an effect).
  Section& one_of(std::vector<std::string> keys) {
    exclusives_.push_back({std::move(keys), false});
    return *this;
  }
  Section& at_most_one_of(std::vector<std::string> keys) {
    exclusives_.push_back({std::move(keys), true});
    return *this;
  }
  /// A rule between keys of this section: check(options, report), called when every key is well by itself.
  template <class F>
  Section& check(F rule) {
    checks_.push_back([rule](const void* o, const Report& report) { rule(*static_cast<const Options*>(o), report); });
    return *this;
  }

 private:
  template <class M>
  static constexpr Kind number_like() {
    using T = typename detail::Inside<M>::type;
    if constexpr (std::is_same_v<T, double>)
      return Kind::number;
    else if constexpr (std::is_same_v<T, std::vector<double>>)
      return Kind::numbers;
    else
      return Kind::vector;
  }
  Parameter& push(Kind kind, std::string key, std::string unit, std::string help, Range range) {
    parameters_.push_back(
        Parameter{.key = std::move(key), .kind = kind, .unit = std::move(unit), .help = std::move(help), .range = range});
    return parameters_.back();
  }
  template <class M>
  Section& add(Kind kind, std::string key, M Options::*m, std::string unit, std::string help, Range range) {
    return scaled(kind, std::move(key), m, std::move(unit), std::move(help), range, 1.0);
  }
  template <class M>
  Section& scaled(Kind kind, std::string key, M Options::*m, std::string unit, std::string help, Range range, double scale) {
    Parameter& p = push(kind, std::move(key), std::move(unit), std::move(help), range);
    p.scale = scale;
    p.optional = detail::Inside<M>::is_optional;
    p.member = detail::access(m);
    return *this;
  }
  template <class T>
  Section& add_choice(std::string key, T Options::*m, std::vector<T> values, std::vector<Choice> choices, std::string help) {
    Parameter& p = push(Kind::choice, std::move(key), "", std::move(help), any());
    p.choices = std::move(choices);
    p.member.size = [m, values](const void* o) {  // values.size() where the member holds none of them
      std::size_t i = 0;
      while (i < values.size() && !(values[i] == static_cast<const Options*>(o)->*m)) ++i;
      return i;
    };
    p.member.resize = [m, values](void* o, std::size_t i) { static_cast<Options*>(o)->*m = values[i]; };
    return *this;
  }
};

}  // namespace spindrift::scene
