// What the kernels of the air cost: nanoseconds per face or cell over rows in cache, and the share of the multiply-add ceiling
// that the counted operations make (a division or square root counts one, an addition one; the ceiling counts two for a
// multiply-add). Processor time of the thread, best of several: other processes only ever add. Rows lie in the second-level
// cache, as a tile's do. Run by perf/run; figures are quoted in docs/developer/notes/air_kernels.md. SPDX-License-Identifier:
// Apache-2.0
#include <ctime>
#include <limits>

#include "kernels/gas/jacobians.hpp"
#include "kernels/gas/muscl.hpp"
#include "kernels/turbulence/model_sa.hpp"
#include "kernels/turbulence/model_sst.hpp"
#include "perf/harness.hpp"

using namespace spindrift;
using namespace spindrift::gas;

namespace {

using Row = Wide<double, 8>;                 // as src/aero/flow sweeps
constexpr int width = 512, components = 40;  // cells of a row with its neighbours

/// Counts what is computed with it; its values are those of double.
struct Counted {
  double x;
  static inline long operations = 0;
  Counted() = default;
  Counted(double v) : x(v) {}
  friend Counted operator+(Counted a, Counted b) { return ++operations, a.x + b.x; }
  friend Counted operator-(Counted a, Counted b) { return ++operations, a.x - b.x; }
  friend Counted operator*(Counted a, Counted b) { return ++operations, a.x * b.x; }
  friend Counted operator/(Counted a, Counted b) { return ++operations, a.x / b.x; }
  Counted operator-() const { return -x; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  friend bool operator<(Counted a, Counted b) { return ++operations, a.x < b.x; }
  friend bool operator<=(Counted a, Counted b) { return ++operations, a.x <= b.x; }
  friend bool operator>(Counted a, Counted b) { return b < a; }
  friend bool operator>=(Counted a, Counted b) { return b <= a; }
  friend Counted max(Counted a, Counted b) { return a > b ? a : b; }
  friend Counted min(Counted a, Counted b) { return a < b ? a : b; }
  friend Counted abs(Counted a) { return std::abs(a.x); }
  friend Counted sqrt(Counted a) { return ++operations, std::sqrt(a.x); }
  friend Counted select(bool mask, Counted yes, Counted no) { return mask ? yes : no; }
  // Polynomials of wide_math.hpp: 7 + 14 terms and what surrounds them.
  friend Counted log(Counted a) { return operations += 30, std::log(a.x); }
  friend Counted log1p(Counted a) { return operations += 36, std::log1p(a.x); }
  friend Counted exp(Counted a) { return operations += 36, std::exp(a.x); }
  friend Counted expm1(Counted a) { return operations += 37, std::expm1(a.x); }
};

struct Rows {
  std::vector<double> data = std::vector<double>(std::size_t(width + 16) * components);
  const double* component(int c) const { return data.data() + std::size_t(c) * (width + 16) + 8; }
  Rows() {  // a smooth flow at Mach 0.2 with a boundary layer's gradients
    for (int c = 0; c < components; ++c)
      for (int i = -8; i < width + 8; ++i) {
        const double s = std::sin(0.05 * i + c);
        double& x = data[std::size_t(c) * (width + 16) + 8 + i];
        const double values[] = {200.0 * s, 60.0 + 5.0 * s, 3.0 * s, -2.0 * s, 1.0 + s, 0.6, 0.0, 0.8, 1e-4, 0.1 * s};
        x = c < 10 ? values[c] : c < 30 ? 1e3 * s + 10.0 : 1e-3 * (1.5 + s);
      }
  }
};

/// Seconds of processor time of one call, the least of several runs.
template <class Body>
double processor_seconds(Body&& body) {
  const auto now = [] {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  };
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 40; ++run) {
    const int calls = 40;
    const double start = now();
    for (int n = 0; n < calls; ++n) {
      body();
      asm volatile("" : : : "memory");
    }
    best = std::min(best, (now() - start) / calls);
  }
  return best;
}

/// Multiply-adds per second times two, of 12 chains.
double ceiling() {
  constexpr int chains = 12, rounds = 20000;
  using Register = NativeWide<double>;
  Register sum[chains];
  for (int n = 0; n < chains; ++n) sum[n] = Register(n);
  Register factor(0.999), term(1e-3);
  const double seconds = processor_seconds([&] {
    perf::keep(factor), perf::keep(term);
    for (int round = 0; round < rounds; ++round)
      for (int n = 0; n < chains; ++n) sum[n] = fma(sum[n], factor, term);
    for (int n = 0; n < chains; ++n) perf::keep(sum[n]);
  });
  return 2.0 * Register::size * chains * rounds / seconds;
}

template <class Real>
struct Cell {
  const Rows& rows;
  int i;
  Real number(int c) const {
    if constexpr (std::is_same_v<Real, Counted>)
      return rows.component(c)[i];
    else
      return Real::load(rows.component(c) + i);
  }
  Primitive<Real> state(int shift = 0) const {
    const Cell at{rows, i + shift};
    return {at.number(0), at.number(1), at.number(2), at.number(3), at.number(4)};
  }
  Face<Real> face() const { return {number(5), number(6), number(7), number(8), number(9)}; }
  Vector<Real> vector(int c) const { return {number(c), number(c + 1), number(c + 2)}; }
  Gradients<Real> gradients(int shift = 0) const {
    const Cell at{rows, i + shift};
    return {at.vector(10), at.vector(13), at.vector(16), at.vector(19)};
  }
};

/// Times kernel(cell) -> something summable by its stored numbers, over a row.
template <class Kernel>
void report(perf::Group& group, const std::string& name, const char* unit, double peak, const Rows& rows, Kernel&& kernel) {
  alignas(64) static double out[width + 16];
  const double seconds = processor_seconds([&] {
    for (int i = 0; i < width; i += Row::size) kernel(Cell<Row>{rows, i}).store(out + i);
    perf::keep(out[7]);
  });
  Counted::operations = 0;
  for (int i = 0; i < width; i += 8) kernel(Cell<Counted>{rows, i});
  const double operations = double(Counted::operations) / (width / 8), ns = 1e9 * seconds / width;
  group.figure(name, ns, unit, std::to_string(int(operations)) + " operations");
  group.figure(name + "/of_ceiling", operations / ns * 1e9 / peak, "-");
}

template <class Real>
Real total(const Conserved<Real>& c) {
  return (c.rho + c.mx) + (c.my + c.mz) + c.E;
}
template <class Real>
Real total(const Block5<Real>& b) {
  Real sum(0.0);
  for (const auto& row : b.m)
    for (const Real& x : row) sum = sum + x;
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  perf::Group group("air_kernels", argc, argv);
  const Rows rows;
  const double peak = ceiling();
  group.figure("ceiling", peak * 1e-9, "GFLOP/s", "multiply-add, double, one core, processor time");
  IdealGas gas;
  gas.pressure_reference = 101325.0, gas.temperature_reference = 288.15;

  const auto flux = [&](const auto& scheme) {
    report(group, "flux/" + std::string(scheme.name), "ns/face", peak, rows,
           [&](const auto& c) { return total(scheme(gas, c.state(-1), c.state(), c.face())); });
  };
  flux(OsherP{}), flux(OsherO{}), flux(Roe{}), flux(RoeLowMach{}), flux(Rusanov{});
  const auto second_order = [&](const auto& limiter, const auto& scheme) {
    report(group, "muscl_flux/" + std::string(limiter.name) + "/" + std::string(scheme.name), "ns/face", peak, rows,
           [&](const auto& c) {
             const auto s = muscl(gas, limiter, c.state(-2), c.state(-1), c.state(), c.state(1));
             return total(scheme(gas, s.l, s.r, c.face()));
           });
  };
  second_order(Unlimited{}, RoeLowMach{}), second_order(VanAlbada{}, RoeLowMach{}), second_order(VanAlbada{}, OsherP{});
  report(group, "viscous/full", "ns/face", peak, rows, [&](const auto& c) {
    const auto l = c.state(-1), r = c.state();
    const auto f = c.face();
    const auto q = 0.5 * (l + r);
    const auto t = transport(gas, viscosity(gas, absolute_temperature(gas, q)), c.number(30));
    return total(
        viscous_flux(t, face_gradients(c.gradients(-1), c.gradients(), l, r, face_line(c.vector(31), f)), q.u, q.v, q.w, f));
  });
  report(group, "viscous/thin_layer", "ns/face", peak, rows, [&](const auto& c) {
    const auto l = c.state(-1), r = c.state();
    const auto f = c.face();
    const auto q = 0.5 * (l + r);
    const auto t = transport(gas, viscosity(gas, absolute_temperature(gas, q)), c.number(30));
    return total(viscous_flux(t, thin_layer_gradients(l, r, face_line(c.vector(31), f)), q.u, q.v, q.w, f));
  });
  const auto source = [&](const auto& model) {
    constexpr int n = std::remove_cvref_t<decltype(model)>::equations;
    report(group, "source/" + std::string(model.name), "ns/cell", peak, rows, [&]<class Real>(const Cell<Real>& c) {
      const turbulence::Flow<Real> flow{Real(1.2),    Real(1.8e-5), c.number(30), c.vector(10),
                                        c.vector(13), c.vector(16), c.vector(31)};
      turbulence::Turbulence<Real, n> t;
      for (int k = 0; k < n; ++k) t.q[k] = c.number(34 + k) + Real(k), t.gradient[k] = c.vector(19 + 3 * k);
      return model.source(flow, t).rate[n - 1] + model.closure(flow, t).eddy_viscosity;
    });
  };
  source(turbulence::Sa{}), source(turbulence::SaNeg{}), source(turbulence::Sst{});
  const auto jacobian = [&](const auto& scheme) {
    report(group, "jacobian/" + std::string(scheme.name), "ns/face", peak, rows, [&](const auto& c) {
      const auto J = flux_jacobian(scheme, gas, c.state(-1), c.state(), c.face());
      return total(J.left) + total(J.right);
    });
  };
  jacobian(RoeLowMach{}), jacobian(Rusanov{});
}
