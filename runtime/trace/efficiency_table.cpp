// The efficiency of a run as text for a person: a line where no records were kept, else a table with one thing a line, percent of
// the threads' time where it is a part of it.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "runtime/trace/efficiency.hpp"

namespace spindrift::runtime {

namespace {

[[gnu::format(printf, 2, 3)]] void print(std::string& out, const char* format, ...) {
  char line[256];
  std::va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(line, sizeof line, format, arguments);
  va_end(arguments);
  out += line;
}

/// "-" where it is unknown.
std::string text(double value, const char* format = "%.4g") {
  if (std::isnan(value)) return "-";
  char number[32];
  std::snprintf(number, sizeof number, format, value);
  return number;
}

void line(std::string& out, const char* name, double part, const std::string& remark = "") {
  print(out, "  %-30s %6s %%", name, text(100.0 * part, "%.1f").c_str());
  out += (remark.empty() ? "" : "   ") + remark + "\n";
}

void add_modules(std::string& out, const Efficiency& e) {
  print(out, "  %-20s %12s %12s %12s %12s\n", "module", "busy core-s", "waiting for", "exposed", "alone s");
  for (const ModuleTimes& m : e.modules)
    print(out, "  %-20.20s %12s %12s %12s %12s\n", m.module.c_str(), text(m.busy_s).c_str(), text(m.idle_s).c_str(),
          text(m.exposed_s).c_str(), text(m.alone_s).c_str());
}

void add_critical_path(std::string& out, const Efficiency& e) {
  constexpr std::size_t most = 6;
  const double recorded_s = e.recorded * e.elapsed_s;
  print(out, "  %-30s %6.1f %%   %.4g s of %.4g s recorded\n", "critical path", 100.0 * e.critical_path_s / recorded_s,
        e.critical_path_s, recorded_s);
  for (std::size_t n = 0; n < e.critical_path.size() && n < most; ++n)
    print(out, "    %-40.40s %10.4g s\n", e.critical_path[n].label.c_str(), e.critical_path[n].seconds);
  if (e.critical_path.size() > most) print(out, "    and %zu more labels\n", e.critical_path.size() - most);
}

}  // namespace

std::string efficiency_table(const Efficiency& e) {
  std::string out;
  if (std::isnan(e.critical_path_s)) {  // no records: the factors that are known, in a line
    print(out,
          "%d thread%s on %d rank%s, busy for %.1f %% of the time: parallel efficiency = load balance %.1f %% x communication "
          "%.1f %%",
          e.threads, e.threads == 1 ? "" : "s", e.ranks, e.ranks == 1 ? "" : "s", 100.0 * e.parallel, 100.0 * e.load_balance,
          100.0 * e.communication);
    return out;
  }
  const double all = e.threads * e.elapsed_s;
  const auto part = [all](double core_s) { return all > 0.0 ? core_s / all : 0.0; };
  print(out, "efficiency: %d threads of %d ranks, %.4g s in the graph\n", e.threads, e.ranks, e.elapsed_s);
  line(out, "parallel efficiency", e.parallel, "= load balance x communication efficiency");
  line(out, "load balance", e.load_balance);
  line(out, "communication efficiency", e.communication, "= serialisation x transfer");
  line(out, "  serialisation", e.serialisation);
  line(out, "  transfer", e.transfer);
  std::string waiting = text(e.idle_s) + " core-s";
  if (!std::isnan(e.exposed_s))
    waiting += ": messages under way " + text(e.exposed_s) + ", late ranks " + text(e.partner_wait_s) + ", own tasks " +
               text(e.idle_s - e.exposed_s - e.partner_wait_s);
  line(out, "waiting", part(e.idle_s), waiting);
  line(out, "completing messages", part(e.poll_s));
  line(out, "runtime overhead", part(e.overhead_s));
  add_modules(out, e);
  print(out, "  %-30s %8s   least time of the modules in turn / time taken together\n", "overlap gained",
        ("x " + text(e.overlap_gain, "%.3f")).c_str());
  add_critical_path(out, e);
  if (e.recorded < 0.995)
    print(out, "  records cover %.1f %% of the run; the division of waiting is taken from that part\n", 100.0 * e.recorded);
  return out;
}

}  // namespace spindrift::runtime
