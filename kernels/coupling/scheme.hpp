// What makes coupling schemes interchangeable: interface data x goes in, the parts return x~, and a scheme turns x and the
// residual r = x~ - x into the next x. What a scheme carries from one evaluation or window to the next is listed once, by
// `visit`, and so is saved and restored bit for bit. Schemes: relaxation_*.hpp, iqn_ils.hpp, ibqn_ls.hpp, interface_gmres.hpp,
// newton.hpp; driven by solve_window.hpp. Theory: docs/theory/coupling.md. Tested in tests/kernels/coupling.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <span>
#include <string_view>
#include <vector>

namespace spindrift::coupling {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Iterates within a window. Rows of x must compare (the caller scales them): schemes take their Euclidean norm.
template <class S>
concept Scheme = requires(S& scheme, const Vector& x, const Vector& r, bool converged) {
  { S::name } -> std::convertible_to<std::string_view>;
  scheme.begin_window();
  { scheme.next(x, r) } -> std::convertible_to<Vector>;  ///< the x to evaluate after the one just evaluated
  scheme.end_window(converged);                          ///< what it learned may serve the next window
  scheme.clear();                                        ///< forgets everything learned
  { scheme.columns() } -> std::convertible_to<int>;      ///< differences kept now
  { scheme.probing() } -> std::convertible_to<bool>;     ///< the x returned last tries a direction; it is no iterate
};

// History as plain data: a visitor meets every member in the order of `visit`.

/// Appends what it meets.
struct Saver {
  std::vector<double>& out;
  void operator()(const double& value) { out.push_back(value); }
  void operator()(const int& value) { out.push_back(value); }
  void operator()(const bool& value) { out.push_back(value); }
  void operator()(const Matrix& m) {
    out.push_back(double(m.rows())), out.push_back(double(m.cols()));
    out.insert(out.end(), m.data(), m.data() + m.size());
  }
  void operator()(const Vector& v) {
    out.push_back(double(v.size()));
    out.insert(out.end(), v.data(), v.data() + v.size());
  }
  template <class T>
  void operator()(const std::vector<T>& list) {
    out.push_back(double(list.size()));
    for (const T& entry : list) (*this)(entry);
  }
};

/// Reads it back in the same order; `intact` turns false where the data do not fit.
struct Loader {
  std::span<const double> in;
  bool intact = true;
  double take() {
    if (in.empty()) return intact = false, 0.0;
    const double value = in.front();
    in = in.subspan(1);
    return value;
  }
  Eigen::Index take_size(std::size_t each = 1) {
    const double value = take();
    if (!(value >= 0.0) || value * double(each) > double(in.size())) return intact = false, 0;
    return Eigen::Index(value);
  }
  void operator()(double& value) { value = take(); }
  void operator()(int& value) { value = int(take()); }
  void operator()(bool& value) { value = take() != 0.0; }
  void operator()(Matrix& m) {
    const Eigen::Index rows = take_size(0), columns = take_size(std::size_t(rows));
    if (!intact) return;
    m.resize(rows, columns);
    for (Eigen::Index i = 0; i < m.size(); ++i) m.data()[i] = take();
  }
  void operator()(Vector& v) {
    v.resize(take_size());
    for (double& value : v) value = take();
  }
  template <class T>
  void operator()(std::vector<T>& list) {
    list.assign(std::size_t(take_size()), T());
    for (T& entry : list) (*this)(entry);
  }
};

template <class S>
void save_history(S& scheme, std::vector<double>& out) {
  Saver saver{out};
  scheme.visit(saver);
}
/// False where `in` is not what save_history wrote for such a scheme; reads from the front and moves `in` on.
template <class S>
bool restore_history(S& scheme, std::span<const double>& in) {
  Loader loader{in};
  scheme.visit(loader);
  in = loader.in;
  return loader.intact;
}

}  // namespace spindrift::coupling
