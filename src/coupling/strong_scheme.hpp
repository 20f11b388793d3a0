// A strong coupling scheme as a run holds it: a type of the concept Scheme (kernels/coupling/scheme.hpp) behind virtual calls, a
// few per evaluation of the window. Made by the files scheme_*.cpp, held by window.cpp; tested in
// tests/src/coupling/window_test.cpp. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "kernels/coupling/differences.hpp"
#include "src/coupling/coupling_options.hpp"

namespace spindrift::coupling {

/// What a scheme may ask of a window: all of it, or one part after the other.
class WindowParts {
 public:
  virtual Vector evaluate(const Vector& x) = 0;
  virtual Vector first(const Vector& x) = 0;   ///< bodies: loads to motions
  virtual Vector second(const Vector& y) = 0;  ///< rotor: motions to loads

 protected:
  ~WindowParts() = default;
};

class StrongScheme {
 public:
  static constexpr std::string_view name = "strong";  // of the concept; the scene's name is CouplingScheme::name
  virtual ~StrongScheme() = default;
  virtual void begin_window() = 0;
  virtual Vector evaluate(WindowParts& window, const Vector& x) = 0;
  virtual Vector next(const Vector& x, const Vector& r) = 0;
  virtual void end_window(bool converged) = 0;
  virtual void clear() = 0;
  virtual int columns() const = 0;
  virtual bool probing() const = 0;
  virtual void visit(Saver& v) = 0;
  virtual void visit(Loader& v) = 0;
};

template <Scheme S>
class StrongSchemeOf final : public StrongScheme {
 public:
  explicit StrongSchemeOf(S scheme) : scheme_(std::move(scheme)) {}
  void begin_window() override { scheme_.begin_window(); }
  Vector evaluate(WindowParts& window, const Vector& x) override {
    if constexpr (requires { scheme_.evaluate(window, x); })
      return scheme_.evaluate(window, x);
    else
      return window.evaluate(x);
  }
  Vector next(const Vector& x, const Vector& r) override { return scheme_.next(x, r); }
  void end_window(bool converged) override { scheme_.end_window(converged); }
  void clear() override { scheme_.clear(); }
  int columns() const override { return scheme_.columns(); }
  bool probing() const override { return scheme_.probing(); }
  void visit(Saver& v) override { scheme_.visit(v); }
  void visit(Loader& v) override { scheme_.visit(v); }

 private:
  S scheme_;
};

template <Scheme S>
std::unique_ptr<StrongScheme> strong_scheme(S scheme) {
  return std::make_unique<StrongSchemeOf<S>>(std::move(scheme));
}

inline LearningOptions learning(const CouplingOptions& o) { return {o.reuse_windows, o.filter}; }

}  // namespace spindrift::coupling
